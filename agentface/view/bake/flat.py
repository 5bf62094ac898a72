"""Pictures of what shaders paint by pixel, without light, for programs that have textures and no such shaders."""

from __future__ import annotations

from typing import Any

import numpy as np

from agentface.conventions import Bytes, Floats, Indices
from agentface.head.look import HairLook, Look
from agentface.head.skin_image import bled
from agentface.view.gl.context import compile_program
from agentface.view.gl.noise import SIDE, noise_volume
from agentface.view.hair.grown import GrownHair
from agentface.view.hair.sheets import PAINTED
from agentface.view.parts.rigid import IRIS_RADIUS

EYE_INSET = 0.96
"""Of half the side of the eye's picture, the eyeball's radius."""
_SEED = 20
_COVER = 0.02
_DULL, _BRIGHT = 0.75, 1.7
_COILED, _SMOOTH = 1.0, 0.6
_SCALP = 0.55


class FlatPainter:
    """Draws such pictures into ``context``, a ``moderngl.Context`` that is current; it may be changed.

    Pictures are ``(size, size, 4)`` uint8 sRGB with straight alpha, their first row at texture coordinate v = 0.
    """

    def __init__(self, context: Any) -> None:
        self._context = context
        noise = noise_volume(np.random.default_rng(_SEED))
        self._noise = context.texture3d((SIDE,) * 3, 4, noise.tobytes())

    def eye(self, look: Look, size: int) -> Bytes:
        """An eyeball from the front: x to the person's left from u 0 to 1, y upward from v 0 to 1."""
        eyes = look.eyes
        values = {
            "iris_inner": tuple(eyes.iris_inner),
            "iris_outer": tuple(eyes.iris_outer),
            "sclera": tuple(eyes.sclera),
            "pupil_radius": eyes.pupil,
            "iris_radius": IRIS_RADIUS,
            "dilation": 1.0,
            "inset": EYE_INSET,
        }
        return self._drawn(self._program("screen", "eye_flat", values), size)

    def sheet(self, look: HairLook, size: int) -> Bytes:
        """Long hair, spread out flat: across a sheet's locks, then cards, from u 0 to 1, along it from v 0 to 1."""
        values = {
            "locks": float(PAINTED),
            "dull_colour": srgb(_DULL * np.array(look.colour)),
            "bright_colour": srgb(_BRIGHT * np.array(look.colour)),
            "least_cover": _COVER,
        }
        return bled(self._drawn(self._program("sheet_flat", "sheet", values), size))

    def cap(self, look: Look, grown: GrownHair, mesh: tuple[Floats, Floats, Floats, Indices], size: int) -> Bytes:
        """The layer on the scalp: ``mesh`` is its ``uv (N, 2)``, places at rest, depths ``(N, 1)`` and triangles."""
        values = {
            "lit_colour": srgb((_COILED if grown.coils else _SMOOTH) * np.array(look.hair.colour)),
            "scalp_colour": srgb(_SCALP * np.array(look.skin.tone)),
            "coils": grown.coils,
            "parting": grown.parting,
        }
        program = self._program("cap_flat", "cap", values)
        layout = [
            (self._context.buffer(np.ascontiguousarray(rows, np.float32).tobytes()), f"{rows.shape[1]}f", name)
            for name, rows in zip(("uv", "rest", "depth"), mesh[:3], strict=True)
        ]
        corners = self._context.buffer(mesh[3].astype(np.int32).tobytes())
        return bled(self._drawn(self._context.vertex_array(program, layout, corners), size))

    def _program(self, vertex: str, fragment: str, values: dict[str, Any]) -> Any:
        program = compile_program(self._context, f"{vertex}.vert.glsl", f"{fragment}.frag.glsl")
        for name, value in values.items():
            program[name].value = value
        if "noise_volume" in program:
            program["noise_volume"].value = 0
        return program

    def _drawn(self, what: Any, size: int) -> Bytes:
        """The picture of an array of triangles, or of a program that fills it."""
        context = self._context
        target = context.framebuffer(context.texture((size, size), 4))
        target.use()
        target.clear(0.0, 0.0, 0.0, 0.0)
        context.enable_only(context.NOTHING)
        self._noise.use(0)
        if hasattr(what, "vertices"):
            what.render()
        else:
            context.vertex_array(what, []).render(context.TRIANGLES, 3)
        drawn = np.frombuffer(target.read(components=4), np.uint8).reshape(size, size, 4)
        target.release()
        return drawn


def srgb(linear: np.typing.ArrayLike) -> tuple[float, ...]:
    """Linear colours 0..1 as sRGB 0..1 (IEC 61966-2-1)."""
    rows = np.clip(np.asarray(linear, np.float64), 0.0, 1.0)
    encoded = np.where(rows <= 0.0031308, 12.92 * rows, 1.055 * rows ** (1 / 2.4) - 0.055)
    return tuple(encoded.tolist())
