"""A synthetic face for the deformer's tests: a bent shield with a nose, eleven regions and 38 muscles."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from agentface.conventions import Bytes, Floats, Indices
from agentface.head.muscle_set import Falloff, MuscleSet

# left half, centimetres: name, origin x y, insertion x y, Rs, Rf, half angle in degrees, regions of one side
_HALF = [
    ("zygomaticus_major", (5.0, 0.0), (2.4, -4.2), 3.6, 6.4, 40, (0, 1)),
    ("zygomaticus_minor", (4.2, 0.6), (1.6, -2.8), 3.0, 5.8, 38, (1,)),
    ("levator_labii_superioris", (2.2, 1.2), (1.3, -3.0), 3.0, 6.0, 40, (1,)),
    ("levator_alaeque_nasi", (0.9, 1.9), (0.7, -2.4), 3.0, 5.6, 40, (1,)),
    ("nasalis", (2.0, -0.6), (0.6, 0.8), 1.4, 3.4, 45, (1,)),
    ("levator_anguli_oris", (2.6, 0.2), (2.4, -4.0), 3.0, 5.4, 38, (0, 1)),
    ("risorius", (5.9, -3.8), (2.6, -4.4), 2.8, 5.6, 38, (0, 1)),
    ("platysma", (4.8, -7.8), (2.6, -4.8), 2.8, 5.4, 40, (0,)),
    ("depressor_anguli_oris", (3.2, -8.6), (2.5, -4.6), 3.0, 5.6, 42, (0, 1)),
    ("depressor_labii_inferioris", (1.6, -9.2), (1.0, -5.4), 3.0, 5.8, 42, (0,)),
    ("mentalis", (0.9, -9.4), (0.7, -6.6), 2.2, 5.0, 45, (0,)),
    ("frontalis_medialis", (1.2, 9.2), (1.0, 4.0), 3.6, 6.8, 38, (4,)),
    ("frontalis_intermedius", (2.8, 8.8), (2.7, 4.2), 3.6, 6.8, 38, (4,)),
    ("frontalis_lateralis", (4.4, 8.0), (4.4, 3.8), 3.4, 6.2, 38, (4,)),
    ("corrugator_supercilii", (0.3, 2.9), (3.2, 4.4), 2.6, 5.2, 45, (1, 4)),
    ("depressor_supercilii", (0.6, 1.6), (1.2, 4.2), 2.4, 5.0, 40, (1, 4)),
    ("procerus", (0.2, 0.6), (0.5, 4.4), 3.0, 5.6, 35, (1, 4)),
    ("orbicularis_oculi_medialis", (1.4, 2.4), (2.4, -0.6), 2.4, 5.0, 45, (1, 2)),
    ("orbicularis_oculi_lateralis", (5.0, 2.4), (4.0, -0.6), 2.4, 5.0, 45, (1, 2)),
]


@dataclass(frozen=True)
class Regions:
    """The region of each vertex."""

    region_of: Bytes


@dataclass(frozen=True)
class Rig:
    """What the deformer needs of a face model."""

    vertices: Floats
    triangles: Indices
    muscles: MuscleSet
    regions: Regions


def make_rig(columns: int = 40, rows: int = 62, falloff: Falloff = "smooth", elasticity: float = 0.012) -> Rig:
    """A rig of ``columns x rows`` vertices, symmetric when ``columns`` is even; ``elasticity`` in metres."""
    across, up = np.meshgrid(np.linspace(-1.25, 1.25, columns), np.linspace(-1.2, 1.2, rows))
    x, y = 7.5 * np.sin(across) * np.cos(up), 11 * np.sin(up)
    z = 8.5 * np.cos(across) * np.cos(up) + 2.0 * np.exp(-(x**2 / 1.2 + (y + 0.5) ** 2 / 3.5))
    points = np.stack([x, y, z], axis=-1).reshape(-1, 3)
    regions = _regions(points)
    reach, rows_ = [], []
    for _, origin, insertion, start, finish, zone, sides in _HALF:
        for side in (1, -1):
            bone, skin = _below(points, side, origin, 0.25), _below(points, side, insertion, 0.0)
            own = [region if side > 0 else region + 5 for region in sides]
            reach.append(_soften(np.isin(regions, own).reshape(rows, columns)))
            rows_.append((*bone, *skin, math.radians(zone), start, finish))
    table = np.array(rows_)
    muscles = MuscleSet(
        names=[f"{row[0]}_{side}" for row in _HALF for side in "lr"],
        origin=table[:, 0:3] / 100,
        insertion=table[:, 3:6] / 100,
        zone=table[:, 6],
        fall_start=table[:, 7] / 100,
        fall_finish=table[:, 8] / 100,
        elasticity=np.full(len(table), elasticity),
        reach=np.array(reach, dtype=np.float32),
        falloff=falloff,
    )
    vertices = np.ascontiguousarray(points / 100, dtype=np.float32)
    return Rig(vertices, _grid(columns, rows), muscles, Regions(regions))


def _regions(points: np.ndarray) -> Bytes:
    x, y = np.abs(points[:, 0]), points[:, 1]
    region = np.full(len(points), 10, dtype=np.uint8)
    face = x < 6.6
    side = np.where(points[:, 0] > 0, 0, 5)
    eye = np.hypot((x - 3) / 1.6, (y - 2.4) / 0.9) < 1
    for number, inside in enumerate(
        [(y < -4.5) & (y > -9.9), (y >= -4.5) & (y < 2.0), eye & (y < 2.4), eye & (y >= 2.4), (y >= 2.0) & (y < 9.8)]
    ):
        fresh = inside & face & ~(eye & (number == 4))
        region[fresh] = number + side[fresh]
    return region


def _below(points: np.ndarray, side: int, place: tuple[float, float], depth: float) -> np.ndarray:
    gap = (points[:, 0] - side * place[0]) ** 2 + (points[:, 1] - place[1]) ** 2
    nearest = points[np.argmin(gap)]
    return nearest * (1 - depth / np.linalg.norm(nearest))


def _soften(mask: np.ndarray) -> np.ndarray:
    """The mask with a border two vertices wide, as a flat array of weights."""
    weight = mask.astype(float)
    for _ in range(2):
        wide = np.pad(weight, 1, mode="edge")
        weight = (wide[:-2, 1:-1] + wide[2:, 1:-1] + wide[1:-1, :-2] + wide[1:-1, 2:] + 4 * weight) / 8
    return weight.ravel()


def _grid(columns: int, rows: int) -> Indices:
    index = np.arange(columns * rows, dtype=np.int32).reshape(rows, columns)
    a, b, c, d = index[:-1, :-1], index[:-1, 1:], index[1:, :-1], index[1:, 1:]
    quads = [np.stack([a, b, d], axis=-1), np.stack([a, d, c], axis=-1)]
    return np.ascontiguousarray(np.concatenate(quads, axis=0).reshape(-1, 3))
