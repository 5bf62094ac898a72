"""The displacement field of a few muscles, compiled in double precision: what the fit evaluates many thousand times."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numba import njit

from agentface.conventions import Doubles

STEP = 0.2
ROWS = 10
"""Numbers a muscle: origin 3, insertion 3, cosine of the zone, fall start, fall finish, elasticity."""


@njit(cache=True, fastmath=True)
def displacements(rest: Doubles, rows: Doubles, reach: Doubles, contraction: Doubles) -> Any:
    """``(V, 3)``: muscles ``rows (M, ROWS)`` with ``reach (M, V)``, combined in parallel steps of 0.2.

    The same formula as the deformer's kernel with the smooth fall-off; a test holds the two together.
    """
    moved = np.zeros(rest.shape)
    steps = math.ceil(contraction.max() / STEP - 1e-9)
    for v in range(rest.shape[0]):
        x, y, z = rest[v, 0], rest[v, 1], rest[v, 2]
        for step in range(steps):
            sx, sy, sz = 0.0, 0.0, 0.0
            for m in range(rows.shape[0]):
                share = min(STEP, contraction[m] - step * STEP)
                if share <= 0.0 or reach[m, v] == 0.0:
                    continue
                dx, dy, dz = rows[m, 0] - x, rows[m, 1] - y, rows[m, 2] - z
                distance = math.sqrt(dx * dx + dy * dy + dz * dz)
                if distance >= rows[m, 8] or distance < 1e-9:
                    continue
                ax, ay, az = rows[m, 3] - rows[m, 0], rows[m, 4] - rows[m, 1], rows[m, 5] - rows[m, 2]
                cosine = -(dx * ax + dy * ay + dz * az) / (distance * math.sqrt(ax * ax + ay * ay + az * az))
                angular = (cosine - rows[m, 6]) / (1.0 - rows[m, 6])
                if angular <= 0.0:
                    continue
                start, finish = rows[m, 7], rows[m, 8]
                part = 1.0 - distance / start if distance < start else (distance - start) / (finish - start)
                pull = share * rows[m, 9] * reach[m, v] * angular * math.cos(0.5 * math.pi * part) / distance
                sx += pull * dx
                sy += pull * dy
                sz += pull * dz
            x += sx
            y += sy
            z += sz
        moved[v, 0], moved[v, 1], moved[v, 2] = x - rest[v, 0], y - rest[v, 1], z - rest[v, 2]
    return moved
