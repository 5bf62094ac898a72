"""The framebuffers of one size and quality."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from agentface.errors import GraphicsError


@dataclass(slots=True)
class Targets:
    """Where a picture is drawn, resolved and developed.

    ``wanted`` samples a pixel were asked for, ``samples`` are had. ``scene`` holds linear light (several samples
    where ``samples`` says so), ``light`` is its resolved texture, ``picture`` the finished bytes.
    """

    size: tuple[int, int]
    wanted: int
    samples: int
    scene: Any
    resolved: Any
    light: Any
    picture: Any

    @classmethod
    def make(cls, context: Any, size: tuple[int, int], samples: int) -> Targets:
        """Framebuffers of ``size`` (width, height) pixels; raises GraphicsError when they do not fit the driver."""
        import moderngl

        wanted, samples = samples, min(samples, int(context.max_samples))
        try:
            light = context.texture(size, 4, dtype="f2")
            light.repeat_x = light.repeat_y = False
            resolved = context.framebuffer([light], None if samples else context.depth_renderbuffer(size))
            scene = resolved
            if samples:
                colour = context.renderbuffer(size, 4, samples=samples, dtype="f2")
                scene = context.framebuffer([colour], context.depth_renderbuffer(size, samples=samples))
            picture = context.framebuffer([context.renderbuffer(size, 4)])
        except moderngl.Error as error:
            raise GraphicsError(
                f"a picture of {size[0]}x{size[1]} pixels: expected the driver to hold it, got: {error}"
            ) from error
        return cls(size, wanted, samples, scene, resolved, light, picture)

    def release(self) -> None:
        """Give the memory back."""
        for item in {id(item): item for item in (self.scene, self.resolved, self.light, self.picture)}.values():
            item.release()
