"""The way out of the mouth: what teeth and lips leave to the tongue.

A row of teeth is a wall: inside it is half an ellipse in the horizontal plane
(:class:`agentface.head.dental_wall.Wall`), before it the parabolic cylinder that touches it
(:class:`agentface.deform.mouth.dental_arch.Arch`), and its edges lie at one height. The lips are what their rings are
at columns across the mouth. Everything is in double precision, so that both forms of the tongue's stage share these
functions; numba compiles those that take scalars or arrays for scalars.
"""

from __future__ import annotations

from typing import Any, NamedTuple, TypeAlias

import numpy as np

from agentface.conventions import Doubles, Floats, Indices
from agentface.deform.mouth.dental_arch import fit_arch
from agentface.head.dental_wall import CLEAR, fit_wall
from agentface.head.model import HeadModel
from agentface.head.ring_names import LipRing

Places: TypeAlias = Any
"""One coordinate of a place, or ``(K,)`` of many: a number in compiled code, an array in numpy's."""
ROWS = "teeth_lower", "teeth_upper"
MIDDLE, BACK, DEPTH, WIDTH, EDGE, FRONT, BEND = range(7)
"""Columns of :attr:`Passage.walls`."""
BOTTOM, TOP, INNER_LOWER, OUTER_LOWER, INNER_UPPER, OUTER_UPPER = range(6)
"""Rows of the lips as a frame has them: heights of the lower and of the upper one, and the depths each lies between."""
COLUMNS = 17
"""Places across the mouth at which a frame looks at the lips."""
EDGE_CLEAR = 0.0006
"""m that the tongue keeps from the edges of the teeth."""
LIP_CLEAR = 0.001
"""m that it keeps from the lips."""
_NEAR = 0.0008  # m from a row, within which its edges count whole
_INSIDE, _BEFORE = 3.0, 1.2  # how steeply what is free widens behind a row of teeth and before it
_LIP_INSIDE, _LIP_BEFORE = 0.3, 1.6
_LIP_NEAR = 0.0015  # m
_SHORTEST = 1e-6  # m
_LEAST_GAP = 0.0022  # m, between lips that let the tongue's edges pass
_STEP = 0.0015  # m, between the edges of teeth and lips, that a tongue takes on its way
_RISE, _RISE_PART = 0.003, 0.25  # m, and part of the gap: how far either lip may be nearer there than in the middle


class Passage(NamedTuple):
    """What of a face the way out needs.

    Attributes:
        walls: ``(2, 7)`` m, the lower and the upper row: middle, back, depth, half width and edge of the wall inside,
            and front and bend (1/m) of the parabola before it.
        upper, lower: ``(R, N)``, ``(R, M)`` vertices of the halves of the lips' rings, from the left corner to the
            right one, the last one repeated where there are fewer.
    """

    walls: Doubles
    upper: Indices
    lower: Indices


def prepare(model: HeadModel) -> Passage:
    """That of a face."""
    walls = []
    for name in ROWS:
        wall, arch = fit_wall(model.parts[name], name, float(model.part_moves[name][0])), fit_arch(model, name)
        walls.append([wall.middle, wall.back, wall.depth - CLEAR, wall.width - CLEAR, wall.edge, arch.front, arch.bend])
    rings = model.lips.rings[: LipRing.BORDER + 1]
    upper, lower = (
        np.array([half + half[-1:] * (longest - len(half)) for half in halves], np.int32)
        for halves in ([ring.upper for ring in rings], [ring.lower for ring in rings])
        for longest in [max(map(len, halves))]
    )
    return Passage(np.array(walls), upper, lower)


def inward(wall: Doubles, x: Places, z: Places) -> Places:
    """How far a place is inside a row of teeth, m; negative outside."""
    across = (x - wall[MIDDLE]) / wall[WIDTH]
    along = np.maximum(z - wall[BACK], 0.0) / wall[DEPTH]
    return wall[DEPTH] * (1.0 - np.sqrt(across * across + along * along))


def half_width(wall: Doubles, z: Places) -> Places:
    """How far aside a place within a row of teeth is free, m."""
    along = np.minimum(np.maximum(z - wall[BACK], 0.0) / wall[DEPTH], 1.0)
    return wall[WIDTH] * np.sqrt(1.0 - along * along)


def beyond_edge(wall: Doubles, x: Places, z: Places) -> Places:
    """How far past the height of a row's edges a place may go, towards the row's gum, m; negative at the row itself."""
    aside = x - wall[MIDDLE]
    before = z - (wall[FRONT] - wall[BEND] * aside * aside)
    free = _INSIDE * np.maximum(inward(wall, x, z) - _NEAR, 0.0) + _BEFORE * np.maximum(before - _NEAR, 0.0)
    return free - EDGE_CLEAR


