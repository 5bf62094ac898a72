"""What neighbours may not do to each other in any pose: skin that turns over, teeth and eyes that poke through it."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numba import njit

from agentface.conventions import SIDES
from agentface.deform.geometry import FaceGeometry
from agentface.head.model import HeadModel
from agentface.head.ring_names import LidRing
from agentface.parameters import PARAMETERS, FacePose

UPPER_LID_RINGS, LOWER_LID_RINGS = LidRing.FOLD + 1, LidRing.PLATE + 2
"""Rings of the lids that fold: those of the lids' regions, and above the upper lid those of the crease."""
DEPTH = 0.008
"""How far behind the surface of a tooth or an eye skin is looked for, in metres."""
_SHARES = np.array([[1, 1, 1], [4, 1, 1], [1, 4, 1], [1, 1, 4]]) / np.array([[3], [6], [6], [6]])
"""Of a triangle's corners in the four points that stand for it."""


def ranges() -> list[np.ndarray]:
    """The lowest and the highest value of every parameter, ``(COUNT,)``, but 0 for the head's angles."""
    return [
        np.array([0.0 if known.kind == "head" else getattr(known, end) for known in PARAMETERS])
        for end in ("low", "high")
    ]


def random_poses(count: int, seed: int) -> Iterator[FacePose]:
    """Poses with every parameter uniform in its range, but the head ahead: its turn twists the neck."""
    low, high = ranges()
    draw = np.random.default_rng(seed)
    for _ in range(count):
        yield FacePose((low + (high - low) * draw.random(len(low))).astype(np.float32))


def fold_vertices(model: HeadModel) -> np.ndarray:
    """``(V,)`` true for what folds by design: the red of the lips, the inside of the mouth, lids."""
    inside = (model.material[:, 0] > 0.4) | (model.material[:, 1] > 0.02)
    for side in SIDES:
        rings = model.eyelids.rings[side]
        for half in (*(r.upper for r in rings[:UPPER_LID_RINGS]), *(r.lower for r in rings[:LOWER_LID_RINGS])):
            inside[half] = True
    return inside


@dataclass(frozen=True)
class Edges:
    """Edges between two triangles: ``triangles (E, 2)``, ``ends (E, 2)``, both less than 90 degrees apart at rest."""

    model: HeadModel
    triangles: np.ndarray
    ends: np.ndarray

    @classmethod
    def of(cls, model: HeadModel) -> Edges:
        owner: dict[tuple[int, int], int] = {}
        pairs = []
        for number, (a, b, c) in enumerate(model.triangles.tolist()):
            for edge in ((a, b), (b, c), (c, a)):
                key = (min(edge), max(edge))
                if key in owner:
                    pairs.append((owner[key], number, *key))
                owner[key] = number
        table = np.array(pairs)
        flat = ~(_cosines(model.vertices, model.triangles, table[:, :2]) < 0)
        return cls(model, table[flat, :2], table[flat, 2:])

    def folding(self) -> np.ndarray:
        """``(E,)`` true for edges inside the folds of lips and lids."""
        return fold_vertices(self.model)[self.ends].all(axis=1)

    def flipped(self, vertices: np.ndarray) -> np.ndarray:
        """``(E,)`` true where the two triangles stand more than 90 degrees apart."""
        return _cosines(vertices, self.model.triangles, self.triangles) < 0


@njit(cache=True)
def _cosines(vertices, triangles, pairs):  # type: ignore[no-untyped-def]
    """The cosine between the normals of each pair of triangles, times both their areas' doubles."""
    normals = np.empty((len(triangles), 3))
    for t in range(len(triangles)):
        a, b, c = triangles[t]
        for i in range(3):
            j, k = (i + 1) % 3, (i + 2) % 3
            y, z = np.float64(vertices[a, j]), np.float64(vertices[a, k])
            uj, uk, vj, vk = vertices[b, j] - y, vertices[b, k] - z, vertices[c, j] - y, vertices[c, k] - z
            normals[t, i] = uj * vk - uk * vj
    result = np.empty(len(pairs))
    for p in range(len(pairs)):
        one, other = normals[pairs[p, 0]], normals[pairs[p, 1]]
        result[p] = one[0] * other[0] + one[1] * other[1] + one[2] * other[2]
    return result


