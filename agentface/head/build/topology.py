"""The skin's triangles: base quads subdivided up to twice where expression happens, thinned out where it does not.

Quads that rings of lips or lids pass through are at most halved, so that rings stay rings.

Every vertex is a vertex of the twice subdivided mesh, so that positions, shapes and attributes of any
identity follow from the two Catmull-Clark matrices.
"""

from __future__ import annotations

from collections.abc import Container
from itertools import pairwise

import numpy as np

from agentface.conventions import Doubles, Indices
from agentface.head.build.splits import ACROSS, WHOLE
from agentface.head.build.subdivide import catmull_clark, children, mirror_level
from agentface.mesh.thin import smallest_angle

MOST_LEVELS = 2


class SkinTopology:
    """The skin's topology: ``triangles (T, 3)`` and ``mirror (V,)``, and the matrices that place its vertices."""

    def __init__(
        self, quads: Indices, levels: Indices, rest: Doubles, mirror: Indices, splits: Indices | None = None
    ) -> None:
        """Subdivide quad i of ``quads (Q, 4)`` ``levels[i]`` times, or halve it as ``splits[i]`` says.

        ``rest (N, 3)`` is a symmetric head to choose diagonals by; ``mirror (N,)`` pairs its vertices.
        """
        self.first = catmull_clark(quads, len(rest))
        self.second = catmull_clark(self.first.quads, self.first.matrix.shape[0])
        once = mirror_level(self.first, mirror, quads)
        self.mirror_all = mirror_level(self.second, once, self.first.quads)
        self.rest = self.lift(rest)
        self.triangles: Indices
        self.mirror: Indices
        self.kept = np.arange(len(self.rest), dtype=np.int32)
        splits = np.zeros(len(quads), np.int32) if splits is None else splits
        half = self._half(quads, balanced(quads, levels), splits)
        self.all_triangles = np.concatenate([half, self.mirror_all[half[:, ::-1]]])
        self._compact()

    def lift(self, values: Doubles) -> Doubles:
        """Values ``(N, k)`` at the base vertices as values at every vertex of the twice subdivided mesh."""
        return np.asarray(self.second.matrix @ (self.first.matrix @ values))

    def place(self, values: Doubles) -> Doubles:
        """Values ``(N, k)`` at the base vertices as values ``(V, k)`` at the skin's vertices."""
        return self.lift(values)[self.kept]

    def keep(self, triangles: Indices) -> None:
        """Replace the triangles (numbered as now), dropping the vertices that none uses any more."""
        self.all_triangles = self.kept[triangles]
        self._compact()

    def reorder(self, order: Indices) -> None:
        """Renumber the vertices: new vertex i is old vertex ``order[i]``."""
        place = np.empty(len(order), np.int32)
        place[order] = np.arange(len(order), dtype=np.int32)
        self.kept = self.kept[order]
        self.triangles = place[self.triangles]
        self.mirror = place[self.mirror[order]]

    def _compact(self) -> None:
        self.kept, inverse = np.unique(self.all_triangles, return_inverse=True)
        self.triangles = inverse.reshape(-1, 3).astype(np.int32)
        self.mirror = np.searchsorted(self.kept, self.mirror_all[self.kept]).astype(np.int32)

    def _half(self, quads: Indices, levels: Indices, splits: Indices) -> Indices:
        left = [i for i, quad in enumerate(quads) if self.rest[quad, 0].mean() > 0]
        leaves: list[list[int]] = []
        for i in left:
            if levels[i] == 0:
                leaves += self._halves(quads[i].tolist(), int(splits[i]))
            for child in children(i) if levels[i] else ():
                if levels[i] == 1:
                    leaves.append(self.first.quads[child].tolist())
                else:
                    leaves += [self.second.quads[grandchild].tolist() for grandchild in children(child)]
        # the other half's corners count too: it is this half's mirror image, so along the midline they coincide
        used = {corner for corners in leaves for corner in corners}
        triangles: list[list[int]] = []
        for corners in leaves:
            triangles += self._triangulate(self.with_middles([*corners, corners[0]], used)[:-1])
        return np.array(triangles, np.int32)

    def _halves(self, quad: list[int], split: int) -> list[list[int]]:
        if split == WHOLE:
            return [quad]
        a, b, c, d = quad if split == ACROSS else quad[1:] + quad[:1]
        near, far = self.middle(a, b), self.middle(c, d)
        return [[a, near, far, d], [near, b, c, far]]

    def middle(self, a: int, b: int) -> int:
        """The vertex in the middle of the edge ``a``-``b`` of one of the quads or of their quarters; else -1."""
        ends = (min(a, b), max(a, b))
        return self.first.edge_vertex.get(ends, self.second.edge_vertex.get(ends, -1))

    def with_middles(self, path: list[int], used: Container[int]) -> list[int]:
        """A path of vertices with those that are ``used`` on its edges between them."""
        result = path[:1]
        for a, b in pairwise(path):
            middle = self.middle(a, b)
            result += self.with_middles([a, middle, b], used)[1:] if middle in used else [b]
        return result

    def _triangulate(self, polygon: list[int]) -> list[list[int]]:
        """Cut the ear with the largest smallest angle until a triangle is left."""
        rest, result = list(polygon), []
        while len(rest) > 3:
            count = len(rest)
            ears = [[rest[i - 1], rest[i], rest[(i + 1) % count]] for i in range(count)]
            best = max(range(count), key=lambda i: self._quality(ears, rest, i))
            result.append(ears[best])
            del rest[best]
        return [*result, rest]

    def _quality(self, ears: list[list[int]], rest: list[int], i: int) -> float:
        worst = smallest_angle(self.rest[ears[i]])
        if len(rest) == 4:
            worst = min(worst, smallest_angle(self.rest[ears[(i + 2) % 4]]))
        return worst


def balanced(quads: Indices, levels: Indices) -> Indices:
    """``levels`` raised so that quads sharing a vertex differ by at most one."""
    result = levels.copy()
    highest = np.zeros(int(quads.max()) + 1, np.int32)
    np.maximum.at(highest, quads.ravel(), result.repeat(4))
    return np.maximum(result, highest[quads].max(1) - 1).astype(np.int32)
