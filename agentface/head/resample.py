"""The same face with more or fewer vertices: finer for close views, both to see how cost grows with the mesh."""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from functools import cached_property
from typing import Any

import numpy as np
import numpy.typing as npt

from agentface.conventions import SIDES, Floats, Indices
from agentface.head.feature_points import renumbered
from agentface.head.model import HeadModel
from agentface.head.muscle_set import MuscleSet
from agentface.head.regions import HALF_REGIONS, REGIONS, REST, SUB_REGIONS
from agentface.head.rings import EyelidsFile, LipsFile, RingHalves
from agentface.mesh.glb import Shape

_ON_MIDLINE = 1e-9  # m
_OUTSIDE, _INSIDE = 2, 7  # rings beside the mouth's that the lips need, on the skin and inside the mouth
_SMALLEST_OFFSET = 5e-6  # m, of a vertex that a shape moves, as in the asset


@dataclass(frozen=True, eq=False)
class ResampledModel(HeadModel):
    """A face made of another's vertices and the middles of its edges.

    Landmarks, eyes, hinge and muscles are the other's. Rings go through the same vertices: what is told by rings, the
    lips and the lids' margins, is computed there, and the vertices between them follow.

    Attributes:
        coarse: the face that it was made of.
        parents: ``(V, 2)`` int32, the vertices of ``coarse`` whose mean each vertex is; twice the same for its own.
        place: ``(U,)`` int32, where each vertex of ``coarse`` is now; -1 where it is gone.
        ringed: ``(R,)`` int32, the vertices of the rings and those that their parts count on beside them.
        between: ``(N, 3)`` int32, each vertex between them and the two whose mean it stays, in an order in which
            these come first.
    """

    coarse: HeadModel
    parents: Indices
    place: Indices
    ringed: Indices
    between: Indices

    @cached_property
    def muscles(self) -> MuscleSet:
        """The muscles of ``coarse`` with their reach interpolated: measured anew it would end at other vertices."""
        muscles = self.coarse.muscles
        return replace(muscles, reach=np.ascontiguousarray(_mean(muscles.reach.T, self.parents).T))


def subdivided(model: HeadModel) -> ResampledModel:
    """``model`` with every triangle cut in four at the middles of its edges; the surface stays what it was.

    Every attribute of a new vertex is the mean of its edge's ends; its region is that of one of them, the same on
    both sides of the face. About four times the vertices.
    """
    count = len(model.vertices)
    corners = model.triangles.astype(np.int64)
    sides = np.stack([corners, np.roll(corners, -1, axis=1)], axis=2)
    edges, of_side = np.unique(np.sort(sides, axis=2).reshape(-1, 2), axis=0, return_inverse=True)
    middle = count + of_side.reshape(-1, 3)
    children = [np.stack([corners[:, i], middle[:, i], middle[:, i - 1]], axis=1) for i in range(3)]
    triangles = np.stack([*children, middle], axis=1).reshape(-1, 3)
    images = np.sort(model.mirror[edges].astype(np.int64), axis=1)
    mirror = np.concatenate([model.mirror, count + np.searchsorted(_codes(edges, count), _codes(images, count))])
    parents = np.concatenate([np.arange(count).repeat(2).reshape(-1, 2), edges])
    return _build(model, parents, _owners(model, parents), triangles, mirror)


