"""The tongue: a bend along its length that teeth and lips limit.

A vertex at rest belongs to a place along the middle line; from it, it keeps its arm. The middle line goes out with the
artists' ``tongueOut``, rises, and is bent up and aside towards its tip; across it, edges roll up about it:

    p' = c'(s) + Y(phi(s)) X(theta(s)) roll(p - c(s))

A muscle of the tongue does not open the mouth: ``tongue_out`` goes as far as the gap between the incisors and that
between the lips let a tongue of this thickness, and no farther than to the teeth where these or the lips meet. Then
each section is moved and flattened into what is free at its place, and every vertex is held there
(:mod:`.passage`): inside the rows of teeth, between their edges, between the lips.
"""

from __future__ import annotations

import numpy as np

from agentface.conventions import Doubles, Floats
from agentface.deform.tongue.holding import held_aside, lifted, lowered, posed, settle
from agentface.deform.tongue.sections import OUT, Sections, bend, limit, moves, new_sections
from agentface.deform.tongue.tables import TongueTables, between


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
    x, h, length = (tables.arm + now.limits[OUT] * tables.arm_out).T
    place, pitch, yaw, flat, curl = (
        between(row, station, part) for row in (now.place, now.pitch, now.yaw, now.flat, now.curl)
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
