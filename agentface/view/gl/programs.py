"""The compiled shaders of a renderer, with what stays the same in every picture set."""

from __future__ import annotations

from typing import Any

from agentface.head.look import Look
from agentface.view.gl.context import compile_program
from agentface.view.gl.quality import QUALITIES

FRAME_BINDING = 0
_SLOTS = {
    "skin_fields": 0,
    "picture": 0,
    "noise_volume": 1,
    "key_depth": 2,
    "wrinkle_atlas": 3,
    "skin_picture": 4,
    "pores": 5,
}
SHADERS = {
    "part": ("part", "part"),
    "cloth": ("cloth", "cloth"),
    "eye": ("eye", "eye"),
    "ribbon": ("ribbon", "ribbon"),
    "strand": ("strand", "strand"),
    "sheet": ("sheet", "sheet"),
    "lining": ("anchored", "lining"),
    "cap": ("cap", "cap"),
    "background": ("screen", "background"),
    "copy": ("screen", "copy"),
}
_SELDOM = {"bone": ("bone", "bone"), "film": ("film", "film")}
"""Those that few renderers draw with: compiled when one is first asked for."""


def colours(look: Look) -> dict[str, Any]:
    """The uniforms that are the look's alone."""
    return {
        "skin_tone": look.skin.tone,
        "lip_tint": look.skin.lips,
        "shine": look.skin.shine,
        "hair_colour": look.hair.colour,
        "cloth": look.cloth,
        "teeth": look.teeth,
        "iris_inner": look.eyes.iris_inner,
        "iris_outer": look.eyes.iris_outer,
        "sclera": look.eyes.sclera,
        "pupil_radius": look.eyes.pupil,
        "background_inner": look.background_inner,
        "background_outer": look.background_outer,
        "exposure": look.exposure,
        "light_width": look.lights.width,
    }


class Programs:
    """Programs by name; a skin's has the names of its shaders, and ``-wrinkled`` behind them where it is.

    ``textured``: skins wear a picture.
    """

    def __init__(self, context: Any, *, textured: bool = False) -> None:
        self._context = context
        self._look: Look | None = None
        self._programs = {name: self._compile(*shaders) for name, shaders in SHADERS.items()}
        self.depth = self._compile("depth", None)
        for quality in QUALITIES.values():
            worn = ("TEXTURED",) if textured else ()
            self._programs[quality.skin] = self._compile(quality.skin, quality.skin, worn)
            self._programs[f"{quality.skin}-wrinkled"] = (
                self._compile(quality.skin, quality.skin, (*worn, "WRINKLED"))
                if quality.fine
                else self._programs[quality.skin]
            )

    def __getitem__(self, name: str) -> Any:
        if name in _SELDOM and name not in self._programs:
            self._programs[name] = self._compile(*_SELDOM[name])
            if self._look is not None:
                self.wear(self._look)
        return self._programs[name]

    def skins(self, skin: str) -> tuple[Any, Any]:
        """The programs of a skin that is smooth, and of one with wrinkles."""
        return self._programs[skin], self._programs[f"{skin}-wrinkled"]

    def set(self, values: dict[str, Any]) -> None:
        """Give the uniforms of these names their values, in all programs that have them."""
        for program in self._programs.values():
            for name, value in values.items():
                if name in program:  # a compiler drops what a shader does not use
                    program[name].value = tuple(value) if isinstance(value, list) else value

    def wear(self, look: Look) -> None:
        """Set the colours of ``look``."""
        self._look = look
        self.set(colours(look))

    def _compile(self, vertex: str, fragment: str | None, defines: tuple[str, ...] = ()) -> Any:
        program = compile_program(
            self._context, f"{vertex}.vert.glsl", fragment and f"{fragment}.frag.glsl", defines=defines
        )
        for name, slot in _SLOTS.items():
            if name in program:
                program[name].value = slot
        if "Frame" in program:
            program["Frame"].binding = FRAME_BINDING
        return program
