"""The loops of the paper's Table 1 (Bui, Heylen, Nijholt, section 5), compiled, in double precision.

Three ways to compute one thing: the vector muscles in steps, and the vertices' normals for Phong shading.

* :func:`contract_polygons` and :func:`contract_polygons_in_regions` walk over polygons that hold copies of their
  corners, as Waters' program does: a vertex is computed as often as polygons meet in it, and so is its normal
  (:func:`polygon_normals`). Whether a corner lies in a muscle's zone takes a root, a division and an arc cosine.
  The second looks first whether the muscle acts on the corner's region: the paper's cut-off.
* :func:`contract_vertices` walks over vertices that polygons share, looks at the region first, and decides with squares
  and products alone; a normal is computed once a vertex (:func:`shared_normals`).

Positions are in metres; ``moved`` and ``change`` have the shape of ``rest``.
"""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt
from numba import njit

from agentface.conventions import Bytes, Doubles, Floats, Indices
from agentface.head.muscle_set import MuscleSet

_NOTHING = 1e-6  # a contraction as small as this is none, as in the deformer

Flags = npt.NDArray[np.int64]


def constants(muscles: MuscleSet) -> Doubles:
    """float64 ``(M, 13)``: origin, insertion minus origin, zone, Rs, Rf, k, slope, base, cosine of the zone.

    The angular fall-off is ``slope * cos(alpha) + base`` inside the zone.
    """
    edge = np.cos(muscles.zone)
    smooth = muscles.falloff == "smooth"
    slope = 1.0 / (1.0 - edge) if smooth else np.ones_like(edge)
    base = -edge * slope if smooth else np.zeros_like(edge)
    columns = [muscles.zone, muscles.fall_start, muscles.fall_finish, muscles.elasticity, slope, base, edge]
    return np.column_stack([muscles.origin, muscles.insertion - muscles.origin, *columns])


@njit(cache=True)
def contract_polygons(
    rest: Doubles, moved: Doubles, change: Doubles, muscles: Doubles, levels: Doubles, step: float,
    triangles: Indices, reach: Floats,
) -> None:  # fmt: skip
    """The original loop over ``rest (T, 3, 3)``; ``reach (M, V)`` weighs what a muscle does to a vertex."""
    moved[:] = rest
    left = levels.copy()
    while left.max() > _NOTHING:
        change[:] = 0.0
        for muscle in range(muscles.shape[0]):
            part = min(step, left[muscle])
            if part <= 0.0:
                continue
            left[muscle] -= part
            for polygon in range(moved.shape[0]):
                for corner in range(3):
                    x = moved[polygon, corner, 0] - muscles[muscle, 0]
                    y = moved[polygon, corner, 1] - muscles[muscle, 1]
                    z = moved[polygon, corner, 2] - muscles[muscle, 2]
                    weight = _weight_by_angle(muscles, muscle, x, y, z)
                    if weight > 0.0:
                        weight *= part * reach[muscle, triangles[polygon, corner]]
                        change[polygon, corner, 0] -= weight * x
                        change[polygon, corner, 1] -= weight * y
                        change[polygon, corner, 2] -= weight * z
        moved += change


@njit(cache=True)
def contract_polygons_in_regions(
    rest: Doubles, moved: Doubles, change: Doubles, muscles: Doubles, levels: Doubles, step: float,
    triangles: Indices, reach: Floats, regions: Bytes, flags: Flags,
) -> None:  # fmt: skip
    """The same where ``flags (M,)`` has the bit of the corner's region, ``regions (T, 3)``."""
    moved[:] = rest
    left = levels.copy()
    while left.max() > _NOTHING:
        change[:] = 0.0
        for muscle in range(muscles.shape[0]):
            part = min(step, left[muscle])
            if part <= 0.0:
                continue
            left[muscle] -= part
            for polygon in range(moved.shape[0]):
                for corner in range(3):
                    if (flags[muscle] >> regions[polygon, corner]) & 1:
                        x = moved[polygon, corner, 0] - muscles[muscle, 0]
                        y = moved[polygon, corner, 1] - muscles[muscle, 1]
                        z = moved[polygon, corner, 2] - muscles[muscle, 2]
                        weight = _weight_by_angle(muscles, muscle, x, y, z)
                        if weight > 0.0:
                            weight *= part * reach[muscle, triangles[polygon, corner]]
                            change[polygon, corner, 0] -= weight * x
                            change[polygon, corner, 1] -= weight * y
                            change[polygon, corner, 2] -= weight * z
        moved += change