def thinned(model: HeadModel, count: int) -> ResampledModel:
    """``model`` without the vertices that matter least to its form, down to about ``count`` of them, symmetric.

    Vertices of rings, those near the mouth's, feature points and what lies in the median plane stay, and so does that
    without which a triangle would turn over or degenerate; if this is more than ``count``, what comes back is the
    coarsest possible.
    """
    from agentface.mesh.thin import Thinner

    vertices = model.vertices.astype(np.float64)
    free = vertices[:, 0] > _ON_MIDLINE
    free[_ringed(model)] = False
    points = (row.vertex for row in model.feature_points.values() if row.mesh == "skin" and row.vertex is not None)
    free[list(points)] = False
    if isinstance(model, ResampledModel):
        free[model.between] = False
    half = model.triangles[vertices[model.triangles, 0].mean(axis=1) > 0.0]
    left = Thinner(vertices, half, free).run((len(vertices) - count) // 2)
    triangles = np.concatenate([left, model.mirror[left[:, ::-1]]])
    kept = np.unique(triangles)
    place = np.zeros(len(vertices), np.int64)
    place[kept] = np.arange(len(kept))
    return _build(model, kept.repeat(2).reshape(-1, 2), kept, place[triangles], place[model.mirror[kept]])


def _build(model: HeadModel, parents: Any, owners: Any, triangles: Any, mirror: Any) -> ResampledModel:
    """A face of the means of ``parents (V, 2)``; each vertex is in the region of its ``owners (V,)``.

    They are renumbered in the order of their owners, which keeps regions together and neighbours near in memory.
    """
    order = np.argsort(owners, kind="stable")
    place = np.empty(len(order), np.int32)
    place[order] = np.arange(len(order), dtype=np.int32)
    owners, parents = owners[order], np.ascontiguousarray(parents[order], np.int32)
    vertices = _mean(model.vertices, parents)
    own = np.flatnonzero(parents[:, 0] == parents[:, 1]).astype(np.int32)
    new_of_old = np.full(len(model.vertices), -1, np.int32)
    new_of_old[parents[own, 0]] = own
    ranges = {
        name: (int(np.searchsorted(owners, first)), int(np.searchsorted(owners, last, side="right")) - 1)
        for name, (first, last) in model.regions.ranges.items()
    }
    kept: dict[str, Any] = {field.name: getattr(model, field.name) for field in fields(HeadModel)}
    return ResampledModel(**kept | {
        "vertices": vertices,
        "triangles": place[triangles],
        "mirror": place[mirror[order]],
        "material": _mean(model.material, parents),
        "shade": _mean(model.shade, parents),
        "jaw_weights": _mean(model.jaw_weights, parents),
        "own_uv": None if model.own_uv is None else _mean(model.own_uv, parents),
        "shapes": {name: _shape(shape, parents, len(model.vertices)) for name, shape in model.shapes.items()},
        "regions": replace(model.regions, region_of=model.regions.region_of[owners], ranges=ranges),
        "lips": _lips(model.lips, new_of_old),
        "eyelids": _eyelids(model.eyelids, new_of_old),
        "feature_points": renumbered(model.feature_points, new_of_old),
        "coarse": model,
        "parents": parents,
        "place": new_of_old,
        "ringed": new_of_old[_ringed(model)],
        "between": _between(model, parents, new_of_old),
    })  # fmt: skip


def _mean(values: Floats, parents: Indices) -> Floats:
    """The means of ``values (V, ...)`` over parents; a vertex that is its own parent keeps its value, bit for bit."""
    return np.float32(0.5) * (values[parents[:, 0]] + values[parents[:, 1]])


def _shape(shape: Shape, parents: Indices, count: int) -> Shape:
    offsets = _mean(shape.dense(count), parents)
    moved = np.flatnonzero(np.abs(offsets).max(axis=1) > _SMALLEST_OFFSET)
    return Shape(moved.astype(np.int32), offsets[moved])


def _codes(edges: Any, count: int) -> npt.NDArray[np.int64]:
    codes: npt.NDArray[np.int64] = edges[:, 0] * count + edges[:, 1]
    return codes


def _owners(model: HeadModel, parents: Any) -> npt.NDArray[np.int64]:
    """Which of its two parents gives each vertex its region; the mirror image's is the mirror image.

    A parent off the median plane goes before one on it, then one on the vertex's own side, then the inner region.
    """
    names = [REGIONS[index] for index in model.regions.region_of]
    side_of = np.array([{"l": 1, "r": -1}.get(name[-1], 0) if name != REST else 0 for name in names])
    rank = np.array([HALF_REGIONS.index(name[:-2]) if name != REST else 2 * len(HALF_REGIONS) for name in names])
    for name in SUB_REGIONS:
        for side in SIDES:
            rank[model.regions.members(f"{name}_{side}")] += len(HALF_REGIONS)
    x = model.vertices[:, 0]
    middle = np.where(x[parents].sum(axis=1) > _ON_MIDLINE, 1, -1)
    cost = 100 * (np.abs(x) <= _ON_MIDLINE)[parents] + rank[parents] + 50 * (side_of[parents] * middle[:, None] < 0)
    owners: npt.NDArray[np.int64] = parents[np.arange(len(parents)), cost.argmin(axis=1)]
    return owners


def _ringed(model: HeadModel) -> Indices:
    """The vertices of lids and lips; of the mouth also the rings beside those of ``lips.yaml``, on both sides."""
    if isinstance(model, ResampledModel):
        return model.ringed
    rings = [set(ring.upper + ring.lower) for ring in model.lips.rings]
    start, end = np.concatenate([model.triangles[:, [i, (i + 1) % 3]] for i in range(3)]).T
    seen = set[int]().union(*rings)
    for ring, steps in ((rings[-1], _OUTSIDE), (rings[0], _INSIDE)):
        front = ring
        for _ in range(steps):
            front = set(end[np.isin(start, list(front))].tolist()) - seen
            seen |= front
    lids = [ring for side in SIDES for ring in model.eyelids.rings[side]]
    return np.array(sorted(seen.union(*(ring.upper + ring.lower for ring in lids))), np.int32)


def _between(model: HeadModel, parents: Indices, place: Indices) -> Indices:
    before = model.between if isinstance(model, ResampledModel) else np.zeros((0, 3), np.int32)
    inside = np.zeros(len(model.vertices), np.bool_)
    inside[_ringed(model)] = inside[before[:, 0]] = True
    new = np.flatnonzero(inside[parents].all(axis=1) & (parents[:, 0] != parents[:, 1]))
    rows = [place[before], np.column_stack([new, place[parents[new]]])]
    return np.ascontiguousarray(np.concatenate(rows), np.int32)


def _rings(rings: list[RingHalves], place: Indices) -> list[RingHalves]:
    return [RingHalves(upper=place[ring.upper].tolist(), lower=place[ring.lower].tolist()) for ring in rings]


def _lips(lips: LipsFile, place: Indices) -> LipsFile:
    return lips.model_copy(update={"rings": _rings(lips.rings, place)})


def _eyelids(lids: EyelidsFile, place: Indices) -> EyelidsFile:
    return lids.model_copy(update={"rings": {side: _rings(rings, place) for side, rings in lids.rings.items()}})
