"""The pose that shows given features of a face: bounded least squares in a few steps, for any linear features.

Gauss and Newton's steps on one constant Jacobian J, the mean over natural poses, which Broyden's update (in Schubert's
form, inside a fixed pattern) bends towards the truth as the steps go. Each step minimises

    |W (J (x - x0) + f(x0) - goal)|^2 + x' P x + pull |x - back|^2 + damp |x - x0|^2

over a box, with P a prior's precision, ``back`` the pose before, and W the weights, 0 for what is not asked for. A
step that makes it worse is not taken; the next one is shorter.
Broyden (1965), Math. Comp. 19; Schubert (1970), Math. Comp. 24: an update that keeps zeros zero.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from agentface.conventions import Doubles, Floats, Indices
from agentface.mpeg4.sight import PlainSight, look

ROUNDS, SWEEPS, SMALL = 4, 3, 1e-4
"""Rounds of the minimum in a box at most, sweeps a round, and the change from which on a further sweep is worth it."""
DAMP, EASE, FIRM = 0.03, 0.3, 4.0
"""The least damping after a step that made it worse, and its factors after a good and a bad step."""
FLAT, STILL, NEAR = 2e-3, 2e-3, 8e-3
"""A gain, as part of what is left, a step, and a feature's miss, from which on a further step is not worth it."""
SHORT = 1e-8  # a squared step that tells nothing of the Jacobian
SHARE = 1e-3  # of a squared step, the least part that a row's update is divided by


class Problem(NamedTuple):
    """What is the same for every frame: N features, F parameters that may move.

    Attributes:
        free: ``(F,)`` int32, their places in a pose.
        low, high: ``(F,)`` float64, their ranges.
        jacobian: ``(N, F)`` float64, features a parameter; 0 outside the pattern.
        pattern: ``(N, F)`` float64, 1 where a parameter serves a feature, else 0.
    """

    free: Indices
    low: Doubles
    high: Doubles
    jacobian: Doubles
    pattern: Doubles


class Wish(NamedTuple):
    """What is wanted of one frame.

    Attributes:
        goal: ``(N,)`` float64, the features.
        weight: ``(N,)`` float64, 0 for those that nobody asks for.
        held: ``(F,)`` bool, parameters that stay as they are.
        prior: ``(F, F)`` float64, P.
        pull: how strongly the pose before holds.
        steps: at most, 1 or more.
    """

    goal: Doubles
    weight: Doubles
    held: npt.NDArray[np.bool_]
    prior: Doubles
    pull: float
    steps: int


def solve(sight: PlainSight, problem: Problem, wish: Wish, values: Floats, features: Doubles) -> int:
    """Move ``values (COUNT,)``, the start and the pose before, to the pose that shows the wish best.

    ``features (N,)`` are those of the start, as far as they are known, and become those of the result. Returns how
    often it looked.
    """
    count, weight = len(problem.free), wish.weight
    x = np.empty(count)
    for i in range(count):
        x[i] = values[problem.free[i]]
    back, low, high = x.copy(), problem.low.copy(), problem.high.copy()
    for i in range(count):
        if wish.held[i]:
            low[i], high[i] = x[i], x[i]
    seen, trial = np.empty(len(weight)), values.copy()
    jacobian = problem.jacobian.copy()
    cost, damp, looks = np.inf, 0.0, 0
    for _ in range(wish.steps):
        new = x.copy()
        next_step(jacobian, wish, features, x, back, damp, low, high, new)
        step = new - x
        for i in range(count):
            trial[problem.free[i]] = new[i]
        look(sight, trial, seen)
        looks += 1
        learn(jacobian, problem.pattern, step, seen - features)
        miss, way = weight * (seen - wish.goal), new - back
        now = float(miss @ miss + new @ (wish.prior @ new) + wish.pull * (way @ way))
        if now < cost:
            gain, cost, damp = cost - now, now, EASE * damp
            x[:], features[:] = new, seen
            values[:] = trial
            if gain < FLAT * now or np.abs(step).max() < STILL or miss @ miss < NEAR * NEAR * len(miss):
                break
        else:
            damp = max(FIRM * damp, DAMP)
    return looks


