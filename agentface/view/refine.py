"""Vertex normals, and finer meshes for smooth outlines: curved PN edges (Vlachos et al. 2001, section 3.1)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from agentface.conventions import Doubles, Floats, Indices


def vertex_normals(vertices: Floats | Doubles, triangles: Indices) -> Floats:
    """``(V, 3)`` unit normals: the mean of the triangles' normals, weighted by area."""
    a, b, c = (vertices[triangles[:, corner]] for corner in range(3))
    faces = np.cross(b - a, c - a)
    corners, weights = triangles.T.ravel(), np.tile(faces, (3, 1))
    sums = np.stack([np.bincount(corners, weights[:, axis], len(vertices)) for axis in range(3)], axis=1)
    length = np.linalg.norm(sums, axis=1, keepdims=True)
    return np.asarray(sums / np.maximum(length, 1e-12), np.float32)


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


def refine(triangles: Indices, vertex_count: int) -> Refined:
    """Each triangle cut into four at the middles of its edges."""
    edges = np.sort(np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]]), axis=1)
    keys, where = np.unique(edges[:, 0].astype(np.int64) * vertex_count + edges[:, 1], return_inverse=True)
    middles = np.stack([keys // vertex_count, keys % vertex_count], axis=1).astype(np.int32)
    ab, bc, ca = (where.reshape(3, -1) + vertex_count).astype(np.int32)
    a, b, c = triangles.T
    finer = [[a, ab, ca], [b, bc, ab], [c, ca, bc], [ab, bc, ca]]
    kept = unrefined(triangles, vertex_count).ends
    return Refined(np.concatenate([np.stack(f, axis=1) for f in finer]), np.concatenate([kept, middles]))
