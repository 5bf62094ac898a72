"""Fits the tissue's muscles to the artists' shapes of a face: where they lie, how far they reach, how strong they are.

A muscle's parameters are found by L-BFGS on the linear response of the tissue at rest, whose gradient costs one more
solution of the same system; what the equilibrium has beyond that is a background, renewed twice.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from agentface.conventions import SIDES, Doubles
from agentface.errors import InvalidValueError, Place
from agentface.facs.action_units import ActionUnit, load_action_units
from agentface.head.model import HeadModel
from agentface.studies.calibration.tissue_knobs import EXACT, knobs, turned, values_of
from agentface.studies.calibration.tissue_loss import ShapeLoss
from agentface.tissue.columns import Columns, coloured, pack, unpacked
from agentface.tissue.lattice import Lattice, build_lattice
from agentface.tissue.layers import EPIDERMIS, HYPODERMIS
from agentface.tissue.muscles import belly_field, unit_field
from agentface.tissue.newton import factors, solve
from agentface.tissue.relaxation import gradually, new_loads
from agentface.tissue.tissue_file import TISSUE_FILE, TISSUE_MUSCLES, UNPAIRED, MuscleRow, TissueFile

Progress = Callable[[str], None]
_HOME = 0.05
"""The pull to the anatomist's values."""
_ROUNDS = (30, 15, 15)
"""Steps of each search; between two of them the background is made anew."""
_LOG_STRENGTH = -5.0, 6.5
_STEP = 2e-3
"""Of a knob's range: for the change of a muscle's forces with it."""
_DIGITS = 4
_TOGETHER = {"levator_alaeque_nasi": {"corrugator": 0.5}}
"""What else contracts in the action unit that a muscle is fitted to."""
_PARTS = {
    "levator_alaeque_nasi": 1.3,
    "levator_labii": 1.3,
    "zygomaticus_major": 1.3,
    "depressor_anguli": 1.1,
    "risorius": 1.05,
    "mentalis": 1.3,
    "orbicularis_oculi": 0.9,
    "orbicularis_oris": 0.3,
}
"""Of the artists' shape: what muscle and tissue are to make of it; the lips' own model has the rest of pucker."""


class TissueFitter:
    """Fits the muscles of one face.

    Args:
        model: the face, without asymmetry.
        file: its tissue, and the muscles from which the fit starts.
    """

    def __init__(self, model: HeadModel, file: TissueFile) -> None:
        self.model, self.file = model, file
        self.lattice: Lattice = build_lattice(model, file)
        self._columns: Columns = pack(self.lattice, coloured(self.lattice, model.mirror))
        self._count = len(self.lattice.free)
        self._factors: Any = factors(self.lattice, self.lattice.points)

    def response(self, forces: Doubles) -> Doubles:
        """``(3, V, 3)`` mm: the linear response to ``forces (3, V, 3)``."""
        return solve(self.lattice, self._factors, forces.reshape(-1, 3)).reshape(forces.shape)

    def equilibrium(self, forces: Doubles) -> Doubles:
        """``(3, V, 3)`` mm: the movement under ``forces (3, V, 3)`` on the hypodermis."""
        there = gradually(self._columns, new_loads(self._columns, forces[HYPODERMIS]))
        return unpacked(self._columns, there) - self.lattice.rest

    def force(self, name: str, row: MuscleRow) -> Doubles:
        """``(3, V, 3)``: the pull of a muscle, or of a pair."""
        return row.strength * self._of_sides(unit_field, name, row)

    def belly(self, name: str, row: MuscleRow) -> Doubles:
        """``(3, V, 3)``: what a muscle, or a pair, pushes out of the face."""
        return self._of_sides(belly_field, name, row)

    def fit(self, progress: Progress) -> TissueFile:
        """The file with its muscles fitted one after the other; ``progress`` is told of each.

        Raises InvalidValueError for a muscle whose action unit is not in ``rules/action_units.yaml``, and DataError
        where the face has not the artists' shapes.
        """
        units, rows = load_action_units(), dict(self.file.muscles)
        for name, row in rows.items():
            if row.action_unit not in units:
                place = Place(TISSUE_FILE, ("muscles", name, "action_unit"))
                raise InvalidValueError(place, f"one of {', '.join(map(str, units))}", row.action_unit)
        for name in TISSUE_MUSCLES:
            others = self.belly(name, rows[name])
            for other, part in _TOGETHER.get(name, {}).items():
                others += part * self.force(other, rows[other])
            rows[name], loss = MuscleFit(self, name, rows[name], units[rows[name].action_unit], others).run()
            progress(f"{name}: {loss:.3f}")
        return self.file.model_copy(update={"muscles": rows})

    def _of_sides(
        self, field: Callable[[HeadModel, Lattice, MuscleRow, str], Doubles], name: str, row: MuscleRow
    ) -> Doubles:
        result = np.zeros((3, self._count, 3))
        for side in SIDES if name != UNPAIRED else SIDES[:1]:
            result[HYPODERMIS] += field(self.model, self.lattice, row, side)
        return result