def next_step(
    jacobian: Doubles, wish: Wish, features: Doubles, x: Doubles, back: Doubles, damp: float,
    low: Doubles, high: Doubles, new: Doubles,
) -> None:  # fmt: skip
    """Write the minimum of the frame's quadratic, in the box from ``low`` to ``high``, into ``new``: the start, too."""
    weight = wish.weight
    rows = jacobian * weight.reshape(-1, 1)
    a = gram(rows)
    b = (weight * (wish.goal - features)) @ rows + a @ x + wish.pull * back + damp * x
    a += wish.prior
    for i in range(len(x)):
        a[i, i] += wish.pull + damp
    box_minimum(a, b, low, high, new)


def learn(jacobian: Doubles, pattern: Doubles, step: Doubles, change: Doubles) -> None:
    """Bend the Jacobian so that ``step`` makes ``change``, inside the pattern: Schubert's form of Broyden's update."""
    whole = step @ step
    if whole <= SHORT:
        return
    for row in range(len(change)):
        square, made = SHARE * whole, 0.0
        inside = 0.0
        for i in range(len(step)):
            inside += pattern[row, i] * step[i] * step[i]
            made += jacobian[row, i] * step[i]
        share = (change[row] - made) / max(square, inside)
        for i in range(len(step)):
            jacobian[row, i] += share * pattern[row, i] * step[i]


def box_minimum(a: Doubles, b: Doubles, low: Doubles, high: Doubles, x: Doubles) -> int:
    """Move ``x (F,)`` to the minimum of 1/2 x' a x - b' x in a box; returns the rounds that it took.

    ``a (F, F)`` is symmetric and positive definite, and ``x`` lies in the box. A round is some sweeps of cyclic
    coordinate descent, which find what the box holds, and a whole step of all that it does not hold, cut to the box.
    Both only descend. A sweep ends it that moves no coordinate by :data:`SMALL`.
    """
    slope = a @ x - b
    for turn in range(ROUNDS):
        for _ in range(SWEEPS):
            largest = 0.0
            for i in range(len(b)):
                to = min(max(x[i] - slope[i] / a[i, i], low[i]), high[i])
                by = to - x[i]
                if by != 0.0:
                    x[i] = to
                    accumulate(slope, by, a[i])
                    largest = max(largest, abs(by))
            if largest < SMALL:
                return turn + 1
        whole_step(a, low, high, x, slope)
    return ROUNDS


def whole_step(a: Doubles, low: Doubles, high: Doubles, x: Doubles, slope: Doubles) -> None:
    """Step to the minimum over the coordinates that lie inside the box, back to its sides, if that descends."""
    inside = np.flatnonzero((x > low) & (x < high))
    count = len(inside)
    part, way = np.empty((count, count)), np.empty(count)
    for i in range(count):
        way[i] = -slope[inside[i]]
        for j in range(count):
            part[i, j] = a[inside[i], inside[j]]
    settle(part, way)
    step, curve = np.zeros(len(x)), np.zeros(len(x))
    for i in range(count):
        k = inside[i]
        step[k] = min(max(x[k] + way[i], low[k]), high[k]) - x[k]
        accumulate(curve, step[k], a[k])
    if step @ slope + 0.5 * (step @ curve) < 0.0:
        x += step
        slope += curve


def gram(rows: Doubles) -> Doubles:
    """``rows' rows``."""
    return np.asarray(rows.T @ rows)


def accumulate(out: Doubles, by: float, row: Doubles) -> None:
    """Add ``by`` times ``row`` to ``out``."""
    out += by * row


def settle(a: Doubles, right: Doubles) -> None:
    """Turn ``right (F,)`` into the solution of a x = right; ``a (F, F)`` is symmetric, positive definite, and lost."""
    right[:] = np.linalg.solve(a, right)
