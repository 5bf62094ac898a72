"""The 23 muscles as fields of force on the hypodermis (Zhang, Prakash and Sung, section 3.2; the forces are ours).

The paper refers for its three kinds of muscle to a work that prints no formula either. Here a linear muscle pulls
toward its bone end, within a cone, and may thicken; a sheet along parallel fibres, within a strip; a sphincter toward
its centre, on a ring. Forces are given for 8 mm2 of skin, so that they do not depend on the mesh.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from agentface.conventions import SIDES, Doubles
from agentface.errors import InvalidValueError, Place
from agentface.head.model import HeadModel
from agentface.head.muscles import anchor_point
from agentface.mesh.smoothstep import smoothstep
from agentface.parameters import COUNT, indices_of
from agentface.tissue.lattice import Lattice
from agentface.tissue.layers import HYPODERMIS
from agentface.tissue.tissue_file import (
    NAMES,
    TISSUE_FILE,
    LinearRow,
    MuscleRow,
    SheetRow,
    SphincterRow,
    TissueFile,
    row_and_side,
)

_TINY = 1e-9
_SHORTEST_M = 1e-5
"""Between the ends of a muscle: a shorter one has no direction."""
_LEAST = 1e-3
"""Of its strength: what a muscle must pull with somewhere."""


def nodal_forces(model: HeadModel, lattice: Lattice) -> Doubles:
    """``(23, V, 3)``: the force of every muscle, fully contracted, on each node of the hypodermis.

    Raises InvalidValueError for a muscle that pulls on nothing.
    """
    return np.stack([_force(model, lattice, name) for name in NAMES])


def _force(model: HeadModel, lattice: Lattice, name: str) -> Doubles:
    base, own = row_and_side(name)
    row, side = lattice.file.muscles[base], own or SIDES[0]
    place = ("muscles", base)
    if not isinstance(row, SphincterRow):
        origin, insertion = (anchor_point(anchor, side, model.landmarks) for anchor in (row.origin, row.insertion))
        if not np.linalg.norm(insertion - origin) > _SHORTEST_M:
            where = Place(TISSUE_FILE, (*place, "insertion"))
            raise InvalidValueError(where, "a point apart from the origin", insertion.round(6).tolist())
    field = unit_field(model, lattice, row, side)
    if not np.abs(field).max() > _LEAST:
        hint = "its zone must reach skin of its regions"
        raise InvalidValueError(Place(TISSUE_FILE, place), "a muscle that pulls on some of the tissue", "none", hint)
    return row.strength * field + belly_field(model, lattice, row, side)


def belly_field(model: HeadModel, lattice: Lattice, row: MuscleRow, side: str) -> Doubles:
    """``(V, 3)``: the force with which a muscle that thickens pushes out of the face; 0 for one without a belly."""
    field = np.zeros_like(lattice.normals)
    if isinstance(row, LinearRow) and row.belly is not None:
        unit = 1e3 * model.landmarks.eye_separation
        away = lattice.rest[HYPODERMIS] - 1e3 * anchor_point(row.belly, side, model.landmarks)
        near = smoothstep(1.0, 0.0, np.linalg.norm(away, axis=1) / (unit * row.belly.radius))
        field += (row.belly.strength * near * _reach(model, lattice, row))[:, None] * lattice.normals
    return field


def unit_field(model: HeadModel, lattice: Lattice, row: MuscleRow, side: str) -> Doubles:
    """``(V, 3)``: the pull of a muscle of strength 1 on one side."""
    unit = 1e3 * model.landmarks.eye_separation
    points, reach = lattice.rest[HYPODERMIS], _reach(model, lattice, row)
    if isinstance(row, SphincterRow):
        centre = 1e3 * anchor_point(row.centre, side, model.landmarks)
        pull = _sphincter(row, points, centre, unit, lattice.normals)
    else:
        origin, insertion = (
            1e3 * anchor_point(anchor, side, model.landmarks) for anchor in (row.origin, row.insertion)
        )
        if isinstance(row, SheetRow):
            pull = _sheet(row, points, origin, insertion, unit)
        else:
            pull = _linear(row, points, origin, insertion, unit)
    field = reach[:, None] * pull
    lattice.carried.hand_on(field)
    return field


def _reach(model: HeadModel, lattice: Lattice, row: MuscleRow) -> Doubles:
    """``(V,)``: how far a muscle may move each node at all, as its area of skin and its regions say."""
    return np.asarray(model.borders.reach(row, model.landmarks.eye_separation) * lattice.area * lattice.pulled)


def _linear(row: LinearRow, points: Doubles, origin: Doubles, insertion: Doubles, unit: float) -> Doubles:
    """Toward the bone end: most on the axis of the cone and at ``fall_start``, 0 at its edges."""
    axis, away = insertion - origin, points - origin
    distance = np.maximum(np.linalg.norm(away, axis=1), _TINY)
    cosine, edge = away @ axis / (distance * np.linalg.norm(axis)), np.cos(np.radians(row.zone_deg))
    aside = smoothstep(edge, 1.0, cosine)
    near, start, finish = (unit * place for place in (row.fall_near, row.fall_start, row.fall_finish))
    rising = np.sin(np.clip((distance - near) / (start - near), 0.0, 1.0) * np.pi / 2.0)
    falling = np.cos(np.clip((distance - start) / (finish - start), 0.0, 1.0) * np.pi / 2.0)
    size = aside * np.where(distance <= start, rising, falling) ** 2
    return np.asarray(-(size / distance)[:, None] * away)


def _sheet(row: SheetRow, points: Doubles, origin: Doubles, insertion: Doubles, unit: float) -> Doubles:
    """Along the fibres to the bone: most at the skin end, 0 at the strip's edges and beyond its two lengths."""
    axis = (insertion - origin) / np.linalg.norm(insertion - origin)
    along = (points - insertion) @ axis
    aside = np.linalg.norm(points - insertion - along[:, None] * axis, axis=1)
    across = np.clip(1.0 - aside / (unit * row.half_width), 0.0, 1.0)
    reach = np.where(along < 0.0, -along / row.above, along / row.below) / unit
    size = smoothstep(0.0, 1.0, across) * smoothstep(1.0, 0.0, reach)
    return np.asarray(-size[:, None] * axis)


