"""The loops of a bite; their numpy twin is in :mod:`agentface.deform.mouth.lip_bite`."""

from __future__ import annotations

import numpy as np

from agentface.conventions import Floats
from agentface.deform.mouth.contact_tables import ContactTables
from agentface.deform.mouth.lip_bite import ABOVE, BACK, BEYOND, CLEAR, OUT_OF_REACH, REACH, RINGS
from agentface.kernel import kernel

_ZERO, _QUARTER, _HALF = np.float32(0.0), np.float32(0.25), np.float32(0.5)
_FIRST, _LAST = RINGS


@kernel(error_model="numpy")
def bite(tables: ContactTables, level: np.float32, points: Floats) -> None:
    """Brings the rim of the lower lip to the incisors by ``level`` of its way; as its twin."""
    grid, edge = tables.grid, tables.crowns[0, 2]
    count = tables.lower.shape[0]
    up, back = np.empty(count, np.float32), np.empty(count, np.float32)
    for k in range(count):
        top = np.float32(-np.inf)
        for ring in range(_FIRST, _LAST):
            top = max(top, points[grid[ring, tables.lower[k]], 1])
        rise, before = edge + ABOVE - top, np.float32(np.inf)
        for ring in range(_FIRST, _LAST):
            x, y, z = points[grid[ring, tables.lower[k]]]
            distance = z - tables.crowns[0, 0] + tables.crowns[0, 1] * x * x
            before = min(before, distance + OUT_OF_REACH * max(edge - (y + rise), _ZERO))
        up[k] = min(max(rise, -REACH), REACH)
        back[k] = -min(max(REACH / max(abs(rise), REACH) * (before + BEYOND), _ZERO), BACK)
    rows = tables.last + 1 - tables.first
    give = np.empty(tables.upper.shape[0], np.float32)
    for k in range(give.shape[0]):
        low = np.float32(np.inf)
        for ring in range(rows):
            low = min(low, points[grid[tables.first + ring, tables.upper[k]], 1])
        give[k] = min(max(edge + ABOVE + CLEAR - low, _ZERO), REACH)
    for ring in range(grid.shape[0]):
        tip, fall = level * tables.tip[ring], level * tables.fall[ring]
        for k in range(count):
            vertex = grid[ring, tables.lower[k]]
            points[vertex, 1] += tip * tables.bitten[k] * _even(up, k)
            points[vertex, 2] += tip * tables.bitten[k] * _even(back, k)
        for k in range(give.shape[0]):
            points[grid[ring, tables.upper[k]], 1] += fall * tables.bared[k] * _even(give, k)


@kernel(error_model="numpy")
def _even(moves: Floats, k: int) -> np.float32:
    if k == 0 or k == moves.shape[0] - 1:
        return moves[k]
    return _HALF * moves[k] + _QUARTER * (moves[k - 1] + moves[k + 1])
