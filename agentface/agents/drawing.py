""":class:`Drawing`: how the pictures of a speaker look."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from agentface.conventions import Bytes
from agentface.errors import InvalidValueError, UnknownNameError
from agentface.face import Face

LOOK, TRANSPARENT = "look", "transparent"
BACKGROUNDS = (LOOK, TRANSPARENT)
Background = str | tuple[int, int, int]
_SMALLEST, _LARGEST = 16, 4096


@dataclass(frozen=True, slots=True)
class Drawing:
    """What is drawn of a face.

    Attributes:
        size: width and height in pixels, 16..4096.
        camera: ``front``, ``three-quarter`` or ``profile``.
        quality: ``fast`` or ``portrait``.
        background: ``look``, the one of the face's look; ``transparent``; or one colour, red, green and blue in 0..255.

    Raises InvalidValueError, UnknownNameError; a camera or a quality that there is not where it is drawn first.
    """

    size: tuple[int, int] = (512, 512)
    camera: str = "front"
    quality: str = "fast"
    background: Background = LOOK

    def __post_init__(self) -> None:
        _whole_numbers("size", self.size, 2, _SMALLEST, _LARGEST)
        if isinstance(self.background, str):
            if self.background not in BACKGROUNDS:
                raise UnknownNameError("background", self.background, BACKGROUNDS)
        else:
            _whole_numbers("background", self.background, 3, 0, 255)

    @property
    def channels(self) -> int:
        """3 for red, green and blue, 4 with alpha."""
        return 4 if self.background == TRANSPARENT else 3

    def draw(self, face: Face) -> Bytes:
        """A picture of the face as shown now, ``(height, width, channels)``; raises GraphicsError."""
        image = face.render(self.size, self.camera, self.quality, alpha=self.background != LOOK)
        return image if isinstance(self.background, str) else _over(image, self.background)


def _over(image: Bytes, colour: tuple[int, int, int]) -> Bytes:
    """A picture with straight alpha over one colour."""
    alpha = image[..., 3:].astype(np.uint16)
    mixed = image[..., :3] * alpha + np.array(colour, np.uint16) * (255 - alpha)
    return ((mixed + 127) // 255).astype(np.uint8)


def _whole_numbers(where: str, values: Any, count: int, low: int, high: int) -> None:
    whole = isinstance(values, tuple) and len(values) == count
    if not whole or not all(type(value) is int and low <= value <= high for value in values):
        raise InvalidValueError(where, f"{count} whole numbers in {low}..{high}", values)
