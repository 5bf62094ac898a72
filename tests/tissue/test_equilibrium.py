"""Equilibria: one for each load, however it is reached; mirror images; nothing inverted; exact by another method."""

from __future__ import annotations

import numpy as np
import pytest

from agentface.conventions import Doubles, Floats
from agentface.head.model import HeadModel
from agentface.mesh.normals import doubled_areas
from agentface.tissue.columns import unpacked
from agentface.tissue.forces import energy, forces
from agentface.tissue.layers import EPIDERMIS, HYPODERMIS
from agentface.tissue.newton import newton
from agentface.tissue.relaxation import relax
from agentface.tissue.solvers.equilibrium import equilibrium
from agentface.tissue.tables import TissueTables

SAME_MM = 0.02


def loads_of(tissue: TissueTables, contractions: Doubles) -> Floats:
    return np.tensordot(contractions.astype(np.float32), tissue.loads, 1)


def apart(tissue: TissueTables, one: Floats, other: Floats) -> float:
    """The largest distance of any node, mm."""
    return float(np.linalg.norm(unpacked(tissue.columns, one) - unpacked(tissue.columns, other), axis=2).max())


@pytest.fixture(scope="module")
def found(tissue: TissueTables, emotions: dict[str, Doubles]) -> dict[str, Floats]:
    return {name: equilibrium(tissue, contractions) for name, contractions in emotions.items()}


@pytest.mark.untraced
def test_all_six_are_the_same_from_rest_and_from_each_other(
    tissue: TissueTables, emotions: dict[str, Doubles], found: dict[str, Floats]
) -> None:
    for name, contractions in emotions.items():
        for start in (tissue.columns.rest, *(found[other] for other in emotions if other != name)):
            there = start.copy()
            relax(tissue.columns, there, loads_of(tissue, contractions))
            assert apart(tissue, there, found[name]) < SAME_MM, name


def test_they_are_in_equilibrium(tissue: TissueTables, emotions: dict[str, Doubles], found: dict[str, Floats]) -> None:
    lattice = tissue.lattice
    for name, contractions in emotions.items():
        load = np.zeros_like(lattice.rest)
        load[HYPODERMIS] = np.tensordot(contractions, tissue.forces, 1)
        points = unpacked(tissue.columns, found[name]).reshape(-1, 3)
        left = np.abs(forces(lattice, points, load.reshape(-1, 3))).max()
        assert left < 2e-3 * np.abs(load).max(), name


def test_symmetric_loads_have_symmetric_equilibria(
    model: HeadModel, tissue: TissueTables, found: dict[str, Floats]
) -> None:
    for name, positions in found.items():
        points = unpacked(tissue.columns, positions)
        flipped = points[:, model.mirror] * [-1.0, 1.0, 1.0]
        assert np.abs(flipped - points).max() < 1e-2, f"{name}: 1e-5 m"


@pytest.mark.slow
def test_newtons_method_stays_where_it_is(
    tissue: TissueTables, emotions: dict[str, Doubles], found: dict[str, Floats]
) -> None:
    check_newton(tissue, emotions["disgust"], found["disgust"], start=unpacked(tissue.columns, found["disgust"]))


@pytest.mark.soak
def test_newtons_method_finds_the_same_from_rest(
    tissue: TissueTables, emotions: dict[str, Doubles], found: dict[str, Floats]
) -> None:
    for name, contractions in emotions.items():
        check_newton(tissue, contractions, found[name], start=None)


def check_newton(tissue: TissueTables, contractions: Doubles, there: Floats, start: Doubles | None) -> None:
    exact = newton(tissue.lattice, np.tensordot(contractions, tissue.forces, 1), start)
    assert np.linalg.norm(exact - unpacked(tissue.columns, there), axis=2).max() < 0.01


def test_no_contraction_is_rest_itself(tissue: TissueTables) -> None:
    assert (equilibrium(tissue, np.zeros(23)) == tissue.columns.rest).all()


def test_energy_does_not_grow_without_forces(tissue: TissueTables) -> None:
    from agentface.tissue.descent_compiled import sweep

    lattice, columns = tissue.lattice, tissue.columns
    moving = len(columns.first) - 1
    rng, positions = np.random.default_rng(1), columns.rest.copy()
    positions[:moving] += 0.2 * rng.standard_normal(positions[:moving].shape).astype(np.float32)
    none, moved = np.zeros_like(tissue.loads[0]), np.zeros(moving, np.float32)
    nothing = np.zeros_like(lattice.points)
    before = energy(lattice, unpacked(columns, positions).reshape(-1, 3), nothing)
    first = before
    for _ in range(30):
        sweep(columns, positions, none, np.arange(moving, dtype=np.int32), moving, 1.0, moved)
        now = energy(lattice, unpacked(columns, positions).reshape(-1, 3), nothing)
        assert now <= before * (1 + 1e-5) + 1e-3
        before = now
    assert before < 0.05 * first


@pytest.mark.slow
@pytest.mark.untraced
def test_a_thousand_random_contractions_invert_nothing(tissue: TissueTables) -> None:
    lattice, rng = tissue.lattice, np.random.default_rng(8)
    triangles = lattice.prisms.corners[:, :3]
    upright = doubled_areas(lattice.rest[EPIDERMIS], triangles)
    for turn in range(1000):
        part = rng.random(23) * (rng.random(23) < rng.random())
        positions = tissue.columns.rest.copy()
        guess = tissue.responses.powers(part) @ tissue.responses.columns
        moving = len(tissue.columns.first) - 1
        positions[:moving] += guess.reshape(positions[:moving].shape)
        relax(tissue.columns, positions, loads_of(tissue, part), tolerance=5e-2, most=150)
        points = unpacked(tissue.columns, positions)
        assert np.isfinite(points).all()
        relative = lattice.prisms.volumes(points.reshape(-1, 3)) / lattice.volumes
        assert relative.min() > 0.0, f"turn {turn}: a prism is inverted"
        turned = (doubled_areas(points[EPIDERMIS], triangles) * upright).sum(axis=1)
        assert turned.min() > 0.0, f"turn {turn}: a triangle is flipped"
