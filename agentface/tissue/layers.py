"""Where the three layers lie under the skin: inward, as thick as the tissue there, and no prism degenerate."""

from __future__ import annotations

import numpy as np

from agentface.conventions import Doubles, Indices
from agentface.head.model import HeadModel
from agentface.mesh.graph import SparseMatrix, grown, smoothed
from agentface.mesh.normals import doubled_areas
from agentface.tissue.members import Members
from agentface.tissue.tissue_file import LatticeTable

EPIDERMIS, DERMIS, HYPODERMIS = range(3)
_LEAST_AREA = 0.30
"""Of a prism's upper triangle, the least that its lower one may have."""
_STEEP = 0.6
"""Cosine below which a smoothed direction is bent back to the normal."""
_NEAR_A_HOLE_MM = 2.0
_THINNEST_MM = 0.1


def inward(normals: Doubles, beside: SparseMatrix) -> Doubles:
    """``(V, 3)`` unit directions into the face: smoothed normals, which do not leave the skin sideways."""
    ways = smoothed(beside, normals, 3)
    ways /= -np.linalg.norm(ways, axis=1, keepdims=True)
    along = -(ways * normals).sum(axis=1)
    back = np.clip((_STEEP - along) / _STEEP, 0.0, 1.0)[:, None]
    ways -= back * (ways + normals)
    return np.asarray(ways / np.linalg.norm(ways, axis=1, keepdims=True))


def thickness(
    model: HeadModel, table: LatticeTable, depth: Doubles, ways: Doubles, beside: SparseMatrix, where: Members
) -> Doubles:
    """``(V,)`` mm from epidermis to hypodermis: thinner where prisms would degenerate."""
    points, triangles = 1e3 * model.vertices.astype(np.float64), model.triangles
    low, high = table.thickness_mm
    thick = np.clip(table.thickness * depth * by_region(model, table.regions, beside), low, high)
    near = grown(where.absent, beside, 2)
    thick[near] = np.minimum(thick[near], _NEAR_A_HOLE_MM)
    thick = smoothed(beside, thick, 2)
    whole = ~where.absent[triangles].any(axis=1)
    while True:
        lower = [area_ratio(points, points + (part * thick)[:, None] * ways, triangles) for part in (table.dermis, 1.0)]
        bad = np.unique(triangles[whole & (np.minimum(*lower) < _LEAST_AREA)])
        bad = bad[thick[bad] > 1.5 * _THINNEST_MM]
        if not len(bad):
            return np.minimum(thick, thick[model.mirror])
        thick[bad] *= 0.85
        thick = np.maximum(np.minimum(thick, smoothed(beside, thick, 1, 0.3) + 1e-9), _THINNEST_MM)


def by_region(model: HeadModel, factors: dict[str, float], beside: SparseMatrix) -> Doubles:
    """``(V,)``: the factor of each vertex's region, 1 for one that has none, evened out at borders."""
    field = np.ones(len(model.vertices))
    for name, factor in factors.items():
        field[model.regions.mask([name])] = factor
    return smoothed(beside, field, 3)


def area_ratio(upper: Doubles, lower: Doubles, triangles: Indices) -> Doubles:
    """``(T,)``: area of each lower triangle along the upper one's normal over that one's area."""
    above, below = doubled_areas(upper, triangles), doubled_areas(lower, triangles)
    return np.asarray((above * below).sum(axis=1) / np.maximum((above * above).sum(axis=1), 1e-12))
