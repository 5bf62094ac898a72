"""Pictures with captions side by side: what the figures of the documents are made of."""

from __future__ import annotations

from collections.abc import Sequence
from io import BytesIO
from typing import TYPE_CHECKING

import numpy as np

from agentface.conventions import Bytes
from agentface.errors import InvalidValueError

if TYPE_CHECKING:
    from PIL.Image import Image

GAP, CAPTION = 12, 52
INK = (40, 40, 44)
_COLOURS = 250
_LARGEST = 2**26  # pixels of a whole sheet


def check_sheet_size(size: tuple[int, int], count: int, columns: int) -> None:
    """Raise InvalidValueError when ``count`` panels of ``size`` pixels would make more than 67 megapixels."""
    pixels = columns * (size[0] + GAP) * -(-count // columns) * (size[1] + CAPTION + GAP)
    if pixels > _LARGEST:
        text = f"{count} pictures of {size[0]}x{size[1]}, {pixels / 1e6:.0f} megapixels"
        raise InvalidValueError("sheet", f"{_LARGEST / 1e6:.0f} megapixels together", text, "fewer or smaller pictures")


def sheet(panels: Sequence[tuple[Image | Bytes, str, str]], columns: int) -> Image:
    """Panels ``(picture, title, note)`` in rows of ``columns``; all pictures have the size of the first."""
    from PIL import Image as Images

    pictures = [Images.fromarray(picture) if isinstance(picture, np.ndarray) else picture for picture, _, _ in panels]
    width, height = pictures[0].size
    rows = -(-len(panels) // columns)
    size = (columns * (width + GAP) + GAP, rows * (height + CAPTION + GAP) + GAP)
    result = Images.new("RGB", size, (255, 255, 255))
    for i, (picture, (_, title, note)) in enumerate(zip(pictures, panels, strict=True)):
        place = (GAP + i % columns * (width + GAP), GAP + i // columns * (height + CAPTION + GAP))
        result.paste(picture, place)
        _caption(result, (place[0] + 4, place[1] + height), title, note)
    return result


def png(image: Image, palette: Bytes | None = None) -> bytes:
    """The PNG file of a picture in few colours: those of ``palette (N, 3)``, or the best for the picture, dithered."""
    from PIL import Image as Images

    dither = Images.Dither.FLOYDSTEINBERG
    if palette is None:
        colours = image.quantize(_COLOURS, method=Images.Quantize.MEDIANCUT)
    else:
        dither, colours = Images.Dither.NONE, Images.new("P", (1, 1))
        colours.putpalette(palette.tobytes())
    buffer = BytesIO()
    image.quantize(palette=colours, dither=dither).save(buffer, "PNG", optimize=True)
    return buffer.getvalue()


def _caption(image: Image, place: tuple[int, int], title: str, note: str) -> None:
    from PIL import ImageDraw, ImageFont

    draw = ImageDraw.Draw(image)
    draw.text((place[0], place[1] + 4), title, fill=INK, font=ImageFont.load_default(21))
    draw.text((place[0], place[1] + 29), note, fill=INK, font=ImageFont.load_default(16))
