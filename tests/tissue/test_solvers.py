"""The solvers: what each does over time, and the sets of the adaptive one."""

from __future__ import annotations

import numpy as np
import pytest

from agentface.conventions import Doubles, Floats
from agentface.errors import UnknownNameError
from agentface.tissue.columns import rings_of, unpacked
from agentface.tissue.solvers.adaptive import Adaptive, breadth_first, prepare
from agentface.tissue.solvers.block_descent import BlockDescent
from agentface.tissue.solvers.equilibrium import equilibrium
from agentface.tissue.solvers.semi_implicit import SemiImplicit
from agentface.tissue.solvers.solver import make_solver, solver_names
from agentface.tissue.tables import TissueTables


def moved_mm(tissue: TissueTables, positions: Floats) -> Doubles:
    return np.linalg.norm(unpacked(tissue.columns, positions) - tissue.lattice.rest, axis=2)


def off_mm(tissue: TissueTables, one: Floats, other: Floats) -> float:
    return float(np.linalg.norm(unpacked(tissue.columns, one) - unpacked(tissue.columns, other), axis=2).max())


def test_an_unknown_solver_is_refused(tissue: TissueTables) -> None:
    assert solver_names() == ("block_descent", "semi_implicit", "adaptive")
    with pytest.raises(UnknownNameError, match="semi_implicit"):
        make_solver("implicit", tissue)


def test_the_default_follows_a_ramp_closely(tissue: TissueTables, emotions: dict[str, Doubles]) -> None:
    for name in ("happiness", "sadness"):
        solver = BlockDescent(tissue)
        for level in np.linspace(0.05, 1.0, 20):
            solver.follow(level * emotions[name])
        there = equilibrium(tissue, emotions[name])
        assert off_mm(tissue, solver.positions, there) < 0.015 * moved_mm(tissue, there).max(), name


@pytest.mark.parametrize("name", ["block_descent", "semi_implicit"])
def test_an_onset_has_mass_and_a_release_swings_and_settles(
    tissue: TissueTables, emotions: dict[str, Doubles], name: str
) -> None:
    solver = make_solver(name, tissue)
    asked = emotions["happiness"]
    whole = moved_mm(tissue, equilibrium(tissue, asked)).max()
    far = []
    for _ in range(60):
        solver.step(asked, 1 / 60)
        far.append(moved_mm(tissue, solver.positions).max() / whole)
    assert far[0] < 0.5, "it is there at once"
    assert max(far) < 1.25
    if name == "block_descent":  # the semi-implicit scheme damps by itself
        assert max(far) > 1.005, "it does not overshoot"
    assert far[-1] == pytest.approx(1.0, abs=0.01)
    for _ in range(60):
        solver.step(0.0 * asked, 1 / 60)
    assert moved_mm(tissue, solver.positions).max() < 0.1


def test_the_default_rests_exactly_when_it_is_released(tissue: TissueTables, emotions: dict[str, Doubles]) -> None:
    solver = BlockDescent(tissue)
    solver.reset(emotions["anger"])
    for _ in range(90):
        solver.step(np.zeros(23), 1 / 60)
    assert (solver.positions == tissue.columns.rest).all()


def test_a_held_expression_settles_into_its_equilibrium(tissue: TissueTables, emotions: dict[str, Doubles]) -> None:
    solver = BlockDescent(tissue)
    for _ in range(150):
        solver.step(emotions["disgust"], 1 / 60)
    assert off_mm(tissue, solver.positions, equilibrium(tissue, emotions["disgust"])) < 0.02


@pytest.mark.parametrize("dt", [0.0, 1e-6, 0.2])
def test_the_paper_s_scheme_divides_long_steps(tissue: TissueTables, emotions: dict[str, Doubles], dt: float) -> None:
    solver = SemiImplicit(tissue)
    for _ in range(3):
        solver.step(emotions["fear"], dt)
    assert np.isfinite(solver.positions).all()
    assert moved_mm(tissue, solver.positions).max() < 30.0
    assert (moved_mm(tissue, solver.positions).max() > 1e-4) == (dt > 1e-3)


def test_node_sets_are_the_paper_s(tissue: TissueTables, emotions: dict[str, Doubles]) -> None:
    lattice = tissue.lattice
    sets = prepare(tissue, emotions["happiness"]).sets
    pulled = np.tensordot(emotions["happiness"], tissue.forces, 1).any(axis=1)
    assert set(sets.dynamic.tolist()) == set(np.flatnonzero(pulled & lattice.free).tolist())
    assert not set(sets.dynamic.tolist()) & set(sets.quasi_static.tolist())
    assert sum(sets.nodes.values()) == 3 * len(lattice.free)
    order = sets.distance[sets.quasi_static]
    assert (np.diff(order) >= 0).all(), "not breadth first"
    assert (order > 0).all()
    far = moved_mm(tissue, equilibrium(tissue, emotions["happiness"])).max(axis=0)
    static = np.ones(len(far), np.bool_)
    static[sets.dynamic] = static[sets.quasi_static] = False
    assert far[static].max() < 0.01 * far.max()


def test_breadth_first_distances_are_scipys(tissue: TissueTables) -> None:
    from scipy.sparse import csgraph

    from agentface.mesh.graph import adjacency

    lattice = tissue.lattice
    start = np.zeros(len(lattice.free), np.bool_)
    start[[100, 2000]] = True
    every = np.ones_like(start)
    graph = adjacency(lattice.edges, len(start))
    told = csgraph.dijkstra(graph, indices=[100, 2000], unweighted=True, min_only=True)
    found = breadth_first(rings_of(lattice), start, every)
    assert (np.where(np.isinf(told), -1, told) == found).all()


def test_the_adaptive_scheme_groups_anew_for_other_muscles(tissue: TissueTables, emotions: dict[str, Doubles]) -> None:
    solver = Adaptive(tissue)
    one = solver.group(emotions["surprise"])
    assert solver.group(0.5 * emotions["surprise"]) is one
    other = solver.group(emotions["anger"])
    assert other is not one
    assert solver.group(emotions["surprise"]) is one
    for _ in range(6):
        solver.step(emotions["surprise"], 1 / 60)
    assert np.isfinite(solver.positions).all()
    assert 0.5 < moved_mm(tissue, solver.positions).max() < 20.0
