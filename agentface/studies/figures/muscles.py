"""The muscles on the face: where each leaves the bone, where it enters the skin, and how it is called."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from agentface.conventions import Doubles, Floats
from agentface.face import Face
from agentface.head.look import load_look
from agentface.head.model import HeadModel, load_model
from agentface.head.ring_names import LidRing, LipRing
from agentface.parameters import PARAMETERS
from agentface.studies.figures.mesh_view import Colour
from agentface.studies.figures.overlay import Canvas, Label, Place
from agentface.view.camera import Camera
from agentface.view.renderer import Renderer

_SIZE, _MARGIN = (600, 800), 350
_AWAY, _COVERED = 1.1, 3.75  # m, of the camera; eye separations that the picture is high
_BELOW = 0.50  # eye separations, from the eyes down to the middle of the picture
_FADE = 0.35
_BONE: Colour = (252, 250, 244)
_COLOURS: dict[Colour, tuple[str, ...]] = {
    (44, 92, 168): ("frontalis", "corrugator", "depressor_supercilii", "procerus"),
    (122, 72, 158): ("orbicularis_oculi",),
    (30, 128, 92): ("levator_labii", "nasalis", "zygomaticus_minor"),
    (186, 44, 40): ("zygomaticus_major", "levator_anguli", "depressor_anguli", "risorius", "platysma"),
    (190, 116, 20): ("depressor_labii", "mentalis", "orbicularis_oris"),
}
"""Colour of a group: how the names of its muscles begin."""
_BELLY, _RING = 190, 105  # opacity of 255
_THICK, _THIN = 0.95, 3.0  # half a belly's width: pixels for the root of a pixel of length, and at the ends
_NAMED_AT = 0.4  # of the way from the bone to the skin
_FIBRES = (-0.5, 0.0, 0.5)
_RINGS = {
    "orbicularis oculi, pars palpebralis  AU 43": ("l", (LidRing.EDGE, LidRing.CREASE)),
    "orbicularis oculi, pars orbitalis": ("r", (LidRing.FOLD, LidRing.ORBIT + 1)),
}


def figures(face: str | Path) -> dict[str, bytes]:
    """``muscles.png``: every vector muscle with its name and action unit, and the three rings."""
    model = load_model(face, asymmetry=0.0)
    look = load_look(model)
    bald = look.model_copy(update={"hair": look.hair.model_copy(update={"style": "none"})})
    centre = model.landmarks["pupil_l"] * [0, 1, 1] - [0, _BELOW * model.landmarks.eye_separation, 0]
    x, y, z = (float(value) for value in centre)
    opening = 2 * float(np.arctan(0.5 * _COVERED * model.landmarks.eye_separation / _AWAY))
    camera = Camera((x, y + 0.02, z + _AWAY), (x, y, z), opening)
    canvas = Canvas(Renderer(model, bald), Face(model).geometry, camera, _SIZE, _MARGIN, _FADE)
    left, right = _draw_rings(canvas, model)
    labels = _draw_muscles(canvas, model)
    for i, label in enumerate(sorted(labels, key=lambda label: label.at[1])):
        # every other one is named on the face's other side, where it is the mirror image
        if i % 2:
            right.append(label)
        else:
            left.append(Label(label.text, (canvas.image.width - label.at[0], label.at[1]), label.colour))
    canvas.label(left, right=False)
    canvas.label(right, right=True)
    return {"muscles.png": canvas.png()}


def _draw_muscles(canvas: Canvas, model: HeadModel) -> list[Label]:
    """Draw the muscles of both sides; the labels of the left ones, which are seen at the right."""
    muscles, labels = model.muscles, []
    origin, insertion = canvas.pixels(muscles.origin), canvas.pixels(muscles.insertion)
    # the longest first, the short ones over them
    for i in np.argsort(-np.linalg.norm(origin - insertion, axis=1), kind="stable"):
        _draw_belly(canvas, origin[i], insertion[i], _colour(muscles.names[i]))
    for i, name in enumerate(muscles.names):
        canvas.dot(origin[i], _colour(name), 3.8)
        canvas.dot(origin[i], _BONE, 2.6)
        if name.endswith("_l"):
            place = origin[i] + _NAMED_AT * (insertion[i] - origin[i])
            labels.append(Label(_title(name), _place(place), _colour(name)))
    return labels


def _colour(name: str) -> Colour:
    return next(colour for colour, starts in _COLOURS.items() if name.startswith(starts))


def _draw_belly(canvas: Canvas, bone: Doubles, skin: Doubles, colour: Colour) -> None:
    """A spindle from the bone to the skin, widest past its middle, with fibres."""
    along = skin - bone
    length = float(np.linalg.norm(along))
    across = np.array([-along[1], along[0]]) / length
    part = np.linspace(0.0, 1.0, 24)
    width = _THICK * np.sqrt(length) * np.sin(np.pi * part**1.2) ** 0.8 + _THIN
    axis = bone + part[:, None] * along
    sides = [axis + (sign * width)[:, None] * across for sign in (1, -1)]
    canvas.pen.polygon([tuple(place) for place in np.concatenate([sides[0], sides[1][::-1]])], fill=(*colour, _BELLY))
    pale = tuple(round(0.45 * value + 0.55 * 255) for value in colour)
    for fibre in _FIBRES:
        canvas.line(axis + (fibre * width)[:, None] * across, (*pale, 200), 0.6)


def _draw_rings(canvas: Canvas, model: HeadModel) -> tuple[list[Label], list[Label]]:
    """The ring muscles of eyes and mouth as bands between rings of the skin; their labels, left and right."""
    for side in ("l", "r"):
        lids = [[*ring.upper, *ring.lower[-2:0:-1]] for ring in model.eyelids.rings[side]]
        for _, (inner, outer) in _RINGS.values():
            _draw_band(canvas, model.vertices[lids[inner]], model.vertices[lids[outer]], _colour("orbicularis_oculi"))
    lips = [[*ring.upper, *ring.lower[-2:0:-1]] for ring in model.lips.rings]
    mouth = _colour("orbicularis_oris")
    _draw_band(canvas, model.vertices[lips[LipRing.CONTACT]], model.vertices[lips[LipRing.SKIN]], mouth)
    left: list[Label] = []
    right: list[Label] = []
    for text, (side, (inner, outer)) in _RINGS.items():
        rings = model.eyelids.rings[side]
        # the outer corner
        ends = [ring.upper[0] if side == "l" else ring.upper[-1] for ring in (rings[inner], rings[outer])]
        place = canvas.pixels(model.vertices[ends]).mean(axis=0)
        (right if side == "l" else left).append(Label(text, _place(place), _colour("orbicularis_oculi")))
    place = canvas.pixels(model.vertices[[model.lips.rings[LipRing.BORDER].lower[len(lips[0]) // 5]]])[0]
    right.append(Label("orbicularis oris  AU 18, 24", _place(place), mouth))
    return left, right


def _draw_band(canvas: Canvas, inner: Floats, outer: Floats, colour: Colour) -> None:
    a, b = canvas.pixels(inner), canvas.pixels(outer)
    closed = [tuple(place) for ring in (b, a[::-1]) for place in np.concatenate([ring, ring[:1]])]
    canvas.pen.polygon(closed, fill=(*colour, _RING))


def _place(point: Doubles) -> Place:
    return float(point[0]), float(point[1])


def _title(name: str) -> str:
    """The name without side, and the action units that the registry names."""
    description = next(parameter.description for parameter in PARAMETERS if parameter.name == name)
    units = re.search(r"\(AU ([\d, ]+)\)", description)
    plain = name.removesuffix("_l").replace("_", " ")
    return f"{plain}  AU {units[1]}" if units else plain
