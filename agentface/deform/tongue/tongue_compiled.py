"""The tongue's loop; the numpy twin is :mod:`.tongue`; both share the code of :mod:`.sections` and :mod:`.holding`."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

from agentface.conventions import Doubles, Floats
from agentface.deform.tongue import holding, passage_compiled, sections
from agentface.deform.tongue.sections import OUT, Sections
from agentface.deform.tongue.tables import TongueTables
from agentface.kernel import compiled_twin, kernel

_names: dict[str, Any] = {**vars(sections), **vars(holding), "__name__": __name__, "passage": passage_compiled}


def _twin(function: Callable[..., Any]) -> Any:
    made = _names[function.__name__] = compiled_twin(function, _names, error_model="numpy")
    return made


# in the order in which they call each other
new_sections, strongest, moves = _twin(sections.new_sections), _twin(sections.strongest), _twin(sections.moves)
step, at_least, posed = _twin(sections.step), _twin(holding.at_least), _twin(holding.posed)
lips_at, floor, ceiling = _twin(holding.lips_at), _twin(holding.floor), _twin(holding.ceiling)
room, held_within, limit = _twin(holding.room), _twin(holding.held_within), _twin(sections.limit)
bend, settle = _twin(sections.bend), _twin(holding.settle)
held_aside, lifted, lowered = _twin(holding.held_aside), _twin(holding.lifted), _twin(holding.lowered)


@kernel(error_model="numpy")
def apply(tables: TongueTables, values: Floats, vertices: Floats, jaw: Floats, out: Floats) -> None:
    """Write the tongue at the pose ``values`` into ``out (T, 3)`` m, between the lips of ``vertices (V, 3)`` m."""
    if not moves(tables, values):
        out[:] = tables.rest
        return
    now = new_sections()
    limit(tables, values, vertices, jaw, now)
    bend(tables, values, now)
    settle(tables, jaw, now)
    walls, limits = tables.passage.walls, now.limits
    for vertex in range(tables.rest.shape[0]):
        x, y, z = _placed(tables, now, vertex)
        lips = lips_at(now, posed(jaw, x, y, z)[0])
        x, z = held_aside(walls, limits, jaw, lips, x, y, z)
        y = lifted(walls, limits, x, y, z)
        at_x, at_y, at_z = posed(jaw, x, y, z)
        up = lowered(walls, limits, lips_at(now, at_x), at_x, at_y, at_z)
        out[vertex, 0], out[vertex, 1], out[vertex, 2] = x + up * jaw[1, 0], y + up * jaw[1, 1], z + up * jaw[1, 2]


@kernel(error_model="numpy")
def _placed(tables: TongueTables, now: Sections, vertex: int) -> tuple[float, float, float]:
    """A vertex about the stations, m."""
    k, part, out = tables.station[vertex], tables.part[vertex], now.limits[OUT]
    pitch, yaw = _between(now.pitch, k, part), _between(now.yaw, k, part)
    flat, curl = _between(now.flat, k, part), _between(now.curl, k, part)
    x = tables.arm[vertex, 0] + out * tables.arm_out[vertex, 0]
    h = flat * (tables.arm[vertex, 1] + out * tables.arm_out[vertex, 1])
    length = tables.arm[vertex, 2] + out * tables.arm_out[vertex, 2]
    turn = curl * x + 1e-12
    sine, half = math.sin(turn), math.sin(0.5 * turn)
    x, h = x * sine / turn - h * sine, h * math.cos(turn) + x * half * half / (0.5 * turn)
    h, length = h * math.cos(pitch) + length * math.sin(pitch), length * math.cos(pitch) - h * math.sin(pitch)
    x, length = x * math.cos(yaw) + length * math.sin(yaw), length * math.cos(yaw) - x * math.sin(yaw)
    return (
        _between(now.place[:, 0], k, part) + x,
        _between(now.place[:, 1], k, part) + h,
        _between(now.place[:, 2], k, part) + length,
    )


@kernel(error_model="numpy")
def _between(rows: Doubles, station: int, part: float) -> float:
    """``rows (K,)`` at a place along the tongue."""
    here: float = rows[station]
    return here + part * (rows[station + 1] - here)
