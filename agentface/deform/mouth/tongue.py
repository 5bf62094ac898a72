"""The tongue: a bend along its length that teeth and lips limit.

A vertex at rest belongs to a place along the middle line; from it, it keeps its arm. The middle line goes out with the
artists' ``tongueOut``, rises, and is bent up and aside towards its tip; across it, edges roll up about it:

    p' = c'(s) + Y(phi(s)) X(theta(s)) roll(p - c(s))

A muscle of the tongue does not open the mouth: ``tongue_out`` goes as far as the gap between the incisors and that
between the lips let a tongue of this thickness, and no farther than to the teeth where these or the lips meet. Then each section
is moved and flattened into what is free at its place, and every vertex is held there
(:mod:`agentface.deform.mouth.passage`): inside the rows of teeth, between their edges, between the lips.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from agentface.conventions import Doubles, Floats, Indices
from agentface.deform.mouth import passage
from agentface.deform.mouth.passage import (
    BACK, BOTTOM, COLUMNS, DEPTH, EDGE, FRONT, INNER_LOWER, INNER_UPPER, MIDDLE, OUTER_LOWER, OUTER_UPPER, TOP, WIDTH,
    Passage,
)  # fmt: skip
from agentface.head.model import HeadModel
from agentface.mesh.smoothstep import smoothstep
from agentface.parameters import indices_of

NAMES = "tongue_out", "tongue_raise", "tongue_tip_raise", "tongue_tip_shift", "tongue_roll"
SHAPE = "tongueOut"
STATIONS = 25
_FARTHER = 1.4  # times the artists' way forward: as far as MPEG-4 has it, a mouth's width
_ROUND_FROM, _ROUND = 0.72, 0.5  # where along the tongue its tip begins to be round, and how round it is
_PLUMPER = 0.4  # how much thicker than at rest, where it lies flat
_FORWARD = 0.027  # m, of a tongue without that shape
_LIFT, _SINK = 0.008, 0.004  # m, of the back of the tongue
_TIP_UP, _TIP_DOWN, _TIP_ASIDE, _DROOP = 1.1, 0.7, 0.85, 0.6  # rad; how far a tongue that is out hangs down
_BEND_MORE = 0.3  # as a part, when it is out
_BEND_FROM, _BEND_LAST, _BEND_BEFORE = 0.45, 0.75, 0.12
"""Where along the tongue it bends at rest, where at the latest, and how much before it leaves the lips."""
_ROLLED = 1.3  # rad, the turn of each edge
_CARRIES = 0.95  # of what lifts a station, what lifts the next one: it does not hang down at once
_PALATE, _FLOOR = 0.012, 0.0062  # m from the edges of the teeth
_THIN, _THICK = 0.003, 0.0075  # m, gaps that let nothing through, and all
_NARROW, _WIDE = 0.006, 0.014  # m, widths of a mouth that do
_FAN = 0.72  # of the arch's width, what goes out between the teeth
_CROSSES, _SETS_IN = 0.66, 0.25  # of the arch's depth, before where it is as wide; and over which its edges set in
_SOFT = 0.0006  # m, over which a limit sets in
_LEAVES = 0.05, 0.15  # of the way out, over which the tongue leaves its place behind the teeth
_OVER = 0.03  # m, what is as good as no limit
_STEEP = 2.0
_SPREADS = 0.15  # how much wider a place before the lips is, a metre of its way
_LIPS_FROM, _LIPS_WHOLE = (
    0.012,
    0.004,
)  # m behind the lips, where their opening begins to tell, and from where it is all
_PASSES = 0.0015  # m under the upper teeth, which count where the lower lip would push the tongue into them
_AJAR = 0.05  # of the way that the lips let it, from which on they hold it whole
_LITTLE = 1e-4
_SOONEST = 0.1  # of any movement, from which on the teeth hold the tongue


class TongueTables(NamedTuple):
    """What the tongue needs a frame; T vertices, K stations from its root to its tip.

    Attributes:
        parameters: ``(5,)``, where those of ``NAMES`` stand in a pose.
        rest: ``(T, 3)`` float32 m.
        arm: ``(T, 3)`` m, from the middle line.
        arm_out: ``(T, 3)`` m, how it changes when the tongue is out.
        station: ``(T,)``, the station behind each vertex; ``part``: ``(T,)`` 0..1, how far it is towards the next one.
        line: ``(K, 2)`` m, height and depth of the middle line; ``line_out``: ``(K, 2)`` m, its way out.
        thick: ``(K,)`` m, half of the tongue's height; ``wide``: ``(K,)`` m, half of its width; ``wide_out``: ``(K,)``
            m, how that changes when it is out.
        hump: ``(K,)`` 0..1, how far each station rises; ``rolls``: ``(K,)`` 0..1, how far it rolls.
        passage: teeth and lips.
    """

    parameters: Indices
    rest: Floats
    arm: Doubles
    arm_out: Doubles
    station: Indices
    part: Doubles
    line: Doubles
    line_out: Doubles
    thick: Doubles
    wide: Doubles
    wide_out: Doubles
    hump: Doubles
    rolls: Doubles
    passage: Passage


class Sections(NamedTuple):
    """The stations in one pose.

    Attributes:
        place: ``(K, 3)`` m; ``pitch``, ``yaw``: ``(K,)`` rad; ``flat``: ``(K,)`` 0..1, what is left of its height.
        curl: ``(K,)`` 1/m, the roll.
        across, lips: the lips as :func:`.passage.look_at_lips` has them.
        limits: out of the mouth 0..1; 0..1 how far the limits are in force; half the width between the teeth m; the
            right and the left end of the lips' opening m; how far past the teeth the tongue may go m; whether it
            passes over the edges of the teeth, 0..1; where along the tongue its bend begins, 0..1; the depth m before the lips from which on it may
            spread; how far m it need not heed lips that let nothing through.
    """

    place: Doubles
    pitch: Doubles
    yaw: Doubles
    flat: Doubles
    curl: Doubles
    across: Doubles
    lips: Doubles
    limits: Doubles


def prepare(model: HeadModel) -> TongueTables:
    """The tables of a face."""
    mesh = model.parts["tongue"]
    rest = mesh.attributes["POSITION"].astype(np.float64)
    out = _way_out(model, rest)
    out[:, 2] *= _FARTHER
    z = rest[:, 2]
    end = np.clip(((z - z.min()) / (z.max() - z.min()) - _ROUND_FROM) / (1.0 - _ROUND_FROM), 0.0, 1.0)
    aside = rest[:, 0] - model.part_moves["tongue"][0]
    out[:, 0] += (np.sqrt(1.0 - _ROUND * end * end) - 1.0) * (aside + out[:, 0])
    along = (z - z.min()) / (z.max() - z.min()) * (STATIONS - 1)
    station = np.minimum(along.astype(np.int32), STATIONS - 2)
    part, at = along - station, np.linspace(z.min(), z.max(), STATIONS)
    near = [np.abs(z - place) <= 1.2 * (at[1] - at[0]) for place in at]
    low, high = (np.array([bound(rest[rows, 1]) for rows in near]) for bound in (np.min, np.max))
    line = np.column_stack([0.5 * (low + high), at])
    line_out = np.array([out[rows, 1:].mean(axis=0) for rows in near])
    wide = np.array([np.abs(rest[rows, 0] - model.part_moves["tongue"][0]).max() for rows in near])
    share = np.linspace(0.0, 1.0, STATIONS)
    middle, there = _between(line, station, part), np.abs(rest[:, 0] + out[:, 0] - model.part_moves["tongue"][0])
    wide_out = np.array([there[rows].max() for rows in near]) - wide
    arm = rest - np.column_stack([np.zeros(len(rest)), middle])
    arm_out = out - np.column_stack([np.zeros(len(rest)), _between(line_out, station, part)])
    arm_out[:, 1] += _PLUMPER * arm[:, 1]
    return TongueTables(
        parameters=np.array([indices_of(name)[0] for name in NAMES], np.int32),
        rest=rest.astype(np.float32),
        arm=arm,
        arm_out=arm_out,
        station=station,
        part=part,
        line=line,
        line_out=line_out,
        thick=0.5 * (high - low),
        wide=wide,
        wide_out=wide_out,
        hump=smoothstep(0.0, 0.55, share) * (1.0 - smoothstep(0.6, 1.0, share)),
        rolls=smoothstep(0.3, 0.7, share),
        passage=passage.prepare(model),
    )


def _way_out(model: HeadModel, rest: Doubles) -> Doubles:
    shapes = model.parts["tongue"].shapes
    if SHAPE in shapes:
        return np.asarray(shapes[SHAPE].dense(len(rest)), np.float64)
    z = rest[:, 2]
    return np.column_stack([np.zeros((len(rest), 2)), _FORWARD * (z - z.min()) / (z.max() - z.min())])


def _between(rows: Doubles, station: Indices, part: Doubles) -> Doubles:
    """``rows (K, ...)`` at each place along the tongue."""
    weight = part if rows.ndim == 1 else part[:, None]
    return np.asarray(rows[station] + weight * (rows[station + 1] - rows[station]))


def new_sections() -> Sections:
    """Those of a pose that is still to come."""
    flat, curl, pitch, yaw = np.ones(STATIONS), np.zeros(STATIONS), np.zeros(STATIONS), np.zeros(STATIONS)
    return Sections(
        np.zeros((STATIONS, 3)), pitch, yaw, flat, curl, np.zeros(COLUMNS), np.zeros((6, COLUMNS)), np.zeros(10)
    )


def moves(tables: TongueTables, values: Floats) -> bool:
    """Whether the tongue leaves its rest at all."""
    for index in range(tables.parameters.shape[0]):
        if values[tables.parameters[index]] != 0.0:
            return True
    return False


def step(start: float, end: float, value: float) -> float:
    """The cubic from 0 at ``start`` to 1 at ``end``."""
    t = min(max((value - start) / (end - start), 0.0), 1.0)
    return t * t * (3.0 - 2.0 * t)


def limit(tables: TongueTables, values: Floats, vertices: Floats, jaw: Floats, now: Sections) -> None:
    """Look at teeth and lips, and write ``now.across``, ``now.lips`` and ``now.limits``."""
    lower, upper = tables.passage.walls[0], tables.passage.walls[1]
    passage.look_at_lips(tables.passage, vertices, now.across, now.lips)
    depth = lower[BACK] + lower[DEPTH]
    edge = jaw[1, 0] * lower[MIDDLE] + jaw[1, 1] * lower[EDGE] + jaw[1, 2] * depth + jaw[1, 3]
    between = upper[EDGE] - edge
    right, left, gap = passage.slot(now.across, now.lips, edge, upper[EDGE])
    last = STATIONS - 1
    tip_y, tip_z, reach = tables.line[last, 0], tables.line[last, 1], tables.line_out[last, 1]
    ahead = jaw[2, 0] * lower[MIDDLE] + jaw[2, 1] * tip_y + jaw[2, 2] * tip_z + jaw[2, 3]
    to_teeth = min(max(depth - tip_z, 0.0) / reach, 1.0)
    through = step(_THIN, _THICK, gap) * step(_NARROW, _WIDE, left - right)
    allowed = min(step(_THIN, _THICK, between), to_teeth + (1.0 - to_teeth) * through)
    wanted = float(values[tables.parameters[0]])
    out = 0.0
    if wanted > _LITTLE and allowed > _LITTLE:
        out = (wanted**-4.0 + allowed**-4.0 - 1.0) ** -0.25
    most = 0.0
    for index in range(tables.parameters.shape[0]):
        most = max(most, abs(values[tables.parameters[index]]))
    force = step(0.0, _SOONEST, most)
    leaves = step(0.0, _LEAVES[0], out)
    now.limits[0], now.limits[1] = out, force
    now.limits[2] = _FAN * lower[WIDTH] * step(_LEAVES[0], _LEAVES[1], out)
    now.limits[3], now.limits[4] = right, left
    now.limits[5] = max(out - _LEAVES[0], 0.0) * 3.0 * reach
    now.limits[6] = leaves
    now.limits[9] = _OVER * (1.0 - leaves * step(0.0, _AJAR, through))
    now.limits[8] = now.lips[OUTER_LOWER, COLUMNS // 2]
    lip = now.limits[8] + tip_z - ahead
    leaves_lips = 1.0 - max(tip_z + out * reach - lip, 0.0) / (
        tip_z - tables.line[0, 1] + out * (reach - tables.line_out[0, 1])
    )
    now.limits[7] = min(max(leaves_lips - _BEND_BEFORE, _BEND_FROM), _BEND_LAST) * leaves + _BEND_FROM * (1.0 - leaves)


def bend(tables: TongueTables, values: Floats, now: Sections) -> None:
    """Write where the stations would be with nothing in their way into ``now``."""
    out, raised = now.limits[0], values[tables.parameters[1]]
    up, aside, rolled = (values[tables.parameters[2]], values[tables.parameters[3]], values[tables.parameters[4]])
    lift = _LIFT * raised if raised > 0.0 else _SINK * raised
    pitch = _TIP_UP * up if up > 0.0 else _TIP_DOWN * up
    more = 1.0 + _BEND_MORE * out
    pitch = more * pitch - _DROOP * out * out
    hangs = _BEND_BEFORE if pitch < 0.0 else 0.0  # what hangs down clears the lip first
    start = now.limits[7] + out * hangs
    for k in range(STATIONS):
        share = step(start, 1.0, k / (STATIONS - 1))
        now.pitch[k], now.yaw[k] = pitch * share, more * _TIP_ASIDE * aside * share
        now.curl[k] = _ROLLED * rolled * tables.rolls[k] / (tables.wide[k] + out * tables.wide_out[k])
        now.flat[k] = 1.0
    before_y, before_z = 0.0, 0.0
    for k in range(STATIONS):
        y = tables.line[k, 0] + out * tables.line_out[k, 0] + lift * tables.hump[k]
        z = tables.line[k, 1] + out * tables.line_out[k, 1]
        if k == 0:
            now.place[0, 0], now.place[0, 1], now.place[0, 2] = 0.0, y, z
        else:
            theta, phi = 0.5 * (now.pitch[k] + now.pitch[k - 1]), 0.5 * (now.yaw[k] + now.yaw[k - 1])
            high, long = y - before_y, z - before_z
            ahead = long * np.cos(theta) - high * np.sin(theta)
            now.place[k, 0] = now.place[k - 1, 0] + ahead * np.sin(phi)
            now.place[k, 1] = now.place[k - 1, 1] + high * np.cos(theta) + long * np.sin(theta)
            now.place[k, 2] = now.place[k - 1, 2] + ahead * np.cos(phi)
        before_y, before_z = y, z


def lips_at(now: Sections, x: float) -> tuple[float, float, float, float, float, float]:
    """The lips at ``x`` m: a column of ``now.lips``."""
    column = 1
    while column < COLUMNS - 1 and now.across[column] > x:
        column += 1
    first, last = now.across[column - 1], now.across[column]
    part = min(max((first - x) / max(first - last, 1e-6), 0.0), 1.0)
    one, other = now.lips[:, column - 1], now.lips[:, column]
    return (
        one[BOTTOM] + part * (other[BOTTOM] - one[BOTTOM]),
        one[TOP] + part * (other[TOP] - one[TOP]),
        one[2] + part * (other[2] - one[2]),
        one[3] + part * (other[3] - one[3]),
        one[4] + part * (other[4] - one[4]),
        one[5] + part * (other[5] - one[5]),
    )


def room(tables: TongueTables, jaw: Floats, now: Sections, x: float, y: float, z: float) -> tuple[float, float]:
    """How far a place, in the jaw's axes and m, may go down and up along the height of the head, m."""
    walls, over = tables.passage.walls, _OVER * (1.0 - now.limits[6])
    at_x, at_y, at_z = posed(jaw, x, y, z)
    bottom, top, inner_lower, outer_lower, inner_upper, outer_upper = lips_at(now, at_x)
    below = bottom - passage.beyond_lip(inner_lower, outer_lower, at_z) - now.limits[9]
    above = top + passage.beyond_lip(inner_upper, outer_upper, at_z) + now.limits[9]
    down = (y - floor(walls[0], x, z, over)) * jaw[1, 1]
    teeth = ceiling(walls[1], at_x, at_z, over)
    return min(down, at_y - min(below, teeth - _PASSES)), min(teeth, above) - at_y


