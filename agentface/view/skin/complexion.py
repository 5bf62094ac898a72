"""What of the skin is static: tints, shade in its folds, softened normals; placed by landmarks to fit any face."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from agentface.conventions import Doubles, Floats, Indices
from agentface.head.landmarks import Landmarks
from agentface.head.model import HeadModel
from agentface.head.ring_names import LidRing, LipRing
from agentface.mesh.evening import evened
from agentface.mesh.smoothstep import smoothstep
from agentface.view.skin.ears import ear_light


class _Spot(NamedTuple):
    """A soft ellipsoid on either side of the face: exp(-d^2), d the distance as a part of its ``widths``.

    ``at``: its middle, as shares of left landmarks, and ``up`` from there; lengths in eye separations.
    """

    strength: float
    at: dict[str, float]
    up: float
    widths: tuple[float, float, float]

    def field(self, model: HeadModel) -> Doubles:
        """``(V,)``."""
        unit = model.landmarks.eye_separation
        middle = sum((share * model.landmarks[name] for name, share in self.at.items()), np.zeros(3))
        away = (_folded(model) - middle - [0.0, self.up * unit, 0.0]) / (unit * np.array(self.widths))
        return np.asarray(self.strength * np.exp(-(away**2).sum(1)))


_RED = (
    _Spot(0.60, {"cheekbone_l": 0.45, "infraorbital_l": 0.35, "alare_l": 0.20}, -0.10, (0.42, 0.32, 0.6)),
    _Spot(0.75, {"nose_tip": 1.0}, 0.0, (0.24, 0.22, 0.4)),
    _Spot(0.45, {"alare_l": 1.0}, 0.0, (0.16, 0.16, 0.3)),
    _Spot(0.35, {"pogonion": 1.0}, 0.0, (0.32, 0.22, 0.4)),
    _Spot(0.25, {"mouth_corner_l": 1.0}, 0.0, (0.22, 0.20, 0.4)),
    _Spot(0.20, {"pupil_l": 1.0}, -0.16, (0.34, 0.10, 0.4)),
)
_RED_EARS = 0.5
_SOCKET = (
    _Spot(0.55, {"pupil_l": 1.0}, 0.08, (0.42, 0.30, 0.4)),
    _Spot(0.40, {"pupil_l": 1.0}, -0.24, (0.30, 0.10, 0.4)),
)
_GLOSS = (
    _Spot(0.50, {"brow_inner_l": 0.5, "glabella": 0.5}, 0.35, (0.50, 0.40, 0.8)),
    _Spot(0.90, {"nasion": 0.5, "nose_tip": 0.5}, 0.0, (0.12, 0.50, 0.6)),
)
_CORNER = _Spot(1.0, {"mouth_corner_l": 1.0}, 0.0, (0.085, 0.075, 0.25))
_CORNER_LIGHT, _CORNER_EVENED, _CORNER_FADE = 0.38, 0.95, 0.65
"""How much light the pockets at the corners of the mouth get, how far it is the same all over them, and how much of the
lips' red they lack."""
_CREASE_SHADE = 0.65
"""How much light the bottom of the fold above the upper lid lacks, which the mesh has no room for."""
_CREASES = {
    LidRing.CREASE - 2: 0.3,
    LidRing.CREASE - 1: 0.7,
    LidRing.CREASE: 1.0,
    LidRing.CREASE + 1: 0.7,
    LidRing.FOLD: 0.3,
}
_CREASE_ENDS = 0.6  # exponent: how soon the crease is deep, from the corners of the eye on
_DARKER, _STEEPER = 0.25, 1.5
"""Shade s becomes s (0.25 + 1.5 s): the darkest places, nostrils above all, are seen as holes."""
_LIP_MEETS_M = 0.0012
"""Above and below where the lips touch, over which the one's colour goes over into the other's."""
_BEARD_ACROSS = (0.0, 0.25, 0.45, 0.75, 1.1)
_BEARD_TOP = (("subnasale", -0.02), ("subnasale", -0.06), ("mouth_corner_l", -0.02), ("mouth_corner_l", 0.05),
              ("mouth_corner_l", 0.5))  # fmt: skip
"""The upper border of a beard: eye separations from the median plane, and above which landmark it lies there."""
_BEARD_BELOW, _BEARD_BEHIND = (-0.5, -0.1), (-0.1, 0.4)
"""Eye separations above the chin's underside, and before the ears, between which a beard grows dense."""
_BEARD_EDGE = 0.16


