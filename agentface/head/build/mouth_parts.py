"""Single teeth with gums along the base mesh's dental arches, the tongue, and the eyeballs."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from agentface.conventions import Doubles, Indices
from agentface.head.build.subdivide import catmull_clark

# Mean mesiodistal widths and crown heights in millimetres, from the middle outward (Wheeler's dental anatomy), and how
# far the middle of the edge stands out over its sides: canines are pointed.
_UPPER = ((8.5, 10.5, 0.3), (6.5, 9.0, 0.4), (7.5, 10.0, 1.6), (7.0, 8.5, 1.1), (7.0, 8.5, 0.8), (9.5, 7.5, 0.4),
          (9.0, 7.0, 0.4))  # fmt: skip
_LOWER = ((5.2, 9.0, 0.15), (5.6, 9.2, 0.2), (6.8, 10.0, 1.2), (7.0, 8.5, 0.9), (7.1, 8.0, 0.6), (10.0, 7.5, 0.4),
          (9.5, 7.0, 0.4))  # fmt: skip
_SMALLER = (0.90, 1.02, 0.9)
"""Parts of these: the base mesh's heads are smaller than Wheeler's patients, and bare more of their teeth."""
# The base mesh's strips are wider than an arch of single teeth, and its lower strip reaches high behind the upper one:
# the rows meet edge to edge, 3.5 mm below where the lips touch, so that a parted mouth shows the upper teeth.
_ARCH_WIDTH, _SHOW_UPPER, _SINK_LOWER = 0.86, 0.036, 0.082
_ACROSS = np.array([-1.0, -0.86, -0.5, 0.0, 0.5, 0.86, 1.0])
# a crown from the gum behind it over its edge to the gum before it: where, how wide, how far forward, both as parts
_ROWS = (
    (1.0, 0.76, -2.6),
    (0.40, 0.86, -2.2),
    (0.03, 0.86, -1.4),
    (0.0, 0.90, 0.35),
    (0.10, 1.01, 0.75),
    (0.42, 1.05, 1.0),
    (1.0, 0.97, 0.75),
)
_TONGUE_FLAT, _TONGUE_BACK = 0.72, 0.03
"""At rest it lies low behind the lower teeth."""


@dataclass(frozen=True, slots=True)
class PartMesh:
    """Positions ``(P, 3)`` in decimetres, triangles, and material weights ``(P, 4)``: tooth, gum, tongue, eye."""

    positions: Doubles
    triangles: Indices
    material: Doubles


def dental_arch(strip: Doubles, *, upper: bool) -> PartMesh:
    """Fourteen teeth and their gum, fitted to the vertices ``strip (S, 3)`` of the base mesh's row of teeth."""
    half_width = np.abs(strip[:, 0]).max() * _ARCH_WIDTH
    back, front = strip[:, 2].min(), strip[:, 2].max() - 0.02
    depth = front - back
    turn = np.linspace(0.0, 0.5 * np.pi, 400)
    arch = np.stack([half_width * np.sin(turn), back + depth * np.cos(turn) ** 0.8], 1)
    length = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(arch, axis=0), axis=1))])
    edge = strip[:, 1].min() - _SHOW_UPPER if upper else strip[:, 1].max() - _SINK_LOWER
    table = np.array(_UPPER if upper else _LOWER) / 100.0 * _SMALLER
    table[:, 0] *= min(1.0, length[-1] * 0.98 / table[:, 0].sum())
    out = 1.0 if upper else -1.0
    crowns, start = [], 0.0
    for width, height, point in table:
        middle = start + 0.5 * width
        start += width
        at = np.array([np.interp(middle, length, arch[:, 0]), edge, np.interp(middle, length, arch[:, 1])])
        ahead = (
            np.interp(middle + 0.01, length, arch[:, 0]) - at[0],
            np.interp(middle + 0.01, length, arch[:, 1]) - at[2],
        )
        across = np.array([ahead[0], 0.0, ahead[1]]) / np.hypot(*ahead)
        for side in (1.0, -1.0):
            flip = np.array([side, 1.0, 1.0])
            crowns.append(_crown(at * flip, across * flip, (width, height, point), out))
    crowns.append(_gum(arch, edge, out))
    return _joined(crowns)


def _crown(at: Doubles, across: Doubles, size: tuple[float, float, float], out: float) -> PartMesh:
    """A tooth down to its gum, open below it."""
    width, height, point = size
    outward = np.cross(across, [0.0, 1.0, 0.0])
    outward *= np.sign(outward[2] + 1e-9 + 0.3 * outward[0] * np.sign(at[0]))
    thick = 0.022 + 0.25 * max(0.0, width - 0.07)
    rows = []
    for up, wide, forward in _ROWS:
        round_off = np.abs(_ACROSS)
        front = forward * thick - (0.5 * thick + 0.12 * width) * round_off**3
        edge = (point * round_off + 0.075 * width * round_off**4) * (1.0 - up) ** 3
        rows.append(
            at
            + np.outer(0.5 * width * wide * _ACROSS, across)
            + np.outer(front, outward)
            + np.outer(out * (height * up + edge), [0.0, 1.0, 0.0])
        )
    positions = np.concatenate(rows)
    faces = np.array(_tube(len(_ACROSS), len(rows), closed=False), np.int32)
    front = faces[-2 * (len(_ACROSS) - 1) :]
    a, b, c = (positions[front[:, i]] for i in range(3))
    inward = (np.cross(b - a, c - a) @ outward).sum() < 0
    faces = faces[:, ::-1] if inward else faces
    return PartMesh(positions, faces, np.tile([1.0, 0, 0, 0], (len(positions), 1)))


