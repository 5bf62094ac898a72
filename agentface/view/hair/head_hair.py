"""The hair of the head on the GPU: a dark layer on the scalp, and strands grown when a quality is first drawn."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

import numpy as np

from agentface.cache import stamp_of
from agentface.conventions import Doubles, Floats
from agentface.head.look import HairLook
from agentface.head.model import HeadModel
from agentface.view.camera import Camera
from agentface.view.gl.programs import Programs
from agentface.view.gl.quality import quality_named
from agentface.view.hair.cap import Cap, scalp_cap
from agentface.view.hair.groom import groom
from agentface.view.hair.hairline import Hairline
from agentface.view.hair.hull import Hull
from agentface.view.hair.sheets import Sheet, SheetArray, edge_shade, flyaways, parting_line, sheets
from agentface.view.hair.strands import StrandArray, Strands
from agentface.view.hair.styles import PARTED, STYLES
from agentface.view.parts.anchored import Anchored

_T = TypeVar("_T")
_SEED = 20
STREAKS = {"fast": 6.0, "portrait": 7.0}
NARROWEST = {"fast": 0.9, "portrait": 0.5}
_GLOSS = {"cropped": 0.25, "swept": 0.8, "bob": 0.9, "bun": 0.9}
_NO_PARTING = 1.0, 1.0, 1.0, 1.0
"""The uniform ``parting`` of ``shaders/cap.frag.glsl``, far from the head."""


class GrownHair:
    """Hair of any style but ``none``, as it grows at rest.

    ``centre (3,)`` m is that of the head; ``sheets`` are long hair, ``parting (4,)`` where it parts, as the uniform of
    ``shaders/cap.frag.glsl``.
    """

    def __init__(self, model: HeadModel, look: HairLook) -> None:
        self._model, self._look = model, look
        self.centre = np.array([0.0, 0.4 * model.landmarks.eye_separation, -0.012])
        self.sheets: list[Sheet] = []
        self.parting: tuple[float, ...] = _NO_PARTING
        if look.style in PARTED:
            line, self.sheets = self._kept("sheets", self._grow_sheets)
            self.parting = tuple(line[[0, 0, -1, -1], [0, 2, 0, 2]].tolist())

    @property
    def gloss(self) -> float:
        """How much it shines, 0..1."""
        return _GLOSS[self._look.style]

    @property
    def coils(self) -> float:
        """1 where what one sees of the cap is the hair itself, else 0."""
        return float(self._look.style == "cropped")

    def cap(self) -> Anchored:
        """The layer on the scalp."""
        return scalp_cap(self._model, Hairline(self._model, self._look.hairline), self._look)

    def shade(self, skin: Floats) -> Doubles:
        """``(V,)`` 0..1: the part of the surroundings' light that hair at the face keeps off the ``skin (V, 3)``."""
        return edge_shade(self.sheets, skin)

    def strands(self, quality: str) -> Strands:
        """The strands of a quality."""
        return self._kept(f"strands.{quality}", lambda: self._grow_strands(quality))

    def _kept(self, name: str, grow_it: Callable[[], _T]) -> _T:
        return self._model.derived(f"view.{name}.{stamp_of((), repr(self._look))}", lambda _: grow_it())

    def _grow_sheets(self) -> tuple[Doubles, list[Sheet]]:
        hull = Hull(self._model, ears=True)
        line = parting_line(self._model, self._look, hull)
        return line, sheets(self._model, self._look, hull, np.random.default_rng(_SEED))

    def _grow_strands(self, quality: str) -> Strands:
        model, look, rng = self._model, self._look, np.random.default_rng(_SEED)
        if self.sheets:
            return flyaways(self.sheets, STYLES[look.style].amounts[quality], look, rng).in_order(model)
        return groom(model, model.normals, look, quality, rng)


class HeadHair:
    """What has grown, on the GPU."""

    def __init__(self, context: Any, programs: Programs, model: HeadModel, look: HairLook, grown: GrownHair) -> None:
        cap, strand, sheet = (programs[name] for name in ("cap", "strand", "sheet"))
        self._context, self._program, self._model, self._grown = context, strand, model, grown
        self._cap = Cap(context, cap, grown.cap(), model.vertices)
        self._strands: dict[str, StrandArray] = {}
        cap["hair_colour"].value = tuple(look.colour)
        cap["coils"].value = grown.coils
        cap["parting"].value = grown.parting
        strand["hair_centre"].value = tuple(grown.centre)
        self._sheets: SheetArray | None = None
        if grown.sheets:
            self._sheets = SheetArray(context, sheet, grown.sheets, model, grown.centre)
            sheet["hair_colour"].value = tuple(look.colour)
        programs.set({"gloss": grown.gloss})

    def draw_solid(self, quality: str, camera: Camera, head: Floats) -> None:
        """Draw what hides what is behind it, seen by ``camera`` with the head turned by ``head (4, 4)``."""
        eye: Doubles = np.linalg.solve(head.astype(np.float64), np.array([*camera.eye, 1.0]))[:3]
        self._program["narrowest"].value = NARROWEST[quality]
        self._program["streaks"].value = STREAKS[quality]
        if self._sheets is not None:
            self._sheets.draw(eye, fine=quality_named(quality).fine)
        self._strands_for(quality).draw_solid(eye)
        self._context.enable(self._context.CULL_FACE)
        self._cap.draw_solid()
        self._context.disable(self._context.CULL_FACE)

    def draw_inside(self) -> None:
        """Draw hair that is seen from inside, after the skin."""
        if self._sheets is not None:
            self._sheets.draw_inside()

    def draw_soft(self, quality: str, onto: Any) -> None:
        """Draw what blends, after everything solid, into the framebuffer ``onto``; after :meth:`draw_solid`."""
        self._context.enable(self._context.CULL_FACE)
        self._cap.draw_soft()
        self._context.disable(self._context.CULL_FACE)
        onto.depth_mask = False  # a nearly clear hair hides nothing
        self._strands_for(quality).draw_fine()
        onto.depth_mask = True

    def _strands_for(self, quality: str) -> StrandArray:
        if quality not in self._strands:
            strands = self._grown.strands(quality)
            self._strands[quality] = StrandArray(self._context, self._program, strands, self._model, self._grown.centre)
        return self._strands[quality]