def complexion(model: HeadModel, covered: Floats, stubble: float = 0.0) -> Floats:
    """``(V, 4)`` 0..1: redness (below 0: a shaved beard), darker skin, gloss, and ``covered (V,)`` by hair.

    Darker are the eye sockets and, of the lips, the upper one.
    """
    red, dark, gloss = (sum(spot.field(model) for spot in spots) for spots in (_RED, _SOCKET, _GLOSS))
    dark = np.maximum(dark, _upper_lip(model))
    beard = stubble * _beard(model)
    red = (red + _RED_EARS * model.material[:, 3]) * (1.0 - beard) - beard
    bare = covered * (1.0 - model.material[:, 1])  # long hair hangs round the mouth's lining, not on it
    tints = np.stack([red, dark, gloss, bare], axis=1)
    return np.asarray(np.clip(tints, [-1, 0, 0, 0], 1), np.float32)


def folds(model: HeadModel) -> Floats:
    """``(V, 1)`` 0..1: of the surroundings' light what reaches the skin at rest, in its folds and pockets too."""
    shade = model.shade[:, 0]
    light = shade * np.clip(_DARKER + _STEEPER * shade, 0.0, 1.0)
    light = light + _CORNER_EVENED * _CORNER.field(model) * (_CORNER_LIGHT - light)
    light = light * (1.0 - _CREASE_SHADE * _lid_creases(model)) * ear_light(model)
    return light[:, None].astype(np.float32)


def softened_corners(model: HeadModel) -> Floats:
    """``(V, 4)``: the model's material, with lips that run out into the skin at the corners of the mouth."""
    material = np.array(model.material, np.float32)
    material[:, 0] *= 1.0 - _CORNER_FADE * _CORNER.field(model)
    return material


def blurred(normals: Floats, triangles: Indices, times: int) -> Floats:
    """``(V, 3)`` normals averaged with their neighbours ``times`` over: light that scattered in the skin."""
    field = normals.astype(np.float64)
    for _ in range(times):
        field = evened(field, triangles, 1)
        field /= np.maximum(np.linalg.norm(field, axis=1, keepdims=True), 1e-9)
    return field.astype(np.float32)


def _folded(model: HeadModel) -> Doubles:
    """``(V, 3)`` m: the vertices, those of the right half mirrored to the left."""
    return np.column_stack([np.abs(model.vertices[:, 0]), model.vertices[:, 1:]]).astype(np.float64)


def _lid_creases(model: HeadModel) -> Doubles:
    """``(V,)`` 0..1: the fold over the upper lids."""
    crease = np.zeros(len(model.vertices))
    for rings in model.eyelids.rings.values():
        for number, depth in _CREASES.items():
            half = np.array(rings[number].upper)
            crease[half] = depth * np.sin(np.linspace(0.0, np.pi, len(half))).clip(0.0) ** _CREASE_ENDS
    return crease


def _upper_lip(model: HeadModel) -> Doubles:
    """``(V,)`` 0..1: the red of the upper lip."""
    touching = model.vertices[np.array(model.lips.rings[LipRing.CONTACT].upper)]
    touching = touching[touching[:, 0].argsort()]
    x, y = model.vertices[:, 0], model.vertices[:, 1]
    above = y - np.interp(x, touching[:, 0], touching[:, 1])
    return np.asarray(smoothstep(-_LIP_MEETS_M, _LIP_MEETS_M, above) * np.clip(3.0 * model.material[:, 0], 0.0, 1.0))


def _beard(model: HeadModel) -> Doubles:
    """``(V,)`` 0..1: where a beard grows: chin, jaw and upper lip, not on the lips."""
    at: Landmarks = model.landmarks
    x, y, z = (_folded(model) / at.eye_separation).T
    top = [float(at[name][1]) / at.eye_separation + up for name, up in _BEARD_TOP]
    grown = np.clip((np.interp(x, _BEARD_ACROSS, top) - y) / _BEARD_EDGE, 0.0, 1.0)
    grown *= smoothstep(*_BEARD_BELOW, y - float(at["menton"][1]) / at.eye_separation) * smoothstep(*_BEARD_BEHIND, z)
    return np.asarray(grown * (1.0 - np.clip(1.5 * model.material[:, 0], 0.0, 1.0)))
