"""FAP 1, which blends two of MPEG-4's visemes."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from agentface.conventions import Floats
from agentface.errors import InvalidValueError
from agentface.speech.visemes import VISEME_COUNT, Viseme, visemes

BLEND_STEPS = 63
"""The largest blend of FAP 1 and the largest intensity of FAP 2: six bits."""


def viseme_pose(first: int, second: int, blend: int, table: Sequence[Viseme] | None = None) -> Floats:
    """FAP 1: ``(COUNT,)`` float32, the first viseme by ``blend`` of 63 and the second by the rest.

    Raises InvalidValueError for numbers that are no visemes, and for a blend outside 0..63.
    """
    known = visemes() if table is None else table
    for what, number, largest in (
        ("viseme_select1", first, VISEME_COUNT - 1),
        ("viseme_select2", second, VISEME_COUNT - 1),
        ("viseme_blend", blend, BLEND_STEPS),
    ):
        check_step(what, number, largest)
    share = np.float32(blend / BLEND_STEPS)
    return np.asarray(share * known[first].values + (np.float32(1.0) - share) * known[second].values)


def check_step(what: str, number: int, largest: int) -> None:
    """Raise InvalidValueError for what is no whole number in ``0..largest``."""
    if isinstance(number, bool) or number != int(number) or not 0 <= number <= largest:
        raise InvalidValueError(what, f"a whole number in 0..{largest}", number)
