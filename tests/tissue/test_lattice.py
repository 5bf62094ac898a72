"""The lattice: its counts by another way of counting, its prisms, and what is not part of it."""

from __future__ import annotations

import numpy as np
import pytest

from agentface.head.model import load_model
from agentface.mesh.graph import harmonic, laplacian
from agentface.resources import face_names
from agentface.tissue.elements import Prisms
from agentface.tissue.lattice import Lattice, build_lattice
from agentface.tissue.layers import DERMIS, HYPODERMIS, area_ratio


@pytest.fixture(scope="module", params=face_names())
def any_lattice(request: pytest.FixtureRequest) -> Lattice:
    return build_lattice(load_model(request.param, asymmetry=0.0))


def test_springs_are_counted_as_layers_connecting_and_crossed(any_lattice: Lattice) -> None:
    count, edges = any_lattice.rest.shape[1], len(any_lattice.edges)
    assert any_lattice.spring_count == 3 * edges + 2 * count + 4 * edges
    pairs = {tuple(sorted(pair)) for pair in any_lattice.springs.ends.tolist()}
    assert len(pairs) == len(any_lattice.springs.ends), "two springs between the same nodes"
    layers = any_lattice.springs.ends // count
    assert (np.abs(np.diff(layers, axis=1)) <= 1).all(), "a spring past the dermis"
    assert (any_lattice.springs.stiffness > 0).all()


def test_every_spring_has_an_end_that_moves(any_lattice: Lattice) -> None:
    moves = np.tile(any_lattice.free, 3)[any_lattice.springs.ends]
    assert moves.any(axis=1).all()
    assert not np.tile(any_lattice.members.absent, 3)[any_lattice.springs.ends].any()


def test_no_prism_is_degenerate(any_lattice: Lattice) -> None:
    corners = any_lattice.prisms.corners[:, :3]
    assert (any_lattice.volumes > 0.02).all()
    for layer in (DERMIS, HYPODERMIS):
        assert area_ratio(any_lattice.rest[0], any_lattice.rest[layer], corners).min() > 0.25


def test_nodes_are_in_their_order_down_to_the_bone(any_lattice: Lattice) -> None:
    free, normals = any_lattice.free, any_lattice.normals
    depth = [-((layer - any_lattice.rest[0]) * normals).sum(axis=1)[free] for layer in any_lattice.rest]
    assert (depth[DERMIS] > 0).all()
    assert (depth[HYPODERMIS] > depth[DERMIS]).all()
    assert (any_lattice.gap[free] > 0.5).all(), "the hypodermis touches the bone at rest"


def test_the_lattice_is_its_own_mirror_image(any_lattice: Lattice) -> None:
    mirror = load_model(asymmetry=0.0).mirror  # both faces have the same mesh
    flipped = any_lattice.rest[:, mirror] * [-1.0, 1.0, 1.0]
    assert np.abs(flipped - any_lattice.rest).max() < 1e-9
    assert np.allclose(any_lattice.tether[mirror], any_lattice.tether)
    assert (any_lattice.free[mirror] == any_lattice.free).all()


def test_lids_and_the_inside_of_the_mouth_are_carried(any_lattice: Lattice) -> None:
    assert not any_lattice.free[any_lattice.members.carried].any()
    vertices = any_lattice.carried.vertices
    assert (np.diff(any_lattice.carried.first) > 0).mean() > 0.9
    moved = np.zeros_like(any_lattice.rest[0])
    moved[any_lattice.free] = [1.0, 2.0, 3.0]
    any_lattice.carried.apply(moved)
    share = moved[vertices, 0]
    assert (share > -1e-3).all()
    assert (share < 1.001).all()
    assert np.allclose(moved[vertices, 1], 2.0 * share, atol=1e-5)


def test_what_is_handed_on_does_the_same_work(any_lattice: Lattice) -> None:
    rng = np.random.default_rng(0)
    forces, moved = rng.standard_normal((2, *any_lattice.rest[0].shape))
    moved[any_lattice.members.fixed | any_lattice.members.still] = 0.0
    any_lattice.carried.apply(moved)
    work = (forces * moved).sum()
    any_lattice.carried.hand_on(forces)
    assert (forces * moved).sum() == pytest.approx(work, rel=1e-5)
    assert not forces[any_lattice.members.carried].any()


def test_a_prism_of_right_angles_has_base_times_height() -> None:
    top = np.array([[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 3.0, 0.0]])
    points = np.concatenate([top, top - [0.0, 0.0, 4.0]])
    prisms = Prisms(np.arange(6, dtype=np.int32)[None])
    assert prisms.volumes(points) == pytest.approx([12.0])


def test_prisms_gradients_are_their_volumes_slopes(lattice: Lattice) -> None:
    rng = np.random.default_rng(0)
    points = lattice.points + 0.2 * rng.standard_normal(lattice.points.shape)
    way = rng.standard_normal(points.shape)
    slopes = (lattice.prisms.gradients(points) * way[lattice.prisms.corners]).sum(axis=(1, 2))
    step = 1e-5
    found = lattice.prisms.volumes(points + step * way) - lattice.prisms.volumes(points - step * way)
    assert np.abs(found / (2 * step) - slopes).max() < 1e-5


def test_a_field_that_is_harmonic_on_a_path_is_straight() -> None:
    edges = np.array([[index, index + 1] for index in range(10)], np.int32)
    field = harmonic(laplacian(edges, 11), np.array([0, 10], np.int32), np.array([1.0, 6.0]))
    assert np.allclose(field, np.linspace(1.0, 6.0, 11))
