"""The lower lip against the upper incisors: where f and v are made."""

from __future__ import annotations

import numpy as np

from agentface.conventions import Floats
from agentface.deform.mouth.contact_tables import ContactTables

ABOVE = np.float32(0.001)
"""m above the incisors' edges, to which the lower lip's rim goes."""
CLEAR = np.float32(0.0005)
"""m above that, to which the upper lip gives way."""
BEYOND = np.float32(0.0022)
"""m into the crowns, to which the lip would go: that is as soft as the teeth push, which then lay it against them."""
REACH = np.float32(0.009)
"""m, how far the lip goes up or down at most; farther off, it goes back by less, too."""
BACK = np.float32(0.0115)
"""m, how far the lip goes back at most: farther, and the skin below it would turn over."""
OUT_OF_REACH = np.float32(5.0)
"""How much farther from the teeth a ring counts for each m that it lies below their edges."""
RINGS = (2, 7)
"""The rings of which one touches the teeth: the first, and the first beyond."""


def bite(tables: ContactTables, level: np.float32, points: Floats) -> None:
    """Bring the rim of the lower lip to the incisors by ``level`` of its way; the upper lip gives way to it."""
    front, bend, edge, _ = tables.crowns[0]
    rings = tables.grid[RINGS[0] : RINGS[1]]
    rim = points[rings[:, tables.lower]]
    up = edge + ABOVE - rim[..., 1].max(axis=0)
    reached = np.clip(up, -REACH, REACH)
    near = REACH / np.maximum(np.abs(up), REACH)
    before = rim[..., 2] - front + bend * rim[..., 0] ** 2
    before += OUT_OF_REACH * np.maximum(edge - (rim[..., 1] + up), np.float32(0.0))
    back = -np.clip(near * (before.min(axis=0) + BEYOND), np.float32(0.0), BACK)
    rows = tables.grid[:, tables.lower]
    fall = level * tables.tip[:, None] * tables.bitten
    points[rows, 1] += fall * _even(reached)
    points[rows, 2] += fall * _even(back)
    low = points[tables.grid[tables.first : tables.last + 1][:, tables.upper], 1].min(axis=0)
    rise = np.clip(edge + ABOVE + CLEAR - low, np.float32(0.0), REACH)
    points[tables.grid[:, tables.upper], 1] += level * tables.fall[:, None] * tables.bared * _even(rise)


def _even(moves: Floats) -> Floats:
    evened = moves.copy()
    evened[1:-1] = np.float32(0.5) * moves[1:-1] + np.float32(0.25) * (moves[:-2] + moves[2:])
    return evened
