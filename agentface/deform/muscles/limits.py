"""How far the vector muscles may move the skin: no triangle squashed flat, no vertex outside its region's limit.

Regions control the displacement (Bui et al., section 2.1). After :mod:`.squash`, a point that has moved
by d, |d| > 0.8 L with L its limit, is drawn back to the length

    L (0.8 + 0.2 s / (1 + s)),     s = (|d| / L − 0.8) / 0.2,

smooth in value and slope and below L. L is what ``regions.yaml`` says for the vertex's region, less where a region with
a smaller limit is near: away from that it grows by 1.5 m a metre.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from agentface.conventions import Doubles, Floats
from agentface.deform.mouth.jaw import Follow
from agentface.deform.muscles import squash
from agentface.deform.muscles.squash import SquashTables
from agentface.head.model import HeadModel
from agentface.head.regions import LIMITED

_KNEE = 0.8
_SLOPE = 1.5


class LimitTables(NamedTuple):
    """The limits of a face.

    Attributes:
        rest: ``(P, 3)`` float32 m, the points at rest.
        limit: ``(P,)`` float32 m, how far each may travel.
        knee: the part of its limit from which a point is held back.
        squash: the heights that muscles can squash.
    """

    rest: Floats
    limit: Floats
    knee: float
    squash: SquashTables


def prepare(model: HeadModel, follow: Follow | None = None, rest: Floats | None = None) -> LimitTables:
    """The limits of the vertices and, where ``rest (P, 3)`` goes on after these, of the points that ``follow`` them."""
    limit = travel_limits(model)
    if follow is not None and rest is not None:
        limit = np.concatenate([limit, (limit[follow[0]] * follow[1]).sum(axis=1)])
    points = model.vertices if rest is None else rest
    return LimitTables(
        rest=np.ascontiguousarray(points, np.float32),
        limit=np.ascontiguousarray(limit, np.float32),
        knee=_KNEE,
        squash=squash.prepare(model),
    )


def travel_limits(model: HeadModel) -> Doubles:
    """``(V,)`` m: the limit of each vertex's region or sub-region, less within reach of a smaller one."""
    limit = np.empty(len(model.vertices))
    for name in LIMITED:  # regions come first, so that their sub-regions take what is theirs
        limit[model.regions.mask([name])] = model.regions.limits[name] * model.landmarks.eye_separation
    ends = np.concatenate([model.triangles[:, [i, (i + 1) % 3]] for i in range(3)])
    start, end = np.concatenate([ends, ends[:, ::-1]]).T
    step = _SLOPE * np.linalg.norm(model.vertices[start].astype(np.float64) - model.vertices[end], axis=1)
    while True:
        less = limit.copy()
        np.minimum.at(less, end, limit[start] + step)
        if np.array_equal(less, limit):
            return limit
        limit = less


def apply(tables: LimitTables, points: Floats) -> None:
    """Bound the squash and the travel of ``points (P, 3)`` m in place; points within the bounds stay as they are."""
    squash.apply(tables.squash, points)
    moved = points[: len(tables.rest)] - tables.rest
    far = np.linalg.norm(moved, axis=1)
    knee, above = np.float32(tables.knee), np.float32(1.0 - tables.knee)
    beyond = np.flatnonzero(far > knee * tables.limit)
    limit = tables.limit[beyond]
    s = (far[beyond] / limit - knee) / above
    length = limit * (knee + above * s / (1.0 + s))
    points[beyond] = tables.rest[beyond] + moved[beyond] * (length / far[beyond])[:, None]
