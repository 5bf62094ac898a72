"""Guides over the picture to paint the skin on: the mesh's edges and the landmarks by name."""

from __future__ import annotations

import numpy as np

from agentface.conventions import Bytes
from agentface.head.model import HeadModel
from agentface.view.skin.template import flat_triangles

_FINER = 2
_EDGE = (60, 210, 255, 150)
_POINT = (200, 30, 20, 255)
_HALO = (255, 255, 255, 170)


def with_guides(image: Bytes, model: HeadModel) -> Bytes:
    """``image (N, N, 4)`` with the mesh's edges and the landmarks' names drawn over it."""
    from PIL import Image, ImageDraw, ImageFont

    size = len(image)
    over = Image.new("RGBA", (_FINER * size, _FINER * size), (*_EDGE[:3], 0))
    draw = ImageDraw.Draw(over)
    triangles = flat_triangles(model)
    edges = np.unique(np.sort(triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1), axis=0)
    for start, end in _FINER * size * model.uv[edges]:
        draw.line([tuple(start), tuple(end)], fill=_EDGE)
    result = Image.alpha_composite(Image.fromarray(image), over.resize((size, size), Image.Resampling.BOX))
    draw = ImageDraw.Draw(result)
    font, dot = ImageFont.load_default(max(size / 110, 8)), max(size / 700, 1)
    for name, place in _landmarks(model).items():
        x, y = size * place
        draw.ellipse([x - dot, y - dot, x + dot, y + dot], fill=_POINT)
        draw.text(
            (x + 2 * dot, y), name, fill=_POINT, font=font, anchor="lm", stroke_width=max(1, size // 900),
            stroke_fill=_HALO,
        )  # fmt: skip
    return np.array(result)


def _landmarks(model: HeadModel) -> dict[str, np.typing.NDArray[np.float32]]:
    """Where each landmark lies in the picture: at the vertex nearest to it."""
    return {
        name: model.uv[np.linalg.norm(model.vertices - place, axis=1).argmin()]
        for name, place in model.landmarks.items()
    }
