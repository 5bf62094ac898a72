"""The vertices round the mouth as a grid: rings from inside the mouth out to the skin, columns across them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from agentface.conventions import Doubles, Indices
from agentface.errors import InvalidValueError, Place
from agentface.head.model import HeadModel
from agentface.head.resample import ResampledModel

_RINGS = Place("lips.yaml", ("rings",))
INNER_RINGS, OUTER_RINGS = 3, 2
"""How many rings the patch has inside the mouth and on the skin, besides the rings of ``lips.yaml``."""
BAG_RINGS = 4
"""Rings further inside, that follow the patch with a fade."""
SEAM_RING, VERMILION_RING = INNER_RINGS + 1, INNER_RINGS + 7
"""The rings where the lips touch and where their red ends."""


@dataclass(frozen=True, slots=True)
class LipGrid:
    """Vertices on a grid that closes round the mouth.

    Attributes:
        vertices: ``(R, N)``, a row a ring, from inside the mouth out to the skin; columns from the left corner
            over the upper lip to the right corner and back below.
        bag: ``(BAG_RINGS, N)``, the rings next to the innermost one, outermost first.
        upper, lower: the columns of the middle of each lip.
    """

    vertices: Indices
    bag: Indices
    upper: int
    lower: int

    @property
    def mirror(self) -> Indices:
        """``(N,)``: the column that is each column's image in the median plane."""
        count = self.vertices.shape[1]
        return ((2 * self.upper - np.arange(count)) % count).astype(np.int32)


def lip_grid(model: HeadModel) -> LipGrid:
    """The grid of a face; raises InvalidValueError where the mesh round its mouth is no grid."""
    if isinstance(model, ResampledModel):
        coarse = lip_grid(model.coarse)
        return LipGrid(model.place[coarse.vertices], model.place[coarse.bag], coarse.upper, coarse.lower)
    rings = [np.array(ring.upper + ring.lower[-2:0:-1], np.int32) for ring in model.lips.rings]
    first = rings[0]
    upper = len(model.lips.rings[0].upper) // 2
    lower = len(first) - (len(model.lips.rings[0].lower) - 1) // 2
    edges = _edges(_near(model.triangles, np.concatenate(rings), max(OUTER_RINGS, INNER_RINGS + BAG_RINGS)))
    aligned = [first]
    for ring in rings[1:]:
        aligned.append(_aligned(aligned[-1], ring, edges))
    seen = set(np.concatenate(aligned).tolist())
    for _ in range(OUTER_RINGS):
        aligned.append(_grown(aligned[-1], seen, edges))
    inner = [first]
    for _ in range(INNER_RINGS + BAG_RINGS):
        inner.append(_grown(inner[-1], seen, edges))
    grid = np.stack([*inner[INNER_RINGS:0:-1], *aligned])
    return LipGrid(grid, np.stack(inner[INNER_RINGS + 1 :]), upper, lower)


def column_places(grid: LipGrid, points: Doubles, columns: int) -> Doubles:
    """``(N,)``: where each column of the grid lies on a scale of 0..``columns`` that closes round the mouth.

    By the mean length along the rings of the red, with the corners at 0 and at half the scale and the middles of
    the lips at a quarter and three quarters of it, so that left and right are images of each other.
    """
    red = points[grid.vertices[SEAM_RING : VERMILION_RING + 1]]
    steps = np.linalg.norm(np.roll(red, -1, axis=1) - red, axis=2).mean(0)
    count, quarter = len(steps), columns / 4
    steps = 0.5 * (steps + steps[(grid.mirror - 1) % count])
    places = np.zeros(count)
    # the corner lies between the first column and the second one, which is the outermost one on the red's outer half
    along = np.concatenate([[0.0], np.cumsum(steps)]) - 0.5 * steps[0]
    length = along[grid.upper]
    for column in range(grid.upper + 1):
        places[column] = quarter * along[column] / length
    back = along[-1] - along[grid.lower : count] + steps[0]
    length = along[-1] + steps[0] - along[grid.lower]
    places[grid.lower : count] = -quarter * back / length
    left = (np.arange(count) <= grid.upper) | (np.arange(count) >= grid.lower)
    places = np.where(left, places, 2 * quarter - places[grid.mirror])
    return np.asarray(places % columns)


def _near(triangles: Indices, vertices: Indices, steps: int) -> Indices:
    """The triangles that are reached from ``vertices`` over so many edges."""
    reached = np.zeros(int(triangles.max()) + 1, bool)
    reached[vertices] = True
    for _ in range(steps):
        reached[triangles[reached[triangles].any(axis=1)]] = True
    return triangles[reached[triangles].all(axis=1)]


def _edges(triangles: Indices) -> dict[int, set[int]]:
    neighbours: dict[int, set[int]] = {}
    for a, b, c in triangles.tolist():
        neighbours.setdefault(a, set()).update((b, c))
        neighbours.setdefault(b, set()).update((a, c))
        neighbours.setdefault(c, set()).update((a, b))
    return neighbours


def _aligned(ring: Indices, other: Indices, edges: dict[int, set[int]]) -> Indices:
    """``other`` turned so that every vertex of it is joined to the one of ``ring`` in the same column."""
    if len(ring) == len(other):
        for candidate in (other, other[::-1]):
            for shift in range(len(other)):
                turned = np.roll(candidate, shift)
                if all(b in edges[a] for a, b in zip(ring.tolist(), turned.tolist(), strict=True)):
                    return turned
    raise InvalidValueError(_RINGS, "rings whose vertices are joined one to one", f"{len(ring)}, {len(other)}")


def _grown(ring: Indices, seen: set[int], edges: dict[int, set[int]]) -> Indices:
    """The next ring beyond ``ring``, whose vertices are then seen."""
    new = set().union(*(edges[vertex] for vertex in ring.tolist())) - seen
    start = min(new)
    path, before = [start], -1
    while len(path) < len(new):
        ahead = sorted(vertex for vertex in edges[path[-1]] & new if vertex != before and vertex not in path)
        if not ahead:
            break
        before = path[-1]
        path.append(ahead[0])
    seen |= new
    if len(path) != len(new):
        raise InvalidValueError(_RINGS, "a mesh of closed rings round the mouth", f"a ring that ends after {len(path)}")
    return _aligned(ring, np.array(path, np.int32), edges)