def posed(jaw: Floats, x: Doubles, y: Doubles, z: Doubles) -> tuple[Doubles, Doubles, Doubles]:
    """Places in the jaw's axes, in the head's."""
    return (
        jaw[0, 0] * x + jaw[0, 1] * y + jaw[0, 2] * z + jaw[0, 3],
        jaw[1, 0] * x + jaw[1, 1] * y + jaw[1, 2] * z + jaw[1, 3],
        jaw[2, 0] * x + jaw[2, 1] * y + jaw[2, 2] * z + jaw[2, 3],
    )


def floor(lower: Doubles, x: Doubles, z: Doubles, over: float) -> Doubles:
    """The least height over the lower teeth, m; ``over`` m less where nothing passes over them."""
    beside = (z - lower[BACK]) / lower[DEPTH]  # behind the canines the walls alone hold it: it need not lie over them
    beside = np.minimum(np.maximum((_CROSSES - beside) / _SETS_IN, 0.0), 1.0)
    ground = lower[EDGE] - _FLOOR - _STEEP * np.maximum(z - lower[FRONT], 0.0) - np.maximum(lower[BACK] + 0.01 - z, 0.0)
    return np.maximum(lower[EDGE] - passage.beyond_edge(lower, x, z) - over - _OVER * beside, ground)


