"""How features of a face change with its parameters, in the mean over poses: what :mod:`.solver` begins with."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from agentface.conventions import Doubles, Floats, Indices
from agentface.parameters import COUNT, HIGH, LOW

Looks = Callable[[Floats], Doubles]
"""``(B, COUNT)`` poses to ``(B, N)`` features."""
_STEP = 0.1
"""Of a parameter's range, the step of differences."""


class Coupled(NamedTuple):
    """Parameters that do something else together than alone: they are stepped at once, each for its own features.

    ``columns`` are their places in a pose, and ``rows``, ``(N,)`` bool for each of them, the features.
    """

    columns: Sequence[int]
    rows: Sequence[npt.NDArray[np.bool_]]


def mean_jacobian(look: Looks, poses: Floats, moved: Indices, coupled: Sequence[Coupled] = ()) -> Doubles:
    """``(N, COUNT)``: features a parameter, 0 for those that are not ``moved``; by one-sided steps into the range."""
    total: Doubles | None = None
    for pose in poses:
        step = _STEP * (HIGH - LOW)
        step = np.where(pose + step <= HIGH, step, -step)[moved]
        trials = np.repeat(pose[None], len(moved) + 1 + len(coupled), axis=0)
        trials[np.arange(len(moved)) + 1, moved] += step
        ways = []
        for trial, (columns, _) in zip(trials[len(moved) + 1 :], coupled, strict=True):
            place = list(columns)
            reach = _STEP * (HIGH - LOW)[place]
            ways.append(reach if (pose[place] + reach <= HIGH[place]).all() else -reach)
            trial[place] = np.clip(trial[place] + ways[-1], LOW[place], HIGH[place])
        shown = look(trials)
        jacobian = np.zeros((shown.shape[1], COUNT))
        jacobian[:, moved] = ((shown[1 : len(moved) + 1] - shown[0]) / step[:, None]).T
        for after, way, (columns, rows) in zip(shown[len(moved) + 1 :], ways, coupled, strict=True):
            for column, by, own in zip(columns, way, rows, strict=True):
                jacobian[:, column] = np.where(own, (after - shown[0]) / by, 0.0)
        total = jacobian if total is None else total + jacobian
    if total is None:
        return np.zeros((0, COUNT))
    return total / len(poses)
