"""What acts on the nodes of a lattice (Zhang, Prakash and Sung, Eq. 1 to 3), in numpy; compiled twins follow it.

Signs: a force here is what moves a node. The paper subtracts an F_ela that pulls a stretched spring's ends together.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from agentface.conventions import Doubles
from agentface.mesh.graph import SparseMatrix
from agentface.mesh.normals import doubled_areas
from agentface.tissue.elements import Elements
from agentface.tissue.lattice import REFERENCE_MM2, Lattice
from agentface.tissue.layers import HYPODERMIS

_Blocks = tuple[Any, Any, Doubles]
"""Rows, columns and ``(N, 3, 3)`` blocks of a matrix."""
CRUSHED = 0.2
"""Of a volume at rest: below it the pressure's law goes on straight, so that it stays finite."""


def spring_tension(lattice: Lattice, stretch: Doubles) -> tuple[Doubles, Doubles]:
    """Eq. 1: ``(S,)`` K times the stretch in mm, and its slope; K = (1 + (stretch / unit)^2)^alpha k0."""
    springs, table = lattice.springs, lattice.file.springs
    square = (stretch / (table.unit * springs.length)) ** 2
    stiffness = springs.stiffness * (1.0 + square) ** table.alpha
    slope = stiffness * (1.0 + 2.0 * table.alpha * square / (1.0 + square))
    return stiffness * stretch, slope


def bending_at_rest(lattice: Lattice) -> Doubles:
    """``(3, V, 3)``: the sum of each node's springs as they lie at rest, times the stiffness of their directions.

    The force that holds directions is this less the same sum of the springs as they lie.
    """
    total, pull = np.zeros_like(lattice.points), _bending(lattice)[:, None] * _ways(lattice, lattice.points)
    np.add.at(total, lattice.springs.ends[:, 0], pull)
    np.subtract.at(total, lattice.springs.ends[:, 1], pull)
    return total.reshape(lattice.rest.shape)


def _bending(lattice: Lattice) -> Doubles:
    return lattice.file.springs.bending * lattice.springs.stiffness


def _ways(lattice: Lattice, points: Doubles) -> Doubles:
    ends = lattice.springs.ends
    return points[ends[:, 0]] - points[ends[:, 1]]


def pressure(volume: Doubles) -> tuple[Doubles, Doubles]:
    """What a relative volume v is pressed with: v - 1 above 1, (v - 1/v) / 2 below, straight if crushed; its slope."""
    safe = np.maximum(volume, CRUSHED)
    low, low_slope = 0.5 * (safe - 1.0 / safe), 0.5 * (1.0 + 1.0 / safe**2)
    low = low + low_slope * (volume - safe)
    swollen = volume >= 1.0
    return np.where(swollen, volume - 1.0, low), np.where(swollen, 1.0, low_slope)


def pressure_energy(volume: Doubles) -> Doubles:
    """The integral of :func:`pressure` from 1."""
    safe = np.maximum(volume, CRUSHED)
    low = 0.25 * (safe * safe - 1.0) - 0.5 * np.log(safe)
    below = volume - safe
    at_safe, slope = pressure(safe)
    low = low + at_safe * below + 0.5 * slope * below * below
    return np.where(volume >= 1.0, 0.5 * (volume - 1.0) ** 2, low)


class Held(NamedTuple):
    """The bone's hold on the hypodermis: forces ``(V, 3)``, stiffness along and across the skin, and the energy."""

    forces: Doubles
    along: Doubles
    across: Doubles
    energy: float


def held(lattice: Lattice, points: Doubles) -> Held:
    """Springs to where the hypodermis rests, and contact with the bone, nodes at ``points (3 V, 3)``."""
    normals, gap, contact = lattice.normals, lattice.gap, lattice.file.skull.contact
    moved = points.reshape(3, -1, 3)[HYPODERMIS] - lattice.rest[HYPODERMIS]
    out = (moved * normals).sum(axis=1)
    along, across = lattice.tether.T
    deep = np.maximum(-gap - out, 0.0)
    pull = -(across - along) * out + contact * deep
    forces = pull[:, None] * normals - along[:, None] * moved
    energy = 0.5 * (along * (moved**2).sum(axis=1) + (across - along) * out**2 + contact * deep**2)
    return Held(forces, along, across + contact * (deep > 0.0), float(energy[lattice.free].sum()))


def volume_forces(
    lattice: Lattice, points: Doubles, elements: Elements | None = None, rest: Doubles | None = None
) -> Doubles:
    """``(3 V, 3)``: the incompressibility force, in the form and strength of ``tissue.yaml``.

    ``elements``, of the volumes ``rest`` at rest, take the place of the lattice's prisms.
    """
    table = lattice.file.volume
    solid, volumes = (lattice.prisms, lattice.volumes) if elements is None or rest is None else (elements, rest)
    forces, relative = np.zeros_like(points), solid.volumes(points) / volumes
    if table.form in ("printed", "signed"):
        corners = lattice.prisms.corners[:, :3]
        ways = doubled_areas(points, corners)
        ways /= np.linalg.norm(ways, axis=1, keepdims=True)
        size = (relative - 1.0) ** 2 if table.form == "printed" else -(relative - 1.0) * np.abs(relative - 1.0)
        each = np.repeat((table.rho * size[:, None] * ways)[:, None], 3, axis=1)
    else:
        corners = solid.corners[:, :3] if table.form == "epidermis" else solid.corners
        size = -table.rho * pressure(relative)[0] / REFERENCE_MM2
        each = size[:, None, None] * solid.gradients(points)[:, : corners.shape[1]]
    np.add.at(forces, corners, each)
    return forces


