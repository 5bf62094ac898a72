"""The chest, compiled; the numpy twin is :mod:`agentface.deform.finish.chest`."""

from __future__ import annotations

from agentface.conventions import Floats
from agentface.deform.finish.chest import ChestTables
from agentface.kernel import kernel


@kernel(error_model="numpy")
def apply(tables: ChestTables, values: Floats, transform: Floats) -> None:
    """Write what moves shoulders and clothes into ``transform (4, 4)``."""
    breath = values[tables.breath]
    for row in range(4):
        for column in range(4):
            transform[row, column] = 1.0 if row == column else 0.0
            if row < 3:
                transform[row, column] += breath * tables.filled[row, column]
