"""Contact: lips against lips and teeth, checked by intersecting triangles, which contact itself never does."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from agentface.deform.mouth import contact
from agentface.deform.mouth import contact_compiled as compiled
from agentface.deform.mouth.dental_arch import fit_arch
from agentface.deform.mouth.lip_grid import column_places, lip_grid
from agentface.parameters import COUNT, PARAMETERS, FacePose, indices_of
from tests.deform.crossings import crossings, edges_of
from tests.heads import deformer_of, head_model

FACES = {face: head_model(face) for face in ("amber", "onyx")}
TABLES = {face: contact.prepare(model) for face, model in FACES.items()}
LOW = np.array([known.low for known in PARAMETERS])
HIGH = np.array([known.high for known in PARAMETERS])
MM = 1e-3


@pytest.fixture(params=FACES)
def face(request):
    return request.param


class Mouth:
    """The triangles of both lips and of the front of the teeth, and what passes through what."""

    def __init__(self, model):
        self.model, grid = model, lip_grid(model)
        place = column_places(grid, model.vertices.astype(np.float64), 24)
        outer = grid.vertices[2:12]
        self.lips = [self._within(outer[:, (place > a) & (place < b)]) for a, b in ((0.4, 11.6), (12.4, 23.6))]
        self.edges = [edges_of(triangles) for triangles in self.lips]
        self.red = edges_of(self._within(outer[1:]))
        self.teeth = [self._front(name) for name in ("teeth_upper", "teeth_lower")]

    def _within(self, vertices):
        return self.model.triangles[np.isin(self.model.triangles, vertices).all(1)]

    def _front(self, name):
        mesh = self.model.parts[name]
        points = mesh.attributes["POSITION"].astype(np.float64)
        return points, mesh.triangles[points[mesh.triangles][..., 2].max(1) > points[:, 2].max() - 22 * MM]

    def crossings(self, vertices, jaw):
        points = vertices.astype(np.float64)
        upper, lower = self.lips
        lip = len(crossings(points, self.edges[0], points, lower)) + len(
            crossings(points, self.edges[1], points, upper)
        )
        turned = self.teeth[1][0] @ jaw[:3, :3].T.astype(np.float64) + jaw[:3, 3]
        return lip, *(
            len(crossings(points, self.red, placed, teeth[1]))
            for placed, teeth in ((self.teeth[0][0], self.teeth[0]), (turned, self.teeth[1]))
        )


def random_poses(count, seed):
    """Uniform poses; a third with few muscles, a third with the jaw nearly closed, where lips meet."""
    rng = np.random.default_rng(seed)
    for number in range(count):
        values = LOW + rng.random(COUNT) * (HIGH - LOW)
        if number % 3 == 1:
            values *= rng.random(COUNT) < 0.3
        if number % 3 == 2:
            values[indices_of("jaw_open")[0]] *= rng.random() ** 2
        yield FacePose(values.astype(np.float32))


@pytest.mark.slow
def test_lips_and_teeth_never_pass_through_each_other(face):
    mouth, deformer = Mouth(FACES[face]), deformer_of(face)
    for pose in random_poses(150, seed=5):
        geometry = deformer.at(pose)
        assert mouth.crossings(geometry.vertices, geometry.jaw) == (0, 0, 0), repr(pose)


@pytest.mark.parametrize(
    "muscles",
    [
        {"orbicularis_oris_press": 0.8, "zygomaticus_major": 1, "zygomaticus_minor": 1},
        {"orbicularis_oris_press": 0.8, "zygomaticus_major": 1, "platysma": 1},
        {
            "orbicularis_oris_press": 1,
            "zygomaticus_major_r": 1,
            "zygomaticus_minor_r": 1,
            "levator_labii_superioris_alaeque_nasi_r": 1,
        },
    ],
)
def test_tight_lips_that_smile_do_not_pass_through_each_other(face, muscles):
    geometry = deformer_of(face).at(FacePose.of(**muscles))
    assert Mouth(FACES[face]).crossings(geometry.vertices, geometry.jaw) == (0, 0, 0)


@pytest.mark.slow
def test_lips_of_muscles_at_their_ends_hardly_ever_pass_through_each_other(face):
    """Muscles at 0 or 1 are the hardest: at most one pose in ten, by a few edges; none through the teeth."""
    mouth, deformer = Mouth(FACES[face]), deformer_of(face)
    rng, through = np.random.default_rng(9), []
    for number in range(60):
        values = np.where(rng.random(COUNT) < (0.5 if number % 2 else 0.25), HIGH, np.maximum(LOW, 0.0))
        values[indices_of("jaw_open")[0]] *= number % 3 == 0
        values[indices_of("lip_bite")[0]] = 0.0  # between columns that have been drawn apart, teeth stand out
        geometry = deformer.at(FacePose(values.astype(np.float32)))
        lips, *teeth = mouth.crossings(geometry.vertices, geometry.jaw)
        assert teeth == [0, 0], repr(values)
        through.append(lips)
    assert max(through) < 12
    assert np.count_nonzero(through) <= 6


@pytest.mark.parametrize("press", [0.4, 0.7, 1.0])
def test_pressed_lips_are_shut(face, press):
    """From corner to corner no more than a tenth of a millimetre stays open between the lowest and the highest ring."""
    vertices = deformer_of(face).at(FacePose.of(orbicularis_oris_press=press)).vertices
    rings = FACES[face].lips.rings[:5]
    corner = FACES[face].landmarks["mouth_corner_l"][0]
    for x in np.linspace(-0.6, 0.6, 41) * corner:
        heights = []
        for halves in ([ring.upper for ring in rings], [ring.lower for ring in rings]):
            lines = [vertices[half][np.argsort(vertices[half][:, 0])] for half in halves]
            heights.append([np.interp(x, line[:, 0], line[:, 1]) for line in lines])
        assert min(heights[0]) - max(heights[1]) < 0.1 * MM


def test_the_oracle_sees_lips_that_pass_through(face):
    model = FACES[face]
    mouth, points = Mouth(model), model.vertices.copy()
    assert mouth.crossings(points, np.eye(4)) == (0, 0, 0)
    points[np.unique(mouth.lips[0]), 1] -= 2 * MM
    assert mouth.crossings(points, np.eye(4))[0] > 10
    points = model.vertices.copy()
    points[TABLES[face].grid.ravel(), 1:] -= [3 * MM, 12 * MM]
    assert min(mouth.crossings(points, np.eye(4))[1:]) > 10


def test_lips_that_only_touch_stay_bit_for_bit(face):
    for module in (contact, compiled):
        points = FACES[face].vertices.copy()
        module.apply(TABLES[face], FacePose().array, points)
        np.testing.assert_array_equal(points, FACES[face].vertices)


@pytest.mark.slow
@settings(max_examples=20)
@given(st.floats(0.3, 3), st.floats(-1.5, 1.5))
def test_overlapping_lips_part_by_half_each(depth, slide):
    """Pressed together by ``depth`` mm and slid along each other by ``slide`` mm, they end up touching."""
    for face, model in FACES.items():
        tables, mouth = TABLES[face], Mouth(model)
        points = model.vertices.copy()
        upper, lower = (tables.grid[:, columns[1:-1]] for columns in (tables.upper, tables.lower))
        points[upper, 1] -= 0.5 * depth * MM
        points[lower, 1] += 0.5 * depth * MM
        points[upper, 0] += slide * MM
        before = points.copy()
        contact.apply(tables, FacePose().array, points)
        assert mouth.crossings(points, np.eye(4))[0] == 0
        raised, sunk = points[upper, 1] - before[upper, 1], before[lower, 1] - points[lower, 1]
        assert raised.min() >= 0
        assert sunk.min() >= 0
        seam = tables.seam
        middle = slice(3, -3)
        assert abs(np.median(raised[seam, middle]) - np.median(sunk[seam, middle])) < 0.15 * MM + 0.1 * depth * MM


def test_the_teeth_hold_lips_that_are_pushed_in(face):
    tables, mouth = TABLES[face], Mouth(FACES[face])
    for opening in (0.0, 0.3, 1.0):
        pose = FacePose.of(jaw_open=opening)
        geometry = deformer_of(face, compiled=False).at(pose)
        points = geometry.vertices.copy()
        points[tables.grid[3:12], 2] -= 6 * MM
        contact.apply(tables, pose.array, points)
        assert mouth.crossings(points, geometry.jaw)[1:] == (0, 0)


def test_the_arch_has_the_teeth_behind_it_and_lies_close(face):
    model = FACES[face]
    for name in ("teeth_upper", "teeth_lower"):
        points = model.parts[name].attributes["POSITION"].astype(np.float64)
        points = points[np.abs(points[:, 0]) < model.landmarks["mouth_corner_l"][0]]
        distance = fit_arch(model, name).distance(points)
        assert distance.max() < 1e-5
        for side in np.arange(0, 20, 4) * MM:
            there = (np.abs(points[:, 0]) >= side) & (np.abs(points[:, 0]) < side + 4 * MM)
            assert distance[there].max() > -1.0 * MM


@settings(max_examples=30)
@given(st.floats(0, 1), st.floats(0, 1), st.floats(0, 6), st.integers(0, 10**6))
def test_compiled_and_numpy_agree(opening, press, size, seed):
    values = FacePose.of(jaw_open=opening, orbicularis_oris_press=press).array
    for face, model in FACES.items():
        noise = np.random.default_rng(seed).standard_normal(model.vertices.shape)
        one = (model.vertices + size * MM * noise).astype(np.float32)
        other = one.copy()
        contact.apply(TABLES[face], values, one)
        compiled.apply(TABLES[face], values, other)
        np.testing.assert_allclose(one, other, atol=1e-7)


def bent(model, rng, size):
    """The face, bent smoothly by up to some ``size`` m."""
    waves = np.cos(np.outer(model.vertices[:, 0] / 0.02, np.arange(4)) + rng.uniform(0, 6, 4))
    return (model.vertices + waves @ (size * rng.standard_normal((4, 3)))).astype(np.float32)


def test_contact_is_symmetric(face):
    model, tables, flip = FACES[face], TABLES[face], np.array([-1, 1, 1])
    rng = np.random.default_rng(2)
    for opening in np.linspace(0.0, 0.5, 30):
        values = FacePose.of(jaw_open=float(opening)).array
        one = bent(model, rng, 1.2 * MM)
        one[tables.grid[:, tables.upper[1:-1]], 1] -= 1.5 * MM
        other = (one[model.mirror] * flip).astype(np.float32)
        before = one.copy()
        contact.apply(tables, values, one)
        contact.apply(tables, values, other)
        assert np.abs(one - before).max() > 0.1 * MM
        np.testing.assert_allclose(other, one[model.mirror] * flip, atol=1e-5)


@pytest.mark.slow
def test_contact_is_continuous(face):
    """Two poses a hair apart end up a few hairs apart, also where columns change their neighbours across."""
    model, tables = FACES[face], TABLES[face]
    rng, values = np.random.default_rng(3), FacePose().array
    for _ in range(40):
        one = bent(model, rng, 1.5 * MM)
        other = (one + 1e-5 * rng.standard_normal(one.shape)).astype(np.float32)
        apart = np.abs(one - other).max()
        contact.apply(tables, values, one)
        contact.apply(tables, values, other)
        assert np.abs(one - other).max() < 10 * apart
