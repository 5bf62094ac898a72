"""FAPs to the pose that shows them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from agentface.conventions import Doubles, Floats, Indices
from agentface.errors import InvalidValueError
from agentface.head.model import HeadModel
from agentface.mesh.smoothstep import smoothstep
from agentface.mpeg4.fap_fit import CLOSED, LIDS, fap_fit, features_of
from agentface.mpeg4.faps import FAP_COUNT, fap
from agentface.mpeg4.gaze import GivenAngles
from agentface.mpeg4.looking import Looking
from agentface.mpeg4.meter import FapMeter
from agentface.mpeg4.solver import Wish
from agentface.parameters import COUNT, PARAMETERS, FacePose

Mask = npt.NDArray[np.bool_]
_SOFT = 0.05
"""Of a FAP's range, how far beyond its reach a target may lead."""
_ZERO, _BEGIN, _BACK = 1e-3, 1e-3, 1e-2
"""How strongly rest holds where every FAP is given, the pose that a first frame begins with, and the frame before."""
_SHUT, _CLOSED, _SHARES = 2.0, 6.0, 0.25
"""The weight of an eye's being shut beside one for each lid; of one that is to be closed, and of its lids then."""
_CLOSING, _AJAR = 0.85, 0.03
"""Of the way to closed: an eye that is to be farther is to be closed, whatever its lids share of it; what is ajar."""
_SERVES = 0.5
"""Of a parameter's largest effect: FAPs that it does less for do not move it by themselves."""
_ENOUGH, _FELT = 0.2, 0.02
"""Of the best parameter's effect on a FAP that is asked for more than ``_FELT`` of its range: where those that serve it
do less than ``_ENOUGH`` of it, the best may move, too, with its other side for a point of the middle."""
_MIDDLE = 0.002
"""m from the median plane: what serves a point that near to it does so on both sides."""
_TOLD = 0.05
"""Of a FAP's range: what is missed by more is told."""


@dataclass(frozen=True, slots=True, eq=False)
class FapSolution:
    """The pose found for a frame of FAPs.

    Attributes:
        pose: what shows them.
        moves: ``(COUNT,)`` bool, the parameters that the FAPs given determine; the others are as they were before.
        shown: ``(68,)`` float32, what the pose shows on the geometric face.
        missed: ``(68,)`` float32, shown less asked, of those given; 0 for the others.
        out_of_reach: the numbers of those that the face cannot show so far: beyond its reach, without a range, or
            missed by more than a twentieth of their range.
        looks: how many poses were tried.
        features: what the solver knows of the pose, for the next frame.
    """

    pose: FacePose
    moves: Mask
    shown: Floats
    missed: Floats
    out_of_reach: tuple[int, ...]
    looks: int
    features: Doubles


