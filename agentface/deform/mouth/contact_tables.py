"""What contact needs of a face, made once."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from agentface.conventions import Doubles, Floats, Indices
from agentface.deform.morphs import JawSlides, jaw_slides
from agentface.deform.mouth.dental_arch import Arch, fit_arch, fit_crowns
from agentface.deform.mouth.lip_grid import INNER_RINGS, SEAM_RING, LipGrid, column_places, lip_grid
from agentface.deform.mouth.lip_parting import overlaps
from agentface.head.model import HeadModel
from agentface.parameters import PARAMETERS, indices_of

_FIRST_RING, _LAST_RING = INNER_RINGS - 1, INNER_RINGS + 5
_FALL = (0.3, 0.65, 1, 1, 1, 1, 1, 1, 1, 0.8, 0.55, 0.32, 0.14, 0.04)  # of the way the lips are pushed, by rings
_TIP = (0.3, 0.65, 1, 1, 1, 0.94, 0.83, 0.7, 0.57, 0.44, 0.32, 0.21, 0.115, 0.04)  # of a bite's: the red tips inward
_ARCH_KEPT = 0.3  # of its distance at rest that a vertex keeps from the teeth
_SOFTEST = 0.0012  # m, over which the teeth begin to push
_ROUNDING = 2e-7  # m
_CLEAR = 2e-5  # m, that lips keep between them where they did at rest
_NEAREST = 0.0004  # m, vertices that lie nearer to the teeth at rest, or behind them, are not pushed
_BITTEN = 0.019  # m from the middle, where a lower lip that is bitten lies as ever
_TOUCH = 0.00005  # m, that a bitten lip keeps from the crowns


class ContactTables(NamedTuple):
    """What contact needs a frame.

    Attributes:
        grid: ``(R, N)`` vertices of the lips, as in :class:`agentface.deform.mouth.lip_grid.LipGrid`.
        first, last: the rings between which the lips may touch, both included.
        seam: the ring where they touch.
        upper, lower: ``(U,)``, ``(L,)``: the columns of either lip from the left corner to the right one, of which
            the first and the last belong to the corners.
        overlap_upper, overlap_lower: ``(U,)``, ``(L,)`` m, how far the lips overlap in height there at rest.
        fall: ``(R,)`` 0..1, how much of the push reaches a ring.
        tip: ``(R,)`` 0..1, how much of a bite reaches a ring of the lower lip.
        vertex: ``(K,)`` vertices before the teeth.
        kept: ``(2, K)`` m, how near each may come to the upper and the lower arch; negative: as near as it likes.
        relief: ``(2, K)`` m, how much nearer it may come in a bite: to the crowns, which lie behind the gum's arch.
        softness: ``(2, K)`` m, over which the push sets in.
        arch: ``(2, 4)``, the numbers of both :class:`agentface.deform.mouth.dental_arch.Arch`.
        incisors: ``(4,)``, the numbers of the upper crowns' arch.
        bitten: ``(L,)`` 0..1, how much of a bite reaches a column of the lower lip; ``bared (U,)`` of the upper.
        hinge, widest, jaw, slides: the turn of the lower arch, and how far it slides before.
        press, shut_from: where press stands in a pose, and the level from which it shuts the lips.
        seal, bite: where these stand in a pose.
        morphs: ``(H,)`` where what moves lips or jaw by a shape stands.
    """

    grid: Indices
    first: int
    last: int
    seam: int
    upper: Indices
    lower: Indices
    overlap_upper: Floats
    overlap_lower: Floats
    fall: Floats
    tip: Floats
    vertex: Indices
    kept: Floats
    relief: Floats
    softness: Floats
    arch: Floats
    incisors: Floats
    bitten: Floats
    bared: Floats
    hinge: Floats
    widest: float
    jaw: int
    slides: JawSlides
    press: int
    shut_from: float
    seal: int
    bite: int
    morphs: Indices


def prepare(model: HeadModel) -> ContactTables:
    """The tables of a face."""
    grid, points = lip_grid(model), model.vertices.astype(np.float64)
    upper, lower = _columns(grid, points)
    rings = grid.vertices[_FIRST_RING : _LAST_RING + 1]
    at_rest = [overlaps(rings, *lips, points)[0].max((0, 1)) for lips in ((upper, lower, 1.0), (lower, upper, -1.0))]
    names = "teeth_upper", "teeth_lower"
    arches, crowns = ([fit(model, name) for name in names] for fit in (fit_arch, fit_crowns))
    distance = np.stack([arch.distance(points[grid.vertices.ravel()]) for arch in arches])
    pushed = (distance > _NEAREST).any(0)
    vertex, distance = grid.vertices.ravel()[pushed], distance[:, pushed]
    kept = np.where(distance > _NEAREST, _ARCH_KEPT * distance, -1.0)
    fade = np.cos(np.clip(points[grid.vertices[SEAM_RING], 0] / _BITTEN, -1.0, 1.0) * (0.5 * math.pi))
    of_lower = np.where(np.isin(np.arange(len(fade)), lower), fade, 0.0)
    share = np.broadcast_to(np.minimum(1.0, 2.0 * of_lower), grid.vertices.shape).ravel()[pushed]
    return ContactTables(
        grid=grid.vertices,
        first=_FIRST_RING,
        last=_LAST_RING,
        seam=SEAM_RING,
        upper=upper,
        lower=lower,
        overlap_upper=(np.maximum(at_rest[0], -_CLEAR) + _ROUNDING).astype(np.float32),
        overlap_lower=(np.maximum(at_rest[1], -_CLEAR) + _ROUNDING).astype(np.float32),
        fall=np.array(_FALL, np.float32),
        tip=np.array(_TIP, np.float32),
        vertex=np.ascontiguousarray(vertex),
        kept=kept.astype(np.float32),
        relief=(
            share * np.stack([_relief(points[vertex], *pair) for pair in zip(arches, crowns, kept, strict=True)])
        ).astype(np.float32),
        softness=np.clip(0.5 * (1 - _ARCH_KEPT) * distance, 1e-5, _SOFTEST).astype(np.float32),
        arch=np.array([arch.numbers for arch in arches], np.float32),
        incisors=np.array(crowns[0].numbers, np.float32),
        bitten=fade[lower].astype(np.float32),
        bared=fade[upper].astype(np.float32),
        hinge=np.array(model.jaw.pivot[1:], np.float32),
        widest=math.radians(model.jaw.widest_deg),
        jaw=indices_of("jaw_open")[0],
        slides=jaw_slides(model),
        press=indices_of("orbicularis_oris_press")[0],
        shut_from=model.lips.orbicularis_oris.roll_from,
        seal=indices_of("lip_seal")[0],
        bite=indices_of("lip_bite")[0],
        morphs=np.array(
            [known.index for known in PARAMETERS if known.morphs and known.group in ("mouth", "jaw")], np.int32
        ),
    )


def _relief(places: Doubles, gum: Arch, crowns: Arch, kept: Doubles) -> Doubles:
    """``(K,)`` m: from where a vertex at ``places (K, 3)`` is kept to just before the crowns."""
    on_crowns = places.copy()
    on_crowns[:, 2] = crowns.front - crowns.bend * places[:, 0] ** 2
    return np.where(kept < 0.0, 0.0, np.maximum(kept - gum.distance(on_crowns) - _TOUCH, 0.0))


def _columns(grid: LipGrid, points: Doubles) -> tuple[Indices, Indices]:
    """The columns of the upper and of the lower lip, both from the left corner to the right one."""
    place = column_places(grid, points, 4)
    columns = np.arange(grid.vertices.shape[1], dtype=np.int32)
    above, below = columns[place < 2], columns[place >= 2]
    return above[np.argsort(place[above])], below[np.argsort(-place[below])]
