"""The chest: a breath lifts the shoulders and widens it about its back."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from agentface.conventions import Floats
from agentface.head.model import HeadModel
from agentface.parameters import indices_of

_RISE = 0.008  # m, of the shoulders with the deepest breath
_WIDER, _DEEPER = 0.012, 0.022  # of the chest's width and depth
_BACK = -0.06  # m behind the neck's axis; the back stays


class ChestTables(NamedTuple):
    """Where the breath stands in a pose, and what it does.

    Attributes:
        breath: index of the parameter.
        filled: ``(3, 4)`` float32, what a full chest adds to the unmoved one.
    """

    breath: int
    filled: Floats


def prepare(model: HeadModel) -> ChestTables:
    """The tables of a face."""
    (breath,) = indices_of("breath")
    filled = np.zeros((3, 4), np.float32)
    filled[0, 0], filled[2, 2], filled[1, 3] = _WIDER, _DEEPER, _RISE
    filled[2, 3] = -_DEEPER * (model.landmarks["gonion_l"][2] + _BACK)
    return ChestTables(breath, filled)


def breath_of(shoulders: Floats) -> Floats:
    """``(...)`` how deep a breath ``FaceGeometry.shoulders (..., 4, 4)`` show, 0..1."""
    breath: Floats = shoulders[..., 1, 3] / np.float32(_RISE)
    return breath


def apply(tables: ChestTables, values: Floats, transform: Floats) -> None:
    """Write into ``transform (4, 4)`` what moves shoulders and clothes from where they are without breath."""
    transform[:] = np.eye(4)
    transform[:3] += values[tables.breath] * tables.filled
