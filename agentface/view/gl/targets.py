"""The framebuffers of one size and quality."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from agentface.conventions import Bytes
from agentface.errors import GraphicsError, InvalidValueError

LARGEST_SIDE = 8192


@dataclass(slots=True)
class Targets:
    """Where a picture is drawn and resolved.

    ``wanted`` samples a pixel were asked for, ``samples`` are had. ``scene`` is what is drawn into (``picture`` itself
    where there is one sample), ``picture`` the finished bytes, ``light`` their texture, ``backdrop`` what is behind
    the face once ``painted``, ``buffers`` what else they are made of, ``pixels (height, width, 4)`` what was read
    last, the bottom row first.
    """

    size: tuple[int, int]
    wanted: int
    samples: int
    scene: Any
    picture: Any
    light: Any
    backdrop: Any
    buffers: tuple[Any, ...]
    pixels: Bytes
    painted: bool = False

    @classmethod
    def make(cls, context: Any, size: tuple[int, int], samples: int) -> Targets:
        """Framebuffers of ``size`` (width, height) pixels; raises GraphicsError when they do not fit the driver."""
        import moderngl

        wanted, samples = samples, min(samples, int(context.max_samples))
        try:
            light, behind = context.texture(size, 4), context.renderbuffer(size, 4)
            depth = context.depth_renderbuffer(size, samples=samples)
            buffers = [depth, behind]
            picture = scene = context.framebuffer([light], None if samples else depth)
            if samples:
                buffers.append(context.renderbuffer(size, 4, samples=samples))
                scene = context.framebuffer([buffers[-1]], depth)
            backdrop = context.framebuffer([behind])
        except moderngl.Error as error:
            raise GraphicsError(
                f"a picture of {size[0]}x{size[1]} pixels: expected the driver to hold it, got: {error}"
            ) from error
        pixels = np.empty((size[1], size[0], 4), np.uint8)
        return cls(size, wanted, samples, scene, picture, light, backdrop, tuple(buffers), pixels)

    def read(self, *, alpha: bool = False) -> Bytes:
        """The picture ``(height, width, 3)``, the top row first; ``alpha``: 4, straight."""
        self.picture.read_into(self.pixels, components=4, alignment=1)
        upright = self.pixels[::-1]
        pixels = np.empty((*upright.shape[:2], 4 if alpha else 3), np.uint8)
        for channel in range(pixels.shape[2]):  # much faster than a slice of all three
            pixels[..., channel] = upright[..., channel]
        if alpha:
            cover = pixels[..., 3]
            edge = (cover > 0) & (cover < 255)
            colour = pixels[edge].astype(np.float32)
            colour[:, :3] *= 255 / colour[:, 3:]
            pixels[edge] = np.minimum(colour + 0.5, 255).astype(np.uint8)
        return pixels

    def release(self) -> None:
        """Give the memory back."""
        for item in (self.scene, self.picture, self.backdrop, self.light, *self.buffers):
            item.release()  # a second time, where scene and picture are one, does nothing


def checked_size(size: Any) -> tuple[int, int]:
    """Width and height in pixels; raises InvalidValueError unless both are whole numbers in 1..8192."""
    expected = f"(width, height), whole numbers of pixels in 1..{LARGEST_SIDE}"
    try:
        width, height = size
    except (TypeError, ValueError):
        raise InvalidValueError("size", expected, size) from None
    if not all(isinstance(side, (int, np.integer)) and not isinstance(side, bool) for side in (width, height)):
        raise InvalidValueError("size", expected, size)
    if not (1 <= width <= LARGEST_SIDE and 1 <= height <= LARGEST_SIDE):
        raise InvalidValueError("size", expected, size)
    return int(width), int(height)
