"""Puts a head together: one person's arrays and tables on the shared topology."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from agentface.conventions import SIDES, Doubles
from agentface.head.asymmetry import SHAPE
from agentface.head.build import mouth_parts
from agentface.head.build.fold import fold_lids
from agentface.head.build.head_topology import HeadTopology
from agentface.head.build.identity import Recipe, asymmetry, close_lips, person
from agentface.head.build.jaw import JawShares, jaw_shares
from agentface.head.build.relax import relaxed
from agentface.head.build.source import BaseMesh
from agentface.head.ring_names import LidRing
from agentface.mesh.evening import evened
from agentface.mesh.glb import MeshArrays, Shape
from agentface.mesh.smoothstep import falloff

_SMALLEST_OFFSET = 5e-6
METRES = 0.1
_EVENINGS = 20
"""How often the asymmetry is evened out: lids, lips and teeth go along without being bent."""
_EYE_WHOLE, _EYE_ENDS = 1.5, 2.6
"""Radii from an eye's centre within which all goes along with it, and beyond which nothing does."""


@dataclass(frozen=True, slots=True)
class Head:
    """One person's head on the shared topology, in metres: meshes for ``head.glb`` and what the tables need."""

    meshes: dict[str, MeshArrays]
    eye_centre: Doubles
    eye_radius: float
    origin: Doubles


def build_head(topology: HeadTopology, recipe: Recipe, jaw_table: JawShares) -> Head:
    """The head of the person that ``recipe`` describes."""
    mesh, skin = topology.mesh, topology.skin
    base = close_lips(person(mesh, recipe), skin, topology.loops, mesh.positions)
    eye = base[np.unique(mesh.quads["helper-l-eye"])]
    radius = 0.5 * (eye[:, 0].max() - eye[:, 0].min())
    centre = np.array(
        [0.5 * (eye[:, 0].max() + eye[:, 0].min()), 0.5 * (eye[:, 1].max() + eye[:, 1].min()), eye[:, 2].min() + radius]
    )
    points = relaxed(topology, fold_lids(topology, skin.place(base), recipe.lid_fold, centre))
    ear = points[topology.landmarks["ear_front_l"]["vertices"]][0]
    origin = np.array([0.0, centre[1], ear[2]])
    shapes = {name: skin.place(mesh.face_unit(name)) for name in mesh.face_units()}
    uneven = _rigid_eyes(topology, evened(skin.place(asymmetry(mesh, recipe)), skin.triangles, _EVENINGS), points)
    guide = _artists_jaw(points - origin, shapes["jawOpen"], *hinge(base, mesh, origin))
    jaw = jaw_shares(topology, points, guide, jaw_table, unit=2.0 * centre[0])
    meshes = {
        "skin": MeshArrays(
            skin.triangles,
            {
                "POSITION": _metres(points - origin),
                "_MATERIAL": _bytes(topology.material),
                "_SHADE": _bytes(np.tile([1.0, 0, 0, 0], (len(skin.kept), 1))),
                "_JAW": jaw.astype(np.float32),
                "_MIRROR": skin.mirror.astype(np.float32),
            },
            {name: _sparse(offsets) for name, offsets in {**shapes, SHAPE: uneven}.items()},
        )
    }
    strips = [
        base[np.unique(mesh.quads[f"helper-{row}-teeth"])] * [recipe.teeth.width, 1.0, 1.0]
        - [0.0, 0.0, 0.01 * recipe.teeth.back_mm]
        for row in ("upper", "lower")
    ]
    parts = {
        "teeth_upper": mouth_parts.dental_arch(strips[0], upper=True),
        "teeth_lower": mouth_parts.dental_arch(strips[1], upper=False),
        "tongue": mouth_parts.tongue(base, mesh.quads["helper-tongue"]),
        "eye_l": mouth_parts.eyeball(centre, 0.995 * radius),
        "eye_r": mouth_parts.eyeball(centre * [-1, 1, 1], 0.995 * radius),
    }
    out = mouth_parts.tongue(base + mesh.face_unit("tongueOut"), mesh.quads["helper-tongue"]).positions
    tongue_out = {"tongueOut": _sparse(out - parts["tongue"].positions)}
    for name, part in parts.items():
        attributes: dict[str, np.typing.NDArray[Any]]
        attributes = {"POSITION": _metres(part.positions - origin), "_MATERIAL": _bytes(part.material)}
        meshes[name] = MeshArrays(part.triangles, attributes, tongue_out if name == "tongue" else {})
    meshes["lashes"] = _lashes(base - origin, mesh)
    return Head(meshes, METRES * (centre - origin), float(METRES * radius), origin)


