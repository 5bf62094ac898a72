"""Further loops in the base mesh, the fold over the lids, and skin at rest that is not all but folded."""

from types import SimpleNamespace

import numpy as np
import pytest

from agentface.head.build.fold import LidFold, fold_lids
from agentface.head.build.relax import relaxed
from agentface.head.build.splits import ACROSS, ALONG, WHOLE, across_rings, between_rings
from agentface.head.build.topology import SkinTopology
from agentface.head.ring_names import LID_RINGS, LidRing
from tests.head.test_build import sheet

SIDE = 7


def row(number):
    return list(range(number * SIDE, (number + 1) * SIDE))


def column(number):
    return list(range(number, SIDE * SIDE, SIDE))


def skin_of(splits):
    points, quads, mirror = sheet()
    return points, SkinTopology(quads, np.zeros(len(quads), np.int32), points, mirror, splits)


def area(points, triangles):
    a, b, c = (points[triangles[:, i], :2] for i in range(3))
    return 0.5 * ((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0])


def test_a_ring_is_put_in_between_two():
    points, quads, _ = sheet()
    splits = between_rings(quads, row(2), row(3))
    assert (splits != WHOLE).sum() == SIDE - 1
    assert set(splits[splits != WHOLE].tolist()) == {ALONG}
    points, skin = skin_of(splits)
    placed = skin.place(points)
    new = placed[(placed[:, 1] > points[row(2)[0], 1] + 1e-6) & (placed[:, 1] < points[row(3)[0], 1] - 1e-6)]
    assert len(new) == SIDE
    assert np.ptp(new[:, 1]) < 1e-9
    areas = area(placed, skin.triangles)
    assert areas.min() > 0
    assert areas.sum() == pytest.approx(4.0, rel=0.03)


def test_a_column_is_put_in_as_far_as_a_border():
    _, quads, _ = sheet()
    edges = [(row(0)[0], row(0)[1]), (row(0)[-1], row(0)[-2])]
    through = across_rings(quads, edges, [])
    assert (through != WHOLE).sum() == 2 * (SIDE - 1)
    halfway = across_rings(quads, edges, [set(row(3))])
    assert (halfway != WHOLE).sum() == 2 * 3
    assert set(halfway.tolist()) == {WHOLE, ACROSS}
    points, skin = skin_of(halfway)
    placed = skin.place(points)
    assert area(placed, skin.triangles).min() > 0
    assert area(placed, skin.triangles).sum() == pytest.approx(4.0, rel=0.03)
    np.testing.assert_allclose(placed[skin.mirror] * [-1, 1, 1], placed, atol=1e-9)


def eye():
    """A left eye at (2, 0, 0) decimetres with rings on a sphere of 1, and its image."""
    centre = np.array([2.0, 0.0, 0.0])
    angles = np.linspace(0.15, 0.75, LID_RINGS)
    turn = np.linspace(0.0, np.pi, 9)
    points, rings = [], []
    for polar in angles:
        halves = []
        for sign in (1.0, -1.0):
            first = len(points)
            points += [
                np.add(centre, [np.sin(polar) * np.cos(t), sign * np.sin(polar) * np.sin(t), np.cos(polar)])
                for t in turn
            ]
            halves.append(list(range(first, len(points))))
        rings.append(tuple(halves))
    placed = np.array(points)
    count = len(placed)
    both = np.concatenate([placed, placed * [-1, 1, 1]])
    right = [tuple([v + count for v in half] for half in ring) for ring in rings]
    topology = SimpleNamespace(lid_rings=lambda side: rings if side == "l" else right)
    return topology, both, rings, centre


def test_the_fold_sinks_at_the_crease_hangs_above_it_and_ends_at_the_corners():
    topology, points, rings, centre = eye()
    placed = fold_lids(topology, points, LidFold(depth_mm=1.0, bulge_mm=0.3), centre)
    moved = placed - points
    upper = {number: np.array(rings[number][0]) for number in range(LID_RINGS)}
    out = (points - centre) / np.linalg.norm(points - centre, axis=1, keepdims=True)
    radial = (moved * out).sum(axis=1)
    middle = 4
    assert radial[upper[LidRing.CREASE][middle]] == pytest.approx(-0.01, rel=0.02)
    assert radial[upper[LidRing.ORBIT][middle]] == pytest.approx(0.003, rel=0.02)
    hung = fold_lids(topology, points, LidFold(overhang_mm=0.5), centre) - points
    assert hung[upper[LidRing.ORBIT][middle]] == pytest.approx([0.0, -0.005, 0.0], abs=1e-4)
    ends = [upper[number][end] for number in upper for end in (0, -1)]
    np.testing.assert_allclose(moved[ends], 0.0, atol=1e-9)
    lower = np.concatenate([ring[1][1:-1] for ring in rings])
    np.testing.assert_array_equal(moved[lower], 0.0)
    half = len(points) // 2
    np.testing.assert_allclose(moved[half:] * [-1, 1, 1], moved[:half], atol=1e-12)


def test_no_fold_is_the_face_as_it_was():
    topology, points, _, centre = eye()
    np.testing.assert_array_equal(fold_lids(topology, points, LidFold(), centre), points)


def folded_sheet(height):
    points, quads, _ = sheet(9)
    points = points * [1, 1, 0]
    points[40, 2] = height
    triangles = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    material = np.zeros((len(points), 4))
    topology = SimpleNamespace(
        skin=SimpleNamespace(triangles=triangles), material=material, lid_rings=lambda _: [([], [])] * LID_RINGS
    )
    return topology, points


def sharpest(points, triangles):
    a, b, c = (points[triangles[:, i]] for i in range(3))
    across = np.cross(b - a, c - a)
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    pairs = [
        (i, j)
        for i in range(len(triangles))
        for j in range(i)
        if len(set(triangles[i].tolist()) & set(triangles[j].tolist())) == 2
    ]
    return max(np.degrees(np.arccos(np.clip(across[i] @ across[j], -1, 1))) for i, j in pairs)


def test_what_is_sharper_than_it_may_be_is_evened_out():
    topology, points = folded_sheet(0.8)
    assert sharpest(points, topology.skin.triangles) > 80
    found = relaxed(topology, points)
    assert sharpest(found, topology.skin.triangles) <= 45.0 + 1e-6
    far = np.linalg.norm(points[:, :2] - points[40, :2], axis=1) > 0.9
    np.testing.assert_array_equal(found[far], points[far])


def test_gentle_skin_and_lips_stay():
    topology, points = folded_sheet(0.1)
    np.testing.assert_array_equal(relaxed(topology, points), points)
    topology, points = folded_sheet(0.8)
    topology.material[:, 0] = 1.0
    np.testing.assert_array_equal(relaxed(topology, points), points)