def ceiling(upper: Doubles, x: Doubles, z: Doubles, over: float) -> Doubles:
    """The greatest height under the upper teeth and the palate, m."""
    palate = upper[EDGE] + _PALATE + _STEEP * np.maximum(z - upper[FRONT], 0.0)
    beside = np.minimum(np.maximum((_CROSSES - (z - upper[BACK]) / upper[DEPTH]) / _SETS_IN, 0.0), 1.0)
    return np.minimum(upper[EDGE] + passage.beyond_edge(upper, x, z) + over + _OVER * beside, palate)


def at_least(value: Doubles) -> Doubles:
    """0 below, ``value`` above, and over ``_SOFT`` m a parabola that joins both with their slopes."""
    near = np.minimum(np.maximum(value + _SOFT, 0.0), 2.0 * _SOFT)
    return near * near / (4.0 * _SOFT) + np.maximum(value - _SOFT, 0.0)


def held_within(low: Doubles, high: Doubles, value: Doubles) -> Doubles:
    """``value`` between two limits; halfway where these have changed places."""
    value = low + at_least(value - low)
    value = high - at_least(high - value)
    return np.maximum(value, np.minimum(low, 0.5 * (low + high)))


def held_aside(
    walls: Doubles, limits: Doubles, jaw: Floats, lip: tuple[Doubles, ...], x: Doubles, y: Doubles, z: Doubles
) -> tuple[Doubles, Doubles]:
    """The x and z of places held inside the rows of teeth, and in the opening of the lips."""
    _, _, ahead = posed(jaw, x, y, z)
    behind_lower = walls[0, BACK] + walls[0, DEPTH] + limits[5]
    far = np.maximum(z - (behind_lower - at_least(behind_lower - z)), 0.0)
    behind_upper = walls[1, BACK] + walls[1, DEPTH] + limits[5]
    far = np.maximum(far, np.maximum(ahead - (behind_upper - at_least(behind_upper - ahead)), 0.0))
    z = z - limits[1] * far
    ahead = ahead - limits[1] * far
    wide = np.maximum(passage.half_width(walls[0], z), limits[2])
    wide = np.minimum(wide, np.maximum(passage.half_width(walls[1], ahead), limits[2]))
    _, _, inner_lower, _, inner_upper, _ = lip
    inner, spread = np.minimum(inner_lower, inner_upper), _SPREADS * np.maximum(ahead - limits[8], 0.0)
    wide = wide + spread
    shifted = jaw[0, 3]
    high, low = walls[0, MIDDLE] + wide, walls[0, MIDDLE] - wide
    mouth = np.minimum(np.maximum((ahead - inner + _LIPS_FROM) / (_LIPS_FROM - _LIPS_WHOLE), 0.0), 1.0)
    free = _OVER * (1.0 - mouth) + spread
    high = np.minimum(high, limits[4] - shifted - 2.0 * passage.EDGE_CLEAR + free)
    low = np.maximum(low, limits[3] - shifted + 2.0 * passage.EDGE_CLEAR - free)
    return x + limits[1] * (held_within(low, high, x) - x), z


