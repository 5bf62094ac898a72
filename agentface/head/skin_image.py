"""A picture worn as skin: read, held against its limits, and made ready to be sampled with mipmaps."""

from __future__ import annotations

import warnings
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from agentface.conventions import Bytes, Floats
from agentface.errors import DataError, Fault

if TYPE_CHECKING:
    from PIL.Image import Image

    from agentface.head.look import Look

LARGEST_SIDE = 8192
_FORMATS = ("PNG", "JPEG", "WEBP")
_SIDE = 2048
_SRGB8_ALPHA8 = 0x8C43  # OpenGL's number
_MODES = ("1", "L", "LA", "P", "PA", "RGB", "RGBA", "CMYK", "YCbCr")


def skin_image(look: Look, largest: int = _SIDE) -> Bytes | None:
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


def read_texture(path: str | Path, largest: int = _SIDE) -> Bytes:
    """The picture at ``path`` as read-only ``(H, W, 4)`` uint8 with straight alpha, made smaller to fit ``largest``.

    Raises DataError for no file, no PNG, JPEG or WebP of 8 bits a channel, a damaged or a too large one.
    """
    path = Path(path)
    try:
        status = path.stat()
    except (OSError, ValueError) as error:
        raise _refused(path, "a picture file", getattr(error, "strerror", None) or str(error)) from None
    if not path.is_file():
        raise _refused(path, "a picture file", "a folder" if path.is_dir() else "something else")
    return _decoded(path, status.st_mtime_ns, status.st_size, largest)


@lru_cache(maxsize=1)  # read_look decodes to see whether it can be; the renderer wants the same a moment later
def _decoded(path: Path, _mtime_ns: int, _bytes: int, largest: int) -> Bytes:
    from PIL import Image, ImageOps, UnidentifiedImageError

    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # what PIL warns of, such as many pixels, is looked at below
            with Image.open(path, formats=_FORMATS) as opened:
                _check(path, opened)
                opened.draft("RGB", (largest, largest))
                upright = ImageOps.exif_transpose(opened).convert("RGBA")
    except UnidentifiedImageError:
        raise _refused(path, f"a picture: {', '.join(_FORMATS)}", "something else") from None
    except Image.DecompressionBombError:
        raise _refused(path, _SIDES, "far more") from None
    except DataError:
        raise
    except Exception as error:  # decoders raise whatever a damaged file leads them to
        raise _refused(path, "an undamaged picture", str(error) or type(error).__name__) from error
    upright.thumbnail((largest, largest), Image.Resampling.HAMMING)  # weighs colours by alpha; no overshoot
    image = np.array(upright)
    image.setflags(write=False)
    return image


_SIDES = f"at most {LARGEST_SIDE} x {LARGEST_SIDE} pixels"


def _check(path: Path, image: Image) -> None:
    if max(image.size) > LARGEST_SIDE:
        raise _refused(path, _SIDES, f"{image.width} x {image.height}")
    if image.mode not in _MODES:
        raise _refused(path, "8 bits a channel", f"pixels of the kind {image.mode}")


def _refused(path: Path, expected: str, got: str) -> DataError:
    return DataError([Fault(path, None, "", expected, got)])


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
