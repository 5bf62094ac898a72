"""Static tints of the skin, placed by landmarks so that they fit any face."""

from __future__ import annotations

import numpy as np

from agentface.anatomy.model import HeadModel
from agentface.conventions import Doubles, Floats


def complexion(model: HeadModel, covered: Floats) -> Floats:
    """``(V, 4)`` 0..1: redness, tint of the eye socket, gloss of forehead and nose, and ``covered (V,)`` by hair."""
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
    red = 0.40 * spot(cheek - 0.10 * up, (0.38, 0.30, 0.6))
    red += 0.60 * spot(at["nose_tip"], (0.24, 0.20, 0.4)) + 0.35 * spot(at["alare_l"], (0.14, 0.14, 0.3))
    red += 0.30 * spot(at["pogonion"], (0.32, 0.22, 0.4)) + 0.55 * model.material[:, 3]
    socket = 0.75 * spot(eye + 0.08 * up, (0.42, 0.30, 0.4)) + 0.4 * spot(eye - 0.24 * up, (0.30, 0.10, 0.4))
    brow = 0.5 * (at["brow_inner_l"] + at["glabella"])
    gloss = spot(brow + 0.35 * up, (0.55, 0.5, 0.8)) + spot(0.5 * (at["nasion"] + at["nose_tip"]), (0.12, 0.5, 0.6))
    return np.asarray(np.clip(np.stack([red, socket, gloss, covered], axis=1), 0, 1), np.float32)


def blurred(normals: Floats, triangles: np.typing.NDArray[np.int32], times: int) -> Floats:
    """``(V, 3)`` normals averaged with their neighbours ``times`` over: light that scattered in the skin."""
    ends = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    count = np.bincount(ends[:, 0], minlength=len(normals))[:, None] + 1e-9
    field = normals.astype(np.float64)
    for _ in range(times):
        sums = np.stack([np.bincount(ends[:, 0], field[ends[:, 1], axis], len(normals)) for axis in range(3)], axis=1)
        field = 0.5 * field + 0.5 * sums / count
        field /= np.maximum(np.linalg.norm(field, axis=1, keepdims=True), 1e-9)
    return field.astype(np.float32)
