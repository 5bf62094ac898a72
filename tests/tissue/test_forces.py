"""Forces: the slope of their energy, compiled twins, the paper's printed law, and what moves nothing."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from agentface.conventions import Doubles, Indices
from agentface.head.model import HeadModel
from agentface.tissue.columns import NODES, coloured, new_forces, pack, packed, unpacked
from agentface.tissue.forces import (
    energy,
    forces,
    pressure,
    pressure_energy,
    spring_tension,
    stiffness,
    volume_forces,
)
from agentface.tissue.lattice import Lattice
from agentface.tissue.layers import HYPODERMIS
from agentface.tissue.relaxation import new_loads
from agentface.tissue.tables import TissueTables
from agentface.tissue.tissue_file import VolumeForm


@pytest.fixture(scope="module")
def shaken(lattice: Lattice) -> Doubles:
    """The nodes, ``(3 V, 3)``, those that move a third of a millimetre off."""
    off = np.random.default_rng(4).standard_normal(lattice.rest.shape) * lattice.free[None, :, None]
    return (lattice.rest + 0.33 * off).reshape(-1, 3)


@pytest.fixture(scope="module")
def load(tissue: TissueTables) -> Doubles:
    result = np.zeros_like(tissue.lattice.rest)
    result[HYPODERMIS] = tissue.forces[3] + tissue.forces[12]
    return result.reshape(-1, 3)


def test_nothing_pulls_at_rest(lattice: Lattice) -> None:
    assert np.abs(forces(lattice, lattice.points, np.zeros_like(lattice.points))).max() < 1e-9


def test_forces_are_the_energys_slope(lattice: Lattice, shaken: Doubles, load: Doubles) -> None:
    way = np.random.default_rng(5).standard_normal(shaken.shape) * np.tile(lattice.free, 3)[:, None]
    step = 1e-6
    slope = energy(lattice, shaken + step * way, load) - energy(lattice, shaken - step * way, load)
    assert slope / (2 * step) == pytest.approx(-(forces(lattice, shaken, load) * way).sum(), rel=1e-6)


def test_stiffness_is_the_forces_slope_at_rest(lattice: Lattice) -> None:
    nodes = np.flatnonzero(np.tile(lattice.free, 3))
    way = np.zeros_like(lattice.points)
    way[nodes] = np.random.default_rng(6).standard_normal((len(nodes), 3))
    none, step = np.zeros_like(way), 1e-6
    found = forces(lattice, lattice.points - step * way, none) - forces(lattice, lattice.points + step * way, none)
    told = (stiffness(lattice, lattice.points) @ way[nodes].ravel()).reshape(-1, 3)
    assert np.abs(found[nodes] / (2 * step) - told).max() < 1e-4 * np.abs(told).max()


@pytest.mark.parametrize("form", ["energy", "printed", "signed", "epidermis"])
def test_compiled_forces_are_the_same(
    model: HeadModel, tissue: TissueTables, shaken: Doubles, load: Doubles, form: VolumeForm
) -> None:
    from agentface.tissue.forces_compiled import net_forces

    file = tissue.lattice.file
    volume = file.volume.model_copy(update={"form": form, "rho": 0.2})
    lattice = replace(tissue.lattice, file=file.model_copy(update={"volume": volume}))
    columns = pack(lattice, coloured(lattice, model.mirror))
    moving = len(columns.first) - 1
    out = new_forces(columns)
    positions = packed(columns.vertex, shaken.reshape(3, -1, 3), padding=-1.0)
    loads = new_loads(columns, load.reshape(3, -1, 3)[HYPODERMIS])
    net_forces(columns, positions, positions, loads, 0, moving, False, out)
    found = unpacked(columns, np.concatenate([out[:, :NODES], np.zeros_like(positions[moving:])])).reshape(-1, 3)
    told = forces(lattice, shaken, load)
    assert np.abs(found - told).max() < 1e-5 * np.abs(told).max()


@pytest.mark.parametrize("alpha", [0, 1, 2])
def test_a_springs_tension_is_the_papers(lattice: Lattice, alpha: int) -> None:
    table = lattice.file.springs.model_copy(update={"alpha": alpha})
    other = replace(lattice, file=lattice.file.model_copy(update={"springs": table}))
    stretch = 0.3 * lattice.springs.length
    unit = table.unit * lattice.springs.length
    told = (1.0 + (stretch / unit) ** 2) ** alpha * lattice.springs.stiffness * stretch  # Eq. 1 and 2
    found, slope = spring_tension(other, stretch)
    assert np.allclose(found, told)
    step = 1e-6 * lattice.springs.length
    after, before = spring_tension(other, stretch + step)[0], spring_tension(other, stretch - step)[0]
    assert np.allclose(slope, (after - before) / (2 * step), rtol=1e-5)


def test_the_printed_volume_force_pushes_out_both_ways(lattice: Lattice) -> None:
    volume = lattice.file.volume.model_copy(update={"form": "printed", "rho": 0.1})
    printed = replace(lattice, file=lattice.file.model_copy(update={"volume": volume}))
    for factor in (0.9, 1.1):
        points = lattice.rest.copy()
        points[1:] = points[0] + factor * (points[1:] - points[0])
        pushed = volume_forces(printed, points.reshape(-1, 3)).reshape(3, -1, 3)
        out = (pushed[0] * lattice.normals).sum(axis=1)[lattice.free]
        assert (out > 0).mean() > 0.95
        assert not pushed[1:].any(), "Eq. 3 acts on the epidermis alone"


@given(st.floats(0.05, 3.0))
def test_pressure_is_its_energys_slope_and_restores(volume: float) -> None:
    step = 1e-6
    at = np.array([volume])
    slope = (pressure_energy(at + step) - pressure_energy(at - step)) / (2 * step)
    found, rise = pressure(at)
    assert found == pytest.approx(slope, abs=1e-4)
    assert (found * (volume - 1.0) >= 0).all()
    assert (rise > 0).all()


@dataclass(frozen=True)
class Tetrahedra:
    """Other elements than prisms: four nodes each."""

    corners: Indices

    def volumes(self, points: Doubles) -> Doubles:
        a, b, c, d = (points[self.corners[:, corner]] for corner in range(4))
        return np.asarray((np.cross(b - a, c - a) * (d - a)).sum(axis=1) / 6.0)

    def gradients(self, points: Doubles) -> Doubles:
        a, b, c, d = (points[self.corners[:, corner]] for corner in range(4))
        by_b, by_c, by_d = np.cross(c - a, d - a), np.cross(d - a, b - a), np.cross(b - a, c - a)
        return np.stack([-(by_b + by_c + by_d), by_b, by_c, by_d], axis=1) / 6.0


def test_other_elements_fit_behind_the_same_interface(lattice: Lattice, shaken: Doubles) -> None:
    top, low = lattice.prisms.corners[:, :3], lattice.prisms.corners[:, 3:]
    cut = [
        np.stack([low[:, 0], low[:, 1], low[:, 2], top[:, 0]], axis=1),
        np.stack([low[:, 1], top[:, 1], low[:, 2], top[:, 0]], axis=1),
        np.stack([top[:, 1], top[:, 2], low[:, 2], top[:, 0]], axis=1),
    ]
    solid = Tetrahedra(np.concatenate(cut).astype(np.int32))
    rest = np.maximum(np.abs(solid.volumes(lattice.points)), 1e-3)
    pushed = volume_forces(lattice, shaken, solid, rest)
    assert np.isfinite(pushed).all()
    assert np.abs(pushed.sum(axis=0)).max() < 1e-8 * np.abs(pushed).sum(), "inner forces cancel"
