"""The feature points of MPEG-4 with their numbers, on the face, on the side of the head, and in the open mouth."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from agentface.conventions import Doubles
from agentface.face import Face
from agentface.head.look import load_look
from agentface.head.model import HeadModel, load_model
from agentface.mpeg4.feature_points import FeaturePoint, feature_points
from agentface.resources import face_names
from agentface.studies.figures.mesh_view import Colour
from agentface.studies.figures.overlay import FINER, Canvas, Label, in_colours
from agentface.view.camera import Camera
from agentface.view.renderer import Renderer

_FRONT, _SIDE, _MOUTH, _MARGIN = (620, 860), (560, 860), (460, 430), 92
_SIDE_DEG = 62.0
_AWAY = 1.3  # m, of the camera
_JAW = 0.75
_OF_SKIN: Colour = (22, 66, 150)
_OF_PARTS: Colour = (150, 30, 30)
_HIDDEN = ("10.", "11.2", "11.3", "11.4", "11.6", "2.13", "2.14", "7.1")
"""What is seen better from the side."""
_MIDDLE = 0.003  # m, aside of which a point has a side


def figures(face: str | Path) -> dict[str, bytes]:
    """``feature-points-NAME.png`` of ``face``, and of the faces that come with agentface."""
    first = load_model(face)
    models = [first, *(load_model(name) for name in face_names() if name != first.name)]
    return {f"feature-points-{model.name}.png": _figure(model) for model in models}


def _figure(model: HeadModel) -> bytes:
    from PIL import Image

    look = load_look(model)
    bald = look.model_copy(update={"hair": look.hair.model_copy(update={"style": "none"})})
    renderer, posed = Renderer(model, bald), Face(model)
    points = feature_points(model)
    unit = model.landmarks.eye_separation
    middle = 0.5 * (points["11.1"].position + points["2.1"].position).astype(np.float64)
    front = Canvas(renderer, posed.geometry, _camera(middle, 0.0, 4.0 * unit), _FRONT, _MARGIN)
    skin = {number: point.position.astype(np.float64) for number, point in points.items() if _on_the_skin(point)}
    _mark(front, {number: at for number, at in skin.items() if not number.startswith(_HIDDEN)}, _OF_SKIN)
    aside = np.array([0.02, middle[1] + 0.1 * unit, 0.0])
    side = Canvas(renderer, posed.geometry, _camera(aside, _SIDE_DEG, 5.0 * unit), _SIDE, _MARGIN)
    hidden = {number: at for number, at in skin.items() if number.startswith(_HIDDEN) and at[0] > -_MIDDLE}
    hidden["7.1"] = points["7.1"].position.astype(np.float64)
    _mark(side, hidden, _OF_SKIN)
    posed.set_jaw(_JAW, fade=0.0)
    geometry = posed.step(0.0)
    lips = points["2.3"].position.astype(np.float64) - [0.0, 0.15 * unit, 0.0]
    mouth = Canvas(renderer, geometry, _camera(lips, 0.0, 1.1 * unit, 8.0), _MOUTH, _MARGIN)
    jaw = geometry.jaw.astype(np.float64)
    inside = {
        number: jaw[:3, :3] @ point.position + jaw[:3, 3] if point.mesh != "teeth_upper" else point.position
        for number, point in points.items()
        if point.mesh not in ("", "skin")
    }
    _mark(mouth, {number: np.asarray(at, np.float64) for number, at in inside.items()}, _OF_PARTS)
    pictures = [canvas.image for canvas in (front, side, mouth)]
    whole = Image.new("RGB", (sum(each.width for each in pictures), max(each.height for each in pictures)), "white")
    left = 0
    for picture in pictures:
        whole.paste(picture, (left, (whole.height - picture.height) // 2))
        left += picture.width
    return in_colours(whole.resize((whole.width // FINER, whole.height // FINER), Image.Resampling.BOX))


def _on_the_skin(point: FeaturePoint) -> bool:
    return point.mesh == "skin" or point.number in ("3.5", "3.6")


def _camera(target: Doubles, yaw_deg: float, height: float, pitch_deg: float = 0.0) -> Camera:
    """Looks at ``target`` from the person's left by ``yaw_deg``; the picture is ``height`` metres high."""
    yaw, pitch = np.radians(yaw_deg), np.radians(pitch_deg)
    way = np.array([np.sin(yaw) * np.cos(pitch), np.sin(pitch), np.cos(yaw) * np.cos(pitch)])
    x, y, z = (float(value) for value in target + _AWAY * way)
    at = float(target[0]), float(target[1]), float(target[2])
    return Camera((x, y, z), at, 2 * float(np.arctan(0.5 * height / _AWAY)))


def _mark(canvas: Canvas, points: dict[str, Doubles], colour: Colour) -> None:
    """Number the points in the margins: those of the person's right at the left, those of the middle where is room."""
    places = canvas.pixels(np.array(list(points.values())))
    sides: dict[bool, list[Label]] = {False: [], True: []}
    ordered = sorted(zip(points.items(), places, strict=True), key=lambda each: abs(each[0][1][0]) < _MIDDLE)
    for (number, at), place in ordered:
        right = bool(at[0] > 0.0) if abs(at[0]) >= _MIDDLE else len(sides[True]) < len(sides[False])
        sides[right].append(Label(number, (float(place[0]), float(place[1])), colour))
    for right, labels in sides.items():
        canvas.label(labels, right=right, gap=4.0)