def _gum(arch: Doubles, edge: float, out: float) -> PartMesh:
    path = np.concatenate([(arch * [-1, 1])[::-20], arch[20::20]])
    along = np.gradient(path, axis=0)
    normal = np.stack([along[:, 1], -along[:, 0]], 1)
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    normal *= np.sign(normal[len(normal) // 2, 1])
    # it comes out of the crowns' sides first, so that its border runs in a bow over each of them
    profile = ((0.0, 0.050), (0.022, 0.086), (0.046, 0.12), (0.036, 0.19), (-0.05, 0.19), (-0.05, 0.10))
    rows = []
    # a smile bares the upper crowns whole; below the lower incisors the chin leaves little room
    short, bared = (1.0, 0.024) if out > 0 else (0.62, 0.0)
    for offset, height in profile:
        flat = path + normal * offset
        rows.append(np.stack([flat[:, 0], np.full(len(flat), edge + out * (short * height + bared)), flat[:, 1]], 1))
    positions = np.concatenate(rows)
    faces = np.array(_tube(len(path), len(profile), closed=False), np.int32)
    faces = faces if out > 0 else faces[:, ::-1]
    return PartMesh(positions, faces, np.tile([0, 1.0, 0, 0], (len(positions), 1)))


def tongue(positions: Doubles, quads: Indices) -> PartMesh:
    """The base mesh's tongue, subdivided once: ``positions (N, 3)`` of the whole base mesh, ``quads`` of the tongue."""
    used, inverse = np.unique(quads, return_inverse=True)
    local = inverse.reshape(-1, 4).astype(np.int32)
    level = catmull_clark(local, len(used))
    placed = np.asarray(level.matrix @ positions[used])
    floor = placed[:, 1].min()
    placed[:, 1] = floor + _TONGUE_FLAT * (placed[:, 1] - floor)
    placed[:, 2] -= _TONGUE_BACK
    triangles = np.concatenate([level.quads[:, [0, 1, 2]], level.quads[:, [0, 2, 3]]])
    return PartMesh(placed, triangles.astype(np.int32), np.tile([0, 0, 1.0, 0], (len(placed), 1)))


def eyeball(centre: Doubles, radius: float) -> PartMesh:
    """A globe with a bulging cornea looking along +Z; vertices in rings round the axis, from the cornea's apex back."""
    around = 24
    polar = np.concatenate([np.linspace(0, 0.62, 8)[1:], np.linspace(0.62, 0.62 * np.pi, 6)[1:]])
    turn = np.linspace(0, 2 * np.pi, around, endpoint=False)
    bulge = 1 + 0.075 * np.clip(1 - np.sin(polar) / 0.47, 0, 1) ** 0.8 * (polar < 1.5)
    ring = np.stack([np.cos(turn), np.sin(turn)], 1)
    rows = [
        np.column_stack([ring * np.sin(p), np.full(around, np.cos(p))]) * b for p, b in zip(polar, bulge, strict=True)
    ]
    positions = np.concatenate([[[0, 0, 1.075]], *rows])
    faces = [[0, 1 + i, 1 + (i + 1) % around] for i in range(around)]
    faces += [[1 + corner for corner in face] for face in _tube(around, len(rows), closed=True)]
    placed = positions * radius + centre
    return PartMesh(placed, _facing_out(placed, np.array(faces, np.int32)), np.tile([0, 0, 0, 1.0], (len(placed), 1)))


def _tube(around: int, rows: int, *, closed: bool) -> list[list[int]]:
    faces = []
    for row in range(rows - 1):
        for i in range(around if closed else around - 1):
            a, b = row * around + i, row * around + (i + 1) % around
            faces += [[a, b, a + around], [b, b + around, a + around]]
    return faces


def _facing_out(positions: Doubles, triangles: Indices) -> Indices:
    middle = positions.mean(0)
    a, b, c = (positions[triangles[:, i]] for i in range(3))
    inward = ((np.cross(b - a, c - a)) * ((a + b + c) / 3 - middle)).sum(1) < 0
    result = triangles.copy()
    result[inward] = triangles[inward][:, ::-1]
    return result


def _joined(parts: list[PartMesh]) -> PartMesh:
    starts = np.cumsum([0, *(len(part.positions) for part in parts)])
    return PartMesh(
        np.concatenate([part.positions for part in parts]),
        np.concatenate([part.triangles + start for part, start in zip(parts, starts, strict=False)]).astype(np.int32),
        np.concatenate([part.material for part in parts]),
    )
