"""How deep the soft tissue of a face is: known at landmarks, harmonic between them."""

from __future__ import annotations

import numpy as np

from agentface.conventions import Doubles
from agentface.head.landmarks import both_sides
from agentface.head.model import HeadModel
from agentface.head.regions import REGIONS, REST
from agentface.mesh.graph import SparseMatrix, harmonic

_SCALP_MM = 7.0


def depths(model: HeadModel, laplacian: SparseMatrix, table: dict[str, float]) -> Doubles:
    """``(V,)`` mm from skin to bone, the same on both sides; ``table`` in mm by landmark, paired ones without side."""
    points = model.vertices.astype(np.float64)
    known = dict.fromkeys(np.flatnonzero(model.regions.region_of == REGIONS.index(REST)).tolist(), _SCALP_MM)
    for name, depth in table.items():
        for full in both_sides(name):
            nearest = int(((points - model.landmarks[full]) ** 2).sum(axis=1).argmin())
            known[nearest] = depth
    chosen = np.array(sorted(known), np.int32)
    field = harmonic(laplacian, chosen, np.array([known[vertex] for vertex in chosen.tolist()]))
    return np.asarray(0.5 * (field + field[model.mirror]))
