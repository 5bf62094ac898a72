"""Fits the tissue's muscles to the artists' shapes of a face: where they lie, how far they reach, how strong they are.

A muscle's parameters are found by L-BFGS on the linear response of the tissue at rest, whose gradient costs one more
solution of the same system; what the equilibrium has beyond that is a background, renewed twice.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from agentface.conventions import SIDES, Doubles
from agentface.head.model import HeadModel
from agentface.studies.calibration.action_units import ActionUnit, load_action_units
from agentface.tissue.columns import Columns, coloured, pack, unpacked
from agentface.tissue.lattice import Lattice, build_lattice
from agentface.tissue.layers import EPIDERMIS, HYPODERMIS
from agentface.tissue.muscles import unit_field
from agentface.tissue.solvers.equilibrium import gradually, new_loads
from agentface.tissue.solvers.newton import factors, solve
from agentface.tissue.tissue_file import TISSUE_MUSCLES, UNPAIRED, LinearRow, MuscleRow, SheetRow, TissueFile

Progress = Callable[[str], None]
_BONE_END, _SKIN_END = 0.40, 0.25
"""How far the two ends may go from the anatomist's, in eye separations."""
_STRETCH, _DIRECTION, _OUTSIDE, _HOME = 0.45, 0.8, 1.0, 0.05
_SOFT = 0.04
_ROUNDS = 2
_LOG_STRENGTH = -5.0, 4.6
_DIGITS = 4
_TOGETHER = {"levator_alaeque_nasi": {"corrugator": 0.5}}
"""What else contracts in the action unit that a muscle is fitted to."""
_PARTS = {
    "zygomaticus_major": 1.15,
    "risorius": 1.05,
    "mentalis": 1.3,
    "orbicularis_oculi": 0.9,
    "orbicularis_oris": 0.3,
}
"""Of the artists' shape: what muscle and tissue are to make of it; the lips' own model has the rest of pucker."""


@dataclass(frozen=True)
class Knob:
    """A number of a row that the fit may turn: how to read it, how to set it, and between what."""

    where: tuple[str, int] | tuple[str, str, int] | tuple[str]
    low: float
    high: float


def knobs(row: MuscleRow) -> list[Knob]:
    """What the fit may turn of a muscle's row, the anatomist's values in the middle of anchors' ranges."""
    if isinstance(row, (LinearRow, SheetRow)):
        result = [
            Knob((end, "offset", axis), getattr(row, end).offset[axis] - far, getattr(row, end).offset[axis] + far)
            for end, far in (("origin", _BONE_END), ("insertion", _SKIN_END))
            for axis in range(3)
        ]
        if isinstance(row, SheetRow):
            return [
                *result,
                Knob(("half_width",), 0.11, 0.76),
                Knob(("above",), 0.11, 1.14),
                Knob(("below",), 0.08, 0.57),
            ]
        start, finish = row.fall_start, row.fall_finish
        reach = (
            Knob(("fall_near",), 0.0, 0.8 * start),
            Knob(("fall_start",), 0.6 * start, 1.3 * start),
            Knob(("fall_finish",), 0.7 * finish, 1.4 * finish),
        )
        return [*result, Knob(("zone_deg",), 8.0, 60.0), *reach]
    y, z = row.centre.offset[1:]
    return [
        Knob(("centre", "offset", 1), y - 0.38, y + 0.38),
        Knob(("centre", "offset", 2), z - 0.23, z + 0.26),
        Knob(("radii", 0), 0.34, 1.04),
        Knob(("radii", 1), 0.26, 0.95),
        Knob(("crest",), 0.3, 0.9),
        Knob(("upper",), 0.0, 1.0),
        Knob(("outward",), -0.5, 1.0),
    ]