class FapSolver:
    """Finds poses of one face that show given FAPs; one frame at a time.

    Args:
        model: the face; what is found is exact for its geometric deformer.
        steps: Gauss-Newton steps a frame at most.
        compiled: False for the numpy form.

    Raises InvalidValueError for ``steps`` that is no number from 1 on.
    """

    def __init__(self, model: HeadModel, *, steps: int = 4, compiled: bool = True) -> None:
        if isinstance(steps, bool) or not isinstance(steps, int) or steps < 1:
            raise InvalidValueError("steps", "a number from 1 on", steps)
        self.model, self.steps = model, steps
        self.meter = FapMeter(model, compiled=compiled)
        looking = Looking(compiled=compiled)
        self._solve, self._look = looking.solve, looking.look
        self.fit = fap_fit(self.meter, lambda features: looking.looks(model, features))
        self._features = features_of(self.meter, self.fit.ranges)
        self._sight = looking.new_sight(model, self._features)
        self._given = GivenAngles(model)
        count, free = len(self.meter.faps), len(self.fit.problem.free)
        self._usable = np.append(self.fit.usable, [True] * len(LIDS))
        self._tikhonov = _ZERO * np.eye(free)
        effect = np.abs(self.fit.problem.jacobian[:count])
        self._serves = effect > _SERVES * np.maximum(effect.max(axis=0, initial=0.0), 1e-9)
        self._partners = _partners(self.fit.problem.free)
        self._middle = [abs(self.meter.points[known.points[0]].position[0]) < _MIDDLE for known in self.meter.faps]
        self._serves[self._middle] |= self._serves[self._middle][:, self._partners]
        ends = [self.fit.problem.jacobian[:count] * end for end in (self.fit.problem.low, self.fit.problem.high)]
        self._does = np.maximum(*ends), -np.minimum(*ends)
        self._shut_rows = [np.isin(self.meter.columns, np.array(pair) - 1) for pair in LIDS]

    def solve(
        self,
        faps: npt.ArrayLike,
        mask: npt.ArrayLike | None = None,
        previous: FapSolution | FacePose | None = None,
    ) -> FapSolution:
        """The pose that shows ``faps (68,)`` best, of those that ``mask (68,)`` names; all without one.

        ``previous`` is the frame before, from which the search begins and which the pose stays near; what the FAPs do
        not determine stays as it is there. FAPs 1 and 2 are not looked at.

        Raises InvalidValueError for another shape and for what is not finite.
        """
        asked, named = _checked(faps, mask)
        goal, weight, closing, clamped = self._wish(asked, named)
        whole = bool((weight[self._usable] > 0.0).all())
        values, features = self._start(goal if whole else None, previous)
        angles = self._given.apply(asked, named, values)
        if features is None:
            features = np.empty(len(self._features.matrix))
            self._look(self._sight, values, features)
        elif angles.any():
            features += self.fit.gaze @ angles
        held = np.logical_not(self._moved_by(goal, weight))
        prior = self._tikhonov if whole else self.fit.natural
        pull = _BEGIN if previous is None else _BACK
        wish = Wish(goal, weight, held, prior, pull, self.steps)
        looks = int(self._solve(self._sight, self.fit.problem, wish, values, features))
        short = (closing > 0.0) & (features[-len(LIDS) :] < (1.0 - _AJAR) * goal[-len(LIDS) :])
        if short.any():
            wish = wish._replace(weight=self._closing(weight, np.where(short, closing, 0.0)))
            looks += int(self._solve(self._sight, self.fit.problem, wish, values, features))
        return self._told(asked, named, values, features, clamped, held, looks)

    def reach(self, number: int) -> tuple[float, float]:
        """The least and the largest value, in units, that some pose shows of a FAP; 0 and 0 where it has no range.

        Raises InvalidValueError for what is no number of a FAP.
        """
        place = np.flatnonzero(self.meter.columns == fap(number).number - 1)
        if not len(place) or not self.fit.usable[place[0]]:
            return 0.0, 0.0
        return float(self.fit.low[place[0]]), float(self.fit.high[place[0]])

    def measured(self, values: Floats) -> Doubles:
        """``(68,)`` units: what a pose, ``values (COUNT,)``, shows on the geometric face."""
        features = np.empty(len(self._features.matrix))
        self._look(self._sight, np.ascontiguousarray(values, np.float32), features)
        return self._shown(values, features).astype(np.float64)

    def _shown(self, values: Floats, features: Doubles) -> Floats:
        count, faps = len(self.meter.columns), np.zeros(FAP_COUNT, np.float32)
        faps[self.meter.columns] = np.where(self.fit.usable, features[:count] * self.fit.ranges, 0.0)
        self._given.show(values, faps)
        return faps

    def _start(self, goal: Doubles | None, previous: FapSolution | FacePose | None) -> tuple[Floats, Doubles | None]:
        """The frame before, or else the natural pose nearest to a whole goal; its features where they are known."""
        if isinstance(previous, FapSolution):
            return previous.pose.array.copy(), previous.features.copy()
        if previous is not None:
            return previous.array.copy(), None
        away = np.zeros(1) if goal is None else ((self.fit.shown - goal) ** 2).sum(axis=1)
        nearest = int(away.argmin())
        return self.fit.starts[nearest].copy(), self.fit.shown[nearest].copy()

    def _moved_by(self, goal: Doubles, weight: Doubles) -> Mask:
        """``(F,)``: the parameters that the FAPs asked for move."""
        asked = weight[: len(self._serves)] > 0.0
        moved: Mask = self._serves[asked].any(axis=0)
        for row in np.flatnonzero(asked & (np.abs(goal[: len(asked)]) > _FELT)):
            does = self._does[int(goal[row] < 0.0)][row]
            if does.max(initial=0.0, where=self._serves[row]) < _ENOUGH * does.max():
                best = int(does.argmax())
                moved[best] = True
                if self._middle[row]:
                    moved[self._partners[best]] = True
        return moved

    def _closing(self, weight: Doubles, closing: Doubles) -> Doubles:
        """Weights for eyes that are to be closed as far as ``closing`` says: the sum of an eye's lids before each."""
        firm = weight.copy()
        for eye, rows in enumerate(self._shut_rows):
            firm[: len(rows)][rows] *= 1.0 + closing[eye] * (_SHARES - 1.0)
            firm[len(rows) + eye] += closing[eye] * (_CLOSED - _SHUT)
        return firm

    def _wish(self, asked: Doubles, named: Mask) -> tuple[Doubles, Doubles, Doubles, Mask]:
        """Goal and weights of the features, how far each eye is to be closed, and which targets were bent back."""
        fit, columns = self.fit, self.meter.columns
        target = asked[columns]
        near = _within(target, fit.low, fit.high, _SOFT * fit.ranges)
        used = named[columns] & fit.usable
        shut, both = np.zeros(len(LIDS)), np.zeros(len(LIDS))
        for eye, rows in enumerate(self._shut_rows):
            if used[rows].all():
                shut[eye], both[eye] = min(1.0, target[rows].sum() / CLOSED), 1.0
        goal = np.append(self._features.matrix[: len(columns)].diagonal() * near, shut)
        weight = np.append(used.astype(np.float64), _SHUT * both)
        return goal, weight, smoothstep(_CLOSING, 1.0, shut), (target < fit.low) | (target > fit.high)

    def _told(
        self, asked: Doubles, named: Mask, values: Floats, features: Doubles, clamped: Mask, held: Mask, looks: int
    ) -> FapSolution:
        fit, columns = self.fit, self.meter.columns
        shown = self._shown(values, features)
        missed = np.where(named, shown - asked, 0.0).astype(np.float32)
        beyond = np.zeros(FAP_COUNT, np.bool_)
        beyond[columns] = clamped | ~fit.usable | (np.abs(missed[columns]) > _TOLD * fit.ranges)
        known = np.zeros(FAP_COUNT, np.bool_)
        known[columns] = True
        beyond = np.where(known, beyond, np.abs(missed) > 1.0)
        moves = np.zeros(COUNT, np.bool_)
        moves[fit.problem.free] = ~held
        moves |= self._given.moved(named)
        numbers = np.flatnonzero(beyond & named & (np.abs(asked) > 0.0)) + 1
        return FapSolution(FacePose(values), moves, shown, missed, tuple(numbers.tolist()), looks, features)


