"""What of the skin is seen beside the shirt."""

from __future__ import annotations

import numpy as np

from agentface.conventions import Indices
from agentface.head.model import HeadModel


def uncovered(model: HeadModel) -> Indices:
    """``(T, 3)``: the skin's triangles without those that lie under the shirt, whose ragged end could poke through."""
    chin = float(model.landmarks["menton"][1])
    forward = np.clip(model.vertices[:, 2] / 0.04 + 1.5, 0, 1)
    above = model.vertices[:, 1] > chin - 0.036 - 0.060 * forward
    return np.asarray(model.triangles[above[model.triangles].all(1)])