def lifted(walls: Doubles, limits: Doubles, x: Doubles, y: Doubles, z: Doubles) -> Doubles:
    """The heights of places held over the lower teeth."""
    low = floor(walls[0], x, z, _OVER * (1.0 - limits[6]))
    return y + limits[1] * (low + at_least(y - low) - y)


def lowered(walls: Doubles, limits: Doubles, lip: tuple[Doubles, ...], x: Doubles, y: Doubles, z: Doubles) -> Doubles:
    """How far places, in the head's axes, must go up to lie under the upper teeth and between the lips, m."""
    bottom, top, inner_lower, outer_lower, inner_upper, outer_upper = lip
    low = bottom - passage.beyond_lip(inner_lower, outer_lower, z) - limits[9]
    above = top + passage.beyond_lip(inner_upper, outer_upper, z) + limits[9]
    teeth = ceiling(walls[1], x, z, _OVER * (1.0 - limits[6]))
    return limits[1] * (held_within(np.minimum(low, teeth - _PASSES), np.minimum(teeth, above), y) - y)


def settle(tables: TongueTables, jaw: Floats, now: Sections) -> None:
    """Move and flatten the sections into what is free where they are."""
    shift, flat = np.zeros(STATIONS), np.ones(STATIONS)
    for k in range(STATIONS):
        x, y, z = now.place[k]
        half, wide = (
            tables.thick[k] * (1.0 + _PLUMPER * now.limits[0]),
            tables.wide[k] + now.limits[0] * tables.wide_out[k],
        )
        down, up = room(tables, jaw, now, x, y, z)
        free = max(down + up, 0.0)
        flat[k] = min(1.0, 0.5 * free / half)
        half = half * flat[k]
        if down < half:
            shift[k] = half - down
        elif up < half:
            shift[k] = up - half
        turn = max(now.curl[k] * wide, 1e-9)
        rolled = wide * (1.0 - np.cos(turn)) / turn
        if rolled > 1e-6:
            now.curl[k] *= min(1.0, max(free - 2.0 * half, 0.0) / rolled)
    for _ in range(3):
        before, thinner = shift[0], flat[0]
        for k in range(1, STATIONS - 1):
            here, height = shift[k], flat[k]
            shift[k] = 0.25 * before + 0.5 * here + 0.25 * shift[k + 1]
            flat[k] = min(height, 0.25 * thinner + 0.5 * height + 0.25 * flat[k + 1])
            before, thinner = here, height
    for k in range(1, STATIONS):
        shift[k] = max(shift[k], _CARRIES * shift[k - 1])
    for k in range(STATIONS):
        now.place[k, 1] += now.limits[1] * shift[k]
        now.flat[k] = 1.0 + now.limits[1] * (flat[k] - 1.0)


