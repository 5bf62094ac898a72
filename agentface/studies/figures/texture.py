"""A picture worn as skin: the template, what was painted, and the face that wears it."""

from __future__ import annotations

import tempfile
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw, ImageFilter

from agentface.conventions import Bytes
from agentface.deform.protocol import DEFAULT_DEFORMER, make_deformer
from agentface.emotion.inference import default_inference
from agentface.head.look import load_look
from agentface.head.model import HeadModel, load_model
from agentface.view.contact_sheet import png, sheet
from agentface.view.renderer import Renderer
from agentface.view.skin.template import skin_template

_SIZE, _SIDE, _SEED = (340, 380), 1024, 1
_BLUE, _WHITE, _FRECKLE = (40, 70, 160, 230), (235, 235, 235, 230), (120, 60, 35, 150)


def figures(face: str | Path, deformer_name: str = DEFAULT_DEFORMER) -> dict[str, bytes]:
    """``texture.png``: the template with paint on it, and the face that wears the paint, at rest and smiling."""
    model = load_model(face)
    look, paint = load_look(model), _painted(model)
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "paint.png"
        paint.save(file)
        skin = look.skin.model_copy(update={"texture": str(file)})
        renderer = Renderer(model, look.model_copy(update={"skin": skin}))
    template = Image.fromarray(skin_template(model, look, _SIDE))
    template.alpha_composite(paint)
    panels = [(_panel(template), "the template, painted on", "agentface unwrap")]
    deformer, infer = make_deformer(deformer_name, model), default_inference()
    for title, emotions in (
        ("neutral", {}),
        ("happiness 0.8", {"happiness": 0.8}),
        ("surprise 0.8", {"surprise": 0.8}),
    ):
        picture = renderer.render(deformer.at(infer.pose(emotions)), _SIZE, "front", "portrait")
        panels.append((picture, title, "skin.texture"))
    return {"texture.png": png(sheet(panels, columns=len(panels)))}


def _painted(model: HeadModel) -> Image.Image:
    """Stripes on the cheeks, freckles between them."""
    picture = Image.new("RGBA", (_SIDE, _SIDE), (0, 0, 0, 0))
    pen, rng = ImageDraw.Draw(picture), np.random.default_rng(_SEED)
    at = model.uv[np.linalg.norm(model.vertices - model.landmarks["alare_l"], axis=1).argmin()]
    for row, colour in enumerate((_BLUE, _WHITE, _BLUE)):
        height = float(at[1]) + 0.045 * (row - 0.6)
        for side in (-1, 1):
            ends = [(0.5 + side * 0.10, height), (0.5 + side * 0.27, height - 0.03)]
            pen.line([(_SIDE * x, _SIDE * y) for x, y in ends], colour, round(0.02 * _SIDE))
    for x, y in rng.normal((0.5, float(at[1]) - 0.06), (0.12, 0.03), (160, 2)):
        size = rng.uniform(0.001, 0.0028)
        pen.ellipse([_SIDE * (x - size), _SIDE * (y - size), _SIDE * (x + size), _SIDE * (y + size)], _FRECKLE)
    return picture.filter(ImageFilter.GaussianBlur(0.8))


def _panel(picture: Image.Image) -> Bytes:
    """The middle of a picture as high as the others, on black."""
    width, height = _SIZE
    upright = picture.resize((height, height), Image.Resampling.LANCZOS)
    left = (height - width) // 2
    panel = Image.new("RGBA", _SIZE, (0, 0, 0, 255))
    panel.alpha_composite(upright.crop((left, 0, left + width, height)))
    return np.asarray(panel.convert("RGB"))
