"""The lattice in the form that kernels take: its columns of three nodes, LANES at once, none beside another.

Columns of one batch share no spring and no prism, so that all of a batch can move at the same time, and a batch after
another is Gauss and Seidel's order. Batches of a colour lie together; a column has the colour of its mirror image.
"""

from __future__ import annotations

from typing import NamedTuple, TypeAlias

import numpy as np

from agentface.conventions import Doubles, Floats, Indices
from agentface.deform.lanes import LANES
from agentface.tissue.forces import bending_at_rest
from agentface.tissue.lattice import REFERENCE_MM2, Lattice
from agentface.tissue.tissue_file import FORMS

NODES = 9
"""Coordinates of a column: three of the epidermis, of the dermis, of the hypodermis."""
STATES = NODES + 3
"""And three stiffnesses, a node's each, beside the forces on them."""
AROUND = ((0, 0), (1, 1), (2, 2), (0, 1), (1, 0), (1, 2), (2, 1))
"""Layers that the springs from a column to a neighbour join: here, there."""
CONNECTING = ((0, 1), (1, 2))


class Columns(NamedTuple):
    """B batches that move and others that stay, of LANES columns each; positions are ``(batches, 9, LANES)``.

    Attributes:
        vertex: ``(batches, LANES)`` int32, -1 for a lane without a column.
        place: ``(V,)`` int32, where in positions a vertex's first coordinate is; the others follow LANES apart.
        first: ``(B + 1,)`` int32, where a batch's rings begin.
        neighbour: ``(R, LANES)`` int32, places; a ring goes counter-clockwise, seen from outside.
        pull: ``(R, 7, LANES)`` k0 times the length at rest, of the springs ``AROUND``; 0 for none.
        inverse: ``(R, 7, LANES)`` 1 / length at rest.
        own_pull, own_inverse: ``(B, 2, LANES)`` of the connecting springs.
        volume: ``(R, LANES)`` 1 / volume at rest of the prism between a neighbour and the next; 0 for none.
        normal: ``(B, 3, LANES)`` of the skin.
        tether: ``(B, 2, LANES)`` along and across.
        gap: ``(B, LANES)`` mm to where contact with the bone begins.
        firmness: ``(B, 3, LANES)`` what the prisms add to the stiffness of a column's nodes, at rest.
        rest: positions at rest.
        law: ``(7,)``: Eq. 1's 1 / unit^2 and two coefficients of its power; rho over area; contact; form; bending.
        steady: ``(B, 9, LANES)`` the constant part of what holds the springs' directions.
        colours: ``(K + 1,)`` int32, where the batches of each colour begin.
    """

    vertex: Indices
    place: Indices
    first: Indices
    neighbour: Indices
    pull: Floats
    inverse: Floats
    own_pull: Floats
    own_inverse: Floats
    volume: Floats
    normal: Floats
    tether: Floats
    gap: Floats
    firmness: Floats
    rest: Floats
    law: Floats
    steady: Floats
    colours: Indices


def pack(lattice: Lattice, groups: list[Indices]) -> Columns:
    """The columns of a lattice, batched by ``groups`` of vertices in their order; what is in none of them stays."""
    rings = rings_of(lattice)
    moving, colours = _batches(groups, rings)
    stays = np.ones(len(lattice.free), np.bool_)
    stays[moving[moving >= 0]] = False
    staying = np.flatnonzero(stays).astype(np.int32)
    vertex = np.concatenate([moving, _padded(staying).reshape(-1, LANES)]).astype(np.int32)
    place = np.empty(len(lattice.free), np.int32)
    batch, lane = np.nonzero(vertex >= 0)
    place[vertex[batch, lane]] = NODES * LANES * batch + lane
    own = _springs_by_pair(lattice)
    tables = _ring_tables(lattice, rings, own, moving, place)
    chosen, real = np.maximum(moving, 0), moving >= 0
    count = len(lattice.free)
    own_pull, own_inverse = np.ones((2, len(moving), 2, LANES), np.float32)
    for which, (here, there) in enumerate(CONNECTING):
        for row, lane in zip(*np.nonzero(real), strict=True):
            v = int(moving[row, lane])
            stiff, length = own[v + here * count, v + there * count]
            own_pull[row, which, lane], own_inverse[row, which, lane] = stiff * length, 1.0 / length
    tether = np.where(real[:, None], lattice.tether[chosen].transpose(0, 2, 1), 1.0)
    normal = np.where(real[:, None], lattice.normals[chosen].transpose(0, 2, 1), 0.0)
    return Columns(
        vertex=vertex,
        place=place,
        first=tables.first,
        neighbour=tables.neighbour,
        pull=tables.pull,
        inverse=tables.inverse,
        own_pull=own_pull,
        own_inverse=own_inverse,
        volume=tables.volume,
        normal=np.ascontiguousarray(normal, np.float32),
        tether=np.ascontiguousarray(tether, np.float32),
        gap=np.where(real, lattice.gap[chosen], 1e3).astype(np.float32),
        firmness=np.where(real[:, None], _firmness(lattice)[:, chosen].transpose(1, 0, 2), 0.0).astype(np.float32),
        rest=packed(vertex, lattice.rest, padding=-1.0),
        law=law_of(lattice),
        steady=packed(moving, bending_at_rest(lattice)),
        colours=colours,
    )


