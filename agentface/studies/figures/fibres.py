"""The muscles of the tissue as a picture shows them: bellies of fibres on the bone, from origin to insertion."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from agentface.conventions import SIDES, Doubles, Indices
from agentface.head.model import HeadModel
from agentface.head.muscles import anchor_point
from agentface.mesh.smoothstep import smoothstep
from agentface.tissue.lattice import Lattice
from agentface.tissue.layers import HYPODERMIS
from agentface.tissue.tissue_file import NAMES, UNPAIRED, LinearRow, SheetRow, SphincterRow, TissueFile

COLOURS = {
    "linear": np.array([176.0, 50.0, 44.0]),
    "sheet": np.array([196.0, 92.0, 58.0]),
    "sphincter": np.array([158.0, 54.0, 84.0]),
}
"""Of the kinds of muscle."""
_TENDON = np.array([236.0, 216.0, 196.0])
_FIBRES = {"linear": 5, "sheet": 9, "sphincter": 6}
_STRIPES, _RIDGE = 0.16, 0.00022
"""How much lighter and darker fibres are, and how far they stand out, m."""
_ALONG, _AROUND, _SECTION = 33, 72, 64
"""Points along a strand or a ring's width, round a ring, and round the section of a belly."""
_OVER, _UNDER = 0.0008, 0.0005
"""m over the bone, the least, and under the hypodermis, where a muscle ends."""
_INNER, _OUTER, _MOUTH_OUTER = 0.55, 0.95, 0.80
"""Where the fibres of a ring are: of its crest, and of its rim; round the mouth of a smaller one."""


class Belly(NamedTuple):
    """One muscle as a closed surface: ``points (N, 3)`` m, ``triangles``, ``colours (N, 3)``."""

    points: Doubles
    triangles: Indices
    colours: Doubles


class Bed(NamedTuple):
    """A surface that muscles lie on: ``points (V, 3)`` m with unit ``normals``."""

    points: Doubles
    normals: Doubles

    def heights(self, places: Doubles) -> tuple[Doubles, Doubles]:
        """How far ``places (N, 3)`` are over the surface, m, and the normals ``(N, 3)`` of it there."""
        from scipy.spatial import cKDTree

        away, near = cKDTree(self.points).query(places, 8)
        weights = 1.0 / (away + 5e-4) ** 2
        weights /= weights.sum(axis=1, keepdims=True)
        normals = (weights[..., None] * self.normals[near]).sum(axis=1)
        normals /= np.linalg.norm(normals, axis=1, keepdims=True)
        under = (weights[..., None] * self.points[near]).sum(axis=1)
        return ((places - under) * normals).sum(axis=1), normals

    def over(self, places: Doubles, least: float) -> Doubles:
        """``places (N, 3)`` raised to at least ``least`` m over the surface."""
        height, normals = self.heights(places)
        return np.asarray(places + np.maximum(least - height, 0.0)[:, None] * normals)

    def onto(self, places: Doubles, height: float) -> Doubles:
        """``places (N, 3)`` moved to ``height`` m over the surface."""
        now, normals = self.heights(places)
        return np.asarray(places + (height - now)[:, None] * normals)

    def front(self, places: Doubles) -> Doubles:
        """``(N,)`` m: how far forward the surface is at ``places (N, 2)``, seen from the front."""
        from scipy.spatial import cKDTree

        front = self.points[(self.normals[:, 2] > 0.02) & (self.points[:, 2] > 0.0)]
        away, near = cKDTree(front[:, :2]).query(places, 9)
        weights = 1.0 / (away + 1.5e-3)
        # the plane through the nearest points: their mean would lie before a steep slope
        columns = np.concatenate([np.ones((*near.shape, 1)), front[near][..., :2] - places[:, None]], axis=2)
        columns *= weights[..., None]
        grams = columns.swapaxes(1, 2) @ columns + 1e-6 * np.eye(3)
        plane = np.linalg.solve(grams, columns.swapaxes(1, 2) @ (weights * front[near, 2])[..., None])[:, 0, 0]
        return np.asarray(np.clip(plane, front[near, 2].min(axis=1) - 0.004, front[near, 2].max(axis=1) + 0.002))


def bellies(model: HeadModel, lattice: Lattice, file: TissueFile, bone: Bed) -> dict[str, Belly]:
    """The 23 muscles of ``file`` by name, between the ``bone`` and the hypodermis."""
    outside = ~(model.material[:, 1:3] > [0.02, 0.5]).any(axis=1)
    skin = Bed(1e-3 * lattice.rest[HYPODERMIS][outside], lattice.normals[outside])
    return {name: _belly(model, file, name, bone, skin) for name in NAMES}


def _belly(model: HeadModel, file: TissueFile, name: str, bone: Bed, skin: Bed) -> Belly:
    base, side = (name, SIDES[0]) if name == UNPAIRED else (name[:-2], name[-1])
    row, unit = file.muscles[base], float(model.landmarks.eye_separation)
    if isinstance(row, SphincterRow):
        eye = None if name == UNPAIRED else (model.eye_centre(side).astype(np.float64), model.eyes.radius)
        return _ring(row, anchor_point(row.centre, side, model.landmarks), unit, (bone, skin), eye)
    origin = bone.onto(anchor_point(row.origin, side, model.landmarks)[None], _OVER)[0]
    insertion = skin.onto(anchor_point(row.insertion, side, model.landmarks)[None], -_UNDER)[0]
    return _strand(row, origin, insertion, unit, bone)


