"""The hair of the head on the GPU: a dark layer on the scalp, and strands grown when a quality is first drawn."""

from __future__ import annotations

from typing import Any

import numpy as np

from agentface.anatomy.model import HeadModel
from agentface.view.anchored import AnchoredArray
from agentface.view.grow import grow
from agentface.view.hair import Hairline, scalp_cap
from agentface.view.look import HairLook
from agentface.view.refine import vertex_normals
from agentface.view.strands import StrandArray

_SEED = 20
_STREAKS = {"fast": 1.6, "portrait": 1.7}
_NARROWEST = {"fast": 0.9, "portrait": 0.5}
_OUTERMOST = {"fast": 0.5, "portrait": 0.75}
"""The part of long strands that is drawn: what lies deeper is hidden by them."""
_GLOSS = {"cropped": 0.25, "swept": 0.8, "bob": 0.9, "bun": 0.9}


class HeadHair:
    """Hair of any style but ``none``; ``cap`` and ``strand`` are programs that know the frame."""

    def __init__(self, context: Any, cap: Any, strand: Any, model: HeadModel, look: HairLook) -> None:
        self._context, self._program, self._model, self._look = context, strand, model, look
        mesh = scalp_cap(model, Hairline(model, look.hairline), look)
        self._cap = AnchoredArray(context, cap, mesh, model.vertices)
        self._strands: dict[str, StrandArray] = {}
        cap["hair_colour"].value = tuple(look.colour)
        strand["hair_centre"].value = (0.0, 0.4 * model.landmarks.eye_separation, -0.012)
        strand["gloss"].value = _GLOSS[look.style]

    def draw_solid(self, quality: str) -> None:
        """Draw what hides what is behind it: to be done without blending."""
        strands = self._strands_for(quality)
        self._program["narrowest"].value = _NARROWEST[quality]
        self._program["streaks"].value = _STREAKS[quality]
        strands.draw_solid(1.0 if self._look.style == "cropped" else _OUTERMOST[quality])

    def draw_soft(self, quality: str, onto: Any) -> None:
        """Draw what blends, after everything solid, into the framebuffer ``onto``."""
        self._context.enable(self._context.CULL_FACE)
        self._cap.draw()
        self._context.disable(self._context.CULL_FACE)
        onto.depth_mask = False  # a nearly clear hair hides nothing
        self._strands_for(quality).draw_fine()
        onto.depth_mask = True

    def _strands_for(self, quality: str) -> StrandArray:
        if quality not in self._strands:
            model = self._model
            normals = vertex_normals(model.vertices, model.triangles)
            strands = grow(model, normals, self._look, quality, np.random.default_rng(_SEED))
            self._strands[quality] = StrandArray(self._context, self._program, strands, model.vertices)
        return self._strands[quality]
