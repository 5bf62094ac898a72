"""The regions of the face and their sub-regions, in colours on the skin."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from agentface.conventions import Bytes, Doubles, Floats
from agentface.face import Face
from agentface.head.look import load_look
from agentface.head.model import HeadModel, load_model
from agentface.head.regions import HALF_REGIONS, SUB_REGIONS
from agentface.studies.figures.mesh_view import Colour
from agentface.studies.figures.overlay import Canvas, Label
from agentface.view.camera import Camera
from agentface.view.renderer import Renderer

_SIZE, _MARGIN = (600, 760), 240
_AWAY, _COVERED, _BELOW = 1.1, 3.6, 0.45  # m; eye separations that are seen; from the eyes down to the middle
_COLOURS: dict[str, Colour] = {
    "upper_face": (62, 110, 184),
    "eyebrow": (28, 58, 120),
    "upper_eyelid": (92, 66, 176),
    "lower_eyelid": (208, 88, 160),
    "middle_face": (44, 142, 100),
    "upper_lip": (104, 140, 24),
    "lower_face": (220, 142, 36),
    "lower_lip": (158, 88, 10),
}


def figures(face: str | Path) -> dict[str, bytes]:
    """``regions.png``: the five regions of each half and the three sub-regions; the rest of the head is bare."""
    model = load_model(face, asymmetry=0.0)
    look = load_look(model)
    bald = look.model_copy(update={"hair": look.hair.model_copy(update={"style": "none"})})
    unit = model.landmarks.eye_separation
    x, y, z = (float(value) for value in model.landmarks["pupil_l"] * [0, 1, 1] - [0, _BELOW * unit, 0])
    camera = Camera((x, y + 0.02, z + _AWAY), (x, y, z), 2 * float(np.arctan(0.5 * _COVERED * unit / _AWAY)))
    canvas = Canvas(Renderer(model, bald), Face(model).geometry, camera, _SIZE, _MARGIN)
    _colour(canvas, model, np.asarray(camera.eye))
    left: list[Label] = []
    right: list[Label] = []
    for i, name in enumerate((*HALF_REGIONS, *SUB_REGIONS)):
        side, labels = ("r", left) if i % 2 else ("l", right)
        at = _middle(canvas, model, f"{name}_{side}")
        labels.append(Label(name, at, _COLOURS[name]))
    canvas.label(left, right=False, gap=14.0)
    canvas.label(right, right=True, gap=14.0)
    return {"regions.png": canvas.png()}


def _colour(canvas: Canvas, model: HeadModel, eye: Doubles) -> None:
    """Colour the skin that faces the eye: of each triangle every corner colours its third."""
    from PIL import Image, ImageDraw

    points, part = model.vertices.astype(np.float64), _parts(model)
    corners = points[model.triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    facing = ((eye - corners[:, 0]) * normals).sum(1) > 0.0
    outside = model.material[:, 1][model.triangles].max(1) < 0.5  # not in the mouth
    layer = Image.new("L", canvas.image.size)
    pen = ImageDraw.Draw(layer)
    pixels = canvas.pixels(points)
    for triangle in model.triangles[facing & outside]:
        at = pixels[triangle]
        for i in range(3):
            third = [at[i], at[[i, (i + 1) % 3]].mean(0), at.mean(0), at[[i, (i + 2) % 3]].mean(0)]
            pen.polygon([(float(x), float(y)) for x, y in third], fill=int(part[triangle[i]]))
    canvas.tint(np.asarray(layer), [_COLOURS[name] for name in _COLOURS])


def _parts(model: HeadModel) -> Bytes:
    """``(V,)``: 0 for the rest of the head, else the place in ``_COLOURS``, from 1, of the smallest part it is in."""
    part = np.zeros(len(model.vertices), np.uint8)
    for name in (*HALF_REGIONS, *SUB_REGIONS):
        part[model.regions.mask([name])] = 1 + list(_COLOURS).index(name)
    return part


def _middle(canvas: Canvas, model: HeadModel, name: str) -> tuple[float, float]:
    """The vertex of a region, seen from the front, that lies deepest inside what is drawn of it."""
    part = _parts(model)
    index = 1 + list(_COLOURS).index(name[:-2])
    members = np.flatnonzero(part == index)
    members = members[(model.vertices[members, 0] > 0) == name.endswith("_l")]
    members = members[model.normals[members, 2] > 0.3]
    others: Floats = model.vertices[(part != index) & (model.normals[:, 2] > 0)]
    depth = [float(np.linalg.norm(others - model.vertices[vertex], axis=1).min()) for vertex in members]
    place = canvas.pixels(model.vertices[[members[int(np.argmax(depth))]]])[0]
    return float(place[0]), float(place[1])
