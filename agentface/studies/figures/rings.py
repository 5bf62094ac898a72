"""The rings of vertices round the mouth and the eyes, with the names that the code has for them."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path

import numpy as np

from agentface.conventions import Floats
from agentface.face import Face
from agentface.head.model import load_model
from agentface.head.ring_names import LID_RINGS, LidRing, LipRing
from agentface.head.rings import RingHalves
from agentface.studies.figures.mesh_view import Colour
from agentface.studies.figures.overlay import Canvas, Label
from agentface.view.camera import Camera
from agentface.view.renderer import Renderer

_SIZE, _MARGIN = (640, 520), 170
_AWAY = 0.5  # m, of the camera
_JAW = 0.3
"""The jaw's opening for the lips: with a shut mouth the inner rings are not seen."""
_NAMED: Colour = (22, 66, 150)
_NAMELESS: Colour = (150, 150, 158)
_HIDDEN = 70  # opacity of 255, of what lies behind


def figures(face: str | Path) -> dict[str, bytes]:
    """``lip-rings.png`` and ``lid-rings.png``, named rings in blue; what the skin hides is faint."""
    model = load_model(face, asymmetry=0.0)
    renderer, posed = Renderer(model), Face(model)
    unit = model.landmarks.eye_separation
    lips = model.landmarks["upper_lip_middle"] - np.array([0, 0.16 * unit, 0], np.float32)
    posed.set_jaw(_JAW, fade=0.0)
    mouth = Canvas(renderer, posed.step(0.0), _camera(lips, 1.35 * unit), _SIZE, _MARGIN)
    places = posed.geometry.vertices, posed.geometry.normals
    _draw(mouth, *places, model.lips.rings, LipRing)
    posed = Face(model)
    posed.set_gaze(0.0, -20.0, fade=0.0)
    eye = Canvas(renderer, posed.step(0.0), _camera(model.eye_centre("l"), 0.9 * unit), _SIZE, _MARGIN)
    _draw(eye, posed.geometry.vertices, posed.geometry.normals, model.eyelids.rings["l"][:LID_RINGS], LidRing)
    return {"lip-rings.png": mouth.png(), "lid-rings.png": eye.png()}


def _camera(target: Floats, height: float) -> Camera:
    """Looks straight at ``target``; the picture is ``height`` metres high."""
    x, y, z = (float(value) for value in target)
    return Camera((x, y, z + _AWAY), (x, y, z), 2 * float(np.arctan(0.5 * height / _AWAY)))


def _draw(
    canvas: Canvas, vertices: Floats, normals: Floats, rings: Sequence[RingHalves], names: type[LipRing] | type[LidRing]
) -> None:
    """Draw ``rings`` on the skin, and label those that have a name in the middle of their upper half."""
    pixels, seen = canvas.pixels(vertices), normals[:, 2] > 0.0
    named = {int(member): member.name for member in names}
    left: list[Label] = []
    right: list[Label] = []
    for i, ring in enumerate(rings):
        colour, width = (_NAMED, 1.8) if i in named else (_NAMELESS, 1.0)
        for half in (ring.upper, ring.lower):
            for one, other in pairwise(half):
                opacity = 255 if seen[one] and seen[other] else _HIDDEN
                canvas.line(pixels[[one, other]], (*colour, opacity), width)
    for place, (i, name) in enumerate(sorted(named.items())):
        half = rings[i].upper
        vertex = half[round((0.42 if place % 2 else 0.58) * (len(half) - 1))]
        at = float(pixels[vertex, 0]), float(pixels[vertex, 1])
        (right if place % 2 else left).append(Label(f"{name}  {i}", at, _NAMED))
    canvas.label(left, right=False, gap=12.0)
    canvas.label(right, right=True, gap=12.0)
