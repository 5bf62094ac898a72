"""The cubic that goes from 0 to 1 between two values, level at both."""

from __future__ import annotations

import numpy as np

from agentface.conventions import Doubles, Floats


def smoothstep(start: Doubles | float, end: Doubles | float, value: Doubles | Floats) -> Doubles:
    """0 up to ``start``, 1 from ``end`` (either may be the larger), smooth between; of the shape of ``value``."""
    t = np.clip((value - start) / np.subtract(end, start), 0.0, 1.0)
    return np.asarray(t * t * (3.0 - 2.0 * t))


def falloff(value: Doubles | Floats, start: Doubles | float, end: Doubles | float) -> Doubles:
    """1 up to ``start``, 0 from ``end``, smooth between; of the shape of ``value``."""
    return 1.0 - smoothstep(start, end, value)
