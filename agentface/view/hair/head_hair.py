"""The hair of the head on the GPU: a dark layer on the scalp, and strands grown when a quality is first drawn."""

from __future__ import annotations

from typing import Any

import numpy as np

from agentface.conventions import Doubles, Floats
from agentface.head.look import HairLook
from agentface.head.model import HeadModel
from agentface.view.camera import Camera
from agentface.view.gl.programs import Programs
from agentface.view.gl.quality import quality_named
from agentface.view.hair.cap import Cap
from agentface.view.hair.grown import GrownHair
from agentface.view.hair.sheet_array import SheetArray
from agentface.view.hair.strands import StrandArray

STREAKS = {"fast": 6.0, "portrait": 7.0}
NARROWEST = {"fast": 0.9, "portrait": 0.5}


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
