"""Fields over the skin evened out: every vertex goes half the way to the mean of its neighbours."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from agentface.conventions import Doubles, Floats, Indices


def evened(
    field: Doubles | Floats, triangles: Indices, times: int, free: npt.NDArray[np.bool_] | None = None
) -> Doubles:
    """A field ``(V,)`` or ``(V, k)`` evened out ``times`` over; only where it is ``free (V,)``, if that is given.

    ``triangles (T, 3)`` are those of a closed mesh: each edge is in two of them, once in either direction.
    """
    start, end = triangles.ravel(), np.roll(triangles, -1, axis=1).ravel()
    count = np.maximum(np.bincount(start, minlength=len(field)), 1)
    columns = np.array(field, np.float64).reshape(len(field), -1)
    where = slice(None) if free is None else free
    for _ in range(times):
        for column in columns.T:
            around = np.bincount(start, column[end], len(column)) / count
            column[where] += 0.5 * (around - column)[where]
    return columns.reshape(field.shape)
