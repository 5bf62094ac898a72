"""Static tints of the skin, placed by landmarks so that they fit any face."""

from __future__ import annotations

import numpy as np

from agentface.anatomy.evening import evened
from agentface.anatomy.model import HeadModel
from agentface.anatomy.ring_names import LidRing
from agentface.conventions import Doubles, Floats, Indices


def complexion(model: HeadModel, covered: Floats, stubble: float = 0.0) -> Floats:
    """``(V, 4)`` 0..1: redness (below 0: a shaved beard), socket, gloss, and ``covered (V,)`` by hair."""
    at = model.landmarks
    unit = at.eye_separation
    up = np.array([0, unit, 0], np.float32)
    mirrored = model.vertices * np.array([1, 1, 1], np.float32)
    mirrored[:, 0] = np.abs(mirrored[:, 0])

    def spot(centre: Doubles | Floats, widths: tuple[float, float, float]) -> Floats:
        away = (mirrored - centre) / (unit * np.array(widths, np.float32))
        return np.asarray(np.exp(-(away**2).sum(1)), np.float32)

    eye = at["pupil_l"]
    cheek = 0.45 * at["cheekbone_l"] + 0.35 * at["infraorbital_l"] + 0.20 * at["alare_l"]
    red = 0.55 * spot(cheek - 0.10 * up, (0.42, 0.32, 0.6))
    red += 0.75 * spot(at["nose_tip"], (0.24, 0.22, 0.4)) + 0.45 * spot(at["alare_l"], (0.16, 0.16, 0.3))
    red += 0.35 * spot(at["pogonion"], (0.32, 0.22, 0.4)) + 0.75 * model.material[:, 3]
    red += 0.25 * spot(at["mouth_corner_l"], (0.22, 0.2, 0.4)) + 0.20 * spot(eye - 0.16 * up, (0.34, 0.10, 0.4))
    red = red * (1.0 - stubble * _beard(model)) - stubble * _beard(model)
    socket = 0.75 * spot(eye + 0.08 * up, (0.42, 0.30, 0.4)) + 0.4 * spot(eye - 0.24 * up, (0.30, 0.10, 0.4))
    brow = 0.5 * (at["brow_inner_l"] + at["glabella"])
    gloss = 0.6 * spot(brow + 0.35 * up, (0.55, 0.4, 0.8)) + 0.9 * spot(
        0.5 * (at["nasion"] + at["nose_tip"]), (0.12, 0.5, 0.6)
    )
    tints = np.stack([red, socket, gloss, covered], axis=1)
    return np.asarray(np.clip(tints, [-1, 0, 0, 0], 1), np.float32)


_CREASES = {
    LidRing.CREASE - 2: 0.3,
    LidRing.CREASE - 1: 0.7,
    LidRing.CREASE: 1.0,
    LidRing.CREASE + 1: 0.7,
    LidRing.FOLD: 0.3,
}


def lid_creases(model: HeadModel) -> Floats:
    """``(V,)`` 0..1: the fold over the upper lids, which the mesh has no room for."""
    crease = np.zeros(len(model.vertices), np.float32)
    for rings in model.eyelids.rings.values():
        for number, depth in _CREASES.items():
            half = np.array(rings[number].upper)
            part = np.linspace(0.0, 1.0, len(half))
            crease[half] = depth * np.sin(np.pi * part) ** 0.6
    return crease


def corner_pockets(model: HeadModel) -> Floats:
    """``(V,)`` 0..1: how near a corner of the mouth each vertex is."""
    corner, unit = model.landmarks["mouth_corner_l"], model.landmarks.eye_separation
    mirrored = model.vertices * np.array([1, 1, 1], np.float32)
    mirrored[:, 0] = np.abs(mirrored[:, 0])
    away = (mirrored - corner) / (unit * np.array([0.085, 0.075, 0.25], np.float32))
    return np.asarray(np.exp(-(away**2).sum(1)), np.float32)


def softened_corners(model: HeadModel) -> Floats:
    """``(V, 4)``: the model's material, with lips that run out into the skin at the corners of the mouth."""
    material = np.array(model.material, np.float32)
    material[:, 0] *= 1.0 - 0.55 * corner_pockets(model)
    return material


def _beard(model: HeadModel) -> Floats:
    """``(V,)`` 0..1: where a beard grows: chin, jaw and upper lip, not on the lips."""
    at, unit = model.landmarks, model.landmarks.eye_separation
    x, y, z = np.abs(model.vertices[:, 0]), model.vertices[:, 1], model.vertices[:, 2]
    corner, nose = at["mouth_corner_l"], at["subnasale"]
    # the border runs from the nose past the corner of the mouth and up to the ear
    border = np.interp(
        x / unit,
        [0.0, 0.25, 0.45, 0.75, 1.1],
        np.array(
            [
                nose[1] - 0.02 * unit,
                nose[1] - 0.06 * unit,
                corner[1] - 0.02 * unit,
                corner[1] + 0.05 * unit,
                corner[1] + 0.5 * unit,
            ]
        ),
    )
    above = (border - y) / (0.16 * unit)
    below = (y - float(at["menton"][1]) + 0.5 * unit) / (0.4 * unit)
    grown = np.clip(above, 0, 1) * np.clip(below, 0, 1) * np.clip((z + 0.1 * unit) / (0.5 * unit), 0, 1)
    return np.asarray(grown * (1 - np.clip(1.5 * model.material[:, 0], 0, 1)), np.float32)


def blurred(normals: Floats, triangles: Indices, times: int) -> Floats:
    """``(V, 3)`` normals averaged with their neighbours ``times`` over: light that scattered in the skin."""
    field = normals.astype(np.float64)
    for _ in range(times):
        field = evened(field, triangles, 1)
        field /= np.maximum(np.linalg.norm(field, axis=1, keepdims=True), 1e-9)
    return field.astype(np.float32)
