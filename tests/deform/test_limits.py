"""Limits of what the vector muscles do to the skin: travel by region, no squashed triangles."""

import shutil

import numpy as np
import pytest
import yaml
from hypothesis import given, settings
from hypothesis import strategies as st

from agentface.deform import creases
from agentface.deform.eyes import eyelids
from agentface.deform.mouth import lips
from agentface.deform.muscles import limits, squash
from agentface.deform.muscles import limits_compiled as compiled
from agentface.deform.muscles import squash_compiled as compiled_squash
from agentface.deform.muscles.combine import Combiner
from agentface.emotion.inference import default_inference
from agentface.emotion.state import EMOTIONS, EmotionState
from agentface.errors import DataError
from agentface.facs.action_units import load_action_units
from agentface.head.model import load_model
from agentface.head.regions import with_sides
from agentface.parameters import VECTOR_MUSCLES, FacePose, indices_of
from tests.deform.conflicts import Edges
from tests.heads import head_model

FACES = {face: head_model(face) for face in ("amber", "onyx")}
TABLES = {face: limits.prepare(model) for face, model in FACES.items()}
CREASES = {face: creases.prepare(m, eyelids.prepare(m), lips.prepare(m)) for face, m in FACES.items()}
COMBINERS = {face: Combiner(model.vertices, model.muscles) for face, model in FACES.items()}
FIRST = indices_of(VECTOR_MUSCLES[0])[0]
FRACTIONS = st.lists(st.floats(0, 1, width=32), min_size=len(VECTOR_MUSCLES), max_size=len(VECTOR_MUSCLES))


@pytest.fixture(params=FACES)
def face(request):
    return request.param


def contracted(face, contractions):
    points = FACES[face].vertices.copy()
    COMBINERS[face].apply(np.array(contractions, np.float32), points)
    return points


def of_pose(face, pose):
    return contracted(face, pose.array[FIRST : FIRST + len(VECTOR_MUSCLES)])


def travel(face, points):
    return np.linalg.norm(points.astype(np.float64) - FACES[face].vertices, axis=1)


def beyond(face, points):
    """By how much vertices leave the limit of their region, read from the file: the most for each region."""
    model = FACES[face]
    file = yaml.safe_load((model.folder / "regions.yaml").read_text())
    ranges = file["regions"] | file["sub_regions"]
    inner = {name: [r for sub, r in file["sub_regions"].items() if r[0] >= ranges[name][0]] for name in file["regions"]}
    far, result = travel(face, points), {}
    for name, limit in file["limits"].items():
        for full in with_sides(name):
            first, last = ranges[full]
            own = np.arange(first, last + 1)
            for low, high in inner.get(full, []):
                own = own[(own < low) | (own > high)]
            result[full] = float(far[own].max() - limit * model.landmarks.eye_separation)
    return result


def test_rest_is_left_alone(face):
    points = FACES[face].vertices.copy()
    limits.apply(TABLES[face], points)
    np.testing.assert_array_equal(points, FACES[face].vertices)


def test_no_vertex_leaves_its_regions_limit_however_far_it_is_pushed(face):
    draw = np.random.default_rng(1)
    rest = FACES[face].vertices
    for size in (0.001, 0.01, 0.1, 10.0):
        points = rest + draw.normal(scale=size, size=rest.shape).astype(np.float32)
        limits.apply(TABLES[face], points)
        assert max(beyond(face, points).values()) < 1e-7


def test_limits_of_neighbours_go_over_into_each_other(face):
    model = FACES[face]
    limit = limits.travel_limits(model)
    ends = np.concatenate([model.triangles[:, [i, (i + 1) % 3]] for i in range(3)])
    length = np.linalg.norm(model.vertices[ends[:, 0]] - model.vertices[ends[:, 1]], axis=1)
    assert (np.abs(limit[ends[:, 0]] - limit[ends[:, 1]]) <= 1.5001 * length).all()
    np.testing.assert_allclose(limit[model.mirror], limit, rtol=1e-3)


@given(st.floats(0, 3), st.integers(0, 5000))
def test_the_soft_limit_rises_smoothly_and_only_shortens(far, vertex):
    tables = TABLES["amber"]
    limit = float(tables.limit[vertex])

    def bounded(part):
        points = FACES["amber"].vertices.copy()
        points[vertex, 0] += part * limit
        # the vertex alone, without what its neighbours make of the squash
        limits.apply(tables._replace(squash=NOTHING), points)
        return float(points[vertex, 0] - FACES["amber"].vertices[vertex, 0]) / limit

    here, ahead = bounded(far), bounded(far + 0.01)
    assert here <= min(far, 1.0) + 1e-5
    assert -1e-4 < ahead - here < 0.0101 + 1e-4
    if far < tables.knee:
        assert here == pytest.approx(far, abs=1e-4)


NOTHING = squash.SquashTables(
    *(np.zeros(shape, kind) for shape, kind in (((0, 2, 3), np.int32), ((0, 2), np.float32))),
    *(np.zeros((0, 2, 3), np.float32) for _ in range(3)),
    np.zeros(1, np.int32),
    least=0.0,
    flat=-1.0,
    passes=1,
)


