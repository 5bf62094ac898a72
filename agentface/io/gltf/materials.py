"""What a face is made of, as metallic-roughness materials with baked pictures."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from agentface.conventions import Bytes
from agentface.head.look import Look
from agentface.head.model import HeadModel
from agentface.head.skin_image import skin_image
from agentface.io.gltf.face_parts import FacePart
from agentface.io.gltf.writer import GltfWriter
from agentface.io.picture import encode
from agentface.view.bake.flat import FlatPainter
from agentface.view.dressing import dressed_skin, grown_hair
from agentface.view.gl.ownership import Ownership
from agentface.view.skin.template import skin_template

SKIN_SIDE, EYE_SIDE, HAIR_SIDE, SCALP_SIDE = 1024, 512, 1024, 512
_ROUGH = {"skin": 0.6, "eye": 0.08, "teeth": 0.2, "tongue": 0.35, "flesh": 0.45, "hair": 0.6, "hair_sheet": 0.5,
          "scalp": 0.75, "cloth": 0.9}  # fmt: skip
_IOR, _SKIN_IOR = "KHR_materials_ior", 1.4
"""Khronos' extension, and skin's index of refraction; without it that of glass, whose gloss is half as strong again."""
_BOTH_SIDES = ("hair", "hair_sheet", "flesh")
_ALPHA: dict[str, dict[str, Any]] = {
    "hair_sheet": {"alphaMode": "MASK", "alphaCutoff": 0.5},
    "scalp": {"alphaMode": "BLEND"},
}
_PNG, _JPEG = ("x.png", "image/png"), ("x.jpg", "image/jpeg")


def add_materials(writer: GltfWriter, model: HeadModel, look: Look, parts: Sequence[FacePart]) -> dict[str, int]:
    """The numbers of the materials of ``parts`` by name, which are added with their pictures.

    Raises GraphicsError when there is no OpenGL, which paints them.
    """
    pictures = face_pictures(model, look, parts)
    textures = {
        name: writer.picture(name, encode(image, kind), mime)
        for name, image in pictures.items()
        for kind, mime in [_PNG if image.shape[-1] == 4 else _JPEG]
    }
    writer.use(_IOR)
    return {
        name: writer.add("materials", _material(name, look, textures.get(name)))
        for name in dict.fromkeys(part.material for part in parts)
    }


def face_pictures(model: HeadModel, look: Look, parts: Sequence[FacePart]) -> dict[str, Bytes]:
    """The pictures of those materials of ``parts`` that have one, sRGB: ``(H, W, 3)``, or 4 with alpha."""
    wanted = {part.material for part in parts}
    pictures = {"skin": _skin_picture(model, look)}
    ownership = Ownership()
    try:
        with ownership.current():
            painter = FlatPainter(ownership.maker)
            pictures["eye"] = painter.eye(look, EYE_SIDE)[..., :3]
            if "hair_sheet" in wanted:
                pictures["hair_sheet"] = painter.sheet(look.hair, HAIR_SIDE)
            if "scalp" in wanted:
                pictures["scalp"] = _scalp_picture(painter, model, look, parts)
    finally:
        ownership.release()
    return pictures


def _skin_picture(model: HeadModel, look: Look) -> Bytes:
    """The complexion with beard, brows and scalp, and what the look wears on it."""
    tints = dressed_skin(model, look, None)["complexion"]
    own = skin_template(model, look, SKIN_SIDE, tints=tints)[..., :3]
    worn = skin_image(look, SKIN_SIDE)
    if worn is None:
        return own
    from PIL import Image

    fitted = np.asarray(Image.fromarray(worn).resize((SKIN_SIDE, SKIN_SIDE)), np.float64)
    alpha = fitted[..., 3:] / 255
    return np.asarray(np.round(own * (1.0 - alpha) + fitted[..., :3] * alpha), np.uint8)


def _scalp_picture(painter: FlatPainter, model: HeadModel, look: Look, parts: Sequence[FacePart]) -> Bytes:
    grown = grown_hair(model, look)
    (uv,) = (part.uv for part in parts if part.material == "scalp")
    assert grown is not None, "there is hair on the scalp"  # noqa: S101 - for the type checker
    assert uv is not None, "the scalp has a picture"  # noqa: S101 - for the type checker
    # coils are seen themselves
    cap, side = grown.cap(), HAIR_SIDE if grown.coils else SCALP_SIDE
    return painter.cap(look, grown, (uv, cap.vertices, cap.material[:, :1], cap.triangles), side)


def _material(name: str, look: Look, texture: int | None) -> dict[str, Any]:
    surface: dict[str, Any] = {"metallicFactor": 0.0, "roughnessFactor": _ROUGH[name]}
    if texture is not None:
        surface["baseColorTexture"] = {"index": texture}
    if name == "cloth":
        surface["baseColorFactor"] = [*look.cloth, 1.0]
    both = {"doubleSided": True} if name in _BOTH_SIDES else {}
    soft = {"extensions": {_IOR: {"ior": _SKIN_IOR}}} if name == "skin" else {}
    return {"name": name, "pbrMetallicRoughness": surface, **both, **soft, **_ALPHA.get(name, {})}
