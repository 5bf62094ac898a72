"""Whole frames of FAPs to poses: FAPs 1 and 2 with their definitions, and the low-level FAPs that win over both."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from agentface.conventions import Doubles, Floats
from agentface.emotion.inference import Inference
from agentface.errors import InvalidValueError
from agentface.mpeg4.expressions import EXPRESSIONS, expression_pose
from agentface.mpeg4.fap_solver import FapSolution, FapSolver
from agentface.mpeg4.faps import FAP_COUNT
from agentface.mpeg4.visemes import BLEND_STEPS, check_step, viseme_pose
from agentface.parameters import COUNT, FacePose
from agentface.speech.visemes import VISEME_COUNT

Mask = npt.NDArray[np.bool_]


class Definition(NamedTuple):
    """What a stream says that a viseme or an expression is: ``(68,)`` values of low-level FAPs, ``(68,)`` named."""

    values: Doubles
    named: Mask


class FapPlayer:
    """Plays the frames of a stream in their order, and keeps what they define.

    A frame's visemes and expressions make a base: by the face's own tables, or by what the stream has defined.
    Low-level FAPs that the frame names win over it; where ``init_face`` is set, they are counted from the base instead
    of from the neutral face.

    Args:
        solver: of the face.
        inference: the rules of its emotions; those that come with agentface if none is given.
    """

    def __init__(self, solver: FapSolver, inference: Inference | None = None) -> None:
        self._solver, self._inference = solver, inference
        self._visemes: dict[int, Definition] = {}
        self._expressions: dict[int, Definition] = {}

    def play(
        self,
        faps: npt.ArrayLike,
        mask: npt.ArrayLike,
        viseme: Sequence[int] = (0, 0, 0, 0),
        expression: Sequence[int] = (0, 0, 0, 0, 0, 0),
        previous: FapSolution | None = None,
    ) -> FapSolution:
        """The pose of a frame.

        Args:
            faps: ``(68,)`` units; those of FAPs 1 and 2 are not looked at.
            mask: ``(68,)``, which FAPs the frame names.
            viseme: FAP 1: two visemes, the blend of the first in 0..63, and whether the frame defines the first.
            expression: FAP 2: an expression and its intensity in 0..63, twice, ``init_face``, and whether the frame
                defines the first.
            previous: the frame before.

        Raises InvalidValueError for other shapes, what is not finite, and selections that there are none of.
        """
        values, named = np.asarray(faps, np.float64), np.array(mask, np.bool_)
        for what, array in (("faps", values), ("mask", named)):
            if array.shape != (FAP_COUNT,):
                raise InvalidValueError(what, f"{FAP_COUNT} values", array.shape)
        spoken = tuple(viseme) if named[0] else (0, 0, 0, 0)
        shown = tuple(expression) if named[1] else (0, 0, 0, 0, 0, 0)
        _check(spoken, shown)
        low = named.copy()
        low[:2] = False
        self._define(spoken, shown, values, low)
        if not (named[:2].any()):
            return self._solver.solve(values, low, previous)
        base = self._base(spoken, shown)
        defined, by_definition = self._defined(spoken, shown)
        if shown[4]:
            offset = self._solver.measured(base)
            values = np.where(low, values + offset, values)
        return self._solver.solve(np.where(low, values, defined), low | by_definition, FacePose(base))

    def _define(self, spoken: tuple[int, ...], shown: tuple[int, ...], values: Doubles, low: Mask) -> None:
        for table, number, define in (
            (self._visemes, spoken[0], spoken[3]),
            (self._expressions, shown[0], shown[5]),
        ):
            if define and number and low.any():
                table[number] = Definition(np.where(low, values, 0.0), low.copy())

    def _base(self, spoken: tuple[int, ...], shown: tuple[int, ...]) -> Floats:
        """``(COUNT,)``: the larger of what the tables have for mouth and expression, but for what is defined."""
        one, other = (number if number not in self._visemes else 0 for number in spoken[:2])
        said = viseme_pose(one, other, spoken[2])
        first, second = (number if number not in self._expressions else 0 for number in (shown[0], shown[2]))
        felt = expression_pose(first, shown[1], second, shown[3], self._inference)
        return np.where(np.abs(said) > np.abs(felt), said, felt).astype(np.float32).reshape(COUNT)

    def _defined(self, spoken: tuple[int, ...], shown: tuple[int, ...]) -> tuple[Doubles, Mask]:
        """What definitions make of the frame: ``(68,)`` values and whether they name them."""
        total, named = np.zeros(FAP_COUNT), np.zeros(FAP_COUNT, np.bool_)
        blend = spoken[2] / BLEND_STEPS
        for table, number, share in (
            (self._visemes, spoken[0], blend),
            (self._visemes, spoken[1], 1.0 - blend),
            (self._expressions, shown[0], shown[1] / BLEND_STEPS),
            (self._expressions, shown[2], shown[3] / BLEND_STEPS),
        ):
            if number in table:
                total += share * table[number].values
                named |= table[number].named
        return total, named


def _check(spoken: tuple[int, ...], shown: tuple[int, ...]) -> None:
    of_viseme = ("viseme_select1", "viseme_select2", "viseme_blend", "viseme_def")
    of_expression = (
        *("expression_select1", "expression_intensity1", "expression_select2", "expression_intensity2"),
        *("init_face", "expression_def"),
    )
    visemes, steps, expressions = VISEME_COUNT - 1, BLEND_STEPS, len(EXPRESSIONS) - 1
    for names, got, largest in (
        (of_viseme, spoken, (visemes, visemes, steps, 1)),
        (of_expression, shown, (expressions, steps, expressions, steps, 1, 1)),
    ):
        if len(got) != len(names):
            raise InvalidValueError(f"FAP {1 if names is of_viseme else 2}", f"{len(names)} values", got)
        for name, number, most in zip(names, got, largest, strict=True):
            check_step(name, number, most)
