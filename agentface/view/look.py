"""``look.yaml``: the colours, hair and lights of one face. All colours are linear RGB reflectances, not sRGB."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal

from pydantic import Field

from agentface.anatomy.model import HeadModel
from agentface.config import Table, load

_Fraction = Annotated[float, Field(ge=0, le=1)]
_Colour = Annotated[list[_Fraction], Field(min_length=3, max_length=3)]
_Direction = Annotated[list[float], Field(min_length=3, max_length=3)]


class SkinLook(Table):
    """Reflectance of the skin, the colour that tints the lips, how much it shines (1: as glossy skin)."""

    tone: _Colour
    lips: _Colour
    shine: _Fraction


class EyesLook(Table):
    """Iris near the pupil and at its rim, white of the eye; pupil's radius as a part of the iris's."""

    iris_inner: _Colour
    iris_outer: _Colour
    sclera: _Colour
    pupil: Annotated[float, Field(ge=0.1, le=0.8)]


class HairLook(Table):
    """Hair of the head, brows and lashes; ``hairline`` is its height as a part of the landmark hairline_middle's."""

    style: Literal["none", "cropped", "tied"]
    colour: _Colour
    grey: _Fraction
    hairline: Annotated[float, Field(ge=0.7, le=1.4)]
    brow_colour: _Colour
    brow_density: Annotated[float, Field(ge=0, le=2)]
    lash_length_mm: Annotated[float, Field(ge=0, le=14)]


class Light(Table):
    """A distant light: the direction towards it, its colour, its strength."""

    towards: _Direction
    colour: _Colour
    strength: Annotated[float, Field(ge=0, le=20)]


class Lights(Table):
    """Four lights, and what comes from above and from below."""

    key: Light
    fill: Light
    rim_left: Light
    rim_right: Light
    sky: _Colour
    ground: _Colour


class Look(Table):
    """Everything of ``look.yaml``."""

    skin: SkinLook
    eyes: EyesLook
    hair: HairLook
    cloth: _Colour
    lights: Lights
    background_inner: _Colour
    background_outer: _Colour
    exposure: Annotated[float, Field(gt=0, le=10)]


def load_look(model: HeadModel) -> Look:
    """The look in the model's folder; raises DataError with every fault of the file."""
    return read_look(model.folder / "look.yaml")


def read_look(path: Path) -> Look:
    """The look in a file; raises DataError with every fault of the file."""
    return load(path, Look)
