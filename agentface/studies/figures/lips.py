"""The lips' surface with its control points, and orbicularis oris: Figures 2 and 6 of Bui, Heylen and Nijholt."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from agentface.conventions import Bytes, Doubles, Floats
from agentface.deform.mouth import lips
from agentface.deform.mouth.lip_mesh import LipMesh, evaluate, patch_mesh
from agentface.deform.mouth.lip_surface import COLUMNS, ROWS
from agentface.deform.mouth.lips import LipTables
from agentface.deform.pipeline import GeometricDeformer
from agentface.head.model import HeadModel, load_model
from agentface.parameters import FacePose
from agentface.studies.figures.gouraud import smooth_picture
from agentface.studies.figures.mesh_view import Colour, MeshView
from agentface.view.camera import Camera
from agentface.view.contact_sheet import png, sheet
from agentface.view.renderer import Renderer

if TYPE_CHECKING:
    from PIL.ImageDraw import ImageDraw

LEVELS = (0.0, 0.5, 1.0)
MUSCLES = {"orbicularis_oris_pucker": "pucker", "orbicularis_oris_press": "press"}
_SIDE, _FINER, _PER_CELL = 360, 2, 3
_WIDTH, _NEAR = 1.35, 1.15  # eye separations that a picture of the face, and of the surface, covers
_BEHIND = 0.25  # eye separations, from the lips' front to the middle of the picture
_TURNED_DEG = 40.0
_AWAY = 0.5  # m, of the camera
_OUTSIDE = 3  # the first row of control points that is seen when the mouth is shut
_NET: Colour = (40, 84, 160)
_POINT: Colour = (176, 44, 36)
_FAINT: Colour = (196, 206, 222)


def figures(face: str | Path) -> dict[str, bytes]:
    """``lips.png``, the surface and its control grid at rest, and ``orbicularis_oris.png``, its contractions."""
    model = load_model(face)
    stage = _Stage(model)
    at_rest = FacePose()
    rest = [
        (stage.surface(at_rest, 0.0), "the lips' surface", f"{COLUMNS} x {ROWS} control points"),
        (stage.surface(at_rest, 0.0, net=True), "and its control points", "closed round the mouth"),
        (stage.surface(at_rest, _TURNED_DEG, net=True), "from the side", "from inside the mouth to the skin"),
    ]
    contracted = []
    for muscle, name in MUSCLES.items():
        poses = [FacePose.of(**{muscle: level}) for level in LEVELS]
        captions = [f"{name} {level:.1f}" for level in LEVELS]
        contracted += [(stage.surface(pose, _TURNED_DEG), at, "") for pose, at in zip(poses, captions, strict=True)]
        contracted += [(stage.portrait(pose), at, "") for pose, at in zip(poses, captions, strict=True)]
    return {
        "lips.png": png(sheet(rest, columns=len(rest))),
        "orbicularis_oris.png": png(sheet(contracted, columns=len(LEVELS))),
    }


class _Stage:
    """Takes pictures of one face's mouth."""

    def __init__(self, model: HeadModel) -> None:
        self._model = model
        self._tables: LipTables = lips.prepare(model)
        self._fine: LipMesh = patch_mesh(self._tables, _PER_CELL)
        self._deformer, self._renderer = GeometricDeformer(model, compiled=False), Renderer(model)
        marks = model.landmarks
        self._unit = marks.eye_separation
        front = 0.5 * (marks["upper_lip_middle"] + marks["lower_lip_middle"])
        self._centre = front - np.array([0, 0, _BEHIND * self._unit], np.float32)

    def surface(self, pose: FacePose, yaw_deg: float, *, net: bool = False) -> Bytes:
        """The surface alone, seen ``yaw_deg`` from the person's left; with ``net``, its control points too."""
        from PIL import Image, ImageDraw

        points = self._points(pose)
        places, normals = evaluate(self._tables, self._fine, points)
        view = MeshView(self._centre, _NEAR * self._unit, yaw_deg, _SIDE * _FINER)
        triangles = self._fine.triangles
        triangles = triangles[view.turned(normals[triangles].mean(1))[:, 2] > 0.0]
        picture = smooth_picture(view, places.astype(np.float64), triangles, normals[triangles].astype(np.float64))
        image = Image.fromarray(picture)
        if net:
            _draw_net(ImageDraw.Draw(image), view, points[self._tables.skin_count :].astype(np.float64))
        return np.asarray(image.resize((_SIDE, _SIDE), Image.Resampling.BOX))

    def portrait(self, pose: FacePose) -> Bytes:
        """The mouth in the face."""
        yaw = np.radians(0.5 * _TURNED_DEG)
        target = self._centre.astype(np.float64)
        eye = target + _AWAY * np.array([np.sin(yaw), 0.05, np.cos(yaw)])
        view = Camera(_triple(eye), _triple(target), 2 * float(np.arctan(0.5 * _WIDTH * self._unit / _AWAY)))
        return self._renderer.render(self._deformer.at(pose), (_SIDE, _SIDE), view, "portrait")

    def _points(self, pose: FacePose) -> Floats:
        points = np.concatenate([self._model.vertices, self._tables.control_rest])
        lips.contract(self._tables, pose.array, lips.as_they_lie(self._tables, points), points)
        lips.surface(self._tables, points)
        return points


def _draw_net(draw: ImageDraw, view: MeshView, control: Doubles) -> None:
    """The control grid: the rows inside the mouth faint, those of the red and the skin on top of them."""
    pixels = view.pixels(control)[:, :2].reshape(COLUMNS, ROWS, 2)
    for row in range(ROWS):
        colour = _FAINT if row < _OUTSIDE else _NET
        for column in range(COLUMNS):
            here = _pair(pixels[column, row])
            draw.line([here, _pair(pixels[(column + 1) % COLUMNS, row])], fill=colour, width=_FINER)
            if row > 0:
                draw.line(
                    [here, _pair(pixels[column, row - 1])], fill=_FAINT if row <= _OUTSIDE else _NET, width=_FINER
                )
    radius = 2.0 * _FINER
    for x, y in pixels[:, _OUTSIDE:].reshape(-1, 2):
        draw.ellipse([x - radius, y - radius, x + radius, y + radius], fill=_POINT)


def _pair(pixel: Doubles) -> tuple[float, float]:
    return float(pixel[0]), float(pixel[1])


def _triple(point: Doubles) -> tuple[float, float, float]:
    x, y, z = (float(value) for value in point)
    return x, y, z
