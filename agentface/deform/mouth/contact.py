"""Contact: the lips never pass through each other, nor through the teeth, and touch what speech has them touch."""

from __future__ import annotations

import math

import numpy as np

from agentface.conventions import Doubles, Floats, Indices
from agentface.deform.morphs import jaw_slide, jaw_slides
from agentface.deform.mouth.contact_tables import ContactTables
from agentface.deform.mouth.dental_arch import arch_distance, fit_arch, fit_crowns
from agentface.deform.mouth.lip_bite import bite
from agentface.deform.mouth.lip_grid import INNER_RINGS, SEAM_RING, LipGrid, column_places, lip_grid
from agentface.deform.mouth.lip_parting import close, overlaps, part, seal
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
ROUNDS = 5
"""How often pressed lips are drawn together and parted: each round leaves less of the gap."""
TOUCH = np.float32(0.00002)
"""m, that a bitten lip keeps from the crowns."""
PARTINGS = 3
"""How often lips are parted after the teeth have pushed them: each time takes what the last one left."""
APART = np.float32(1.5e-4)
"""m more between lips that shapes move, too: they slide along each other at a slant to the rings."""


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
        lips=np.ascontiguousarray(grid.vertices[:, np.concatenate([upper, lower])]),
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
        relief=share.astype(np.float32),
        softness=np.clip(0.5 * (1 - _ARCH_KEPT) * distance, 1e-5, _SOFTEST).astype(np.float32),
        arch=np.array([arch.numbers for arch in arches], np.float32),
        crowns=np.array([arch.numbers for arch in crowns], np.float32),
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


def apply(tables: ContactTables, values: Floats, points: Floats) -> None:
    """Draw lips together and part them, bring them to the teeth and hold them out of them; ``points`` in place."""
    apart = APART * min(np.float32(1.0), np.abs(values[tables.morphs]).sum())
    if values[tables.seal] > 0.0:
        seal(tables, values[tables.seal], apart, points)
    for _ in range(ROUNDS if values[tables.press] > 0.0 else 1):
        close(tables, values[tables.press], points)
        part(tables, points, apart)
    if values[tables.bite] > 0.0:
        bite(tables, values[tables.bite], points)
    _hold_out(tables, values, values[tables.bite], points)
    for _ in range(PARTINGS):
        part(tables, points, apart)
    if values[tables.seal] > 0.0:
        seal(tables, values[tables.seal], apart, points)
        _hold_out(tables, values, values[tables.bite] * (np.float32(1.0) - values[tables.seal]), points)


def _hold_out(tables: ContactTables, values: Floats, bitten: np.float32, points: Floats) -> None:
    """Push what has come too near to the teeth out of them; a lip ``bitten`` 0..1 may come nearer.

    They push along x and z in their own frame: the lower arch's turns with the jaw.
    """
    points[tables.vertex, ::2] += _push_out(tables, 0, bitten, points[tables.vertex])
    angle = np.float32(tables.widest * values[tables.jaw])
    cosine, sine = np.cos(angle), np.sin(angle)
    places = points[tables.vertex]
    up, forward = (places[:, 1:] - tables.hinge).T
    places[:, 1] = tables.hinge[0] + cosine * up + sine * forward
    ahead, aside = jaw_slide(tables.slides, values)
    places[:, 0] -= np.float32(aside)
    places[:, 2] = tables.hinge[1] - sine * up + cosine * forward - np.float32(ahead)
    across, ahead = _push_out(tables, 1, bitten, places).T
    points[tables.vertex] += np.stack([across, -sine * ahead, cosine * ahead], axis=1)


def _push_out(tables: ContactTables, arch: int, bitten: np.float32, places: Floats) -> Floats:
    """``(K, 2)`` m: how ``places (K, 3)`` must move along x and z to keep their distance from an arch.

    With t the distance less what is to be kept, and s the softness, the push is 0 for t > s, -t for t < -s,
    and between them (s - t)^2 / 4s, which joins both with their slopes.
    """
    front, bend, edge, fade = tables.arch[arch]
    relief = bitten * tables.relief
    front = front + relief * (tables.crowns[arch, 0] - front)
    bend = bend + relief * (tables.crowns[arch, 1] - bend)
    distance, normal = arch_distance(places, front, bend)
    beyond = (edge - places[:, 1]) / fade
    share = np.clip(np.float32(1.0) - beyond, np.float32(0.0), np.float32(1.0))
    share = share * share * (np.float32(3.0) - np.float32(2.0) * share)
    soft = tables.softness[arch]
    kept = tables.kept[arch] + relief * (TOUCH - tables.kept[arch])
    over = np.clip(soft - (distance - kept), np.float32(0.0), None)
    push = np.where(over < 2 * soft, over * over / (4 * soft), over - soft)
    push = np.where(tables.kept[arch] >= 0.0, share * push, np.float32(0.0))
    return np.asarray(push[:, None] * normal, np.float32)


def _columns(grid: LipGrid, points: Doubles) -> tuple[Indices, Indices]:
    """The columns of the upper and of the lower lip, both from the left corner to the right one."""
    place = column_places(grid, points, 4)
    columns = np.arange(grid.vertices.shape[1], dtype=np.int32)
    above, below = columns[place < 2], columns[place >= 2]
    return above[np.argsort(place[above])], below[np.argsort(-place[below])]
