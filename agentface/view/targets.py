"""The framebuffers of one size and quality."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from agentface.errors import GraphicsError

_SHADOW_SIDE = 512


@dataclass(slots=True)
class Targets:
    """Where a picture is drawn, resolved and developed.

    ``wanted`` samples a pixel were asked for, ``samples`` are had. ``scene`` holds linear light (with several samples where ``samples`` says so), ``light`` is its resolved
    texture, ``picture`` the finished bytes.
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
            raise GraphicsError(f"a picture of {size[0]}x{size[1]} pixels: expected the driver to hold it, got: {error}") from error
        return cls(size, wanted, samples, scene, resolved, light, picture)

    def release(self) -> None:
        """Give the memory back."""
        for item in {id(item): item for item in (self.scene, self.resolved, self.light, self.picture)}.values():
            item.release()


class KeyShadow:
    """The key light's picture of depths."""

    def __init__(self, context: Any) -> None:
        self.context = context
        self.depth = context.depth_texture((_SHADOW_SIDE, _SHADOW_SIDE))
        self.depth.compare_func = "<="
        self.depth.repeat_x = self.depth.repeat_y = False
        self.depth.filter = (context.LINEAR, context.LINEAR)
        self.target = context.framebuffer(depth_attachment=self.depth)

    def draw(self, caster: Any) -> None:
        """Draw ``caster``, a vertex array of a program that writes depth only."""
        self.target.use()
        self.target.clear(depth=1.0)
        self.context.enable_only(self.context.DEPTH_TEST)
        caster.render()

    def use(self, slot: int) -> None:
        """Bind the depths to a texture slot."""
        self.depth.use(slot)
