"""Contact: the lips never pass through each other, nor through the teeth."""

from __future__ import annotations

import math
from typing import NamedTuple, TypeVar

import numpy as np
import numpy.typing as npt

from agentface.conventions import Doubles, Floats, Indices
from agentface.deform.morphs import JawSlides, jaw_slide, jaw_slides
from agentface.deform.mouth.dental_arch import arch_distance, fit_arch
from agentface.deform.mouth.lip_grid import INNER_RINGS, SEAM_RING, LipGrid, column_places, lip_grid
from agentface.head.model import HeadModel
from agentface.parameters import PARAMETERS, indices_of

_Points = TypeVar("_Points", Floats, Doubles)
_FIRST_RING, _LAST_RING = INNER_RINGS - 1, INNER_RINGS + 5
_FALL = (0.3, 0.65, 1, 1, 1, 1, 1, 1, 1, 0.8, 0.55, 0.32, 0.14, 0.04)  # of the way the lips are pushed, by rings
SPREAD, STEEP = np.float32(1.07), np.float32(4.0)
"""How the push at a place between two columns is shared: enough for their mean, and continuous."""
ROUNDS = 5
"""How often pressed lips are drawn together and parted: each round leaves less of the gap."""
PARTINGS = 3
"""How often lips are parted after the teeth have pushed them: each time takes what the last one left."""
FARTHEST = np.float32(0.001)
"""m, the gap that press still closes; one twice as wide it leaves."""
CORNER = np.float32(0.0015)
"""m from a ring's ends over which the push sets in: there its columns may run back and forth."""
_ARCH_KEPT = 0.3  # of its distance at rest that a vertex keeps from the teeth
_SOFTEST = 0.0012  # m, over which the teeth begin to push
_ROUNDING = 2e-7  # m
_CLEAR = 2e-5  # m, that lips keep between them where they did at rest
APART = np.float32(1.5e-4)
"""m more between lips that shapes move, too: they slide along each other at a slant to the rings."""
_NEAREST = 0.0004  # m, vertices that lie nearer to the teeth at rest, or behind them, are not pushed


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
        vertex: ``(K,)`` vertices before the teeth.
        kept: ``(2, K)`` m, how near each may come to the upper and the lower arch; negative: as near as it likes.
        softness: ``(2, K)`` m, over which the push sets in.
        arch: ``(2, 4)``, the numbers of both :class:`agentface.deform.mouth.dental_arch.Arch`.
        hinge, widest, jaw, slides: the turn of the lower arch, and how far it slides before.
        press, shut_from: where press stands in a pose, and the level from which it shuts the lips.
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
    vertex: Indices
    kept: Floats
    softness: Floats
    arch: Floats
    hinge: Floats
    widest: float
    jaw: int
    slides: JawSlides
    press: int
    shut_from: float
    morphs: Indices


def prepare(model: HeadModel) -> ContactTables:
    """The tables of a face."""
    grid, points = lip_grid(model), model.vertices.astype(np.float64)
    upper, lower = _columns(grid, points)
    at_rest = [
        _overlaps(grid.vertices, *lips, points)[0].max((0, 1)) for lips in ((upper, lower, 1.0), (lower, upper, -1.0))
    ]
    arches = [fit_arch(model, name) for name in ("teeth_upper", "teeth_lower")]
    vertex = grid.vertices.ravel()
    distance = np.stack([arch.distance(points[vertex]) for arch in arches])
    vertex, distance = vertex[(distance > _NEAREST).any(0)], distance[:, (distance > _NEAREST).any(0)]
    before = distance > _NEAREST
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
        vertex=np.ascontiguousarray(vertex),
        kept=np.where(before, _ARCH_KEPT * distance, -1.0).astype(np.float32),
        softness=np.clip(0.5 * (1 - _ARCH_KEPT) * distance, 1e-5, _SOFTEST).astype(np.float32),
        arch=np.array([arch.numbers for arch in arches], np.float32),
        hinge=np.array(model.jaw.pivot[1:], np.float32),
        widest=math.radians(model.jaw.widest_deg),
        jaw=indices_of("jaw_open")[0],
        slides=jaw_slides(model),
        press=indices_of("orbicularis_oris_press")[0],
        shut_from=model.lips.orbicularis_oris.roll_from,
        morphs=np.array(
            [known.index for known in PARAMETERS if known.morphs and known.group in ("mouth", "jaw")], np.int32
        ),
    )


def apply(tables: ContactTables, values: Floats, points: Floats) -> None:
    """Part lips that overlap, and push what has come too near to the teeth out of them; ``points`` in place.

    Teeth push along x and z in their own frame: the lower arch's turns with the jaw.
    """
    apart = APART * min(np.float32(1.0), np.abs(values[tables.morphs]).sum())
    for _ in range(ROUNDS if values[tables.press] > 0.0 else 1):
        _close_lips(tables, values[tables.press], points)
        _part_lips(tables, points, apart)
    points[tables.vertex, ::2] += _push_out(tables, 0, points[tables.vertex])
    angle = np.float32(tables.widest * values[tables.jaw])
    cosine, sine = np.cos(angle), np.sin(angle)
    places = points[tables.vertex]
    up, forward = (places[:, 1:] - tables.hinge).T
    places[:, 1] = tables.hinge[0] + cosine * up + sine * forward
    ahead, aside = jaw_slide(tables.slides, values)
    places[:, 0] -= np.float32(aside)
    places[:, 2] = tables.hinge[1] - sine * up + cosine * forward - np.float32(ahead)
    across, ahead = _push_out(tables, 1, places).T
    points[tables.vertex] += np.stack([across, -sine * ahead, cosine * ahead], axis=1)
    for _ in range(PARTINGS):
        _part_lips(tables, points, apart)


