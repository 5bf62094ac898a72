"""Fits muscles to the artists' shapes by least squares from many starts, within anatomical bounds.

The bounds are relative to ``regions/anatomy.yaml``, the anatomist's table: bone end and skin end may move by
``_ORIGIN_WITHIN`` and ``_INSERTION_WITHIN`` eye separations, so a muscle stays the muscle it is named after.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from agentface.conventions import SIDES, Doubles, Indices
from agentface.facs.action_units import ActionUnit
from agentface.head.model import HeadModel
from agentface.head.muscles import Anchor, MuscleRow, MusclesFile, anchor_point, border_weights, off_the_bone
from agentface.parameters import VECTOR_MUSCLES
from agentface.studies.calibration.field import ROWS, displacements

_ORIGIN_WITHIN = 0.40
_INSERTION_WITHIN = 0.25
_LOW = (*[-_ORIGIN_WITHIN] * 3, *[-_INSERTION_WITHIN] * 3, 12.0, 0.15, 0.12, 0.01)
_HIGH = (*[_ORIGIN_WITHIN] * 3, *[_INSERTION_WITHIN] * 3, 50.0, 1.8, 1.5, 0.60)
_BEYOND_INSERTION = 0.55  # how far a zone may reach past the skin end: wide zones blur the face and cost time
_DIRECTION_WEIGHT = 0.55
_OUTSIDE_WEIGHT = 0.8
_STRETCH_WEIGHT = 0.25  # a pinch is ugly however few vertices it has
_PEAK_WEIGHT = 4.0  # the largest displacements are what a stranger sees

Progress = Callable[[str], None]


@dataclass(frozen=True, slots=True)
class Group:
    """Action units that are fitted together because they share muscles."""

    units: tuple[ActionUnit, ...]
    muscles: tuple[str, ...]


def groups(units: Sequence[ActionUnit]) -> list[Group]:
    """The action units that are fitted, grouped so that no muscle is in two groups."""
    result: list[Group] = []
    for unit in filter(lambda unit: unit.fitted, units):
        touching = [group for group in result if set(group.muscles) & unit.muscles.keys()]
        result = [group for group in result if group not in touching]
        members = (*(member for group in touching for member in group.units), unit)
        names = dict.fromkeys(name for member in members for name in member.muscles)
        result.append(Group(members, tuple(names)))
    return result


class Fitter:
    """The residuals of one group on one face; symmetric, so only the left half of the face counts."""

    def __init__(self, model: HeadModel, anatomy: MusclesFile, group: Group) -> None:
        self.model, self.anatomy, self.group = model, anatomy, group
        self.unit = model.landmarks.eye_separation
        weights = border_weights(anatomy, model.borders, model.landmarks.eye_separation)
        names = [f"{name}_{side}" for name in group.muscles for side in SIDES]
        self._reach_all = weights[[VECTOR_MUSCLES.index(name) for name in names]].astype(np.float64)
        half = np.flatnonzero((model.vertices[:, 0] > -1e-6) & (self._touched() > 0)).astype(np.int32)
        self._rest = model.vertices[half].astype(np.float64)
        self._reach = np.ascontiguousarray(self._reach_all[:, half])
        self._edges, self._lengths = self._half_edges(half)
        self._targets = [unit.strength * unit.shape(model)[half].astype(np.float64) for unit in group.units]
        self._contractions = [
            np.array([unit.muscles.get(name, 0.0) for name in group.muscles for _ in SIDES]) for unit in group.units
        ]

    def _half_edges(self, half: Indices) -> tuple[Indices, Doubles]:
        """The edges between the vertices of the left half, and their lengths as a column."""
        place = np.full(len(self.model.vertices), -1)
        place[half] = np.arange(len(half))
        ends = place[np.concatenate([self.model.triangles[:, [i, (i + 1) % 3]] for i in range(3)])]
        ends = ends[(ends[:, 0] < ends[:, 1]) & (ends.min(1) >= 0)]
        return ends, np.linalg.norm(self._rest[ends[:, 0]] - self._rest[ends[:, 1]], axis=1, keepdims=True)

    def _touched(self) -> Doubles:
        shapes = sum(np.abs(unit.shape(self.model)).max(1) for unit in self.group.units)
        return np.asarray(self._reach_all.max(0) + 1e3 * shapes)

    def start(self) -> Doubles:
        """The anatomist's values, ``(M, ROWS)`` flattened: offsets zero, then zone, Rs, Rf - Rs, k."""
        rows = []
        for name in self.group.muscles:
            row = self.anatomy.muscles[name]
            rows.append([0.0] * 6 + [row.zone_deg, row.fall_start, row.fall_finish - row.fall_start, row.elasticity])
        return np.clip(np.array(rows), _LOW, _HIGH).ravel()

    def bounds(self) -> tuple[Doubles, Doubles]:
        """The lowest and the highest values."""
        count = len(self.group.muscles)
        return np.tile(_LOW, count), np.tile(_HIGH, count)

    def rows(self, values: Doubles) -> Doubles:
        """The muscles of both sides ``(2 M, ROWS)`` in metres."""
        rows = np.empty((2 * len(self.group.muscles), ROWS))
        for i, (name, value) in enumerate(zip(self.group.muscles, values.reshape(-1, ROWS), strict=True)):
            row = self.anatomy.muscles[name]
            for j, side in enumerate(SIDES):
                flip = np.array([1.0 if side == SIDES[0] else -1.0, 1.0, 1.0]) * self.unit
                rows[2 * i + j, :3] = anchor_point(row.origin, side, self.model.landmarks) + flip * value[:3]
                rows[2 * i + j, 3:6] = anchor_point(row.insertion, side, self.model.landmarks) + flip * value[3:6]
                rows[2 * i + j, 6] = np.cos(np.radians(value[6]))
                length = float(np.linalg.norm(rows[2 * i + j, 3:6] - rows[2 * i + j, :3])) / self.unit
                rows[2 * i + j, 7:] = self.unit * np.array([*_fall_off(value, length), value[9]])
        return rows

    def residuals(self, values: Doubles) -> Doubles:
        """Displacements, directions and stretching against the artists', and a mild pull to the anatomy."""
        rows, parts = self.rows(values), []
        reach = self._reach * off_the_bone(self._rest, rows[:, :3], rows[:, 3:6])
        for target, contraction in zip(self._targets, self._contractions, strict=True):
            moved = displacements(self._rest, rows, reach, contraction)
            size = np.linalg.norm(target, axis=1, keepdims=True)
            peak = size.max()
            inside = size[:, 0] > 0.25 * peak
            weight = np.where(inside, 1.0 + _PEAK_WEIGHT * (size[:, 0] / peak) ** 4, _OUTSIDE_WEIGHT)
            scale = weight[:, None] / (peak * np.sqrt(inside.sum()))
            parts.append(((moved - target) * scale).ravel())
            unit_moved = moved[inside] / (np.linalg.norm(moved[inside], axis=1, keepdims=True) + 0.04 * peak)
            parts.append(
                (_DIRECTION_WEIGHT / np.sqrt(inside.sum()) * (unit_moved - target[inside] / size[inside])).ravel()
            )
            stretch = (moved - target)[self._edges[:, 0]] - (moved - target)[self._edges[:, 1]]
            parts.append((_STRETCH_WEIGHT / np.sqrt(inside.sum()) * stretch / self._lengths).ravel())
        pull = (values - self.start()).reshape(-1, ROWS)[:, :6] * 0.02
        return np.concatenate([*parts, pull.ravel()])

    def solve(self, starts: int, rng: np.random.Generator, progress: Progress) -> tuple[Doubles, float]:
        """The best values found from ``starts`` starts, the first at the anatomist's values, and their cost."""
        from scipy.optimize import least_squares

        low, high = self.bounds()
        best, cost = self.start(), np.inf
        for attempt in range(starts):
            first = self.start()
            if attempt:
                spread = (high - low) * np.tile([0.30] * 6 + [0.25] * 4, len(self.group.muscles))
                first = first + rng.normal(0, 0.5, len(first)) * spread
            inside = np.clip(first, low + 1e-6, high - 1e-6)
            found = least_squares(
                self.residuals, inside, bounds=(low, high), max_nfev=60, x_scale=high - low, diff_step=1e-4
            )
            if found.cost < cost:
                best, cost = found.x, float(found.cost)
            progress(
                f"AU {'+'.join(str(unit.number) for unit in self.group.units)}: start {attempt + 1}, cost {cost:.4f}"
            )
        return best, cost

    def fitted(self, values: Doubles) -> dict[str, MuscleRow]:
        """The rows of ``muscles.yaml`` for these values."""
        result = {}
        for name, value in zip(self.group.muscles, values.reshape(-1, ROWS), strict=True):
            row = self.anatomy.muscles[name]
            ends = [_moved(row.origin, value[:3]), _moved(row.insertion, value[3:6])]
            origin, insertion = (anchor_point(end, SIDES[0], self.model.landmarks) for end in ends)
            start, finish = _fall_off(value, float(np.linalg.norm(insertion - origin)) / self.unit)
            result[name] = row.model_copy(
                update={
                    "origin": ends[0],
                    "insertion": ends[1],
                    "zone_deg": round(float(value[6]), 2),
                    "fall_start": round(start, 4),
                    "fall_finish": round(finish, 4),
                    "elasticity": round(float(value[9]), 4),
                }
            )
        return result


def _fall_off(value: Doubles, length: float) -> tuple[float, float]:
    """Rs and Rf in eye separations, for a muscle of ``length`` from bone end to skin end."""
    finish = min(float(value[7] + value[8]), length + _BEYOND_INSERTION)
    return min(float(value[7]), finish - 0.1), finish


def _moved(anchor: Anchor, by: Doubles) -> Anchor:
    return Anchor(at=anchor.at, offset=[round(float(a + b), 4) for a, b in zip(anchor.offset, by, strict=True)])
