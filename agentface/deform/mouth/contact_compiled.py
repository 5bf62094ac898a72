"""The loops of contact; their numpy twins are in :mod:`agentface.deform.mouth.contact`."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from agentface.conventions import Floats
from agentface.deform import morphs
from agentface.deform.mouth.contact import APART, PARTINGS, ROUNDS, TOUCH
from agentface.deform.mouth.contact_tables import ContactTables
from agentface.deform.mouth.lip_bite_compiled import bite
from agentface.deform.mouth.lip_facing_compiled import look, look_again, put
from agentface.deform.mouth.lip_parting_compiled import close, part, seal
from agentface.kernel import kernel

_ZERO, _ONE = np.float32(0.0), np.float32(1.0)
_TWO, _THREE, _FOUR = np.float32(2.0), np.float32(3.0), np.float32(4.0)

jaw_slide = kernel(error_model="numpy")(morphs.jaw_slide)


@kernel(error_model="numpy")
def apply(tables: ContactTables, values: Floats, points: Floats) -> None:
    """Shuts lips, parts those that overlap, and pushes them out of the teeth; as its twin."""
    apart = _ZERO
    for k in range(tables.morphs.shape[0]):
        apart += abs(values[tables.morphs[k]])
    apart = APART * min(_ONE, apart)
    mouth = look(tables, points)
    if values[tables.seal] > _ZERO:
        seal(tables, values[tables.seal], apart, mouth)
    for _ in range(ROUNDS if values[tables.press] > _ZERO else 1):
        close(tables, values[tables.press], mouth)
        part(tables, apart, mouth)
    put(tables, mouth, points)
    if values[tables.bite] > _ZERO:
        bite(tables, values[tables.bite], points)
    _hold_out(tables, values, values[tables.bite], points)
    look_again(tables, points, mouth)
    for _ in range(PARTINGS):
        if not part(tables, apart, mouth):
            break
    if values[tables.seal] > _ZERO:
        seal(tables, values[tables.seal], apart, mouth)
    put(tables, mouth, points)
    if values[tables.seal] > _ZERO:
        _hold_out(tables, values, values[tables.bite] * (_ONE - values[tables.seal]), points)


@kernel(error_model="numpy")
def _hold_out(tables: ContactTables, values: Floats, bitten: np.float32, points: Floats) -> None:
    angle = np.float32(tables.widest * values[tables.jaw])
    cosine, sine = np.float32(math.cos(angle)), np.float32(math.sin(angle))
    hinge_y, hinge_z = tables.hinge[0], tables.hinge[1]
    forth, aside = jaw_slide(tables.slides, values)
    for k in range(tables.vertex.shape[0]):
        vertex = tables.vertex[k]
        across, ahead = _push(tables, 0, k, bitten, points[vertex, 0], points[vertex, 1], points[vertex, 2])
        points[vertex, 0] += across
        points[vertex, 2] += ahead
        up, forward = points[vertex, 1] - hinge_y, points[vertex, 2] - hinge_z
        y = hinge_y + cosine * up + sine * forward
        z = hinge_z - sine * up + cosine * forward - np.float32(forth)
        across, ahead = _push(tables, 1, k, bitten, points[vertex, 0] - np.float32(aside), y, z)
        points[vertex, 0] += across
        points[vertex, 1] -= sine * ahead
        points[vertex, 2] += cosine * ahead


@kernel(error_model="numpy", inline="always")
def _push(tables: ContactTables, arch: int, k: int, bitten: np.float32, x: float, y: float, z: float) -> Any:
    kept = tables.kept[arch, k]
    if kept < _ZERO:
        return _ZERO, _ZERO
    beyond = (tables.arch[arch, 2] - y) / tables.arch[arch, 3]
    if beyond >= _ONE:
        return _ZERO, _ZERO
    share = min(_ONE, _ONE - beyond)
    share = share * share * (_THREE - _TWO * share)
    front, bend = tables.arch[arch, 0], tables.arch[arch, 1]
    if bitten > _ZERO:
        relief = bitten * tables.relief[k]
        front += relief * (tables.crowns[arch, 0] - front)
        bend += relief * (tables.crowns[arch, 1] - bend)
        kept += relief * (TOUCH - kept)
    slope = _TWO * bend * x
    steepness = np.float32(math.sqrt(_ONE + slope * slope))
    distance = (z - front + bend * x * x) / steepness
    soft = tables.softness[arch, k]
    over = soft - (distance - kept)
    if over <= _ZERO:
        return _ZERO, _ZERO
    push = share * (over * over / (_FOUR * soft) if over < _TWO * soft else over - soft) / steepness
    return push * slope, push