def _sphincter(row: SphincterRow, points: Doubles, centre: Doubles, unit: float, normals: Doubles) -> Doubles:
    """Toward the centre of an ellipse: 0 in the middle and on its rim, most on its crest; only before the ears."""
    away = points - centre
    wide, high = (unit * radius for radius in row.radii)
    part = np.hypot(away[:, 0] / wide, away[:, 1] / high)
    ring = np.where(part < row.crest, part / row.crest, (1.0 - part) / (1.0 - row.crest))
    above = 0.5 + 0.5 * np.clip(away[:, 1] / (0.5 * high), -1.0, 1.0)
    size = smoothstep(0.0, 1.0, ring) * (1.0 - (1.0 - row.upper) * above) * (away[:, 2] > -unit)
    distance = np.maximum(np.linalg.norm(away, axis=1), _TINY)
    return np.asarray(size[:, None] * (row.outward * normals - away / distance[:, None]))


@dataclass(frozen=True, eq=False)
class Drive:
    """What of a pose contracts the muscles: each is ``min(1, weights pose)``.

    ``weights`` is ``(23, COUNT)``.
    """

    weights: Doubles

    @classmethod
    def of(cls, file: TissueFile) -> Drive:
        """The table ``moved_by`` of every muscle."""
        weights = np.zeros((len(NAMES), COUNT))
        for place, name in enumerate(NAMES):
            base, side = row_and_side(name)
            for muscle, share in file.muscles[base].moved_by.items():
                indices = indices_of(muscle)
                chosen = indices if side is None or len(indices) == 1 else (indices[SIDES.index(side)],)
                weights[place, list(chosen)] += share / len(chosen)
        return cls(weights)

    def contractions(self, values: Doubles) -> Doubles:
        """``(23,)`` 0..1 in the pose ``values (COUNT,)``."""
        return np.minimum(self.weights @ values, 1.0)
