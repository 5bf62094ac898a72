"""Vertices in blocks of neighbours with the muscles that may move them: what the compiled kernel walks over."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from agentface.anatomy.muscle_set import MuscleSet
from agentface.conventions import Doubles, Floats, Indices
from agentface.deform.kernels import LANES


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
    pull: Floats
    """``(P, LANES)`` m, elasticity times reach."""
    fibre: Floats
    """``(M, 16)``: origin, axis / (1 - edge), -edge / (1 - edge), 1 / Rs, 1 / (Rf - Rs), Rs / (Rf - Rs), the slope and
    base of the angular fall-off, sin(zone), edge = cos(zone), 1 - edge, Rf."""


def pack(rest: Floats, muscles: MuscleSet) -> Blocks:
    """The blocks of a face at rest; ``rest`` is ``(V, 3)`` m."""
    reachable = movable(rest, muscles)
    moving = np.flatnonzero(reachable.any(axis=0))
    order = _neighbours(rest, moving)
    count = -(-len(order) // LANES)
    vertex = np.resize(np.append(order, np.repeat(order[-1:], count * LANES - len(order))), (count, LANES))
    weights = np.where(reachable, muscles.elasticity[:, None] * muscles.reach, 0.0)
    by_block = np.ascontiguousarray(weights[:, vertex].transpose(1, 0, 2), dtype=np.float32)
    acts = by_block.any(axis=2)
    first = np.zeros(count + 1, dtype=np.int32)
    np.cumsum(acts.sum(axis=1), out=first[1:])
    return Blocks(
        home=np.ascontiguousarray(rest[vertex].transpose(0, 2, 1), dtype=np.float32).reshape(count, 3 * LANES),
        vertex=vertex.astype(np.int32),
        first=first,
        owner=np.nonzero(acts)[1].astype(np.int32),
        pull=np.ascontiguousarray(by_block[acts]),
        fibre=_fibres(muscles),
    )


def movable(rest: Floats, muscles: MuscleSet) -> npt.NDArray[np.bool_]:
    """``(M, V)``: which muscle can move which vertex, however the others contract; never too few.

    A vertex travels at most the sum of the largest displacements that the muscles have anywhere within its travel;
    a few rounds from a bound that is too wide narrow it. A muscle whose zone is further off never meets the vertex,
    and a vertex that is in no zone at rest never leaves.
    """
    spoke = rest.astype(np.float64)[None] - muscles.origin[:, None]
    distance = np.maximum(np.linalg.norm(spoke, axis=2), _MARGIN)
    angle = np.arccos(np.clip(np.einsum("mvc,mc->mv", spoke, muscles.axis) / distance, -1.0, 1.0))
    strongest = muscles.elasticity[:, None] * muscles.reach
    still = ~_largest(distance, angle, muscles, np.full(rest.shape[:1], _MARGIN), strongest).any(axis=0)
    strongest[:, still] = 0.0
    travel = strongest.sum(axis=0)
    for _ in range(6):
        meets = _largest(distance, angle, muscles, travel + _MARGIN, strongest)
        travel = meets.sum(axis=0)
    return meets > 0.0


def _largest(distance: Doubles, angle: Doubles, muscles: MuscleSet, travel: Doubles, strongest: Doubles) -> Doubles:
    """``(M, V)`` m: at least what each muscle can move each vertex while that is within ``travel (V,)`` of its rest."""
    start, finish, edge = muscles.fall_start[:, None], muscles.fall_finish[:, None], np.cos(muscles.zone)[:, None]
    swing = np.where(travel < distance, np.arcsin(np.minimum(travel / distance, 1.0)), np.pi)
    cosine = np.cos(np.maximum(angle - swing, 0.0))
    inside = cosine if muscles.falloff == "waters" else (cosine - edge) / (1.0 - edge)
    short = np.maximum(1.0 - (distance + travel) / start, 0.0)
    far = np.maximum((distance - travel - start) / (finish - start), 0.0)
    radial = np.cos(np.minimum(np.maximum(short, far), 1.0) * (np.pi / 2))
    meets = (cosine >= edge) & (far < 1.0)
    return np.where(meets, strongest * np.maximum(inside, 0.0) * radial, 0.0)


_MARGIN = 1e-6
"""m: more than single precision loses over a face."""


def _neighbours(rest: Floats, chosen: npt.NDArray[np.intp]) -> npt.NDArray[np.intp]:
    """``chosen`` in an order whose consecutive blocks are compact: halved along the longest side, again and again."""
    if len(chosen) <= LANES:
        return chosen
    points = rest[chosen]
    longest = int(np.argmax(np.ptp(points, axis=0)))
    ranked = chosen[np.argsort(points[:, longest], kind="stable")]
    half = max(1, len(chosen) // LANES // 2) * LANES
    return np.concatenate([_neighbours(rest, ranked[:half]), _neighbours(rest, ranked[half:])])


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
        np.sin(muscles.zone),
        edge,
        1.0 - edge,
        muscles.fall_finish,
    ]
    return np.column_stack(columns).astype(np.float32)