def apply(tables: TongueTables, values: Floats, vertices: Floats, jaw: Floats, out: Floats) -> None:
    """Write the tongue at the pose ``values`` into ``out (T, 3)`` m, between the lips of ``vertices (V, 3)`` m.

    ``jaw (4, 4)`` moves the lower teeth.
    """
    if not moves(tables, values):
        out[:] = tables.rest
        return
    now = new_sections()
    limit(tables, values, vertices, jaw, now)
    bend(tables, values, now)
    settle(tables, jaw, now)
    out[:] = _held(tables, jaw, now, _placed(tables, now))


def _placed(tables: TongueTables, now: Sections) -> Doubles:
    """``(T, 3)`` m: the vertices about the stations."""
    station, part = tables.station, tables.part
    x, h, length = (tables.arm + now.limits[0] * tables.arm_out).T
    place, pitch, yaw, flat, curl = (
        _between(row, station, part) for row in (now.place, now.pitch, now.yaw, now.flat, now.curl)
    )
    h = h * flat
    turn = curl * x + 1e-12
    sine, half = np.sin(turn), np.sin(0.5 * turn)
    x, h = x * sine / turn - h * sine, h * np.cos(turn) + x * half * half / (0.5 * turn)
    cosine, sine = np.cos(pitch), np.sin(pitch)
    h, length = h * cosine + length * sine, length * cosine - h * sine
    cosine, sine = np.cos(yaw), np.sin(yaw)
    return place + np.column_stack([x * cosine + length * sine, h, length * cosine - x * sine])


def _held(tables: TongueTables, jaw: Floats, now: Sections, points: Doubles) -> Doubles:
    """``points (T, 3)`` m held where they are free."""
    walls, limits = tables.passage.walls, now.limits
    x, y, z = points.T
    lips = _lips_at(now, posed(jaw, x, y, z)[0])
    x, z = held_aside(walls, limits, jaw, lips, x, y, z)
    y = lifted(walls, limits, x, y, z)
    at = posed(jaw, x, y, z)
    up = lowered(walls, limits, _lips_at(now, at[0]), *at)
    return np.column_stack([x, y, z]) + up[:, None] * jaw[1, :3].astype(np.float64)


def _lips_at(now: Sections, x: Doubles) -> tuple[Doubles, ...]:
    """:func:`lips_at` for many places."""
    return tuple(np.interp(x, now.across[::-1], row[::-1]) for row in now.lips)