def forces(lattice: Lattice, points: Doubles, load: Doubles) -> Doubles:
    """``(3 V, 3)``: the net force on the nodes that move, 0 on the others; ``load`` is the muscles'."""
    springs, count = lattice.springs, lattice.rest.shape[1]
    way = _ways(lattice, points)
    length = np.linalg.norm(way, axis=1)
    pull = (spring_tension(lattice, length - springs.length)[0] / length)[:, None] * way
    pull += _bending(lattice)[:, None] * (way - _ways(lattice, lattice.points))
    total = load + volume_forces(lattice, points)
    np.subtract.at(total, springs.ends[:, 0], pull)
    np.add.at(total, springs.ends[:, 1], pull)
    total[HYPODERMIS * count :] += held(lattice, points).forces
    total[~np.tile(lattice.free, 3)] = 0.0
    return total


def energy(lattice: Lattice, points: Doubles, load: Doubles) -> float:
    """The energy whose downward slope :func:`forces` is; of the volume force, for the form ``energy`` alone."""
    springs, table = lattice.springs, lattice.file.springs
    ways = _ways(lattice, points)
    stretch = np.linalg.norm(ways, axis=1) - springs.length
    turned = 0.5 * _bending(lattice) * ((ways - _ways(lattice, lattice.points)) ** 2).sum(axis=1)
    unit = (table.unit * springs.length) ** 2
    share = (
        springs.stiffness * unit / (2.0 * (table.alpha + 1)) * ((1.0 + stretch**2 / unit) ** (table.alpha + 1) - 1.0)
    )
    solid = lattice.file.volume.rho / REFERENCE_MM2 * lattice.volumes
    squeezed = solid * pressure_energy(lattice.prisms.volumes(points) / lattice.volumes)
    work = (load * (points - lattice.points))[np.tile(lattice.free, 3)]
    return float(share.sum() + turned.sum() + squeezed.sum() + held(lattice, points).energy - work.sum())


def stiffness(lattice: Lattice, points: Doubles) -> SparseMatrix:
    """``(3 F, 3 F)`` sparse: the slope of :func:`forces`, its sign turned, by the F nodes that move; for ``energy``.

    Nodes stand in their order, three rows each. What a compressed spring and a pressed prism would take away is left
    out, so that it is positive.
    """
    from scipy import sparse

    count, free = lattice.rest.shape[1], np.flatnonzero(np.tile(lattice.free, 3))
    place = np.full(3 * count, -1)
    place[free] = np.arange(len(free))
    parts = [_spring_blocks(lattice, points), _held_blocks(lattice, points), _volume_blocks(lattice, points)]
    rows, columns, blocks = (np.concatenate(part) for part in zip(*parts, strict=True))
    rows, columns = place[rows], place[columns]
    kept = (rows >= 0) & (columns >= 0)
    rows, columns, blocks = rows[kept], columns[kept], blocks[kept]
    across, down = np.meshgrid(np.arange(3), np.arange(3))
    i, j = 3 * rows[:, None, None] + down, 3 * columns[:, None, None] + across
    return sparse.csc_matrix((blocks.ravel(), (i.ravel(), j.ravel())), shape=(3 * len(free),) * 2)


def _spring_blocks(lattice: Lattice, points: Doubles) -> _Blocks:
    a, b = lattice.springs.ends.T
    way = _ways(lattice, points)
    length = np.linalg.norm(way, axis=1)
    tension, slope = spring_tension(lattice, length - lattice.springs.length)
    slope = slope + _bending(lattice)
    side = np.maximum(tension / length + _bending(lattice), 0.0)
    ways = way / length[:, None]
    block = side[:, None, None] * np.eye(3) + (slope - side)[:, None, None] * ways[:, :, None] * ways[:, None]
    return np.concatenate([a, b, a, b]), np.concatenate([a, b, b, a]), np.concatenate([block, block, -block, -block])


def _held_blocks(lattice: Lattice, points: Doubles) -> _Blocks:
    hold, normals = held(lattice, points), lattice.normals
    nodes = HYPODERMIS * len(normals) + np.arange(len(normals))
    turned = (hold.across - hold.along)[:, None, None] * normals[:, :, None] * normals[:, None]
    return nodes, nodes, hold.along[:, None, None] * np.eye(3) + turned


def _volume_blocks(lattice: Lattice, points: Doubles) -> _Blocks:
    prisms, volumes = lattice.prisms, lattice.volumes
    slopes, corners = prisms.gradients(points), prisms.corners
    size = lattice.file.volume.rho * pressure(prisms.volumes(points) / volumes)[1] / (REFERENCE_MM2 * volumes)
    rows = np.repeat(corners, 6, axis=1).ravel()
    columns = np.tile(corners, (1, 6)).ravel()
    blocks = size[:, None, None, None, None] * slopes[:, :, None, :, None] * slopes[:, None, :, None, :]
    return rows, columns, blocks.reshape(-1, 3, 3)
