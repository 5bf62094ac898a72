"""The sections of the tongue in one pose: how far it may go out, and where its middle line is bent."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from agentface.conventions import Doubles, Floats
from agentface.deform.tongue import passage
from agentface.deform.tongue.passage import BACK, COLUMNS, DEPTH, EDGE, MIDDLE, OUTER_LOWER, WIDTH
from agentface.deform.tongue.tables import STATIONS, TongueTables

OUT, FORCE, FAN, RIGHT, LEFT, AHEAD, OVER, BENDS, SPREADS, HEEDLESS, HANGS = range(11)
"""Places in :attr:`Sections.limits`."""
LIMITS = 11
UNLIMITED = 0.03
"""m, what is as good as no limit."""
_LIFT, _SINK = 0.008, 0.004  # m, of the back of the tongue
_TIP_UP, _TIP_DOWN, _TIP_ASIDE, _DROOP = 1.1, 0.7, 0.85, 0.6  # rad; how far a tongue that is out hangs down
_DROOP_LEAST = 0.15  # rad
_HANGS_ALREADY = 0.4  # rad of the way down, that a tongue which is out has gone
_BEND_MORE = 0.3  # as a part, when it is out
_BEND_FROM, _BEND_LAST, _BEND_BEFORE = 0.45, 0.75, 0.12
"""Where along the tongue it bends at rest, where at the latest, and how much before it leaves the lips."""
_ROLLED = 1.3  # rad, the turn of each edge
_THIN, _THICK = 0.003, 0.0075  # m, gaps that let nothing through, and all
_NARROW, _WIDE = 0.006, 0.014  # m, widths of a mouth that do
_FAN = 0.72  # of the arch's width, what goes out between the teeth
_LEAVES = 0.05, 0.15  # of the way out, over which the tongue leaves its place behind the teeth
_AJAR = 0.05  # of the way that the lips let it, from which on they hold it whole
_LITTLE = 1e-4
_SOONEST = 0.1  # of any movement, from which on the teeth hold the tongue


class Sections(NamedTuple):
    """The stations in one pose.

    Attributes:
        place: ``(K, 3)`` m; ``pitch``, ``yaw``: ``(K,)`` rad; ``flat``: ``(K,)`` 0..1, what is left of its height.
        curl: ``(K,)`` 1/m, the roll.
        across, lips: the lips as :func:`.passage.look_at_lips` has them.
        limits: by the names above: how far it is out, 0..1; how far all limits are in force, 0..1; half of its width
            between the teeth, m; the ends of the lips' opening, m; how far past the incisors it may reach, m; whether
            it lies over the teeth, 0..1; where along it the bend begins, 0..1; the depth before the lips from which on
            it may spread, m; how far it need not heed lips that let nothing through, m; the turn by which
            it hangs down, rad.
    """

    place: Doubles
    pitch: Doubles
    yaw: Doubles
    flat: Doubles
    curl: Doubles
    across: Doubles
    lips: Doubles
    limits: Doubles


def new_sections() -> Sections:
    """Those of a pose that is still to come."""
    flat, curl, pitch, yaw = np.ones(STATIONS), np.zeros(STATIONS), np.zeros(STATIONS), np.zeros(STATIONS)
    return Sections(
        np.zeros((STATIONS, 3)),
        pitch,
        yaw,
        flat,
        curl,
        np.zeros(COLUMNS),
        np.zeros((6, COLUMNS)),
        np.zeros(LIMITS),
    )


def moves(tables: TongueTables, values: Floats) -> bool:
    """Whether anything can move the tongue from its rest."""
    return strongest(tables, values) > 0.0


def strongest(tables: TongueTables, values: Floats) -> float:
    """The largest of its own movements and of the slides of the jaw, 0..1."""
    most = 0.0
    for index in range(tables.stirs.shape[0]):
        most = max(most, abs(values[tables.stirs[index]]))
    return most


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
    force = step(0.0, _SOONEST, strongest(tables, values))
    leaves = step(0.0, _LEAVES[0], out)
    now.limits[OUT], now.limits[FORCE] = out, force
    now.limits[FAN] = _FAN * lower[WIDTH] * step(_LEAVES[0], _LEAVES[1], out)
    now.limits[RIGHT], now.limits[LEFT] = right, left
    now.limits[AHEAD] = max(out - _LEAVES[0], 0.0) * 3.0 * reach
    now.limits[OVER] = leaves
    now.limits[HEEDLESS] = UNLIMITED * (1.0 - leaves * step(0.0, _AJAR, through))
    turned = np.arctan2(jaw[2, 1], jaw[1, 1])  # the jaw itself lets it hang
    now.limits[HANGS] = out * out * max(_DROOP - turned, _DROOP_LEAST)
    now.limits[SPREADS] = now.lips[OUTER_LOWER, COLUMNS // 2]
    lip = now.limits[SPREADS] + tip_z - ahead
    leaves_lips = 1.0 - max(tip_z + out * reach - lip, 0.0) / (
        tip_z - tables.line[0, 1] + out * (reach - tables.line_out[0, 1])
    )
    now.limits[BENDS] = min(max(leaves_lips - _BEND_BEFORE, _BEND_FROM), _BEND_LAST) * leaves + _BEND_FROM * (
        1.0 - leaves
    )


def bend(tables: TongueTables, values: Floats, now: Sections) -> None:
    """Write where the stations would be with nothing in their way into ``now``."""
    out, raised = now.limits[OUT], values[tables.parameters[1]]
    up, aside, rolled = (values[tables.parameters[2]], values[tables.parameters[3]], values[tables.parameters[4]])
    lift = _LIFT * raised if raised > 0.0 else _SINK * raised
    pitch = _TIP_UP * up if up > 0.0 else (_TIP_DOWN - _HANGS_ALREADY * out) * up
    more = 1.0 + _BEND_MORE * out
    pitch = more * pitch - now.limits[HANGS]
    hangs = _BEND_BEFORE if pitch < 0.0 else 0.0  # what hangs down clears the lip first
    start = now.limits[BENDS] + out * hangs
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
