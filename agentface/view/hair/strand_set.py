"""Strands before they are put in the order in which they are drawn, and their colours."""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np

from agentface.conventions import Doubles
from agentface.head.look import HairLook
from agentface.head.model import HeadModel
from agentface.view.hair.strands import Strands, nearest_vertices
from agentface.view.hair.visible import Flags

_GREY = 0.085


@dataclass(frozen=True, slots=True)
class StrandSet:
    """``points (N, P, 3)``, ``radii (N,)``, ``paint (N, 4)`` and ``cover (N, P)`` as in :class:`Strands`.

    ``layer (N,)`` is 0 next to the scalp and 1 outside; ``faint (N,)`` 1 for strands that blend, else 0.
    """

    points: Doubles
    radii: Doubles
    paint: Doubles
    cover: Doubles
    layer: Doubles
    faint: Doubles

    def joined(self, other: StrandSet) -> StrandSet:
        """Both."""
        return StrandSet(*(np.concatenate([getattr(self, f.name), getattr(other, f.name)]) for f in fields(self)))

    def chosen(self, kept: Flags) -> StrandSet:
        """Those of ``kept (N,)``."""
        return StrandSet(*(getattr(self, f.name)[kept] for f in fields(self)))

    def in_order(self, model: HeadModel) -> Strands:
        """Those that hide others, then those that blend, the outermost last."""
        order = np.argsort(np.where(self.faint > 0, 2 + self.layer, 1 - self.layer), kind="stable")
        points, radii, paint, cover = (
            field[order].astype(np.float32) for field in (self.points, self.radii, self.paint, self.cover)
        )
        anchors = nearest_vertices(self.points[order, 0], model.vertices)
        return Strands(points, anchors, radii, paint, cover, int((self.faint > 0).sum()))


def paints(
    look: HairLook, tint: Doubles, opacity: Doubles, rng: np.random.Generator, spread: float, *, single: bool = True
) -> Doubles:
    """``(N, 4)``: the hair's colour times ``tint``, each a little different by ``spread``.

    Some hairs are grey where each is a ``single`` one; locks have some of it each.
    """
    count = len(tint)
    shade = np.asarray(look.colour) * (tint * (1 + spread * (rng.random(count) - 0.5)))[:, None]
    pale = 0.7 * np.asarray(look.colour) + _GREY * (0.6 + 0.8 * rng.random((count, 1)))
    drawn = rng.random((count, 1))
    grey = 0.65 * (drawn < look.grey) if single else 0.65 * look.grey * 2 * drawn
    return np.column_stack([(1 - grey) * shade + grey * pale, opacity])
