"""ARKit's weights to the pose that shows them, and poses back to weights."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from agentface.arkit.eye_looks import EyeLooks, Flags
from agentface.arkit.sampled_shapes import SKIN_PLACES, SKIN_SHAPES
from agentface.arkit.shape_fit import ShapeFit, rules_stamp, shape_fit
from agentface.conventions import Doubles, Floats, check_fraction
from agentface.errors import InvalidValueError, UnknownNameError
from agentface.head.arkit import ARKIT_SHAPES
from agentface.head.model import HeadModel
from agentface.mesh.smoothstep import smoothstep
from agentface.mpeg4.looking import Looking
from agentface.mpeg4.solver import ROUNDS, Problem, Wish
from agentface.parameters import COUNT, HIGH, LOW, NEUTRAL, PARAMETERS, FacePose, indices_of

_COUNT = len(ARKIT_SHAPES)
_RIDGE, _BACK = 30.0, 100.0
"""mm^2: how strongly rest holds a parameter, and the frame before."""
_STIFF, _CALLED = 1e4, 0.05
"""mm^2: how strongly rest holds a parameter that serves no shape asked for; the weight of a shape that frees it."""
_SMALL = 0.05
"""Of a signed parameter, what says nothing about the way that it is on."""
_CREEP, _LEAP = 0.05, 4.0
"""How far a parameter may go in a frame while weights stay, and how many times as far as the one that goes most."""
_FIRST = 8
"""Steps for what is made once: the face's own answers to single weights."""
_OWN_RIDGE = 1e-4
"""Of the mean square of an answer, how strongly weights of 0 hold when they are sought."""
_SPARSE = 0.004
"""Of the geometric mean of an answer's and of all answers' mean square, what each weight costs when they are sought:
few weights are likelier than many that undo each other."""
_OPEN, _CLOSE, _TONGUE = (ARKIT_SHAPES.index(name) for name in ("jawOpen", "mouthClose", "tongueOut"))
_SKIN_OPEN, _SKIN_CLOSE = (SKIN_SHAPES.index(name) for name in ("jawOpen", "mouthClose"))
_TONGUE_OUT = indices_of("tongue_out")[0]
_GAZE = [known.index for known in PARAMETERS if known.kind == "gaze"]
_REFINED = 1
"""How often weights are sought again by what the face shows of those found."""
_TRIES = 10
"""Calls of the minimum in a box at most."""


@dataclass(frozen=True, slots=True, eq=False)
class ArkitSolution:
    """The pose found for a frame of weights.

    Attributes:
        pose: what shows them.
        moves: ``(COUNT,)`` bool, the parameters that the weights given move; the others are as they were before.
        looks: how many poses were tried.
        weights: ``(52,)``, those asked for; 0 for those that were not.
        features: what the solver knows of the pose, for the next frame.
    """

    pose: FacePose
    moves: Flags
    looks: int
    weights: Doubles
    features: Doubles