class Poking:
    """Rays from the teeth and the eyes: what has the outside of skin behind it and none before it has come through.

    What shows between open lips or lids has no skin close behind it, what is covered has some before it.
    """

    def __init__(self, model: HeadModel) -> None:
        self._parts = {name: _surface(model, name) for name in ("teeth_upper", "teeth_lower", "eye_l", "eye_r")}
        skin = model.triangles[~(model.material[:, 1] > 0.5)[model.triangles].any(axis=1)]
        self._near = {name: skin[_within(model, skin, points)] for name, (points, _) in self._parts.items()}
        # the lids' wet margins lie against the eye and round it
        self._margin = model.material[:, 2] > 0.5
        self._centres = {f"eye_{side}": model.eye_centre(side).astype(np.float64) for side in SIDES}

    def count(self, geometry: FaceGeometry) -> dict[str, int]:
        """How many points of each part poke through the skin."""
        vertices = geometry.vertices.astype(np.float64)
        result = {}
        for name, (points, normals) in self._parts.items():
            where, outward = points, normals
            if name == "teeth_lower":
                turn = geometry.jaw.astype(np.float64)
                where, outward = points @ turn[:3, :3].T + turn[:3, 3], normals @ turn[:3, :3].T
            elif name in self._centres:
                turn = geometry.eye_rotations[SIDES.index(name[-1])].astype(np.float64)
                where = (points - self._centres[name]) @ turn.T + self._centres[name]
                outward = normals @ turn.T
            near = self._near[name]
            outer = ~self._margin[near].any(axis=1)
            order = np.argsort(where[:, 0])
            result[name] = int(_through(where[order], outward[order], vertices, near, outer, DEPTH).sum())
        return result


def _surface(model: HeadModel, name: str) -> tuple[np.ndarray, np.ndarray]:
    """Points, the triangles' middles among them, and unit normals of a part's front: no gums, no eye's back."""
    part = model.parts[name]
    points = part.attributes["POSITION"].astype(np.float64)
    normals = np.zeros_like(points)
    corners = points[part.triangles]
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    for i in range(3):
        np.add.at(normals, part.triangles[:, i], across)
    chosen = np.ones(len(points), np.bool_)
    if name.startswith("teeth"):
        chosen = part.attributes["_MATERIAL"][:, 0] > 0
    inside = chosen[part.triangles].all(axis=1)
    middles = [np.tensordot(corners[inside], share, (1, 0)) for share in _SHARES]
    points = np.concatenate([points[chosen], *middles])
    normals = np.concatenate([normals[chosen], *[across[inside]] * len(middles)])
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    outside = normals[:, 2] > 0.2
    return points[outside], normals[outside]


def _within(model: HeadModel, triangles: np.ndarray, points: np.ndarray, reach: float = 0.03) -> np.ndarray:
    low, high = points.min(axis=0) - reach, points.max(axis=0) + reach
    middle = model.vertices[triangles].mean(axis=1)
    return ((middle > low) & (middle < high)).all(axis=1)


@njit(cache=True)
def _through(points, outward, vertices, triangles, outer, depth):  # type: ignore[no-untyped-def]
    """Which of ``points`` have the outside of an ``outer`` triangle within ``depth`` behind them and none before.

    The points come in the order of their x.
    """
    behind, before = np.zeros(len(points), np.bool_), np.zeros(len(points), np.bool_)
    across = points[:, 0].copy()
    low, high = points[:, 1].min(), points[:, 1].max()
    for t in range(len(triangles)):
        a, b, c = vertices[triangles[t, 0]], vertices[triangles[t, 1]], vertices[triangles[t, 2]]
        ux, uy, uz = b[0] - a[0], b[1] - a[1], b[2] - a[2]
        vx, vy, vz = c[0] - a[0], c[1] - a[1], c[2] - a[2]
        nx, ny, nz = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
        square = nx * nx + ny * ny + nz * nz
        slant = 0.2 * math.sqrt(square)
        size = depth + max(abs(ux), abs(vx)) + max(abs(uy), abs(vy)) + max(abs(uz), abs(vz))
        if a[1] + size < low or a[1] - size > high:
            continue
        first, last = np.searchsorted(across, a[0] - size), np.searchsorted(across, a[0] + size, side="right")
        for i in range(first, last):
            px, py, pz = points[i, 0] - a[0], points[i, 1] - a[1], points[i, 2] - a[2]
            if abs(px) > size or abs(py) > size or abs(pz) > size:
                continue
            dx, dy, dz = outward[i, 0], outward[i, 1], outward[i, 2]
            along = nx * dx + ny * dy + nz * dz
            if along <= slant:
                continue
            far = (nx * px + ny * py + nz * pz) / along
            if abs(far) < 1e-5 or abs(far) > depth:
                continue
            x, y, z = px - far * dx, py - far * dy, pz - far * dz
            # the foot's barycentric coordinates, by areas
            one = (nz * vy - ny * vz) * x + (nx * vz - nz * vx) * y + (ny * vx - nx * vy) * z
            two = (ny * uz - nz * uy) * x + (nz * ux - nx * uz) * y + (nx * uy - ny * ux) * z
            if one >= 0.0 and two >= 0.0 and one + two <= square:
                if far < 0.0:
                    before[i] = True
                elif outer[t]:
                    behind[i] = True
    return behind & ~before
