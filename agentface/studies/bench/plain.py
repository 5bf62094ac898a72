"""The plain loop the deformer is measured against: every muscle at every vertex, as the paper prints it (section 5)."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt
from numba import njit

from agentface.conventions import Bytes, Doubles, Floats
from agentface.head.muscle_set import MuscleSet


def constants(muscles: MuscleSet) -> Doubles:
    """float64 ``(M, 10)``: origin, axis, cos(zone), Rs, Rf, k."""
    columns = [np.cos(muscles.zone), muscles.fall_start, muscles.fall_finish, muscles.elasticity]
    return np.column_stack([muscles.origin, muscles.axis, *columns])


def region_flags(muscles: MuscleSet, region_of: Bytes) -> npt.NDArray[np.int64]:
    """``(M,)``: for each muscle a bit for each region that holds a vertex it may move."""
    flags = np.zeros(len(muscles), dtype=np.int64)
    for region in np.unique(region_of):
        flags[muscles.reach[:, region_of == region].any(axis=1)] |= 1 << int(region)
    return flags


@njit(cache=True)
def contract(
    rest: Floats,
    moved: Doubles,
    change: Doubles,
    muscles: Doubles,
    levels: Doubles,
    step: float,
    region_of: Bytes,
    masks: npt.NDArray[np.int64],
) -> None:
    """Steps of ``step`` with Waters' fall-off; ``masks (M,)`` has a bit for each region a muscle may move."""
    moved[:] = rest
    left = levels.copy()
    while left.max() > 1e-9:
        change[:] = 0.0
        for muscle in range(muscles.shape[0]):
            part = min(step, left[muscle])
            if part <= 0.0:
                continue
            left[muscle] -= part
            for vertex in range(moved.shape[0]):
                if (masks[muscle] >> region_of[vertex]) & 1:
                    pull(muscles, muscle, part, moved, vertex, change)
        moved += change


@njit(cache=True)
def pull(muscles: Doubles, muscle: int, part: float, moved: Doubles, vertex: int, change: Doubles) -> None:
    """Adds one muscle's displacement of one vertex."""
    x = moved[vertex, 0] - muscles[muscle, 0]
    y = moved[vertex, 1] - muscles[muscle, 1]
    z = moved[vertex, 2] - muscles[muscle, 2]
    distance = math.sqrt(x * x + y * y + z * z)
    if distance == 0.0:
        return
    cosine = (x * muscles[muscle, 3] + y * muscles[muscle, 4] + z * muscles[muscle, 5]) / distance
    start, finish = muscles[muscle, 7], muscles[muscle, 8]
    if cosine < muscles[muscle, 6] or distance > finish:
        return
    argument = 1.0 - distance / start if distance <= start else (distance - start) / (finish - start)
    weight = -part * muscles[muscle, 9] * cosine * math.cos(argument * math.pi / 2) / distance
    change[vertex, 0] += weight * x
    change[vertex, 1] += weight * y
    change[vertex, 2] += weight * z
