"""The build's geometry, on small meshes; the base mesh itself is only needed to build faces."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from agentface.head.build.loops import border_loops, rings
from agentface.head.build.mouth_parts import dental_arch, eyeball
from agentface.head.build.partition import halves
from agentface.head.build.subdivide import catmull_clark, children, mirror_level
from agentface.head.build.topology import SkinTopology, balanced
from agentface.mesh.thin import Thinner, smallest_angle

SIDE = 7


def sheet(side=SIDE):
    """A symmetric sheet of quads, x from -1 to 1; the mirror image of column i is column side - 1 - i."""
    x, y = np.meshgrid(np.linspace(-1, 1, side), np.linspace(0, 2, side))
    points = np.stack([x.ravel(), y.ravel(), 0.2 * np.cos(x.ravel() * 2)], 1)
    grid = np.arange(side * side).reshape(side, side)
    quads = np.stack([grid[:-1, :-1], grid[:-1, 1:], grid[1:, 1:], grid[1:, :-1]], -1).reshape(-1, 4)
    return points, quads.astype(np.int32), grid[:, ::-1].ravel().astype(np.int32)


def test_subdivision_quarters_every_quad():
    points, quads, _ = sheet()
    level = catmull_clark(quads, len(points))
    assert len(level.quads) == 4 * len(quads)
    finer = np.asarray(level.matrix @ points)
    for number in (0, 7, len(quads) - 1):
        corners = set(level.quads[list(children(number))].ravel())
        assert set(quads[number]) <= corners
        assert level.face_vertex[number] in corners
        np.testing.assert_allclose(finer[level.face_vertex[number]], points[quads[number]].mean(0))


@given(arrays(np.float64, (2, 2), elements=st.floats(-3, 3)), arrays(np.float64, 2, elements=st.floats(-3, 3)))
def test_subdivision_keeps_planes_and_commutes_with_affine_maps(linear, shift):
    points, quads, _ = sheet()
    matrix = catmull_clark(quads, len(points)).matrix
    np.testing.assert_allclose(np.asarray(matrix.sum(1)).ravel(), 1.0)
    flat = points[:, :2]
    np.testing.assert_allclose(matrix @ (flat @ linear + shift), (matrix @ flat) @ linear + shift, atol=1e-9)


def test_the_mirror_of_the_finer_mesh_is_its_mirror_image():
    points, quads, mirror = sheet()
    level = catmull_clark(quads, len(points))
    finer, image = np.asarray(level.matrix @ points), mirror_level(level, mirror, quads)
    np.testing.assert_allclose(finer[image] * [-1, 1, 1], finer, atol=1e-12)


@pytest.mark.slow
@pytest.mark.untraced
@given(st.lists(st.integers(0, 2), min_size=36, max_size=36))
def test_a_skin_of_any_levels_is_closed_and_symmetric(levels):
    points, quads, mirror = sheet()
    levels = np.array(levels, np.int32).reshape(6, 6)
    levels = np.maximum(levels, levels[:, ::-1]).ravel()
    skin = SkinTopology(quads, levels, points, mirror)
    placed = skin.place(points)
    np.testing.assert_allclose(placed[skin.mirror] * [-1, 1, 1], placed, atol=1e-12)
    edges = np.concatenate([skin.triangles[:, [i, (i + 1) % 3]] for i in range(3)])
    assert len(np.unique(edges, axis=0)) == len(edges)
    # no crack: the only edges without a twin are those of the sheet's own border
    directed = {tuple(edge) for edge in edges.tolist()}
    for a, b in directed:
        if (b, a) not in directed:
            inside = (np.abs(placed[[a, b], 0]) < 0.97) & (placed[[a, b], 1] > 0.03) & (placed[[a, b], 1] < 1.97)
            assert not inside.all()


def test_levels_are_balanced():
    _, quads, _ = sheet()
    levels = np.zeros(len(quads), np.int32)
    levels[14] = 2
    result = balanced(quads, levels)
    touching = np.isin(quads, quads[14]).any(1)
    assert result[14] == 2
    assert (result[touching] >= 1).all()
    assert result.max() == 2


def test_thinning_keeps_what_is_locked_and_leaves_no_hole():
    points, quads, _ = sheet(12)
    triangles = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    border = (np.abs(points[:, 0]) > 0.99) | (points[:, 1] < 0.01) | (points[:, 1] > 1.99)
    left = Thinner(points, triangles, ~border).run(40)
    used = np.unique(left)
    assert set(np.flatnonzero(border)) <= set(used)
    assert len(used) == len(points) - 40

    def area(faces):
        a, b, c = (points[faces[:, i], :2] for i in range(3))
        u, v = b - a, c - a
        return (u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]) / 2

    assert (area(left) > 0).all()
    assert area(left).sum() == pytest.approx(4.0)
    assert min(smallest_angle(points[face]) for face in left) > 0.1


def test_loops_and_rings_of_a_hole():
    _, quads, _ = sheet(9)
    hole = np.isin(quads, [40]).any(1)
    (seam, *_others) = sorted(border_loops(quads[hole]), key=len)
    assert len(seam) == 8
    first, second = rings(seam, quads[~hole], 2)
    assert (len(first), len(second)) == (16, 24)


def test_a_ring_is_cut_at_its_ends():
    turn = np.linspace(0, 2 * np.pi, 12, endpoint=False)
    points = np.stack([np.cos(turn), np.sin(turn), 0 * turn], 1)
    upper, lower = halves(list(range(12)), points)
    assert upper[0] == lower[0] == 0
    assert upper[-1] == lower[-1] == 6
    assert points[upper[1:-1], 1].min() > 0 > points[lower[1:-1], 1].max()


@pytest.mark.parametrize("upper", [True, False])
def test_an_arch_has_fourteen_single_teeth_and_a_gum(upper):
    strip = np.array([[x, y, 1.1 - 3 * x * x] for x in np.linspace(-0.32, 0.32, 20) for y in (6.5, 6.62)])
    part = dental_arch(strip, upper=upper)
    tooth, gum = part.material[:, 0] > 0, part.material[:, 1] > 0
    assert tooth.sum() % 14 == 0
    assert (tooth ^ gum).all()
    height = part.positions[:, 1] if upper else -part.positions[:, 1]
    assert height[gum].min() > height[tooth].min()
    np.testing.assert_allclose(part.positions[tooth, 0].min(), -part.positions[tooth, 0].max(), atol=1e-6)


@pytest.mark.parametrize("upper", [True, False])
def test_a_tooth_is_seen_from_before_and_from_behind(upper):
    strip = np.array([[x, y, 1.1 - 3 * x * x] for x in np.linspace(-0.32, 0.32, 20) for y in (6.5, 6.62)])
    part = dental_arch(strip, upper=upper)
    middle = [np.abs(part.positions[face, 0]).max() < 0.09 and part.material[face, 0].all() for face in part.triangles]
    a, b, c = (part.positions[part.triangles[middle][:, corner]] for corner in range(3))
    normal, place = np.cross(b - a, c - a), (a + b + c) / 3
    before, behind = normal[:, 2] > 0, normal[:, 2] < 0
    assert before.sum() > 10
    assert behind.sum() > 10
    assert place[before, 2].mean() > place[behind, 2].mean() + 0.02


def test_an_eyeball_is_a_globe_with_a_cornea():
    part = eyeball(np.array([0.3, 7.0, 1.2]), 0.14)
    distance = np.linalg.norm(part.positions - [0.3, 7.0, 1.2], axis=1)
    assert distance.min() == pytest.approx(0.14, rel=1e-6)
    assert distance.max() == pytest.approx(0.14 * 1.075, rel=1e-3)
    assert part.positions[distance.argmax()] == pytest.approx([0.3, 7.0, 1.2 + 0.14 * 1.075])
