"""Finer meshes for smooth outlines: curved PN edges (Vlachos et al. 2001, section 3.1)."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from agentface.conventions import Floats, Indices


@dataclass(frozen=True, slots=True)
class Refined:
    """Triangles ``(4 T, 3)`` whose vertices ``ends (N, 2)`` are old ones (twice the same) and middles of edges."""

    triangles: Indices
    ends: Indices

    def mean(self, field: Floats) -> Floats:
        """A field of the old vertices on the new ones."""
        return np.asarray(0.5 * (field[self.ends[:, 0]] + field[self.ends[:, 1]]), field.dtype)

    def positions(self, vertices: Floats, normals: Floats) -> Floats:
        """``(N, 3)``: old vertices where they were, middles on the cubic through both ends with their normals."""
        a, b = vertices[self.ends[:, 0]], vertices[self.ends[:, 1]]
        na, nb = normals[self.ends[:, 0]], normals[self.ends[:, 1]]
        rise_a = ((b - a) * na).sum(1, keepdims=True)
        rise_b = ((a - b) * nb).sum(1, keepdims=True)
        return np.asarray(0.5 * (a + b) - 0.125 * (rise_a * na + rise_b * nb), np.float32)


def unrefined(triangles: Indices, vertex_count: int) -> Refined:
    """The mesh as it is."""
    return Refined(triangles, np.repeat(np.arange(vertex_count, dtype=np.int32)[:, None], 2, axis=1))


def refine(
    triangles: Indices, vertex_count: int, cut: Callable[[Indices], npt.NDArray[np.bool_]] | None = None
) -> Refined:
    """Each triangle cut at the middles of its edges ``(E, 2)``: into four, or as many of them as ``cut`` chooses."""
    edges = np.sort(np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]]), axis=1)
    keys, where = np.unique(edges[:, 0].astype(np.int64) * vertex_count + edges[:, 1], return_inverse=True)
    middles = np.stack([keys // vertex_count, keys % vertex_count], axis=1).astype(np.int32)
    chosen = np.ones(len(middles), bool) if cut is None else cut(middles)
    number = (vertex_count - 1 + np.cumsum(chosen)).astype(np.int32)
    halved = chosen[where].reshape(3, -1)  # of each triangle, its edges ab, bc, ca
    first = np.select([halved.sum(0) == 1, halved.sum(0) == 2], [halved.argmax(0), (~halved).argmax(0) + 1], 0)
    turn = (first[:, None] + np.arange(3)) % 3  # one cut edge comes first, the one that is left whole last
    a, b, c = np.take_along_axis(triangles, turn, axis=1).T
    ab, bc, ca = np.take_along_axis(number[where].reshape(3, -1).T, turn, axis=1).T
    finer = (
        ((a, b, c),),
        ((a, ab, c), (ab, b, c)),
        ((a, ab, c), (ab, b, bc), (ab, bc, c)),
        ((a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca)),
    )
    parts = [np.stack(part, axis=1)[halved.sum(0) == cuts] for cuts, pattern in enumerate(finer) for part in pattern]
    kept = unrefined(triangles, vertex_count).ends
    return Refined(np.concatenate(parts).astype(np.int32), np.concatenate([kept, middles[chosen]]))