@njit(cache=True)
def contract_vertices(
    rest: Doubles, moved: Doubles, change: Doubles, muscles: Doubles, levels: Doubles, step: float,
    reach: Floats, regions: Bytes, flags: Flags,
) -> None:  # fmt: skip
    """All improvements, over ``rest (V, 3)``; ``regions (V,)``."""
    moved[:] = rest
    left = levels.copy()
    while left.max() > _NOTHING:
        change[:] = 0.0
        for muscle in range(muscles.shape[0]):
            part = min(step, left[muscle])
            if part <= 0.0:
                continue
            left[muscle] -= part
            for vertex in range(moved.shape[0]):
                if (flags[muscle] >> regions[vertex]) & 1:
                    x = moved[vertex, 0] - muscles[muscle, 0]
                    y = moved[vertex, 1] - muscles[muscle, 1]
                    z = moved[vertex, 2] - muscles[muscle, 2]
                    weight = _weight_by_squares(muscles, muscle, x, y, z)
                    if weight > 0.0:
                        weight *= part * reach[muscle, vertex]
                        change[vertex, 0] -= weight * x
                        change[vertex, 1] -= weight * y
                        change[vertex, 2] -= weight * z
        moved += change


@njit(cache=True)
def _weight_by_angle(muscles: Doubles, muscle: int, x: float, y: float, z: float) -> float:
    """What a contraction does to a point at (x, y, z) from the origin, a metre; zone found by distance and angle."""
    dx, dy, dz = muscles[muscle, 3], muscles[muscle, 4], muscles[muscle, 5]
    distance = math.sqrt(x * x + y * y + z * z)
    length = math.sqrt(dx * dx + dy * dy + dz * dz)
    if distance == 0.0:
        return 0.0
    cosine = (x * dx + y * dy + z * dz) / (distance * length)
    if math.acos(min(max(cosine, -1.0), 1.0)) > muscles[muscle, 6] or distance > muscles[muscle, 8]:
        return 0.0
    return _weight(muscles, muscle, cosine, distance)


@njit(cache=True)
def _weight_by_squares(muscles: Doubles, muscle: int, x: float, y: float, z: float) -> float:
    """The same, with squares and products: neither root nor division for a point outside the zone."""
    dx, dy, dz = muscles[muscle, 3], muscles[muscle, 4], muscles[muscle, 5]
    square = x * x + y * y + z * z
    if square > muscles[muscle, 8] * muscles[muscle, 8] or square == 0.0:
        return 0.0
    along = x * dx + y * dy + z * dz
    length = dx * dx + dy * dy + dz * dz
    edge = muscles[muscle, 12]
    if along < 0.0 or along * along < edge * edge * square * length:
        return 0.0
    distance = math.sqrt(square)
    return _weight(muscles, muscle, along / (distance * math.sqrt(length)), distance)


@njit(cache=True)
def _weight(muscles: Doubles, muscle: int, cosine: float, distance: float) -> float:
    start, finish = muscles[muscle, 7], muscles[muscle, 8]
    argument = 1.0 - distance / start if distance <= start else (distance - start) / (finish - start)
    angular = muscles[muscle, 10] * cosine + muscles[muscle, 11]
    return float(muscles[muscle, 9] * angular * math.cos(argument * (math.pi / 2)) / distance)


@njit(cache=True)
def polygon_normals(moved: Doubles, first: Indices, around: Indices, triangles: Indices, out: Doubles) -> None:
    """The normal of every corner ``(T, 3, 3)``: the area-weighted mean over the polygons that meet there.

    The polygons round vertex v are ``around[first[v] : first[v + 1]]``.
    """
    flat = np.empty((moved.shape[0], 3))
    for polygon in range(moved.shape[0]):
        _cross(moved[polygon, 0], moved[polygon, 1], moved[polygon, 2], flat[polygon])
    for polygon in range(moved.shape[0]):
        for corner in range(3):
            vertex = triangles[polygon, corner]
            x, y, z = 0.0, 0.0, 0.0
            for place in range(first[vertex], first[vertex + 1]):
                other = around[place]
                x, y, z = x + flat[other, 0], y + flat[other, 1], z + flat[other, 2]
            length = math.sqrt(x * x + y * y + z * z)
            if length > 0.0:
                x, y, z = x / length, y / length, z / length
            out[polygon, corner, 0], out[polygon, corner, 1], out[polygon, corner, 2] = x, y, z


@njit(cache=True)
def shared_normals(moved: Doubles, triangles: Indices, out: Doubles) -> None:
    """The normal of every vertex ``(V, 3)``, weighted alike."""
    out[:] = 0.0
    across = np.empty(3)
    for polygon in range(triangles.shape[0]):
        a, b, c = triangles[polygon, 0], triangles[polygon, 1], triangles[polygon, 2]
        _cross(moved[a], moved[b], moved[c], across)
        for corner in (a, b, c):
            out[corner, 0] += across[0]
            out[corner, 1] += across[1]
            out[corner, 2] += across[2]
    for vertex in range(out.shape[0]):
        length = math.sqrt(out[vertex, 0] ** 2 + out[vertex, 1] ** 2 + out[vertex, 2] ** 2)
        if length > 0.0:
            out[vertex, 0] /= length
            out[vertex, 1] /= length
            out[vertex, 2] /= length


@njit(cache=True)
def _cross(a: Doubles, b: Doubles, c: Doubles, out: Doubles) -> None:
    ux, uy, uz = b[0] - a[0], b[1] - a[1], b[2] - a[2]
    vx, vy, vz = c[0] - a[0], c[1] - a[1], c[2] - a[2]
    out[0], out[1], out[2] = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