def test_what_is_calibrated_stays(face):
    """No action unit and no emotion comes near a limit of travel; what the squash changes is small."""
    inference = default_inference()
    poses = {f"AU {number}": FacePose.of(**unit.muscles) for number, unit in load_action_units().items()}
    poses |= {name: inference.pose(EmotionState.of({name: 1.0})) for name in EMOTIONS}
    for name, pose in poses.items():
        before = of_pose(face, pose)
        after = before.copy()
        squash.apply(TABLES[face].squash, after)
        last = after.copy()
        limits.apply(TABLES[face]._replace(squash=NOTHING), last)
        np.testing.assert_array_equal(last, after, err_msg=name)
        change, moved = np.linalg.norm(after - before), np.linalg.norm(before - FACES[face].vertices)
        assert change <= 0.02 * moved, name


def test_muscles_alone_turn_no_skin_over():
    """Over 500 random contractions of all vector muscles of either face; without the limits a tenth of them do."""
    before = after = 0
    for face, model in FACES.items():
        edges, draw = Edges.of(model), np.random.default_rng(7)
        outside = ~edges.folding()
        for _ in range(500):
            points = contracted(face, draw.random(len(VECTOR_MUSCLES)) ** 0.4)
            before += (edges.flipped(points) & outside).any()
            compiled.apply(TABLES[face], points)
            after += (edges.flipped(points) & outside).any()
    assert before > 100
    assert after == 0


def test_muscles_that_do_not_meet_are_left_alone(face):
    for name in VECTOR_MUSCLES[::2]:
        points = of_pose(face, FacePose.of(**{name[:-2]: 0.3}))
        after = points.copy()
        limits.apply(TABLES[face], after)
        np.testing.assert_array_equal(after, points, err_msg=name)


@settings(max_examples=40)
@given(FRACTIONS)
def test_limits_keep_the_mirror(fractions):
    for face, model in FACES.items():
        swapped = np.array(fractions, np.float32).reshape(-1, 2)[:, ::-1].ravel()
        one, other = contracted(face, fractions), contracted(face, swapped)
        compiled.apply(TABLES[face], one)
        compiled.apply(TABLES[face], other)
        np.testing.assert_allclose(other[model.mirror] * [-1, 1, 1], one, atol=2e-6)


@settings(max_examples=40)
@given(FRACTIONS, st.floats(0, 0.003))
def test_compiled_and_plain_are_the_same(fractions, noise):
    for face, model in FACES.items():
        push = np.random.default_rng(2).normal(scale=noise, size=model.vertices.shape).astype(np.float32)
        plain = contracted(face, fractions) + push
        fast = plain.copy()
        limits.apply(TABLES[face], plain)
        compiled.apply(TABLES[face], fast)
        np.testing.assert_allclose(fast, plain, atol=1e-7, rtol=0)


def test_points_beside_the_skin_have_their_vertices_limits(face):
    model = FACES[face]
    vertices, weights = np.array([[5, 9], [700, 700]], np.int32), np.array([[0.25, 0.75], [0.5, 0.5]], np.float32)
    rest = np.concatenate([model.vertices, np.full((2, 3), 0.05, np.float32)])
    tables = limits.prepare(model, (vertices, weights), rest)
    limit = TABLES[face].limit
    np.testing.assert_allclose(tables.limit[-2:], [0.25 * limit[5] + 0.75 * limit[9], limit[700]], rtol=1e-6)
    points = rest.copy()
    points[-2:] += 1.0
    limits.apply(tables, points)
    np.testing.assert_array_equal(points[:-2], model.vertices)
    assert (np.linalg.norm(points[-2:] - rest[-2:], axis=1) <= tables.limit[-2:] * (1 + 1e-5)).all()


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [("eyebrow: 0.23", "eyebrows: 0.23", "a limit for eyebrow"), ("eyebrow: 0.23", "eyebrow: 0.0", "greater than 0")],
)
def test_wrong_limits_are_told(tmp_path, old, new, expected):
    face = shutil.copytree(FACES["amber"].folder, tmp_path / "mine")
    text = (face / "regions.yaml").read_text()
    assert old in text
    (face / "regions.yaml").write_text(text.replace(old, new))
    with pytest.raises(DataError, match=expected):
        load_model(face)


@settings(max_examples=20)
@given(FRACTIONS, st.floats(0, 0.003))
def test_creases_compiled_and_plain_are_the_same_and_leave_rest_alone(fractions, noise):
    for face, model in FACES.items():
        tables = CREASES[face]
        rest = model.vertices.copy()
        compiled_squash.apply(tables, rest)
        np.testing.assert_array_equal(rest, model.vertices)
        push = np.random.default_rng(3).normal(scale=noise, size=model.vertices.shape).astype(np.float32)
        plain = contracted(face, fractions) + push
        fast = plain.copy()
        squash.apply(tables, plain)
        compiled_squash.apply(tables, fast)
        np.testing.assert_allclose(fast, plain, atol=1e-7, rtol=0)