class ShapeSolver:
    """Finds poses of one face that show ARKit's weights: the skin goes where the artists' shapes go.

    The target is the sum of the shapes, each times its weight; mouthClose, which closes the lips of an opened jaw,
    counts no more than jawOpen. Eyes and tongue are given by their weights. Backwards, weights are sought by least
    squares in 0..1 on the face's own answers to single weights: on the artists' shapes, what muscles cannot make of one
    shape would be taken for others.

    Args:
        model: the face; what is found is exact for its geometric deformer.
        steps: Gauss-Newton steps a frame at most.
        compiled: False for the numpy form.

    Raises InvalidValueError for ``steps`` that is no number from 1 on.
    """

    def __init__(self, model: HeadModel, *, steps: int = 3, compiled: bool = True) -> None:
        if isinstance(steps, bool) or not isinstance(steps, int) or steps < 1:
            raise InvalidValueError("steps", "a number from 1 on", steps)
        self.model, self.steps = model, steps
        self._looking = Looking(compiled=compiled)
        self.fit: ShapeFit = shape_fit(model, lambda features: self._looking.looks(model, features))
        self._sight = self._looking.new_sight(model, self.fit.features)
        self.eyes = EyeLooks(model)
        free = self.fit.free
        self._low, self._high = LOW[free].astype(np.float64), HIGH[free].astype(np.float64)
        self._pattern = np.ones_like(self.fit.up)
        self._unit = np.ones(len(self.fit.features.matrix))
        self._norms = [np.maximum(np.linalg.norm(way, axis=0), 1.0) for way in (self.fit.up, self.fit.down)]
        self.answers: Doubles = model.derived(f"arkit.answers.{rules_stamp()}", lambda _: self._answers())
        """``(S, K)``: what the face shows for each of the skin's shapes alone; mouthClose less jawOpen."""
        square = self.answers @ self.answers.T
        mean = np.trace(square) / len(square)
        self._square = square + _OWN_RIDGE * mean * np.eye(len(square))
        self._cost = _SPARSE * np.sqrt(mean * np.diag(square))

    def solve(
        self,
        weights: npt.ArrayLike,
        named: npt.ArrayLike | None = None,
        previous: ArkitSolution | FacePose | None = None,
    ) -> ArkitSolution:
        """The pose that shows ``weights (52,)``, of those that ``named (52,)`` says are given; all without it.

        ``previous`` is the frame before, from which the search begins and which the pose stays near; what the weights
        given do not move stays as it is there.

        Raises InvalidValueError for another shape and for what is not in 0..1.
        """
        return self._solved(*_checked(weights, named), previous, self.steps)

    def solve_named(
        self, weights: Mapping[str, float], previous: ArkitSolution | FacePose | None = None
    ) -> ArkitSolution:
        """The pose that shows some weights, by their names; nothing else moves (:meth:`solve`).

        Raises UnknownNameError for what is no shape's name and InvalidValueError for a weight that is not in 0..1.
        """
        values, named = np.zeros(_COUNT), np.zeros(_COUNT, np.bool_)
        for name, weight in weights.items():
            place = arkit_place(name)
            values[place], named[place] = check_fraction(name, weight), True
        return self.solve(values, named, previous)

    def weights(self, values: npt.ArrayLike) -> Floats:
        """``(52,)`` float32, 0..1: the weights of the face that a pose, ``values (COUNT,)``, shows.

        Raises InvalidValueError for another shape.
        """
        pose = np.ascontiguousarray(values, np.float32)
        if pose.shape != (COUNT,):
            raise InvalidValueError("values", f"{COUNT} values", pose.shape)
        seen, found = self._seen(pose), np.zeros(_COUNT)
        near = self._nearest(seen)
        for _ in range(_REFINED):  # answers to many weights are not quite the sum of those to single ones
            found[SKIN_PLACES] = near
            near = self._nearest(seen + near @ self.answers - self.solve(found).features)
        found[SKIN_PLACES] = near
        self.eyes.show(pose, found)
        found[_TONGUE] = pose[_TONGUE_OUT]
        return found.astype(np.float32)

    def _solved(
        self, asked: Doubles, given: Flags, previous: ArkitSolution | FacePose | None, steps: int
    ) -> ArkitSolution:
        asked[_CLOSE] = min(asked[_CLOSE], asked[_OPEN])
        before = previous.pose if isinstance(previous, ArkitSolution) else previous
        values = NEUTRAL.copy() if before is None else before.array.copy()
        features = previous.features.copy() if isinstance(previous, ArkitSolution) else self._seen(values)
        skin, ahead = asked[SKIN_PLACES], _ahead(values)
        held: Flags = np.logical_not(self.fit.serves[given[SKIN_PLACES]].any(axis=0))
        looks = 0
        if not held.all():
            prior = self._prior(skin @ self.fit.serves)
            pull = 0.0 if previous is None else _BACK
            wish = Wish(skin @ self.fit.shapes, self._unit, held, prior, pull, steps)
            problem = self._problem(wish.goal, ahead, _reach(asked, previous))
            looks = int(self._looking.solve(self._sight, problem, wish, ahead, features))
        values[self.fit.free] = ahead[self.fit.free]
        self.eyes.apply(asked, given, values)
        moves = self.eyes.moved(given)
        moves[self.fit.free] = ~held
        if given[_TONGUE]:
            values[_TONGUE_OUT], moves[_TONGUE_OUT] = asked[_TONGUE], True
        return ArkitSolution(FacePose(values), moves, looks, asked, features)

    def _seen(self, values: Floats) -> Doubles:
        """The features of a pose that looks straight ahead: lids follow the eyes, and weights know that."""
        features = np.empty(len(self._unit))
        self._looking.look(self._sight, _ahead(values), features)
        return features

    def _prior(self, called: Doubles) -> Doubles:
        """What holds each parameter at rest, more firmly where no shape that is asked for is served by it."""
        idle = 1.0 - np.asarray(smoothstep(0.0, _CALLED, called))
        return np.diag(_RIDGE + _STIFF * idle * idle)

    def _problem(self, goal: Doubles, start: Floats, reach: float) -> Problem:
        """The frame's problem: no parameter goes farther than ``reach`` from where it starts.

        A signed parameter goes on the way that it is on, or on which it serves the goal.
        """
        fit, now = self.fit, start[self.fit.free]
        rising, falling = goal @ fit.up / self._norms[0], -goal @ fit.down / self._norms[1]
        rises = np.where(np.abs(now) > _SMALL, now > 0.0, rising >= falling)
        jacobian = np.where(rises, fit.up, fit.down)
        low, high = np.maximum(self._low, now - reach), np.minimum(self._high, now + reach)
        return Problem(fit.free, low, high, jacobian, self._pattern)

    def _nearest(self, features: Doubles) -> Doubles:
        """``(S,)``: the weights of ``SKIN_SHAPES`` the sum of whose answers is nearest to ``features (K,)``."""
        low, high, found = np.zeros(len(self._square)), np.ones(len(self._square)), np.zeros(len(self._square))
        right = self.answers @ features - self._cost
        for closed in (1.0, None):  # mouthClose is of an opened jaw
            high[_SKIN_CLOSE] = found[_SKIN_OPEN] if closed is None else closed
            found = np.minimum(found, high)
            for _ in range(_TRIES):
                if self._looking.box_minimum(self._square, right, low, high, found) < ROUNDS:
                    break
        return found

    def _answers(self) -> Doubles:
        shown = np.zeros_like(self.fit.shapes)
        whole = np.ones(_COUNT, np.bool_)
        for row, place in zip(shown, SKIN_PLACES.tolist(), strict=True):
            weights = np.zeros(_COUNT)
            weights[[place, _OPEN] if place == _CLOSE else place] = 1.0
            row[:] = self._solved(weights, whole, None, _FIRST).features
        shown[_SKIN_CLOSE] -= shown[_SKIN_OPEN]
        return shown


