"""A picture worn as skin, made ready to be sampled with mipmaps."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from agentface.conventions import Bytes, Floats
from agentface.head.look import Look
from agentface.head.texture_file import SIDE, read_texture

_SRGB8_ALPHA8 = 0x8C43  # OpenGL's number


def skin_image(look: Look, largest: int = SIDE) -> Bytes | None:
    """The picture that ``look`` wears as skin, or None when it wears none or none of it shows.

    ``(H, W, 4)`` uint8, the top row first, at most ``largest`` pixels a side: sRGB, and straight (not premultiplied)
    alpha: how much of the picture shows, ``skin.texture_strength`` included. Where nothing shows lie the colours round
    about, so that filtering brings in no dark rims.

    Raises DataError when the file cannot be read any more; ``read_look`` has held it against its limits.
    """
    if look.skin.texture is None or look.skin.texture_strength == 0.0:
        return None
    image = read_texture(Path(look.skin.texture), largest)
    if not image[..., 3].any():
        return None
    image = bled(image)
    image[..., 3] = np.round(look.skin.texture_strength * image[..., 3])
    return image


def skin_texture(context: Any, look: Look) -> Any | None:
    """The texture ``skin_picture`` of ``shaders/paint.glsl``, or None; raises DataError as :func:`skin_image`."""
    image = skin_image(look)
    if image is None:
        return None
    height, width = image.shape[:2]
    texture = context.texture((width, height), 4, image.tobytes(), internal_format=_SRGB8_ALPHA8)
    texture.build_mipmaps()
    texture.repeat_x = texture.repeat_y = False
    return texture


def bled(image: Bytes) -> Bytes:
    """A copy of ``(H, W, 4)`` whose texels of alpha 0 have the colour of those round about that show.

    Source: the pull-push of S. J. Gortler et al., The Lumigraph, SIGGRAPH 1996, section 3.4: means over ever larger
    squares, and from the largest down every hole is filled with the mean of the square it lies in.
    """
    result = image.copy()
    shown = image[..., 3] > 0
    if shown.all() or not shown.any():
        return result
    holes = ~shown
    texels = np.zeros((*shown.shape, 4), np.float32)  # colours, and 1 where they are known
    texels[shown, :3] = image[shown, :3]
    texels[..., 3] = shown
    result[holes, :3] = np.round(_filled(texels)[holes, :3])
    return result


def _filled(texels: Floats) -> Floats:
    """``texels (H, W, 4)``, all 0 in their holes and otherwise with a 1 behind the colour, with the holes filled."""
    holes = texels[..., 3] == 0.0
    if not holes.any():
        return texels
    height, width = holes.shape
    even = np.pad(texels, [(0, height % 2), (0, width % 2), (0, 0)])
    rows = even[0::2] + even[1::2]
    sums = rows[:, 0::2] + rows[:, 1::2]
    sums /= np.maximum(sums[..., 3:], 1.0)
    row, column = np.nonzero(holes)
    texels[row, column] = _filled(sums)[row // 2, column // 2]
    return texels
