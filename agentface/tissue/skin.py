"""From the tissue to the skin: what the epidermis has moved, what follows it, and the lips' control points."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from agentface.conventions import Floats, Indices
from agentface.deform.lanes import LANES
from agentface.deform.tables import SkinTables
from agentface.tissue.columns import Columns
from agentface.tissue.members import Carried

METRES = np.float32(1e-3)


class EpidermisTables(NamedTuple):
    """Where the epidermis ends up.

    Attributes:
        place: ``(V,)`` where in positions each vertex is.
        resting: positions at rest.
        carried: the skin that follows.
        rest: ``(P, 3)`` m, the skin's vertices and the lips' control points at rest.
        control_vertices, control_weights: ``(C, 4)``: what of the skin each control point follows.
    """

    place: Indices
    resting: Floats
    carried: Carried
    rest: Floats
    control_vertices: Indices
    control_weights: Floats


def prepare(columns: Columns, carried: Carried, skin: SkinTables) -> EpidermisTables:
    """The tables of a face."""
    controls = skin.lips.control_vertices, skin.lips.control_weights
    return EpidermisTables(columns.place, columns.rest, carried, skin.rest, *controls)


def put(tables: EpidermisTables, positions: Floats, points: Floats) -> None:
    """Writes skin and control points, ``points (P, 3)`` m, as ``positions`` of the tissue have them."""
    count = len(tables.place)
    moved = (positions - tables.resting).ravel()[tables.place[:, None] + LANES * np.arange(3)] * METRES
    tables.carried.apply(moved)
    points[:count] = tables.rest[:count] + moved
    followed = (tables.control_weights[:, :, None] * moved[tables.control_vertices]).sum(axis=1)
    points[count:] = tables.rest[count:] + followed
