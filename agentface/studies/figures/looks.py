"""What faces wear: each with each of its looks, and one with each style of hair."""

from __future__ import annotations

from pathlib import Path
from typing import get_args

from agentface.conventions import Bytes
from agentface.face import Face
from agentface.head.look import HairLook, Look, load_look, look_names
from agentface.head.model import HeadModel, load_model
from agentface.resources import face_names
from agentface.studies.figures.overlay import in_colours
from agentface.view.contact_sheet import sheet
from agentface.view.renderer import Renderer

STYLES: tuple[str, ...] = get_args(HairLook.model_fields["style"].annotation)
_SIZE = (320, 370)


def figures(face: str | Path) -> dict[str, bytes]:
    """``looks.png``: ``face`` and the faces that come with agentface in each look; ``hair.png``: styles of hair."""
    first = load_model(face)
    models = [first, *(load_model(name) for name in face_names() if name != first.name)]
    looks = [
        (_picture(model, load_look(model, name)), model.name, f"--look {name}" if name else "its own look")
        for model in models
        for name in (None, *look_names(model))
    ]
    own = load_look(first)
    hair = [
        (_picture(first, own.model_copy(update={"hair": own.hair.model_copy(update={"style": style})})), style, "")
        for style in STYLES
    ]
    return {
        "looks.png": in_colours(sheet(looks, columns=len(looks))),
        "hair.png": in_colours(sheet(hair, columns=len(hair))),
    }


def _picture(model: HeadModel, look: Look) -> Bytes:
    return Renderer(model, look).render(Face(model).geometry, _SIZE, "three-quarter", "portrait")
