"""The hair of a face, grown once and kept: sheets, strands, and what it does to the skin beside and below it."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar

import numpy as np

from agentface.cache import stamp_of
from agentface.conventions import Doubles, Floats
from agentface.head.look import HairLook
from agentface.head.model import HeadModel
from agentface.view.hair.brows import BrowLine
from agentface.view.hair.groom import groom
from agentface.view.hair.hairline import Hairline, hair_shade, hidden
from agentface.view.hair.hull import Hull
from agentface.view.hair.sheets import Sheet, edge_shade, flyaways, parting_line, sheets
from agentface.view.hair.strands import Strands
from agentface.view.hair.styles import PARTED, STYLES

_T = TypeVar("_T")
_SEED = 20
_BROW_TINT = 0.55


def grown_sheets(model: HeadModel, look: HairLook) -> tuple[Doubles, list[Sheet]] | None:
    """The parting ``(N, 3)`` m and the sheets, the outer ones first; None for a style that has none."""

    def grow() -> tuple[Doubles, list[Sheet]]:
        hull = Hull(model, ears=True)
        line = parting_line(model, look, hull)
        return line, sheets(model, look, hull, np.random.default_rng(_SEED))

    return _kept(model, look, "sheets", grow) if look.style in PARTED else None


def grown_strands(model: HeadModel, look: HairLook, quality: str) -> Strands:
    """The strands of a quality, of any style but ``none``; beside sheets these are single hairs."""

    def grow() -> Strands:
        rng, found = np.random.default_rng(_SEED), grown_sheets(model, look)
        if found is not None:
            return flyaways(found[1], STYLES[look.style].amounts[quality], look, rng).in_order(model)
        return groom(model, model.normals, look, quality, rng)

    return _kept(model, look, f"strands.{quality}", grow)


def covered(model: HeadModel, look: HairLook) -> Floats:
    """``(V,)`` 0..1: how much of the skin's colour is that of the hair on it, brows among it."""
    tint = _BROW_TINT * look.brow_density * BrowLine(model).density(model.vertices)
    if look.style != "none":
        tint = np.maximum(tint, hidden(model, Hairline(model, look.hairline), look))
    return np.asarray(np.clip(tint, 0, 1), np.float32)


def shade_on(model: HeadModel, look: HairLook) -> Doubles:
    """``(V,)`` 0..1: the part of the surroundings' light that hair keeps off the skin."""
    found, shade = grown_sheets(model, look), hair_shade(model, look)
    return shade if found is None else np.maximum(shade, edge_shade(found[1], model.vertices))


def _kept(model: HeadModel, look: HairLook, name: str, grow_it: Callable[[], _T]) -> _T:
    return model.derived(f"view.{name}.{stamp_of((), repr(look))}", lambda _: grow_it())
