"""``look.yaml``: the colours, hair and lights of one face. All colours are linear RGB reflectances, not sRGB."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal

from pydantic import Field

from agentface.cache import prepared, stamp_of
from agentface.config import Document, Table
from agentface.errors import DataError, UnknownNameError
from agentface.head.model import HeadModel

_Fraction = Annotated[float, Field(ge=0, le=1)]
_Colour = Annotated[list[_Fraction], Field(min_length=3, max_length=3)]
_Direction = Annotated[list[float], Field(min_length=3, max_length=3)]


class SkinLook(Table):
    """Reflectance of the skin, the colour that tints the lips, how much it shines (1: as glossy skin).

    ``texture`` is the file of a picture to wear as skin (8-bit sRGB; where it is transparent the skin shows through),
    relative to the look's own; a look that was read has its whole path. ``texture_strength`` is how much of it shows.
    """

    tone: _Colour
    lips: _Colour
    shine: _Fraction
    stubble: _Fraction = 0.0
    texture: str | None = None
    texture_strength: _Fraction = 1.0


class EyesLook(Table):
    """Iris near the pupil and at its rim, white of the eye; pupil's radius as a part of the iris's."""

    iris_inner: _Colour
    iris_outer: _Colour
    sclera: _Colour
    pupil: Annotated[float, Field(ge=0.1, le=0.8)]


class HairLook(Table):
    """Hair of the head, brows and lashes.

    ``hairline`` is its height as a part of the landmark hairline_middle's, ``brow_arch`` how much of the arch of the
    landmarks brows have.
    """

    style: Literal["none", "cropped", "swept", "bob", "bun"]
    colour: _Colour
    grey: _Fraction
    hairline: Annotated[float, Field(ge=0.7, le=1.4)]
    parting: Annotated[float, Field(ge=-1, le=1)]
    length: Annotated[float, Field(ge=0.5, le=2)]
    volume: Annotated[float, Field(ge=0.3, le=2)]
    curl: _Fraction
    brow_colour: _Colour
    brow_density: Annotated[float, Field(ge=0, le=2)]
    brow_arch: _Fraction = 1.0
    lash_length_mm: Annotated[float, Field(ge=0, le=14)]


class Light(Table):
    """A distant light: the direction towards it, its colour, its strength."""

    towards: _Direction
    colour: _Colour
    strength: Annotated[float, Field(ge=0, le=20)]


class Lights(Table):
    """Four lights, and what comes from above and from below.

    ``width`` 0..1: how wide the sources of all but the key light are; their gloss on dry skin is as soft.
    """

    key: Light
    fill: Light
    rim_left: Light
    rim_right: Light
    sky: _Colour
    ground: _Colour
    width: Annotated[float, Field(ge=0, le=1)] = 0.0


class Look(Table):
    """Everything of ``look.yaml``."""

    skin: SkinLook
    eyes: EyesLook
    hair: HairLook
    cloth: _Colour
    teeth: _Colour = [0.56, 0.50, 0.405]
    lights: Lights
    background_inner: _Colour
    background_outer: _Colour
    exposure: Annotated[float, Field(gt=0, le=10)]


def load_look(model: HeadModel, look: str | Path | None = None) -> Look:
    """The look ``look`` of a face: a name in its folder ``looks``, a path, or None for its own ``look.yaml``.

    Raises UnknownNameError for neither a name nor a file, DataError with every fault of the file.
    """
    if look is None:
        return read_look(model.folder / "look.yaml")
    if str(look) in look_names(model):
        return read_look(_looks(model) / f"{look}.yaml")
    given = Path(look).expanduser()
    if given.suffix in (".yaml", ".yml") or given.exists():
        return read_look(given)
    raise UnknownNameError("look, or a path to a look's file", str(look), look_names(model))


def look_names(model: HeadModel) -> tuple[str, ...]:
    """The names of the looks in the face's folder, besides its own."""
    return tuple(sorted(path.stem for path in _looks(model).glob("*.yaml")))


def _looks(model: HeadModel) -> Path:
    return model.folder / "looks"


def read_look(path: str | Path) -> Look:
    """The look in a file; raises DataError with every fault of the file and of the picture it wears as skin."""
    path = Path(path)
    if not path.is_file():
        return _read(path)
    look = prepared(stamp_of([path.resolve()]), "look", lambda: _read(path))
    return look if look.skin.texture is None else _read(path)  # a picture may have changed beside its look


def _read(path: Path) -> Look:
    document = Document(path)
    look = document.collect(Look)
    if look is not None:
        for name in ("key", "fill", "rim_left", "rim_right"):
            towards = getattr(look.lights, name).towards
            if not any(towards):
                document.fault(("lights", name, "towards"), "a direction", repr(towards))
        look = _with_texture(document, look)
    document.check()
    assert look is not None, "a document without faults is parsed"  # noqa: S101 - for the type checker
    return look


def _with_texture(document: Document, look: Look) -> Look:
    """``look`` with the path that its texture lies at; the faults of the picture are the document's."""
    if look.skin.texture is None:
        return look
    from agentface.head.texture_file import read_texture

    path = document.path.parent / look.skin.texture
    try:
        read_texture(path)
    except DataError as error:
        for fault in error.faults:
            document.fault(("skin", "texture"), f"{fault.expected} at {path}", fault.got, fault.hint)
    return look.model_copy(update={"skin": look.skin.model_copy(update={"texture": str(path)})})