def arkit_place(name: str) -> int:
    """Where a weight stands among the 52, by ARKit's name or Live Link Face's, in which the first letter is large.

    Raises UnknownNameError.
    """
    known = f"{name[:1].lower()}{name[1:]}"
    if known not in ARKIT_SHAPES:
        raise UnknownNameError("ARKit weight", name, ARKIT_SHAPES)
    return ARKIT_SHAPES.index(known)


def _reach(asked: Doubles, previous: ArkitSolution | FacePose | None) -> float:
    """How far any parameter may go in a frame: by how much the weights have changed, so that none jumps alone."""
    if not isinstance(previous, ArkitSolution):
        return np.inf
    return float(_CREEP + _LEAP * np.abs(asked - previous.weights).max())


def _ahead(values: Floats) -> Floats:
    """A copy of a pose that looks straight ahead."""
    copy = np.ascontiguousarray(values, np.float32).copy()
    copy[_GAZE] = 0.0
    return copy


def _checked(weights: npt.ArrayLike, named: npt.ArrayLike | None) -> tuple[Doubles, Flags]:
    asked = np.array(weights, np.float64)
    given = np.ones(_COUNT, np.bool_) if named is None else np.array(named, np.bool_)
    for what, array in (("weights", asked), ("named", given)):
        if array.shape != (_COUNT,):
            raise InvalidValueError(what, f"{_COUNT} values", array.shape)
    asked = np.where(given, asked, 0.0)
    wrong = np.flatnonzero(~((asked >= 0.0) & (asked <= 1.0)))
    if len(wrong):
        raise InvalidValueError(ARKIT_SHAPES[wrong[0]], "a number in 0..1", float(asked[wrong[0]]))
    return asked, given