def turned(row: MuscleRow, turned_knobs: list[Knob], values: Doubles, strength: float, digits: int = 12) -> MuscleRow:
    """A row with its knobs at ``values``, rounded to ``digits`` after the point."""
    content: dict[str, Any] = row.model_dump()
    for knob, value in zip(turned_knobs, values.tolist(), strict=True):
        target: Any = content
        for key in knob.where[:-1]:
            target = target[key]
        target[knob.where[-1]] = round(value, digits)
    if isinstance(row, LinearRow):
        content["fall_start"] = max(content["fall_start"], round(content["fall_near"] + 0.09, digits))
        content["fall_finish"] = max(content["fall_finish"], round(content["fall_start"] + 0.09, digits))
    content["strength"] = round(strength, digits)
    return type(row).model_validate(content)


def read(row: MuscleRow, its_knobs: list[Knob]) -> Doubles:
    """The values of a row's knobs."""
    content: dict[str, Any] = row.model_dump()
    values = []
    for knob in its_knobs:
        value: Any = content
        for key in knob.where:
            value = value[key]
        values.append(value)
    return np.array(values)


class TissueFitter:
    """Fits the muscles of one face, a model without asymmetry."""

    def __init__(self, model: HeadModel, file: TissueFile) -> None:
        self.model, self.file = model, file
        self.lattice: Lattice = build_lattice(model, file)
        self.columns: Columns = pack(self.lattice, coloured(self.lattice, model.mirror))
        self.count = len(self.lattice.free)
        self.factors: Any = factors(self.lattice, self.lattice.points)
        edges = self.lattice.edges
        present = self.lattice.free[edges].any(axis=1) & ~self.lattice.members.absent[edges].any(axis=1)
        self.edges = edges[present]
        ends = self.lattice.rest[EPIDERMIS][self.edges]
        self.lengths = np.maximum(np.linalg.norm(ends[:, 0] - ends[:, 1], axis=1), 1.0)

    def solve(self, forces: Doubles) -> Doubles:
        """``(3, V, 3)``: the linear response to ``forces (3, V, 3)``."""
        return solve(self.lattice, self.factors, forces.reshape(-1, 3)).reshape(forces.shape)

    def force(self, name: str, row: MuscleRow) -> Doubles:
        """``(3, V, 3)``: the force of a muscle, or of a pair, at strength 1."""
        result = np.zeros((3, self.count, 3))
        for side in SIDES if name != UNPAIRED else SIDES[:1]:
            result[HYPODERMIS] += unit_field(self.model, self.lattice, row, side)
        return result

    def equilibrium(self, forces: Doubles) -> Doubles:
        """``(3, V, 3)``: the movement under ``forces``."""
        there = gradually(self.columns, new_loads(self.columns, forces[HYPODERMIS]))
        return unpacked(self.columns, there) - self.lattice.rest

    def fit(self, progress: Progress) -> TissueFile:
        """The file with the muscles fitted, in the order of the table."""
        units = load_action_units()
        rows: dict[str, MuscleRow] = dict(self.file.muscles)
        for name in TISSUE_MUSCLES:
            others = sum(
                (
                    part * rows[other].strength * self.force(other, rows[other])
                    for other, part in _TOGETHER.get(name, {}).items()
                ),
                np.zeros((3, self.count, 3)),
            )
            rows[name], error = _MuscleFit(self, name, rows[name], units[rows[name].action_unit], others).run()
            progress(f"{name}: {error:.3f}")
        return self.file.model_copy(update={"muscles": rows})