def _close_lips(tables: ContactTables, press: float, points: Floats) -> None:
    """Press draws lips together that are a little apart: columns go half of the way, evened out."""
    share = min(np.float32(1.0), np.float32(press) / tables.shut_from)
    if share <= 0.0:
        return
    move = np.zeros(tables.grid.shape[1], np.float32)
    for own, other, sign in ((tables.upper, tables.lower, 1.0), (tables.lower, tables.upper, -1.0)):
        gap = np.maximum(-_overlaps(tables.grid, own, other, sign, points)[0].max((0, 1)), np.float32(0.0))
        near = np.clip(np.float32(2.0) - gap / FARTHEST, np.float32(0.0), np.float32(1.0))
        near *= gap
        near[[0, 1, -2, -1]] = 0.0
        even = np.float32(0.5) * near[1:-1] + np.float32(0.25) * (near[:-2] + near[2:])
        move[own[1:-1]] = np.float32(-0.5 * sign) * share * even
    points[tables.grid, 1] += tables.fall[:, None] * move


def _part_lips(tables: ContactTables, points: Floats, apart: np.float32) -> None:
    """Every vertex where the lips touch is held against the height of the other lip at its x: both give way by half.

    They are kept ``apart`` m. The two columns of the other lip between which it lies give way by shares that vanish
    where they cease to be its neighbours, so that lips that slide along each other are pushed without a jump; the
    largest push counts. Where the lips join, in the corners, both go together.
    """
    up, down = np.zeros((2, tables.grid.shape[1]), np.float32)
    lips = (
        (tables.upper, tables.lower, tables.overlap_upper, 1.0, up, down),
        (tables.lower, tables.upper, tables.overlap_lower, -1.0, down, up),
    )
    for own, other, at_rest, sign, own_push, other_push in lips:
        overlap, second, part, inside = _overlaps(tables.grid, own, other, sign, points)
        push = np.float32(0.5) * np.maximum(overlap - at_rest + apart, np.float32(0.0))
        push *= np.clip(inside / CORNER, np.float32(0.0), np.float32(1.0)) ** 2
        push[..., [0, -1]] = 0.0
        np.maximum.at(own_push, np.broadcast_to(own, push.shape), push)
        for neighbour, share in ((second - 1, 1 - part), (second, part)):
            np.maximum.at(other_push, other[neighbour], push * SPREAD * np.minimum(np.float32(1.0), STEEP * share))
    move = up - down
    for end in (0, -1):
        corner = [tables.upper[end], tables.lower[end]]
        move[corner] = np.float32(0.5) * (move[corner[0]] + move[corner[1]])
    if move.any():
        points[tables.grid, 1] += tables.fall[:, None] * move


def _overlaps(
    grid: Indices, own: Indices, other: Indices, sign: float, points: _Points
) -> tuple[_Points, npt.NDArray[np.int64], _Points, _Points]:
    """How far each vertex of ``own`` columns is beyond each ring of the other lip at its x, ``(rings, others, K)`` m.

    Also which of the ``other`` columns is the second of the two that it lies between, how far towards it, 0..1, and
    how far inside the ring's ends. Beyond them the overlap counts for less by as much. ``sign`` is 1 for the upper
    lip, else -1.
    """
    rings = grid[_FIRST_RING : _LAST_RING + 1]
    at, height = np.moveaxis(points[rings[:, None, own], :2], -1, 0)
    across, up = np.moveaxis(points[rings[:, other], :2], -1, 0)
    before = across[None, :, None, 1:-1] >= at[..., None]
    second = np.where(before.any(-1), before.shape[-1] - before[..., ::-1].argmax(-1), 0) + 1
    ring = np.arange(len(rings))[:, None]
    first, last = across[ring, second - 1], across[ring, second]
    part = np.clip((first - at) / np.maximum(first - last, np.float32(1e-6)), np.float32(0.0), np.float32(1.0))
    there = up[ring, second - 1] + part * (up[ring, second] - up[ring, second - 1])
    inside = -np.maximum(at - across[:, :1], across[:, -1:] - at)
    return np.float32(sign) * (there - height) - np.maximum(-inside, np.float32(0.0)), second, part, inside


def _push_out(tables: ContactTables, arch: int, places: Floats) -> Floats:
    """``(K, 2)`` m: how ``places (K, 3)`` must move along x and z to keep their distance from an arch.

    With t the distance less what is to be kept, and s the softness, the push is 0 for t > s, -t for t < -s,
    and between them (s - t)^2 / 4s, which joins both with their slopes.
    """
    front, bend, edge, fade = tables.arch[arch]
    distance, normal = arch_distance(places, front, bend)
    beyond = (edge - places[:, 1]) / fade
    share = np.clip(np.float32(1.0) - beyond, np.float32(0.0), np.float32(1.0))
    share = share * share * (np.float32(3.0) - np.float32(2.0) * share)
    soft = tables.softness[arch]
    over = np.clip(soft - (distance - tables.kept[arch]), np.float32(0.0), None)
    push = np.where(over < 2 * soft, over * over / (4 * soft), over - soft)
    push = np.where(tables.kept[arch] >= 0.0, share * push, np.float32(0.0))
    return np.asarray(push[:, None] * normal, np.float32)


def _columns(grid: LipGrid, points: Doubles) -> tuple[Indices, Indices]:
    """The columns of the upper and of the lower lip, both from the left corner to the right one."""
    place = column_places(grid, points, 4)
    columns = np.arange(grid.vertices.shape[1], dtype=np.int32)
    above, below = columns[place < 2], columns[place >= 2]
    return above[np.argsort(place[above])], below[np.argsort(-place[below])]