def _partners(free: Indices) -> Indices:
    """``(F,)``: where among the free parameters the same one of the other side stands; the middle is its own."""
    places = {PARAMETERS[index].name: place for place, index in enumerate(free)}
    return np.array([places[PARAMETERS[index].partner or PARAMETERS[index].name] for index in free], np.int32)


def _checked(faps: npt.ArrayLike, mask: npt.ArrayLike | None) -> tuple[Doubles, Mask]:
    asked = np.asarray(faps, np.float64)
    named = np.ones(FAP_COUNT, np.bool_) if mask is None else np.array(mask, np.bool_)
    for what, array in (("faps", asked), ("mask", named)):
        if array.shape != (FAP_COUNT,):
            raise InvalidValueError(what, f"{FAP_COUNT} values", array.shape)
    named[:2] = False
    if not np.isfinite(asked[named]).all():
        number = int(np.flatnonzero(named & ~np.isfinite(asked))[0])
        raise InvalidValueError(f"FAP {number + 1}", "a finite number", float(asked[number]))
    return np.where(named, asked, 0.0), named


def _within(target: Doubles, low: Doubles, high: Doubles, soft: Doubles) -> Doubles:
    """Targets, bent where they leave ``low..high`` so that they end ``soft`` beyond it: smooth in value and slope."""
    margin = np.maximum(soft, 1e-9)
    above, below = np.maximum(target - high, 0.0), np.maximum(low - target, 0.0)
    bent = np.clip(target, low, high)
    bent += margin * (1.0 - np.exp(-above / margin)) - margin * (1.0 - np.exp(-below / margin))
    return np.asarray(bent)
