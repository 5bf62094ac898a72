"""A picture to paint on: the skin's own colours, spread over its texture coordinates."""

from __future__ import annotations

from typing import Any

import numpy as np

from agentface.conventions import Bytes, Floats, Indices
from agentface.head.look import Look
from agentface.head.model import HeadModel
from agentface.head.skin_image import bled
from agentface.head.unwrap import unwrap_centre
from agentface.view.gl.context import compile_program
from agentface.view.gl.ownership import Ownership
from agentface.view.skin.complexion import complexion
from agentface.view.skin.uncovered import uncovered

_INSIDE = 0.9  # of the material: nothing is left of the skin's own colour
_MARGIN = 2  # pixels beyond the skin's edge, so that filtering finds skin there


def skin_template(
    model: HeadModel, look: Look, size: int = 2048, context: Any = None, tints: Floats | None = None
) -> Bytes:
    """The skin of ``look`` as a picture ``(size, size, 4)`` uint8 sRGB, transparent where the face has no skin.

    Without what is drawn over a texture: hair, the inside of the mouth, light, the fine noise of the skin. Where layers
    of skin lie on one another (ears, the inside of the lips) the outermost is seen. ``tints (V, 4)`` are what
    :func:`complexion` gives, of skin without hair and beard when None.

    Raises GraphicsError when there is no OpenGL.
    """
    ownership = Ownership(context)
    try:
        with ownership.current():
            drawn = _drawn(ownership.maker, model, look, size, tints)
    finally:
        ownership.release()
    image = bled(drawn)
    image[..., 3] = _grown(drawn[..., 3], _MARGIN)
    return image


def flat_triangles(model: HeadModel) -> Indices:
    """``(T, 3)``: the triangles in the picture: none under the shirt, behind the picture's rim or inside the mouth."""
    triangles = uncovered(model)
    shown = (model.uv_cover > 0.0) & (model.material[:, 1] < _INSIDE)
    return np.asarray(triangles[shown[triangles].any(axis=1)])


def _drawn(context: Any, model: HeadModel, look: Look, size: int, tints: Floats | None) -> Bytes:
    program = compile_program(context, "unwrap.vert.glsl", "unwrap.frag.glsl")
    values: dict[str, Any] = {
        "skin_tone": look.skin.tone,
        "lip_tint": look.skin.lips,
        "hair_colour": look.hair.colour,
        "unwrap_centre": unwrap_centre(model.landmarks),
    }
    for name, value in values.items():
        if name in program:
            program[name].value = tuple(value)
    bare = complexion(model, np.zeros(len(model.vertices), np.float32)) if tints is None else tints
    fields = {"rest": model.vertices, "uv": model.uv, "material": model.material, "complexion": bare}
    layout = [
        (context.buffer(np.ascontiguousarray(field, np.float32).tobytes()), f"{field.shape[1]}f", name)
        for name, field in fields.items()
    ]
    corners = context.buffer(flat_triangles(model).astype(np.int32).tobytes())
    target = context.framebuffer(context.texture((size, size), 4), context.depth_renderbuffer((size, size)))
    target.use()
    target.clear(0.0, 0.0, 0.0, 0.0)
    context.enable_only(context.DEPTH_TEST)
    context.vertex_array(program, layout, corners).render()
    drawn = np.frombuffer(target.read(components=4), np.uint8).reshape(size, size, 4)
    target.release()
    return drawn


def _grown(mask: Bytes, times: int) -> Bytes:
    """``mask (H, W)`` with the largest of each pixel and its eight neighbours, ``times`` over."""
    for _ in range(times):
        for _axis in range(2):
            wide = np.pad(mask, [(1, 1), (0, 0)])
            mask = np.maximum(mask, np.maximum(wide[:-2], wide[2:])).T
    return mask
