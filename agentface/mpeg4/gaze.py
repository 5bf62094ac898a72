"""FAPs 23 to 26 and 48 to 50: the angles of eyes and head, which need no search."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from agentface.conventions import Doubles, Floats
from agentface.deform.eyes import eyeballs
from agentface.head.model import HeadModel
from agentface.mpeg4.fapu import fapu
from agentface.parameters import COUNT, HIGH, LOW, indices_of

_GAZE = np.array([indices_of(name)[0] for name in ("gaze_yaw", "gaze_pitch", "gaze_vergence")])
_HEAD = np.array([indices_of(name)[0] for name in ("head_pitch", "head_yaw", "head_roll")])
_SIGN = np.array([-1.0, 1.0, -1.0])
"""MPEG-4 looks down and tilts to the right where a pose looks up and tilts to the left."""
_YAW, _PITCH, _TURN = slice(22, 24), slice(24, 26), slice(47, 50)
"""Where FAPs 23 and 24, 25 and 26, and 48 to 50 stand."""


class GivenAngles:
    """Sets and tells the parameters of gaze and head of one face."""

    def __init__(self, model: HeadModel) -> None:
        self._unit, self._eyes = fapu(model).AU, eyeballs.prepare(model)

    def apply(self, asked: Doubles, named: npt.NDArray[np.bool_], values: Floats) -> Doubles:
        """Set what ``named (68,)`` of ``asked (68,)`` give of ``values (COUNT,)``; how far gaze went: ``(3,)`` rad.

        Of an eye alone, the other one looks along. What the eyes' holes or the head's range do not allow is left out.
        """
        before = values[_GAZE].astype(np.float64)
        yaw, pitch = named[_YAW], named[_PITCH]
        if yaw.any():
            left, right = asked[_YAW] * self._unit
            inward = 0.5 * (right - left) if yaw.all() else 0.0
            values[_GAZE[0]] = 0.5 * (left + right) if yaw.all() else (left if yaw[0] else right)
            values[_GAZE[2]] = inward
        if pitch.any():
            values[_GAZE[1]] = -asked[_PITCH][pitch].mean() * self._unit
        turned = named[_TURN]
        values[_HEAD[turned]] = (_SIGN * asked[_TURN] * self._unit)[turned]
        for rows in (_GAZE, _HEAD):
            values[rows] = np.clip(values[rows], LOW[rows], HIGH[rows])
        return np.asarray(values[_GAZE] - before)

    def show(self, values: Floats, faps: Floats) -> None:
        """Write the FAPs of the angles of ``values (COUNT,)`` into ``faps (68,)``."""
        sides = [eyeballs.eye_angles(self._eyes, values, side) for side in (0, 1)]
        faps[_YAW] = [yaw / self._unit for yaw, _ in sides]
        faps[_PITCH] = [-pitch / self._unit for _, pitch in sides]
        faps[_TURN] = _SIGN * values[_HEAD] / self._unit

    def moved(self, named: npt.NDArray[np.bool_]) -> npt.NDArray[np.bool_]:
        """``(COUNT,)``: the parameters that ``named (68,)`` give."""
        moves = np.zeros(COUNT, np.bool_)
        moves[_GAZE[[0, 2]]] = named[_YAW].any()
        moves[_GAZE[1]] = named[_PITCH].any()
        moves[_HEAD] = named[_TURN]
        return moves
