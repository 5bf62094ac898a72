"""A picture file that a face wears as skin: read, and held against its limits."""

from __future__ import annotations

import warnings
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from agentface.conventions import Bytes
from agentface.errors import DataError, Fault

if TYPE_CHECKING:
    from PIL.Image import Image

LARGEST_SIDE = 8192
SIDE = 2048
"""Pixels: what is larger is made smaller."""
_FORMATS = ("PNG", "JPEG", "WEBP")
_MODES = ("1", "L", "LA", "P", "PA", "RGB", "RGBA", "CMYK", "YCbCr")


def read_texture(path: str | Path, largest: int = SIDE) -> Bytes:
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
