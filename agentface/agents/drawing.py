""":class:`Drawing`: how pictures of a face look, and :class:`Painter`, who draws them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from agentface.conventions import Bytes
from agentface.deform.geometry import FaceGeometry
from agentface.errors import InvalidValueError, UnknownNameError
from agentface.head.model import HeadModel

if TYPE_CHECKING:
    from agentface.view.renderer import Renderer

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


class Painter:
    """Draws one face in the thread that makes its first picture.

    Args:
        model: the face.
        look: the name of a look of this face, or the path of its file; the face's own when None.
    """

    def __init__(self, model: HeadModel, look: str | None = None) -> None:
        self._model, self._look = model, look
        self._renderer: Renderer | None = None

    def draw(self, geometry: FaceGeometry, drawing: Drawing) -> Bytes:
        """A picture, ``(height, width, channels)``; raises GraphicsError, UnknownNameError."""
        if self._renderer is None:
            from agentface.head.look import load_look
            from agentface.view.renderer import Renderer

            self._renderer = Renderer(self._model, load_look(self._model, self._look))
        alpha = drawing.background != LOOK
        image = self._renderer.render(geometry, drawing.size, drawing.camera, drawing.quality, alpha=alpha)
        return image if isinstance(drawing.background, str) else _over(image, drawing.background)

    def close(self) -> None:
        """Give back what was taken from the graphics driver; may be called twice."""
        renderer, self._renderer = self._renderer, None
        if renderer is not None:
            renderer.close()


def _over(image: Bytes, colour: tuple[int, int, int]) -> Bytes:
    """A picture with straight alpha over one colour."""
    alpha = image[..., 3:].astype(np.uint16)
    mixed = image[..., :3] * alpha + np.array(colour, np.uint16) * (255 - alpha)
    return ((mixed + 127) // 255).astype(np.uint8)


def _whole_numbers(where: str, values: Any, count: int, low: int, high: int) -> None:
    whole = isinstance(values, tuple) and len(values) == count
    if not whole or not all(type(value) is int and low <= value <= high for value in values):
        raise InvalidValueError(where, f"{count} whole numbers in {low}..{high}", values)
