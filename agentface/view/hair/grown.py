"""The hair of a head as it grows at rest, grown once and kept."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar

import numpy as np

from agentface.cache import stamp_of
from agentface.conventions import Doubles, Floats
from agentface.head.look import HairLook
from agentface.head.model import HeadModel
from agentface.view.hair.cap import scalp_cap
from agentface.view.hair.cards import cards
from agentface.view.hair.drape import parting_line
from agentface.view.hair.flyaways import baby_hairs, edge_hairs, flyaways
from agentface.view.hair.groom import groom
from agentface.view.hair.hairline import Hairline
from agentface.view.hair.hull import Hull
from agentface.view.hair.sheets import Sheet, edge_shade, sheets
from agentface.view.hair.strands import Strands
from agentface.view.hair.styles import PARTED, STYLES, parting_of
from agentface.view.parts.anchored import Anchored

_T = TypeVar("_T")
_SEED, _LONG_SEED = 20, 22
_GLOSS = {"cropped": 0.25, "swept": 0.8, "bob": 1.15, "bun": 0.9}
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
        self._cards: list[Sheet] = []
        self._beneath: list[Sheet] = []
        self.parting: tuple[float, ...] = _NO_PARTING
        if look.style in PARTED:
            line, self._cards, self._beneath = self._kept("sheets", self._grow_sheets)
            self.parting = tuple(line[[0, 0, -1, -1], [0, 2, 0, 2]].tolist())

    @property
    def sheets(self) -> list[Sheet]:
        """Long hair: cards, and what is seen between them; what gets the most light hides the rest, and comes first."""
        return sorted(self._cards + self._beneath, key=lambda sheet: -float(sheet.places[..., 2].max()))

    @property
    def layers(self) -> list[list[Sheet]]:
        """The cards, and the sheets below them; none of hair that is not long."""
        return [layer for layer in (self._cards, self._beneath) if layer]

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
        return edge_shade(self._beneath, skin)

    def strands(self, quality: str) -> Strands:
        """The strands of a quality."""
        return self._kept(f"strands.{quality}", lambda: self._grow_strands(quality))

    def _kept(self, name: str, grow_it: Callable[[], _T]) -> _T:
        return self._model.derived(f"view.{name}.{stamp_of((), repr(self._look))}", lambda _: grow_it())

    def _grow_sheets(self) -> tuple[Doubles, list[Sheet], list[Sheet]]:
        hull = Hull(self._model, ears=True, moving=True)
        line = parting_line(self._model, self._look, hull)
        rng = np.random.default_rng(_LONG_SEED)
        grown = cards(self._model, self._look, hull, rng), sheets(self._model, self._look, hull, rng)
        return line, *grown

    def _grow_strands(self, quality: str) -> Strands:
        model, look, rng = self._model, self._look, np.random.default_rng(_SEED)
        if self._cards:
            amount = STYLES[look.style].amounts[quality]
            short = baby_hairs(model, amount, look, parting_of(model, look), rng)
            edge = edge_hairs(model, self._beneath, amount, look, rng)
            return flyaways(self._cards, amount, look, rng).joined(short).joined(edge).in_order(model)
        return groom(model, model.normals, look, quality, rng)
