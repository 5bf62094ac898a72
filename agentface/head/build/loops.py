"""Ordered loops of vertices round the mouth and the eyes, from the seams of the UV islands outward."""

from __future__ import annotations

import numpy as np

from agentface.conventions import Indices


def border_loops(quads: Indices) -> list[list[int]]:
    """The ordered borders of a set of quads, longest first."""
    edges = {(int(quad[i]), int(quad[(i + 1) % 4])) for quad in quads for i in range(4)}
    following = {a: b for a, b in edges if (b, a) not in edges}
    loops = []
    while following:
        first = min(following)
        loop, here = [first], following.pop(first)
        while here != first and here in following:
            loop.append(here)
            here = following.pop(here)
        loops.append(loop)
    return sorted(loops, key=len, reverse=True)


def rings(seed: list[int], quads: Indices, count: int) -> list[list[int]]:
    """``count`` ordered loops round ``seed``, each one quad further out; the seed is not among them."""
    found: list[list[int]] = []
    covered = np.zeros(len(quads), bool)
    reached = set(seed)
    for _ in range(count):
        covered |= np.isin(quads, list(reached)).any(axis=1)
        outer = [loop for loop in border_loops(quads[covered]) if not set(loop) & set(seed)]
        ring = max(outer, key=len)
        found.append(ring)
        reached = set(ring)
    return found