class _MuscleFit:
    """One muscle against the shape of its action unit."""

    def __init__(self, fitter: TissueFitter, name: str, row: MuscleRow, unit: ActionUnit, others: Doubles) -> None:
        self.fitter, self.name, self.row, self.others = fitter, name, row, others
        self.knobs = knobs(row)
        self.low = np.array([knob.low for knob in self.knobs])
        self.width = np.array([knob.high for knob in self.knobs]) - self.low
        part = unit.strength * _PARTS.get(name, 1.0)
        self.target = part * 1e3 * unit.shape(fitter.model).astype(np.float64)
        size = np.linalg.norm(self.target, axis=1)
        self.peak = float(size[fitter.lattice.free].max())
        self.inside = (size > 0.25 * self.peak) & fitter.lattice.free
        self.background = np.zeros_like(fitter.lattice.rest)

    def run(self) -> tuple[MuscleRow, float]:
        """The fitted row, and what its loss is."""
        from scipy.optimize import minimize

        place = (read(self.row, self.knobs) - self.low) / self.width
        self.home = place = np.clip(place, 0.0, 1.0)
        response = self.fitter.solve(self._force(np.append(place, 0.0)))[EPIDERMIS]
        size = max(float(np.linalg.norm(response, axis=1).max()), 1e-6)
        place = np.append(place, np.log(self.peak / size))
        if self.others.any():
            self.background = self.fitter.equilibrium(self.others)
        bounds = [(0.0, 1.0)] * len(self.knobs) + [_LOG_STRENGTH]
        for turn in range(1 + _ROUNDS):
            most = 30 if turn == 0 else 15
            found = minimize(self._loss, place, jac=True, method="L-BFGS-B", bounds=bounds, options={"maxiter": most})
            place = found.x
            force = self._force(place)
            self.background = self.fitter.equilibrium(force + self.others) - self.fitter.solve(force)
        return self._row(place, _DIGITS), float(found.fun)

    def _row(self, place: Doubles, digits: int = 12) -> MuscleRow:
        return turned(self.row, self.knobs, self.low + place[:-1] * self.width, float(np.exp(place[-1])), digits)

    def _force(self, place: Doubles) -> Doubles:
        row = self._row(place)
        return row.strength * self.fitter.force(self.name, row)

    def _loss(self, place: Doubles) -> tuple[float, Doubles]:
        """The loss and its gradient, by the adjoint of the linear response."""
        force = self._force(place)
        moved = self.fitter.solve(force) + self.background
        value, slope = self._shape_loss(moved[EPIDERMIS])
        full = np.zeros_like(moved)
        full[EPIDERMIS] = slope
        for layer in (EPIDERMIS, HYPODERMIS):
            more, slope = self._stretch_loss(moved[layer])
            value, full[layer] = value + more, full[layer] + slope
        home = _HOME * (place[:-1] - self.home)
        adjoint = self.fitter.solve(full)
        gradient = np.empty(len(place))
        for index in range(len(place) - 1):
            step = 2e-3 if place[index] < 0.5 else -2e-3
            other = place.copy()
            other[index] += step
            gradient[index] = ((self._force(other) - force) * adjoint).sum() / step + 2.0 * _HOME * home[index]
        gradient[-1] = (force * adjoint).sum()
        return value + float((home**2).sum()), gradient

    def _shape_loss(self, moved: Doubles) -> tuple[float, Doubles]:
        """How far and which way the skin goes, against the target; most where that is largest."""
        target, free = self.target, self.fitter.lattice.free
        size, count = np.linalg.norm(target, axis=1), int(self.inside.sum())
        weight = np.where(self.inside, 1.0 + 4.0 * (size / self.peak) ** 4, _OUTSIDE) * free
        weight /= self.peak * np.sqrt(count)
        off = (moved - target) * weight[:, None]
        slope = 2.0 * off * weight[:, None]
        chosen, ways = moved[self.inside], target[self.inside] / size[self.inside, None]
        length = np.linalg.norm(chosen, axis=1, keepdims=True)
        soft = length + _SOFT * self.peak
        wrong = chosen / soft - ways
        part = _DIRECTION**2 / count
        value = float((off**2).sum() + part * (wrong**2).sum())
        along = (chosen * wrong).sum(axis=1, keepdims=True) / (np.maximum(length, 1e-9) * soft**2)
        slope[self.inside] += 2.0 * part * (wrong / soft - chosen * along)
        return value, slope

    def _stretch_loss(self, moved: Doubles) -> tuple[float, Doubles]:
        """The stretch along edges of what differs from the target, squared: no pinching."""
        a, b = self.fitter.edges.T
        off = (moved - self.target)[a] - (moved - self.target)[b]
        part = _STRETCH**2 / int(self.inside.sum())
        value = part * float(((off / self.fitter.lengths[:, None]) ** 2).sum())
        pull, slope = 2.0 * part * off / self.fitter.lengths[:, None] ** 2, np.zeros_like(moved)
        np.add.at(slope, a, pull)
        np.subtract.at(slope, b, pull)
        return value, slope
