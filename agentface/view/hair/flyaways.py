"""Single hairs on long hair: those that leave their card, most of them at the face."""

from __future__ import annotations

import numpy as np

from agentface.head.look import HairLook
from agentface.view.hair.ribbons import unit_rows
from agentface.view.hair.sheets import Sheet
from agentface.view.hair.strand_set import StrandSet, paints
from agentface.view.hair.styles import Amount

_AWAY = 0.005
"""Metres that they leave it."""
_LOOSE, _LOOSE_AWAY = 0.18, 3.0
"""The part of them that leaves it farther, and how much farther."""
_ACROSS = 1.8
"""Half widths of a card within which they start."""


def flyaways(cards: list[Sheet], amount: Amount, look: HairLook, rng: np.random.Generator) -> StrandSet:
    """Single hairs that start on ``cards`` and leave them."""
    count, t = amount.hairs, np.linspace(0.0, 1.0, amount.points)
    grids = np.stack([card.points for card in cards]).astype(np.float64)
    chosen, rows = rng.integers(0, len(cards), count), grids.shape[2]
    middle, aside = grids[chosen].mean(axis=1), grids[chosen, 1] - grids[chosen, 0]
    lines = middle + 0.5 * _ACROSS * rng.uniform(-1.0, 1.0, (count, 1, 1)) * aside
    from_row, share = np.floor(rng.random(count) * 0.55 * rows), rng.uniform(0.3, 0.7, count)
    row = np.minimum(from_row[:, None] + share[:, None] * rows * t, rows - 1.001)
    low, part = row.astype(int), (row % 1.0)[..., None]
    each = np.arange(count)[:, None]
    points = (1.0 - part) * lines[each, low] + part * lines[each, low + 1]
    away = unit_rows(points - cards[0].centre)
    far = _AWAY * np.where(rng.random(count) < _LOOSE, _LOOSE_AWAY, 1.0)[:, None]
    off = rng.uniform(0.0, 1.0, (count, 1)) * far * np.sin(np.pi * t * rng.uniform(0.4, 1.0, (count, 1)))
    drift = rng.normal(0.0, 0.5, (count, 1, 3)) * (far * t**2)[..., None]
    points = points + off[..., None] * away + drift
    paint = paints(look, np.full(count, 1.3), np.full(count, 0.7), rng, 0.4)
    return StrandSet(points, amount.radius * rng.uniform(0.6, 1.2, count), paint, np.ones((count, len(t))),
                  np.ones(count), np.ones(count))  # fmt: skip