class MuscleFit:
    """One muscle against the shape of its action unit.

    A place ``(K + 1,)`` is where the muscle's knobs stand, 0..1 of their ranges, and the logarithm of its strength.

    Args:
        fitter: of the face.
        name: of the muscle, without side.
        row: where it starts.
        unit: what it is to make.
        others: ``(3, V, 3)``, the force of what contracts with it, its own belly among it.
    """

    def __init__(self, fitter: TissueFitter, name: str, row: MuscleRow, unit: ActionUnit, others: Doubles) -> None:
        self._fitter, self._name, self._row, self._others = fitter, name, row, others
        self._knobs = knobs(row)
        self._low = np.array([knob.low for knob in self._knobs])
        self._width = np.array([knob.high for knob in self._knobs]) - self._low
        part = unit.strength * _PARTS.get(name, 1.0)
        self._shape = ShapeLoss(fitter.lattice, part * 1e3 * unit.shape(fitter.model).astype(np.float64))
        self._background = np.zeros_like(fitter.lattice.rest)
        self._home = np.clip((values_of(row, self._knobs) - self._low) / self._width, 0.0, 1.0)

    def start(self) -> Doubles:
        """The anatomist's place, as strong as the largest displacement asks for."""
        unit_force = self._force(np.append(self._home, 0.0))
        response = self._fitter.response(unit_force)[EPIDERMIS]
        size = max(float(np.linalg.norm(response, axis=1).max()), 1e-6)
        return np.append(self._home, np.log(self._shape.peak / size))

    def run(self, rounds: Sequence[int] = _ROUNDS) -> tuple[MuscleRow, float]:
        """The fitted row, and its loss, after searches of so many steps each."""
        from scipy.optimize import minimize

        place, loss = self.start(), float("inf")
        if self._others.any():
            self._background = self._fitter.equilibrium(self._others)
        bounds = [(0.0, 1.0)] * len(self._knobs) + [_LOG_STRENGTH]
        for turn, most in enumerate(rounds):
            if turn:
                force = self._force(place)
                self._background = self._fitter.equilibrium(force + self._others) - self._fitter.response(force)
            found = minimize(self.loss, place, jac=True, method="L-BFGS-B", bounds=bounds, options={"maxiter": most})
            place, loss = found.x, float(found.fun)
        return self._at(place, _DIGITS), loss

    def loss(self, place: Doubles) -> tuple[float, Doubles]:
        """The loss at a place and its gradient ``(K + 1,)``, by the adjoint of the linear response."""
        force = self._force(place)
        moved = self._fitter.response(force) + self._background
        value, slope = self._shape.shape(moved[EPIDERMIS])
        full = np.zeros_like(moved)
        full[EPIDERMIS] = slope
        for layer in (EPIDERMIS, HYPODERMIS):
            more, slope = self._shape.stretch(moved[layer])
            value, full[layer] = value + more, full[layer] + slope
        away = _HOME * (place[:-1] - self._home)
        adjoint = self._fitter.response(full)
        gradient = np.empty(len(place))
        for index in range(len(place) - 1):
            step = _STEP if place[index] < 0.5 else -_STEP
            other = place.copy()
            other[index] += step
            gradient[index] = ((self._force(other) - force) * adjoint).sum() / step + 2.0 * _HOME * away[index]
        gradient[-1] = (force * adjoint).sum()
        return value + float((away**2).sum()), gradient

    def _at(self, place: Doubles, digits: int = EXACT) -> MuscleRow:
        values = self._low + place[:-1] * self._width
        return turned(self._row, self._knobs, values, float(np.exp(place[-1])), digits)

    def _force(self, place: Doubles) -> Doubles:
        return self._fitter.force(self._name, self._at(place))
