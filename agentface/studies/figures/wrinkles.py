"""Wrinkles: the normals at their feet and the forehead, Figures 11 and 12 of Bui, Heylen and Nijholt."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from agentface.conventions import Bytes, Doubles, Indices
from agentface.deform.protocol import DEFAULT_DEFORMER, make_deformer
from agentface.head.model import HeadModel, load_model
from agentface.head.trains import Train, ZoneTrain, heights, inner_feet
from agentface.mesh.normals import corner_normals
from agentface.parameters import FacePose
from agentface.studies.figures.gouraud import smooth_picture
from agentface.studies.figures.mesh_view import MeshView, draw_mesh
from agentface.view.camera import Camera
from agentface.view.contact_sheet import png, sheet
from agentface.view.renderer import Renderer

if TYPE_CHECKING:
    from PIL.Image import Image

TRAIN: Train = ZoneTrain(
    origin=np.zeros(3), axis=np.array([0.0, -1.0, 0.0]), zone=math.radians(32), finish=0.07, count=4, height=0.0028
)
"""A single muscle's train, its height doubled so that the mesh shows it."""
SURPRISED = {"frontalis_medialis": 1.0, "frontalis_intermedius": 1.0, "frontalis_lateralis": 1.0}
_ROWS_A_WRINKLE, _PITCH = 4, math.radians(-55)
_PANEL, _FINER = 400, 3
_SEEN = 2.5  # how many times as high the wrinkles of the wired forehead are drawn


def figures(face: str | Path, deformer_name: str = DEFAULT_DEFORMER) -> dict[str, bytes]:
    """``wrinkle-normals.png``, with and without the correction at the feet, and ``wrinkles.png``, mesh and face."""
    return {"wrinkle-normals.png": png(_normals()), "wrinkles.png": png(_forehead(load_model(face), deformer_name))}


def skin_strip(train: Train) -> tuple[Doubles, Indices, np.typing.NDArray[np.bool_]]:
    """A flat piece of skin raised by a train: vertices ``(V, 3)`` m, triangles ``(T, 3)``, which are on inner feet."""
    step = train.length / (train.count * _ROWS_A_WRINKLE)
    chord = -0.07 * math.cos(math.radians(32))
    y = chord + step * np.arange(-_ROWS_A_WRINKLE, _ROWS_A_WRINKLE * (train.count + 1) + 1)
    x = step * np.arange(-18, 19)
    across, along = np.meshgrid(x, y)
    points = np.stack([across, along, np.zeros_like(across)], axis=-1).reshape(-1, 3)
    corner = (np.arange(len(y) - 1)[:, None] * len(x) + np.arange(len(x) - 1)).ravel()
    quads = np.stack([corner, corner + 1, corner + len(x) + 1, corner + len(x)], axis=1)
    triangles = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]]).astype(np.int32)
    feet = inner_feet(train, points, 1e-6)
    points[:, 2] = heights(train, points)
    return points, triangles, feet


def _normals() -> Image:
    points, triangles, feet = skin_strip(TRAIN)
    turned = _pitched(points)
    view = MeshView(turned.mean(axis=0), 0.068, 0.0, _PANEL)
    panels = []
    for title, note, on_foot in (
        ("(a) mean normals of the vertices", "the valleys between the wrinkles are lost", np.zeros_like(feet)),
        ("(b) the triangles' normals at inner feet", "the valleys show", feet),
    ):
        normals = corner_normals(turned, triangles, on_foot)
        panels.append((smooth_picture(view, turned, triangles, normals), title, note))
    return sheet(panels, columns=2)


def _forehead(model: HeadModel, deformer_name: str) -> Image:
    points, triangles, _ = skin_strip(TRAIN)
    turned = _pitched(points)
    strip = MeshView(turned.mean(axis=0), 0.068, 20.0, _PANEL * _FINER)
    deformer = make_deformer(deformer_name, model)
    geometry = deformer.at(FacePose.of(**SURPRISED))
    rest, moved = model.vertices.astype(np.float64), geometry.vertices.astype(np.float64)
    moved += (_SEEN - 1.0) * geometry.wrinkles[:, None] * geometry.smooth_normals
    unit, (x, y, z) = model.landmarks.eye_separation, map(float, model.landmarks["glabella"])
    middle = (x, y + 0.45 * unit, z)
    brows = MeshView(np.array(middle, np.float32), 2.1 * unit, 0.0, _PANEL * _FINER)
    camera = Camera((x, middle[1] + 0.4 * unit, z + 9.0 * unit), middle, math.radians(13.2))
    face = Renderer(model).render(geometry, (_PANEL, _PANEL), camera, "portrait")
    return sheet(
        [
            (
                _wired(strip, turned, turned, triangles),
                "(a) one muscle's wrinkles",
                "the paper's train, 2 times as high",
            ),
            (
                _wired(brows, rest, moved, model.triangles),
                "(b) the forehead's mesh",
                f"frontalis, contracted; {_SEEN:g} times as high",
            ),
            (face, "(c) the forehead", "wrinkles finer than the mesh by pixel"),
        ],
        columns=3,
    )


def _wired(view: MeshView, rest: Doubles, moved: Doubles, triangles: Indices) -> Bytes:
    from PIL import Image, ImageDraw

    image = Image.new("RGB", (view.size, view.size), (255, 255, 255))
    draw_mesh(ImageDraw.Draw(image), view, rest, moved, triangles)
    return np.asarray(image.resize((_PANEL, _PANEL), Image.Resampling.BOX))


def _pitched(points: Doubles) -> Doubles:
    cosine, sine = math.cos(_PITCH), math.sin(_PITCH)
    return points @ np.array([[1, 0, 0], [0, cosine, sine], [0, -sine, cosine]])
