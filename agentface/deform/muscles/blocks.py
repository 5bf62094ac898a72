"""Vertices in blocks, each with the muscles that may move them: what the compiled kernel walks over."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from agentface.conventions import Doubles, Floats, Indices
from agentface.deform.lanes import LANES
from agentface.head.muscle_set import MuscleSet

FIELDS = 12
"""Constants a muscle."""
_MARGIN = 1e-6
"""m: more than single precision loses over a face."""
_NEAR = 0.008
"""m: vertices share a block when they are as near as this to the same muscles; a usual travel."""
_EXTENT = 0.05
"""m: how far apart two vertices are as unlike as one inside and one outside a muscle's zone."""


class Blocks(NamedTuple):
    """B blocks of :data:`LANES` vertices, P pairs of a block and a muscle that may move one of its vertices.

    A last block that is not full repeats its last vertex. Vertices that no muscle can move are in no block.
    """

    home: Floats
    """``(B, 3 * LANES)`` m, rest positions: all x, all y, all z."""
    vertex: Indices
    """``(B, LANES)``."""
    first: Indices
    """``(B + 1,)``: block b has the pairs ``first[b]`` to ``first[b + 1] - 1``."""
    owner: Indices
    """``(P,)``, the muscle of a pair."""
    slack: Floats
    """``(P,)`` m, rising within a block: how far its vertices travel before one may meet the muscle's zone."""
    strongest: Floats
    """``(P,)`` m, the largest of ``pull``."""
    pull: Floats
    """``(P, LANES)`` m, elasticity times reach."""
    fibre: Floats
    """``(M, FIELDS, LANES)``, each number LANES times: origin, axis / (1 - edge), -edge / (1 - edge), 1 / Rs,
    1 / (Rf - Rs), Rs / (Rf - Rs), slope and base of the angular fall-off, where edge = cos(zone)."""


def pack(rest: Floats, muscles: MuscleSet) -> Blocks:
    """The blocks of a face at rest; ``rest`` is ``(V, 3)`` m."""
    apart = slacks(rest, muscles)
    moving = np.flatnonzero((apart == 0.0).any(axis=0))
    traits = np.concatenate([rest[moving].T / _EXTENT, np.maximum(1.0 - apart[:, moving] / _NEAR, 0.0)]).T
    order = moving[_alike(traits, np.arange(len(moving)))]
    count = -(-len(order) // LANES)
    vertex = np.resize(np.append(order, np.repeat(order[-1:], count * LANES - len(order))), (count, LANES))
    strength = muscles.elasticity[:, None] * muscles.reach
    slack, strongest = apart[:, vertex].min(axis=2).T, strength[:, vertex].max(axis=2).T
    owner = np.argsort(slack, axis=1, kind="stable")
    slack, strongest = (np.take_along_axis(table, owner, axis=1) for table in (slack, strongest))
    # a block travels at most what the muscles before move it together
    travel = np.cumsum(strongest, axis=1) - strongest
    meets = np.logical_and.accumulate(slack <= travel + 10 * _MARGIN, axis=1)
    block = np.nonzero(meets)[0]
    first = np.zeros(count + 1, dtype=np.int32)
    np.cumsum(meets.sum(axis=1), out=first[1:])
    return Blocks(
        home=np.ascontiguousarray(rest[vertex].transpose(0, 2, 1), dtype=np.float32).reshape(count, 3 * LANES),
        vertex=vertex.astype(np.int32),
        first=first,
        owner=owner[meets].astype(np.int32),
        slack=slack[meets].astype(np.float32),
        strongest=strongest[meets].astype(np.float32),
        pull=np.ascontiguousarray(strength[owner[meets][:, None], vertex[block]], dtype=np.float32),
        fibre=_fibres(muscles),
    )


def slacks(rest: Floats, muscles: MuscleSet) -> Doubles:
    """float64 ``(M, V)`` m: how far each vertex can travel, at least, before it is in a muscle's zone.

    0 where it is in the zone at rest, infinite where the muscle cannot move it.
    """
    points, origin, axis = rest.astype(np.float64), muscles.origin, muscles.axis
    along = axis @ points.T - (axis * origin).sum(axis=1)[:, None]
    square = (points**2).sum(axis=1) - 2.0 * origin @ points.T + (origin**2).sum(axis=1)[:, None]
    np.maximum(square, 0.0, out=square)
    aside = np.sqrt(np.maximum(square - along * along, 0.0))
    # the nearest point of a cone is on its side, or at its tip for what is behind that
    side = aside * np.cos(muscles.zone)[:, None] - along * np.sin(muscles.zone)[:, None]
    beyond = np.sqrt(square) - muscles.fall_finish[:, None]
    apart = np.maximum(np.maximum(side, beyond) - _MARGIN, 0.0)
    return np.where((muscles.elasticity[:, None] > 0.0) & (muscles.reach > 0.0), apart, np.inf)


def _alike(traits: Doubles, chosen: npt.NDArray[np.intp]) -> npt.NDArray[np.intp]:
    """``chosen`` rows of ``traits (N, K)`` in an order whose consecutive blocks are alike.

    They are halved across the direction in which they differ most, again and again; three rounds of power iteration
    find that well enough.
    """
    if len(chosen) <= LANES:
        return chosen
    spread = traits[chosen] - traits[chosen].mean(axis=0)
    direction = spread[np.argmax(np.einsum("nk,nk->n", spread, spread))]
    for _ in range(3):
        direction = (spread @ direction) @ spread
        direction /= np.linalg.norm(direction) or 1.0
    ranked = chosen[np.argsort(spread @ direction, kind="stable")]
    half = max(1, len(chosen) // LANES // 2) * LANES
    return np.concatenate([_alike(traits, ranked[:half]), _alike(traits, ranked[half:])])


def _fibres(muscles: MuscleSet) -> Floats:
    """Each muscle's constants, as :attr:`Blocks.fibre` lists them.

    The angular fall-off is ``slope * inside + base`` where ``inside = (cos alpha - edge) / (1 - edge)`` is not
    negative; the kernel takes ``inside`` from the scaled axis and the shift.
    """
    edge = np.cos(muscles.zone)
    scale = 1.0 / (1.0 - edge)
    gap = 1.0 / (muscles.fall_finish - muscles.fall_start)
    waters = muscles.falloff == "waters"
    columns = [
        muscles.origin,
        muscles.axis * scale[:, None],
        -edge * scale,
        1.0 / muscles.fall_start,
        gap,
        muscles.fall_start * gap,
        1.0 - edge if waters else np.ones_like(edge),
        edge if waters else np.zeros_like(edge),
    ]
    table: Floats = np.column_stack(columns).astype(np.float32)
    return np.ascontiguousarray(np.repeat(table.reshape(-1, FIELDS, 1), LANES, axis=2))
