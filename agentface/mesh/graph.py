"""A mesh as a graph: its edges, its Laplacian, and fields that are harmonic on it or evened out along edges."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from agentface.conventions import Doubles, Indices

SparseMatrix = Any
"""A matrix of scipy.sparse, which has no types."""
Mask = npt.NDArray[np.bool_]


def edges_of(triangles: Indices) -> Indices:
    """The ``(E, 2)`` edges of ``triangles (T, 3)``, each once, the smaller vertex first, in order."""
    ends = np.sort(np.concatenate([triangles[:, [i, (i + 1) % 3]] for i in range(3)]), axis=1)
    return np.unique(ends, axis=0).astype(np.int32)


def rim_of(triangles: Indices) -> Indices:
    """The vertices on edges of a single triangle: the rims of an open mesh."""
    ends = np.sort(np.concatenate([triangles[:, [i, (i + 1) % 3]] for i in range(3)]), axis=1)
    pairs, count = np.unique(ends, axis=0, return_counts=True)
    return np.unique(pairs[count == 1]).astype(np.int32)


def adjacency(edges: Indices, count: int, weights: Doubles | None = None) -> SparseMatrix:
    """``(count, count)`` sparse: 1, or the edge's of ``weights (E,)``, between the ends of each edge."""
    from scipy import sparse

    values = np.ones(len(edges)) if weights is None else weights
    one = sparse.coo_matrix((values, (edges[:, 0], edges[:, 1])), shape=(count, count))
    return (one + one.T).tocsr()


def laplacian(edges: Indices, count: int, weights: Doubles | None = None) -> SparseMatrix:
    """``(count, count)`` sparse: a vertex's value less its neighbours', by edges of weight 1, or of ``weights``."""
    from scipy import sparse

    beside = adjacency(edges, count, weights)
    return (sparse.diags(np.asarray(beside.sum(1)).ravel()) - beside).tocsr()


def harmonic_weights(matrix: SparseMatrix, unknown: Mask) -> tuple[Indices, Doubles]:
    """How much each vertex of ``unknown (V,)`` takes of those that are known.

    Returns the known vertices that count, ``(K,)``, and ``(U, K)`` weights that make the field harmonic.
    """
    from scipy.sparse.linalg import spsolve

    inner, outer = np.flatnonzero(unknown), np.flatnonzero(~unknown)
    right = -matrix[inner][:, outer].tocsc()
    used = np.flatnonzero(np.diff(right.indptr))
    weights = spsolve(matrix[inner][:, inner].tocsc(), right[:, used].toarray())
    return outer[used].astype(np.int32), np.asarray(weights).reshape(len(inner), len(used))


def harmonic(matrix: SparseMatrix, known: Indices, values: Doubles) -> Doubles:
    """``(V,)``: the field that is harmonic on the graph of ``matrix``, with ``values`` at the vertices ``known``."""
    unknown = np.ones(matrix.shape[0], np.bool_)
    unknown[known] = False
    field = np.zeros(matrix.shape[0])
    field[known] = values
    used, weights = harmonic_weights(matrix, unknown)
    field[unknown] = weights @ field[used]
    return field


def grown(mask: Mask, beside: SparseMatrix, rings: int) -> Mask:
    """A mask with ``rings`` more rings of neighbours."""
    for _ in range(rings):
        mask = mask | (beside @ mask.astype(np.float64) > 0.0)
    return mask


def smoothed(beside: SparseMatrix, field: Doubles, rounds: int, weight: float = 0.5) -> Doubles:
    """A field ``(V,)`` or ``(V, k)`` that has gone ``rounds`` times ``weight`` of the way to the mean round each.

    Also where the mesh is open; on a closed one, :func:`agentface.mesh.evening.evened` does the same by halves.
    """
    count = np.maximum(np.asarray(beside.sum(1)), 1.0)
    count = count if field.ndim > 1 else count.ravel()
    for _ in range(rounds):
        field = (1.0 - weight) * field + weight * (beside @ field) / count
    return field