def packed(vertex: Indices, points: Doubles, padding: float = 0.0) -> Floats:
    """Points ``(3, V, 3)`` as positions ``(batches, 9, LANES)``; empty lanes get points ``padding`` apart in z."""
    rows = np.moveaxis(points[:, np.maximum(vertex, 0)], 0, 2).reshape(*vertex.shape, NODES)
    rows = np.where((vertex >= 0)[..., None], rows, padding * np.array([0, 0, 0, 0, 0, 1, 0, 0, 2]))
    return np.ascontiguousarray(rows.transpose(0, 2, 1), np.float32)


def new_forces(columns: Columns) -> Floats:
    """Scratch for the forces on the batches that move, and their stiffness: ``(B, 12, LANES)``."""
    return np.zeros((len(columns.first) - 1, STATES, LANES), np.float32)


def unpacked(columns: Columns, positions: Floats) -> Doubles:
    """``(3, V, 3)``: the points of positions."""
    rows = positions.reshape(-1)[columns.place[:, None] + LANES * np.arange(NODES)]
    return np.ascontiguousarray(rows.reshape(-1, 3, 3).transpose(1, 0, 2), np.float64)


_SpringsByPair: TypeAlias = dict[tuple[int, int], tuple[float, float]]


class _RingTables(NamedTuple):
    first: Indices
    neighbour: Indices
    pull: Floats
    inverse: Floats
    volume: Floats


def rings_of(lattice: Lattice) -> list[list[int]]:
    """The neighbours of each vertex, counter-clockwise, as far as they form one fan; others in any order."""
    after: list[dict[int, int]] = [{} for _ in lattice.free]
    for triangle in lattice.triangles.tolist():
        for corner in range(3):
            after[triangle[corner]][triangle[(corner + 1) % 3]] = triangle[(corner + 2) % 3]
    return [_ring(following) for following in after]


def _ring(following: dict[int, int]) -> list[int]:
    starts = [vertex for vertex in following if vertex not in following.values()]
    vertex = starts[0] if starts else next(iter(following), -1)
    ring: list[int] = []
    while vertex >= 0 and vertex not in ring:
        ring.append(vertex)
        vertex = following.get(vertex, -1)
    return ring


def coloured(
    lattice: Lattice, mirror: Indices, some: Indices | None = None, rings: list[list[int]] | None = None
) -> list[Indices]:
    """Columns that move, or ``some`` of them, in groups in which none is beside another; images share a colour.

    ``mirror (V,)`` is each vertex's image, ``rings`` are those of the lattice, for who has them. Groups go from the
    forehead down, so that batches lie close together.
    """
    rings = rings_of(lattice) if rings is None else rings
    chosen = (np.flatnonzero(lattice.free) if some is None else some).astype(np.int32)
    colour, wanted = np.full(len(lattice.free), -1), set(chosen.tolist())
    order = chosen[np.argsort(-lattice.rest[0, chosen, 1], kind="stable")]
    for vertex in order.tolist():
        if colour[vertex] < 0:
            both = {vertex, int(mirror[vertex])} & wanted
            taken = {int(number) for one in both for number in colour[rings[one]]}
            colour[list(both)] = next(number for number in range(len(taken) + 1) if number not in taken)
    return [order[colour[order] == number] for number in range(int(colour[chosen].max(initial=-1)) + 1)]


