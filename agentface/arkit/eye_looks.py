"""Where the eyes look, as ARKit's weights: eight of them, each a part of the way to the side of the eye's hole."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from agentface.conventions import Doubles, Floats
from agentface.deform.eyes import eyeballs
from agentface.head.arkit import ARKIT_SHAPES
from agentface.head.model import HeadModel
from agentface.parameters import COUNT, HIGH, LOW, indices_of

Flags = npt.NDArray[np.bool_]
_YAW, _PITCH, _VERGENCE = (indices_of(name)[0] for name in ("gaze_yaw", "gaze_pitch", "gaze_vergence"))
_GAZE = [_YAW, _PITCH, _VERGENCE]


def _places(*names: str) -> list[int]:
    return [ARKIT_SHAPES.index(name) for name in names]


_LEFTWARD = _places("eyeLookOutLeft", "eyeLookInRight")
_RIGHTWARD = _places("eyeLookInLeft", "eyeLookOutRight")
"""To the person's left and right, of the left and the right eye."""
_UP = _places("eyeLookUpLeft", "eyeLookUpRight")
_DOWN = _places("eyeLookDownLeft", "eyeLookDownRight")


class EyeLooks:
    """Sets and tells the gaze of one face: a weight of 1 is the way to the side of its eye hole.

    The hole is an ellipse, so that an eye that looks as far as it can to two sides at once shows less of each. Both
    eyes have one pitch; where two are asked for, it is their mean.
    """

    def __init__(self, model: HeadModel) -> None:
        self._eyes = eyeballs.prepare(model)

    @property
    def limits(self) -> tuple[float, float]:
        """Half the width and half the height of the eye hole, in radians."""
        return self._eyes.yaw_limit, self._eyes.pitch_limit

    def apply(self, weights: Doubles, named: Flags, values: Floats) -> None:
        """Set gaze in ``values (COUNT,)`` by ``weights (52,)``, of which ``named (52,)`` are given.

        Where those of one eye alone are given, the other one looks along.
        """
        yaws, pitches = self._asked(weights, named, _LEFTWARD, _RIGHTWARD), self._asked(weights, named, _UP, _DOWN)
        if len(yaws):
            values[_YAW] = self._eyes.yaw_limit * np.mean(yaws)
            values[_VERGENCE] = self._eyes.yaw_limit * 0.5 * (yaws[-1] - yaws[0])
        if len(pitches):
            values[_PITCH] = self._eyes.pitch_limit * np.mean(pitches)
        values[_GAZE] = np.clip(values[_GAZE], LOW[_GAZE], HIGH[_GAZE])

    def moved(self, named: Flags) -> Flags:
        """``(COUNT,)``: the parameters that ``named (52,)`` weights give."""
        moves = np.zeros(COUNT, np.bool_)
        moves[[_YAW, _VERGENCE]] = named[_LEFTWARD + _RIGHTWARD].any()
        moves[_PITCH] = named[_UP + _DOWN].any()
        return moves

    def show(self, values: Floats, weights: Doubles) -> None:
        """Write the eight weights of the gaze of ``values (COUNT,)`` into ``weights (52,)``."""
        for side in (0, 1):
            yaw, pitch = eyeballs.eye_angles(self._eyes, values, side)
            for share, ahead, behind in (
                (yaw / self._eyes.yaw_limit, _LEFTWARD, _RIGHTWARD),
                (pitch / self._eyes.pitch_limit, _UP, _DOWN),
            ):
                weights[ahead[side]], weights[behind[side]] = min(max(share, 0.0), 1.0), min(max(-share, 0.0), 1.0)

    def angles(self, values: Floats) -> tuple[tuple[float, float], ...]:
        """Yaw to the person's left and pitch upward of the left and the right eye, in radians."""
        return tuple(eyeballs.eye_angles(self._eyes, values, side) for side in (0, 1))

    @staticmethod
    def _asked(weights: Doubles, named: Flags, ahead: list[int], behind: list[int]) -> Doubles:
        """The shares, -1..1, of the eyes of which any is given."""
        given = named[ahead] | named[behind]
        return np.asarray((weights[ahead] - weights[behind])[given])
