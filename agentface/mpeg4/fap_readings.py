"""What is read off a face for each FAP that moves points."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from agentface.errors import InvalidValueError
from agentface.head.model import HeadModel
from agentface.mpeg4.faps import Fap
from agentface.mpeg4.fapu import PARTS, fapu
from agentface.mpeg4.feature_points import feature_points
from agentface.mpeg4.readings import Kind, Readings, rolled

JAW = (3, 14, 15)
"""Read off the jaw's bone: on the skin of the chin, muscles would open the jaw, and the jaw thrust itself."""
CHIN = 18
"""Read in the jaw's frame: elsewhere, every opened jaw would draw the chin down."""
EYES = (23, 24, 25, 26)
HEAD = (48, 49, 50)
"""Read off rotations."""
_EYEBALLS, _PUPILS, _ROLL = (27, 28), (29, 30), 47
_AXIS = {"left": 0, "right": 0, "up": 1, "down": 1, "forward": 2}
_SIGN = {"right": -1.0, "down": -1.0}
_PUPIL = PARTS / 3
"""IRISD that a pupil at rest is wide: a third of the iris, by the standard."""


class _Row(NamedTuple):
    """A number of :class:`Readings`."""

    kind: Kind
    vertex: int
    axis: int
    scale: float
    rest: float


def fap_readings(model: HeadModel, faps: tuple[Fap, ...]) -> Readings:
    """The readings of ``faps`` on a face; raises InvalidValueError where it lacks one of their feature points."""
    points = feature_points(model)
    missing = [point for fap in faps for point in fap.points if point not in points]
    if missing:
        raise InvalidValueError(f"feature points of {model.name}", "those that FAPs move", ", ".join(missing))
    bone = np.array([points["2.1"].position, model.jaw.pivot], np.float64)
    roll = np.array([points[number].vertex for number in ("6.3", "6.4", "6.2")], np.int32)
    rows = [_row(model, fap, bone, roll) for fap in faps]
    kinds, vertices, axes, scales, rests = zip(*rows, strict=True)
    of_kind, vertex, axis = (np.array(column, np.int32) for column in (kinds, vertices, axes))
    return Readings(of_kind, vertex, axis, np.array(scales, np.float64), np.array(rests, np.float64), bone, roll)


def _row(
    model: HeadModel,
    fap: Fap,
    bone: np.ndarray[tuple[int, ...], np.dtype[np.float64]],
    roll: np.ndarray[tuple[int, ...], np.dtype[np.int32]],
) -> _Row:
    unit = fapu(model).of(fap.unit)
    if fap.number in _EYEBALLS:
        return _Row(Kind.EYEBALL, _EYEBALLS.index(fap.number), 0, 1.0 / unit, 0.0)
    if fap.number in _PUPILS:
        return _Row(Kind.PUPIL, _PUPILS.index(fap.number), 0, _PUPIL, 1.0)
    if fap.number == _ROLL:
        return _Row(Kind.ROLL, 0, 0, 1.0 / unit, rolled(roll, model.parts["tongue"].attributes["POSITION"]))
    axis, scale = _AXIS[fap.positive], _SIGN.get(fap.positive, 1.0) / unit
    if fap.number in JAW:
        which = int(JAW.index(fap.number) > 0)
        return _Row(Kind.BONE, which, axis, scale, float(bone[which, axis]))
    point = feature_points(model)[fap.points[0]]
    kind = Kind.TONGUE if point.mesh == "tongue" else Kind.IN_JAW if fap.number == CHIN else Kind.SKIN
    return _Row(kind, point.vertex, axis, scale, float(point.position[axis]))
