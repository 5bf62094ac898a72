"""Catmull-Clark subdivision of quads as a sparse matrix, so that shapes and attributes subdivide like positions."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy import sparse

from agentface.conventions import Indices


@dataclass(frozen=True, slots=True)
class Level:
    """One subdivision step.

    Vertices of the finer mesh are numbered: the old vertices, then one an edge, then one a quad.

    Attributes:
        matrix: ``(n', n)`` sparse, old values to new values.
        quads: ``(4 Q, 4)`` the finer quads; those of old quad i are ``4 i + 0..3`` after :func:`children`.
        edge_vertex: the new vertex in the middle of an old edge ``(low, high)``.
        face_vertex: ``(Q,)`` the new vertex in the middle of an old quad.
    """

    matrix: Any
    quads: Indices
    edge_vertex: dict[tuple[int, int], int]
    face_vertex: Indices


def catmull_clark(quads: Indices, count: int) -> Level:
    """One step over ``quads (Q, 4)`` of a mesh of ``count`` vertices; open borders are creases."""
    faces = len(quads)
    ends = np.sort(np.stack([quads, np.roll(quads, -1, 1)], 2).reshape(-1, 2), 1)
    edges, of_corner, uses = np.unique(ends, axis=0, return_inverse=True, return_counts=True)
    of_corner = of_corner.reshape(faces, 4)
    inner = uses == 2
    face_points = _incidence(np.arange(faces).repeat(4), quads.ravel(), (faces, count)) / 4
    middles = _incidence(np.arange(len(edges)).repeat(2), edges.ravel(), (len(edges), count)) / 2
    beside = _incidence(of_corner.ravel(), np.arange(faces).repeat(4), (len(edges), faces))
    edge_points = sparse.diags(np.where(inner, 0.5, 1.0)) @ middles + sparse.diags(inner * 0.25) @ (
        beside @ face_points
    )
    matrix = sparse.vstack([_old_vertices(quads, edges, inner, face_points, middles, count), edge_points, face_points])
    edge_id, face_id = count + of_corner, count + len(edges) + np.arange(faces)
    corners = [np.stack([quads[:, i], edge_id[:, i], face_id, edge_id[:, i - 1]], 1) for i in range(4)]
    finer = np.stack(corners, 1).reshape(-1, 4).astype(np.int32)
    edge_vertex = {(int(a), int(b)): count + i for i, (a, b) in enumerate(edges)}
    return Level(matrix.tocsr(), finer, edge_vertex, face_id.astype(np.int32))


def children(quad: int) -> range:
    """The numbers of the four finer quads of an old quad."""
    return range(4 * quad, 4 * quad + 4)


def _incidence(rows: Any, columns: Any, shape: tuple[int, int]) -> Any:
    return sparse.csr_matrix((np.ones(len(rows)), (rows, columns)), shape=shape)


def _old_vertices(quads: Any, edges: Any, inner: Any, face_points: Any, middles: Any, count: int) -> Any:
    around = _incidence(quads.ravel(), np.arange(len(quads)).repeat(4), (count, len(quads)))
    along = _incidence(edges.ravel(), np.arange(len(edges)).repeat(2), (count, len(edges)))
    faces_at = np.maximum(np.asarray(around.sum(1)).ravel(), 1)
    edges_at = np.asarray(along.sum(1)).ravel()
    valence = np.maximum(edges_at, 1)
    border = np.zeros(count, bool)
    border[edges[~inner].ravel()] = True
    identity = sparse.identity(count, format="csr")
    smooth = (
        sparse.diags(1 / (valence * faces_at)) @ (around @ face_points)
        + sparse.diags(2 / valence**2) @ (along @ middles)
        + sparse.diags((valence - 3) / valence) @ identity
    )
    crease = 0.5 * identity + 0.25 * (along @ sparse.diags((~inner).astype(float)) @ middles)
    used = edges_at > 0
    return (
        sparse.diags((used & ~border).astype(float)) @ smooth
        + sparse.diags((used & border).astype(float)) @ crease
        + sparse.diags((~used).astype(float)) @ identity
    )


def mirror_level(level: Level, mirror: Indices, quads: Indices) -> Indices:
    """The mirror images of the finer mesh's vertices, from those of the coarser mesh's."""
    count, total = len(mirror), level.matrix.shape[0]
    image = np.arange(total, dtype=np.int32)
    image[:count] = mirror
    for (a, b), vertex in level.edge_vertex.items():
        low, high = sorted((int(mirror[a]), int(mirror[b])))
        image[vertex] = level.edge_vertex[low, high]
    by_corners = {
        tuple(sorted(quad)): int(vertex) for quad, vertex in zip(quads.tolist(), level.face_vertex, strict=True)
    }
    for quad, vertex in zip(quads, level.face_vertex, strict=True):
        image[vertex] = by_corners[tuple(sorted(int(mirror[corner]) for corner in quad))]
    return image