def beyond_lip(inner: Places, outer: Places, z: Places) -> Places:
    """How far past the edge of a lip between depths ``inner`` and ``outer`` a place may go, m; negative within it."""
    behind, before = np.maximum(inner - _LIP_NEAR - z, 0.0), np.maximum(z - outer - _LIP_NEAR, 0.0)
    return _LIP_INSIDE * behind + _LIP_BEFORE * before - LIP_CLEAR


def look_at_lips(passage: Passage, vertices: Floats, across: Doubles, lips: Doubles) -> None:
    """Write into ``across (COLUMNS,)`` the x of each column, and into ``lips (6, COLUMNS)`` the lips there, m."""
    last = passage.upper.shape[1] - 1
    left, right = vertices[passage.upper[LipRing.CONTACT, 0], 0], vertices[passage.upper[LipRing.CONTACT, last], 0]
    for column in range(COLUMNS):
        across[column] = left + (right - left) * column / (COLUMNS - 1)
        lips[BOTTOM, column], lips[TOP, column] = -1.0, 1.0
        lips[INNER_LOWER, column], lips[INNER_UPPER, column] = 1.0, 1.0
        lips[OUTER_LOWER, column], lips[OUTER_UPPER, column] = -1.0, -1.0
    for ring in range(passage.upper.shape[0]):
        _along(passage.lower[ring], vertices, across, lips[BOTTOM], lips[INNER_LOWER], lips[OUTER_LOWER], 1.0)
        _along(passage.upper[ring], vertices, across, lips[TOP], lips[INNER_UPPER], lips[OUTER_UPPER], -1.0)


def _along(
    ring: Indices, vertices: Floats, across: Doubles, edge: Doubles, inner: Doubles, outer: Doubles, sign: float
) -> None:
    """Let one ring of a lip, from the left corner to the right one, count; ``sign`` is 1 for the lower lip, else -1."""
    at, last = 0, ring.shape[0] - 2
    for column in range(across.shape[0]):
        while at < last and vertices[ring[at + 1], 0] > across[column]:
            at += 1
        one, other = vertices[ring[at]], vertices[ring[at + 1]]
        part = min(max((one[0] - across[column]) / max(one[0] - other[0], _SHORTEST), 0.0), 1.0)
        height, depth = one[1] + part * (other[1] - one[1]), one[2] + part * (other[2] - one[2])
        edge[column] = max(edge[column], height) if sign > 0.0 else min(edge[column], height)
        inner[column], outer[column] = min(inner[column], depth), max(outer[column], depth)


def slot(across: Doubles, lips: Doubles, below: float, above: float) -> tuple[float, float, float]:
    """The right and the left end of the part of the mouth that lets a tongue through, m, and the gap in the middle, m.

    ``below`` and ``above`` are the heights of the edges of the teeth, which it passes first. Both ends are the x of the
    middle where nothing gets through.
    """
    middle = COLUMNS // 2
    gap = _gap(lips, middle, below, above)
    ends = [across[middle], across[middle]]
    if gap > _LEAST_GAP:
        for side in range(2):
            step = 1 if side == 0 else -1
            column, here = middle, gap - _LEAST_GAP
            while here > 0.0 and 0 < column < COLUMNS - 1:
                column += step
                there = _fits(lips, column, below, above)
                part = 1.0 if there > 0.0 else here / (here - there)
                ends[side] = across[column - step] + part * (across[column] - across[column - step])
                here = there
    return ends[0], ends[1], max(gap, 0.0)


def _gap(lips: Doubles, column: int, below: float, above: float) -> float:
    """What is free of a column both between the teeth and between the lips, m."""
    return min(lips[TOP, column], above + _STEP) - max(lips[BOTTOM, column], below - _STEP)


def _fits(lips: Doubles, column: int, below: float, above: float) -> float:
    """How well the edges of a tongue fit between the lips at a column, m; negative where they do not."""
    middle = COLUMNS // 2
    rise = max(_RISE, _RISE_PART * (lips[TOP, middle] - lips[BOTTOM, middle]))
    free = _gap(lips, column, below, above) - _LEAST_GAP
    lower, upper = lips[BOTTOM, column] - lips[BOTTOM, middle], lips[TOP, middle] - lips[TOP, column]
    return min(free, rise - lower, rise - upper)
