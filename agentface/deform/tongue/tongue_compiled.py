"""The tongue's loop; the numpy twin is :mod:`.tongue`; both share the code of :mod:`.sections` and :mod:`.holding`.

The stations move one by one, the vertices LANES at once; double precision, as a place at the end of the teeth's wall is
told by the root of what is left of its depth.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from agentface.conventions import Doubles, Floats, Indices
from agentface.deform import simd_numpy  # noqa: F401  # np.sin(vector)
from agentface.deform.lanes import LANES
from agentface.deform.simd import gather, load, store, store_whole, whole
from agentface.deform.tongue import holding, passage_compiled, sections
from agentface.deform.tongue.passage import COLUMNS
from agentface.deform.tongue.passage_compiled import FAST
from agentface.deform.tongue.sections import OUT, Sections
from agentface.deform.tongue.tables import STATIONS, TongueBlocks, TongueTables
from agentface.kernel import compiled_twin, kernel

_X, _Y, _Z, _PITCH, _YAW, _FLAT, _CURL = range(7)  # rows of what the vertices need of the stations
_LIPS = 6  # rows of :attr:`.sections.Sections.lips`
_NARROWEST = 1e-6 * (COLUMNS - 1)  # m, of a mouth whose columns are told apart

_names: dict[str, Any] = {**vars(sections), **vars(holding), "__name__": __name__, "passage": passage_compiled}


def _twin(function: Callable[..., Any]) -> Any:
    made = _names[function.__name__] = compiled_twin(function, _names, error_model="numpy", fastmath=FAST)
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
    stations = _stations(now)
    lanes, column = np.empty((3, LANES)), np.empty(LANES, np.int32)
    for block in range(tables.blocks.part.shape[0]):
        _write(tables.blocks, tables.passage.walls, now, stations, jaw, block, column, lanes)
        for lane in range(min(LANES, out.shape[0] - block * LANES)):
            for axis in range(3):
                out[block * LANES + lane, axis] = lanes[axis, lane]


@kernel(error_model="numpy")
def _stations(now: Sections) -> Doubles:
    """``(7, STATIONS)``: what the vertices need of the stations."""
    found = np.empty((_CURL + 1, STATIONS))
    for k in range(STATIONS):
        found[_X, k], found[_Y, k], found[_Z, k] = now.place[k, 0], now.place[k, 1], now.place[k, 2]
        found[_PITCH, k], found[_YAW, k] = now.pitch[k], now.yaw[k]
        found[_FLAT, k], found[_CURL, k] = now.flat[k], now.curl[k]
    return found


@kernel(error_model="numpy", fastmath=FAST)
def _write(
    blocks: TongueBlocks,
    walls: Doubles,
    now: Sections,
    stations: Doubles,
    jaw: Floats,
    block: int,
    column: Indices,
    lanes: Doubles,
) -> None:
    """Write one block of vertices, placed about the stations and held where they are free, into ``lanes``, m."""
    x, y, z = _placed(blocks, stations, now.limits[OUT], block)
    lip = _lips_at(now.across, now.lips, posed(jaw, x, y, z)[0], column)
    x, z = held_aside(walls, now.limits, jaw, lip, x, y, z)
    y = lifted(walls, now.limits, x, y, z)
    at_x, at_y, at_z = posed(jaw, x, y, z)
    up = lowered(walls, now.limits, _lips_at(now.across, now.lips, at_x, column), at_x, at_y, at_z)
    store(lanes, 0, x + up * jaw[1, 0])
    store(lanes, LANES, y + up * jaw[1, 1])
    store(lanes, 2 * LANES, z + up * jaw[1, 2])


@kernel(error_model="numpy", fastmath=FAST)
def _placed(blocks: TongueBlocks, stations: Doubles, out: float, block: int) -> Any:
    """A block of vertices about the stations, m."""
    at, arm, arm_out = block * LANES, 6 * block * LANES, (6 * block + 3) * LANES
    here, part = np.empty((_CURL + 1, LANES)), load(blocks.part, at)
    for row in range(_CURL + 1):
        _between(stations, blocks.station, at, row * STATIONS, part, here, row * LANES)
    x = load(blocks.arm, arm) + load(blocks.arm, arm_out) * out
    h = load(blocks.arm, arm + LANES) + load(blocks.arm, arm_out + LANES) * out
    length = load(blocks.arm, arm + 2 * LANES) + load(blocks.arm, arm_out + 2 * LANES) * out
    h, turn = h * load(here, _FLAT * LANES), load(here, _CURL * LANES) * x + 1e-12
    sine, half = np.sin(turn), np.sin(turn * 0.5)
    x, h = x * sine / turn - h * sine, h * np.cos(turn) + x * half * half / (turn * 0.5)
    pitch, yaw = load(here, _PITCH * LANES), load(here, _YAW * LANES)
    cosine, sine = np.cos(pitch), np.sin(pitch)
    h, length = h * cosine + length * sine, length * cosine - h * sine
    cosine, sine = np.cos(yaw), np.sin(yaw)
    return (
        load(here, _X * LANES) + x * cosine + length * sine,
        load(here, _Y * LANES) + h,
        load(here, _Z * LANES) + length * cosine - x * sine,
    )


@kernel(error_model="numpy", fastmath=FAST)
def _between(rows: Doubles, index: Indices, at: int, first: int, part: Any, out: Doubles, place: int) -> None:
    """Write what of the row of ``rows`` from ``first`` on lies ``part`` of the way from ``index`` to the next one."""
    here = gather(rows, index, at, first)
    store(out, place, here + part * (gather(rows, index, at, first + 1) - here))


@kernel(error_model="numpy", fastmath=FAST)
def _lips_at(across: Doubles, lips: Doubles, x: Any, column: Indices) -> Any:
    """The lips at each of a block of ``x`` m, whose columns are evenly ``across`` the mouth."""
    first, last = across[0], across[COLUMNS - 1]
    place = (first - x) * ((COLUMNS - 1) / max(first - last, _NARROWEST))
    place = np.minimum(np.maximum(place, 0.0), COLUMNS - 1.0)
    before = whole(np.minimum(place, COLUMNS - 2.0))
    part = place - before
    store_whole(column, 0, before)
    there = np.empty((_LIPS, LANES))
    for row in range(_LIPS):
        _between(lips, column, 0, row * COLUMNS, part, there, row * LANES)
    return (
        load(there, 0),
        load(there, LANES),
        load(there, 2 * LANES),
        load(there, 3 * LANES),
        load(there, 4 * LANES),
        load(there, 5 * LANES),
    )