def _batches(groups: list[Indices], rings: list[list[int]]) -> tuple[Indices, Indices]:
    """``(B, LANES)``, those of one valence together, and where each group's batches begin."""
    rows, starts = [], [0]
    for group in groups:
        valence = np.array([len(rings[vertex]) for vertex in group.tolist()], np.int32)
        rows.append(_padded(group[np.argsort(valence, kind="stable")]).reshape(-1, LANES))
        starts.append(starts[-1] + len(rows[-1]))
    return np.concatenate(rows).astype(np.int32), np.array(starts, np.int32)


def _padded(vertices: Indices) -> Indices:
    return np.concatenate([vertices, np.full(-len(vertices) % LANES, -1)])


def _springs_by_pair(lattice: Lattice) -> _SpringsByPair:
    """Stiffness and length of the spring between two nodes, either of them first."""
    springs = lattice.springs
    pairs = zip(springs.ends.tolist(), springs.stiffness.tolist(), springs.length.tolist(), strict=True)
    return {key: (k, length) for (a, b), k, length in pairs for key in ((a, b), (b, a))}


def _ring_tables(
    lattice: Lattice, rings: list[list[int]], springs: _SpringsByPair, moving: Indices, place: Indices
) -> _RingTables:
    count = len(lattice.free)
    prisms = {
        (a, b, c): 1.0 / volume
        for corners, volume in zip(lattice.prisms.corners[:, :3].tolist(), lattice.volumes.tolist(), strict=True)
        for a, b, c in (corners, corners[1:] + corners[:1], corners[2:] + corners[:2])
    }
    sizes = [max(len(rings[vertex]) for vertex in row if vertex >= 0) for row in moving.tolist()]
    first = np.concatenate([[0], np.cumsum(sizes)]).astype(np.int32)
    neighbour = np.zeros((first[-1], LANES), np.int32)
    pull, inverse = np.zeros((2, first[-1], len(AROUND), LANES), np.float32)
    volume = np.zeros((first[-1], LANES), np.float32)
    away = int(place[np.flatnonzero(~lattice.free)[0]])  # a place that no empty lane is at
    for row, vertices in enumerate(moving.tolist()):
        for lane, vertex in enumerate(vertices):
            ring = rings[vertex] if vertex >= 0 else []
            for step in range(sizes[row]):
                at = first[row] + step
                other = ring[min(step, len(ring) - 1)] if ring else -1
                neighbour[at, lane] = place[other] if ring else away
                if step >= len(ring):
                    continue
                for which, (here, there) in enumerate(AROUND):
                    stiff, length = springs.get((vertex + here * count, other + there * count), (0.0, 1.0))
                    pull[at, which, lane], inverse[at, which, lane] = stiff * length, 1.0 / length
            for step, other in enumerate(ring):  # a shorter ring repeats its last neighbour before it closes
                at = sizes[row] - 1 if step == len(ring) - 1 else step
                volume[first[row] + at, lane] = prisms.get((vertex, other, ring[(step + 1) % len(ring)]), 0.0)
    return _RingTables(first, neighbour, pull, inverse, volume)


def _firmness(lattice: Lattice) -> Doubles:
    """``(3, V)``: the slope of the prisms' force on each node."""
    prisms, result = lattice.prisms, np.zeros(lattice.rest.shape[:2])
    if lattice.file.volume.form == "energy":
        size = lattice.file.volume.rho / (REFERENCE_MM2 * lattice.volumes)
        each = size[:, None] * (prisms.gradients(lattice.points) ** 2).sum(axis=2)
        np.add.at(result.reshape(-1), prisms.corners, each)
    return result


def law_of(lattice: Lattice) -> Floats:
    """:attr:`Columns.law`."""
    table = lattice.file
    one, two = {0: (0.0, 0.0), 1: (1.0, 0.0), 2: (2.0, 1.0)}[table.springs.alpha]
    rho = table.volume.rho / (REFERENCE_MM2 if table.volume.form in ("energy", "epidermis") else 1.0)
    values = (
        table.springs.unit**-2,
        one,
        two,
        rho,
        table.skull.contact,
        FORMS.index(table.volume.form),
        table.springs.bending,
    )
    return np.array(values, np.float32)
