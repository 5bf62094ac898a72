"""The shape of the tissue under given contractions when nothing moves any more: what still pictures show."""

from __future__ import annotations

import numpy as np

from agentface.conventions import Doubles, Floats
from agentface.tissue.columns import packed
from agentface.tissue.newton import newton
from agentface.tissue.relaxation import relax
from agentface.tissue.tables import TissueTables


def equilibrium(tables: TissueTables, contractions: Doubles, *, compiled: bool = True) -> Floats:
    """Where the tissue is at rest with the muscles ``(23,)`` contracted, whatever came before; rest itself for none."""
    columns, positions = tables.columns, tables.columns.rest.copy()
    if not contractions.any():
        return positions
    if not compiled:
        pull = np.tensordot(contractions, tables.forces, 1)
        return packed(columns.vertex, newton(tables.lattice, pull), padding=-1.0)
    moving, responses = len(columns.first) - 1, tables.responses
    guess = responses.powers(contractions) @ responses.columns
    positions[:moving] += guess.reshape(positions[:moving].shape)
    relax(columns, positions, np.tensordot(contractions.astype(np.float32), tables.loads, 1))
    return positions
