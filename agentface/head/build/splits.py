"""Quads that are halved: further rings round the eyes, further columns at the corners of the mouth."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from agentface.conventions import Indices

WHOLE, ACROSS, ALONG = 0, 1, 2
"""A quad of corners 0 1 2 3: as it is, halved through the edges 01 and 23, or through 12 and 30."""


def between_rings(quads: Indices, inner: list[int], outer: list[int]) -> Indices:
    """``(Q,)``: the quads between two neighbouring rings halved, so that a new ring runs between them."""
    depth = np.zeros(int(quads.max()) + 1, np.int8)
    depth[inner], depth[outer] = 1, 2
    corners = depth[quads]
    between = (corners > 0).all(1) & (corners.min(1) < corners.max(1))
    return np.where(between, np.where(corners[:, 0] != corners[:, 1], ACROSS, ALONG), WHOLE).astype(np.int32)


def across_rings(quads: Indices, edges: Iterable[tuple[int, int]], borders: Iterable[set[int]]) -> Indices:
    """``(Q,)``: the strips of quads through ``edges`` halved, so that a new column runs through them.

    A strip ends at the first of its edges that lies in one of the sets of vertices ``borders``.
    """
    result = np.zeros(len(quads), np.int32)
    ends = np.stack([np.sort(quads[:, [i, (i + 1) % 4]], axis=1) for i in range(4)], axis=1)
    at_edge: dict[tuple[int, int], list[tuple[int, int]]] = {}
    for quad, sides in enumerate(ends.tolist()):
        for side, (a, b) in enumerate(sides):
            at_edge.setdefault((a, b), []).append((quad, side))
    for first in edges:
        for start in at_edge[min(first), max(first)]:
            here = start
            while True:
                quad, side = here
                result[quad] = ACROSS if side % 2 == 0 else ALONG
                a, b = sorted(quads[quad, [(side + 2) % 4, (side + 3) % 4]].tolist())
                further = [place for place in at_edge[a, b] if place[0] != quad]
                if not further or any({a, b} <= border for border in borders):
                    break
                here = further[0]
    return result