def _strand(row: LinearRow | SheetRow, origin: Doubles, insertion: Doubles, unit: float, bone: Bed) -> Belly:
    """A spindle, or of a sheet a broad band, straight but where the bone is in its way."""
    part, flat = np.linspace(0.0, 1.0, _ALONG), isinstance(row, SheetRow)
    axis = bone.over(origin + part[:, None] * (insertion - origin), _OVER)
    axis[1:-1] = 0.25 * axis[:-2] + 0.5 * axis[1:-1] + 0.25 * axis[2:]
    along = np.gradient(axis, axis=0)
    across = np.cross(bone.heights(axis)[1], along)
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    up = np.cross(along, across)
    up /= np.linalg.norm(up, axis=1, keepdims=True)
    if isinstance(row, SheetRow):
        width, thick = unit * row.half_width * (0.9 + 0.1 * part), np.full(_ALONG, 0.0014)
    else:
        length = float(np.linalg.norm(insertion - origin))
        swell = np.sin(np.pi * np.clip(part, 0.02, 0.98) ** 1.1) ** 0.7
        width, thick = 0.0012 + (0.055 * length + 0.0015) * swell, 0.0006 + 0.0014 * swell
    angle = np.linspace(0.0, 2.0 * np.pi, _SECTION, endpoint=False)
    grain, rise = np.cos(2.0 * np.pi * _FIBRES[row.kind] * np.cos(angle)), np.sin(angle)
    points = axis[:, None] + (width[:, None] * np.cos(angle))[..., None] * across[:, None]
    if flat:
        points = bone.onto(points.reshape(-1, 3), 0.0025).reshape(points.shape)
    points += (thick[:, None] * rise + _RIDGE * grain * (rise > 0.0))[..., None] * up[:, None]
    tendon = np.clip(1.0 - part / (0.3 if flat else 0.2), 0.0, 1.0) + np.clip((part - 0.92) / 0.08, 0.0, 1.0)
    striped = COLOURS[row.kind] * (1.0 + _STRIPES * grain[:, None])
    return _closed(points, striped + 0.85 * tendon[:, None, None] * (_TENDON - striped), turns=False)


def _ring(
    row: SphincterRow, centre: Doubles, unit: float, beds: tuple[Bed, Bed], eye: tuple[Doubles, float] | None
) -> Belly:
    """A flat ring of fibres, from inside its crest to near its rim, rising inwards from bone to hypodermis."""
    turn = np.linspace(0.0, 2.0 * np.pi, _AROUND, endpoint=False)[:, None]
    section = np.linspace(0.0, 2.0 * np.pi, _SECTION, endpoint=False)
    inner, outer = _INNER * row.crest, _MOUTH_OUTER if eye is None else _OUTER
    part = 0.5 * (inner + outer) - 0.5 * (outer - inner) * np.cos(section)
    wide, high = (unit * radius for radius in row.radii)
    x, y = centre[0] + wide * part * np.cos(turn), centre[1] + high * part * np.sin(turn)
    places = np.stack([x, y], axis=-1).reshape(-1, 2)
    share = np.tile(smoothstep(inner, outer, part), _AROUND)
    bone, skin = (bed.front(places) for bed in beds)
    depth = (1.0 - share) * skin + share * np.minimum(bone + 0.002, skin)
    if eye is not None:  # the lids' part of it lies before the eyeball
        (middle_x, middle_y, middle_z), radius = eye
        aside = (places[:, 0] - middle_x) ** 2 + (places[:, 1] - middle_y) ** 2
        depth = np.maximum(depth, middle_z + np.sqrt(np.maximum((radius + 0.001) ** 2 - aside, 0.0)))
    grain, rise = np.cos(2.0 * np.pi * _FIBRES[row.kind] * np.cos(section)), np.sin(section)
    z = depth.reshape(x.shape) - _UNDER + 0.0012 * rise + _RIDGE * grain * (rise > 0.0)
    striped = COLOURS[row.kind] * (1.0 + _STRIPES * grain[:, None])
    return _closed(np.stack([x, y, z], axis=-1), np.broadcast_to(striped, (*x.shape, 3)), turns=True)


def _closed(points: Doubles, colours: Doubles, *, turns: bool) -> Belly:
    """The surface round sections ``points (A, B, 3)`` in a row; if it ``turns``, the first follows the last."""
    count, around = points.shape[:2]
    row, column = np.meshgrid(np.arange(count if turns else count - 1), np.arange(around), indexing="ij")
    after, beside = (row + 1) % count, (column + 1) % around
    a, b, c, d = (i * around + j for i, j in ((row, column), (row, beside), (after, column), (after, beside)))
    triangles = np.stack([a, b, d, a, d, c], axis=-1).reshape(-1, 3).astype(np.int32)
    return Belly(points.reshape(-1, 3), triangles, colours.reshape(-1, 3))
