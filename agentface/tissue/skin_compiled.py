"""From the tissue to the skin, compiled; the numpy twin is :mod:`agentface.tissue.skin`."""

from __future__ import annotations

import numpy as np

from agentface.conventions import Floats
from agentface.deform.lanes import LANES
from agentface.kernel import kernel
from agentface.tissue.skin import METRES, EpidermisTables

_METRES = np.float32(METRES)


@kernel(error_model="numpy", fastmath=True)
def put(tables: EpidermisTables, positions: Floats, points: Floats) -> None:
    """Writes skin and control points, ``points (P, 3)`` m, as ``positions`` of the tissue have them."""
    now, before = positions.ravel(), tables.resting.ravel()
    rest, carried = tables.rest, tables.carried
    count = tables.place.shape[0]
    for vertex in range(count):
        for axis in range(3):
            at = tables.place[vertex] + axis * LANES
            points[vertex, axis] = rest[vertex, axis] + _METRES * (now[at] - before[at])
    for index in range(carried.vertices.shape[0]):
        x = y = z = np.float32(0.0)
        for term in range(carried.first[index], carried.first[index + 1]):
            weight, carrier = carried.weights[term], carried.carriers[term]
            x += weight * (points[carrier, 0] - rest[carrier, 0])
            y += weight * (points[carrier, 1] - rest[carrier, 1])
            z += weight * (points[carrier, 2] - rest[carrier, 2])
        vertex = carried.vertices[index]
        points[vertex, 0], points[vertex, 1], points[vertex, 2] = (
            rest[vertex, 0] + x,
            rest[vertex, 1] + y,
            rest[vertex, 2] + z,
        )
    for control in range(tables.control_vertices.shape[0]):
        for axis in range(3):
            moved = np.float32(0.0)
            for term in range(tables.control_vertices.shape[1]):
                vertex = tables.control_vertices[control, term]
                moved += tables.control_weights[control, term] * (points[vertex, axis] - rest[vertex, axis])
            points[count + control, axis] = rest[count + control, axis] + moved