def _rigid_eyes(topology: HeadTopology, offsets: Doubles, points: Doubles) -> Doubles:
    """Offsets ``(V, 3)`` that move the surroundings of an eye as one, so that its lids still close."""
    result = offsets.copy()
    for side in SIDES:
        upper, lower = topology.lid_rings(side)[LidRing.INNER_MARGIN]
        margin = upper + lower[1:-1]
        centre, move = points[margin].mean(0), offsets[margin].mean(0)
        radius = 0.5 * np.ptp(points[margin, 0])
        near = falloff(np.linalg.norm(points - centre, axis=1) / radius, _EYE_WHOLE, _EYE_ENDS)
        result += near[:, None] * (move - result)
    return result


def _lashes(base: Doubles, mesh: BaseMesh) -> MeshArrays:
    """The base mesh's lash cards of both eyes."""
    quads = np.concatenate([rows for name, rows in mesh.quads.items() if "eyelashes" in name])
    used, inverse = np.unique(quads, return_inverse=True)
    local = inverse.reshape(-1, 4)
    triangles = np.concatenate([local[:, [0, 1, 2]], local[:, [0, 2, 3]]]).astype(np.int32)
    return MeshArrays(triangles, {"POSITION": _metres(base[used])})


def hinge(base: Doubles, mesh: BaseMesh, origin: Doubles) -> tuple[Doubles, float]:
    """The jaw's axis (a point of it) and the angle in radians of the shape jawOpen, fitted to the lower teeth."""
    teeth = np.unique(mesh.quads["helper-lower-teeth"])
    before = (base[teeth] - origin)[:, 1:]
    after = before + mesh.face_unit("jawOpen")[teeth][:, 1:]
    u, _, vt = np.linalg.svd((before - before.mean(0)).T @ (after - after.mean(0)))
    turn = (u @ np.diag([1.0, np.sign(np.linalg.det(u @ vt))]) @ vt).T
    move = after.mean(0) - turn @ before.mean(0)
    pivot = np.linalg.solve(np.eye(2) - turn, move)
    return np.array([0.0, *pivot]), float(np.arctan2(turn[1, 0], turn[0, 0]))


def _artists_jaw(points: Doubles, opened: Doubles, pivot: Doubles, angle: float) -> Doubles:
    """How far each skin vertex follows the jaw, 0..1, in the artists' jawOpen: its part along the rigid rotation."""
    arm = points - pivot
    turned = arm.copy()
    turned[:, 1] = np.cos(angle) * arm[:, 1] - np.sin(angle) * arm[:, 2]
    turned[:, 2] = np.sin(angle) * arm[:, 1] + np.cos(angle) * arm[:, 2]
    move = turned - arm
    return np.clip((opened * move).sum(1) / np.maximum((move**2).sum(1), 1e-4), 0, 1)


def _metres(positions: Doubles) -> np.typing.NDArray[np.float32]:
    return (METRES * positions).astype(np.float32)


def _bytes(weights: Doubles) -> np.typing.NDArray[np.uint8]:
    return np.round(255 * np.clip(weights, 0, 1)).astype(np.uint8)


def _sparse(offsets: Doubles) -> Shape:
    metres = (METRES * offsets).astype(np.float32)
    moved = np.flatnonzero(np.abs(metres).max(1) > _SMALLEST_OFFSET)
    moved = moved if len(moved) else np.array([0])  # a sparse accessor needs one entry
    return Shape(moved.astype(np.int32), metres[moved])
