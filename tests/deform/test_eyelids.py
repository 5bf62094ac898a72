"""The lids: they shut without a gap, stay on their sphere, follow the eye, and their two muscles couple."""

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from agentface.deform.eyes import eyeballs, eyelids
from agentface.deform.eyes import eyelids_compiled as compiled
from agentface.parameters import COUNT, NAMES, PARAMETERS, FacePose
from agentface.studies.calibration.agreement import agreement
from tests.heads import head_model

FACES = {face: head_model(face) for face in ("amber", "onyx")}
TABLES = {face: eyelids.prepare(model) for face, model in FACES.items()}
CLOSE, SQUEEZE, WIDEN = "orbicularis_oculi_palpebralis", "orbicularis_oculi_orbitalis", "levator_palpebrae"
IRIS = 0.445  # of the eye's radius, as the eyes are drawn
LEVELS = st.floats(0, 1, width=32)
FRACTIONS = st.lists(LEVELS, min_size=COUNT, max_size=COUNT)
LOW, HIGH = (np.array([getattr(known, end) for known in PARAMETERS], np.float32) for end in ("low", "high"))


@pytest.fixture(params=FACES)
def face(request):
    return request.param


def spread(fractions):
    return (LOW + (HIGH - LOW) * np.array(fractions, np.float32)).astype(np.float32)


def moved(face, values, points=None):
    points = (FACES[face].vertices if points is None else points).copy()
    eyelids.apply(TABLES[face], values, points)
    return points


def posed(face, **contractions):
    return moved(face, FacePose.of(**contractions).array)


def edges(face, points, side="l", ring=None):
    """The upper and the lower edge of the slit as polylines."""
    file = FACES[face].eyelids
    halves = file.rings[side][file.edge_ring if ring is None else ring]
    return points[halves.upper].astype(np.float64), points[halves.lower].astype(np.float64)


def distance(points, line):
    """Of each point to a polyline."""
    start, along = line[:-1], np.diff(line, axis=0)
    part = np.clip(((points[:, None] - start) * along).sum(2) / np.maximum((along**2).sum(1), 1e-15), 0, 1)
    return np.linalg.norm(points[:, None] - start - part[..., None] * along, axis=2).min(1)


def largest_gap(face, points, side="l", ring=None):
    upper, lower = edges(face, points, side, ring)
    return max(distance(upper, lower).max(), distance(lower, upper).max())


def opening(face, points, side="l"):
    """The height of the slit in the middle half of the eye."""
    upper, lower = (edge[np.argsort(edge[:, 0])] for edge in edges(face, points, side))
    x = np.linspace(*np.quantile(upper[:, 0], [0.25, 0.75]), 9)
    return float(np.mean(np.interp(x, *upper.T[:2]) - np.interp(x, *lower.T[:2])))


def test_the_pose_at_rest_moves_nothing(face):
    points = FACES[face].vertices.copy()
    compiled.apply(TABLES[face], FacePose().array, points)
    np.testing.assert_array_equal(points, FACES[face].vertices)
    np.testing.assert_array_equal(posed(face), FACES[face].vertices)


@pytest.mark.parametrize("pose", [{CLOSE: 1}, {SQUEEZE: 1}, {SQUEEZE: 0.5}, {CLOSE: 1, WIDEN: 1, "gaze_pitch": 0.5}])
@pytest.mark.parametrize("side", "lr")
def test_closed_lids_leave_no_gap_along_the_whole_slit(face, pose, side):
    assert largest_gap(face, FACES[face].vertices, side) > 0.003
    points = posed(face, **pose)
    assert largest_gap(face, points, side) < 0.0003
    for ring in range(1, FACES[face].eyelids.edge_ring):
        assert largest_gap(face, points, side, ring) < 0.0003


@settings(max_examples=30)
@given(FRACTIONS, st.integers(0, 2**32 - 1))
def test_closed_lids_stay_closed_whatever_moved_the_skin_before(fractions, seed):
    values = spread(fractions)
    values[[NAMES.index(f"{CLOSE}_l"), NAMES.index(f"{CLOSE}_r")]] = 1.0
    push = np.random.default_rng(seed).normal(0, 0.003, FACES["amber"].vertices.shape).astype(np.float32)
    for face, model in FACES.items():
        points = moved(face, values, model.vertices + push)
        assert max(largest_gap(face, points, side) for side in "lr") < 0.0003


def test_lids_close_evenly(face):
    heights = [opening(face, posed(face, **{CLOSE: level})) for level in np.linspace(0, 1, 9)]
    assert (np.diff(heights) < 0).all()
    assert heights[4] == pytest.approx(0.5 * heights[0], rel=0.12)
    assert abs(heights[-1]) < 1e-4


def test_lids_open_past_neutral_and_show_the_white_above_the_iris(face):
    model = FACES[face]
    wide = posed(face, **{WIDEN: 1})
    assert opening(face, wide) > 1.3 * opening(face, model.vertices)
    inner = edges(face, wide, ring=1)[0][::-1] - model.eye_centre("l")
    assert np.interp(0.0, *inner[:, :2].T) > IRIS * model.eyes.radius
    np.testing.assert_allclose(edges(face, wide)[1], edges(face, model.vertices)[1], atol=1e-6)


def test_a_squeeze_narrows_the_slit_from_below_and_raises_the_cheek(face):
    rest, squint = FACES[face].vertices, posed(face, **{SQUEEZE: 0.25})
    assert 0.4 < opening(face, squint) / opening(face, rest) < 0.6
    upper, lower = (after - before for after, before in zip(edges(face, squint), edges(face, rest), strict=True))
    assert lower[:, 1].max() > -upper[:, 1].min()
    cheek = np.argmin(np.linalg.norm(rest - FACES[face].landmarks["infraorbital_l"], axis=1))
    tight = posed(face, **{SQUEEZE: 1})
    assert tight[cheek, 1] > squint[cheek, 1] > rest[cheek, 1]


@pytest.mark.parametrize(
    ("shape", "pose", "least"),
    [("eyeBlink", {CLOSE: 1}, 0.8), ("eyeWide", {WIDEN: 1}, 0.8), ("eyeSquint", {SQUEEZE: 0.3}, 0.7)],
)
def test_the_lids_move_as_the_artists_have_them(face, shape, pose, least):
    model = FACES[face]
    artists = sum(model.shapes[f"{shape}{side}"].dense(len(model.vertices)) for side in ("Left", "Right"))
    result = agreement(model, posed(face, **pose) - model.vertices, artists)
    assert result.cosine > least
    assert shape != "eyeSquint" or 0.7 < result.peak_ratio < 1.4


def test_the_lids_follow_the_eye_up_and_down_the_upper_one_more(face):
    limit = np.radians(FACES[face].eyes.pitch_limit_deg)
    rest = edges(face, FACES[face].vertices)
    (up, up_lower), (down, down_lower), beyond = (
        [(after - before)[:, 1] for after, before in zip(edges(face, posed(face, gaze_pitch=pitch)), rest, strict=True)]
        for pitch in (limit, -limit, 2 * limit)
    )
    assert up.max() > up_lower.max() > 0.001
    assert down.min() < down_lower.min() < -0.001
    np.testing.assert_allclose(beyond[0], up, atol=1e-7)


@settings(max_examples=30)
@given(FRACTIONS, st.floats(0, 0.01), st.integers(0, 2**32 - 1))
def test_nothing_goes_below_the_sphere_of_the_lids(fractions, size, seed):
    push = np.random.default_rng(seed).normal(0, size, FACES["amber"].vertices.shape).astype(np.float32)
    for face, model in FACES.items():
        tables = TABLES[face]
        values = spread(fractions)
        points = moved(face, values, model.vertices + push)
        for side, vertex in enumerate(tables.vertex.reshape(2, -1)):
            ahead = np.array([0, 0, eyeballs.FARTHEST * values[tables.eyes.thrust[side]]])
            rest = np.linalg.norm(model.vertices[vertex] - tables.centre[side], axis=1)
            far = np.linalg.norm(points[vertex] - tables.centre[side] - ahead, axis=1)
            assert (far > np.minimum(rest, model.eyelids.sphere * model.eyes.radius) - 2e-6).all()


@settings(max_examples=40)
@given(FRACTIONS, st.integers(0, 2**32 - 1))
@example([0.0] * COUNT, 0)
@example([1.0] * COUNT, 1)
def test_the_compiled_loop_is_the_numpy_form(fractions, seed):
    push = np.random.default_rng(seed).normal(0, 0.002, FACES["amber"].vertices.shape).astype(np.float32)
    for face, model in FACES.items():
        values, points = spread(fractions), model.vertices + push
        expected = moved(face, values, points)
        compiled.apply(TABLES[face], values, points)
        np.testing.assert_allclose(points, expected, atol=1e-7)


@settings(max_examples=20)
@given(FRACTIONS)
def test_a_mirrored_pose_gives_mirrored_lids(fractions):
    values = spread(fractions)
    mirrored = values.copy()
    for index, name in enumerate(NAMES):
        other = name[:-2] + {"_l": "_r", "_r": "_l"}[name[-2:]] if name.endswith(("_l", "_r")) else name
        mirrored[NAMES.index(other)] = values[index] * (-1 if PARAMETERS[index].sideways else 1)
    for face, model in FACES.items():
        one, other = moved(face, values), moved(face, mirrored)
        np.testing.assert_allclose(one[model.mirror] * [-1, 1, 1], other, atol=1e-5)


@settings(max_examples=20)
@given(FRACTIONS, FRACTIONS)
def test_a_small_step_of_the_pose_is_a_small_step_of_the_lids(fractions, towards):
    start, step = spread(fractions), 1e-3
    for face in FACES:
        near = start + np.float32(step) * (spread(towards) - start)
        gone = np.linalg.norm(moved(face, near) - moved(face, start), axis=1).max()
        assert gone < 0.1 * step


@given(LEVELS, LEVELS, LEVELS, LEVELS)
@example(1.0, 0.5, 0.0, 0.0)
@example(0.5, 0.25, 0.5, 0.0)
def test_the_coupling_is_the_papers_where_the_paper_speaks(closing, squeezing, other_closing, other_squeezing):
    closed, squeezed = eyelids.coupled(closing, squeezing, other_closing, other_squeezing)
    assert closing <= closed <= 1
    assert squeezing <= squeezed <= 1
    if squeezing > 0.5 * closing:
        assert closed == min(1.0, 2 * squeezing)
        assert squeezed == squeezing
    else:
        assert closed == closing
        if other_closing == other_squeezing == 0:
            assert squeezed == 0.5 * closing
        if max(other_closing, min(1.0, 2 * other_squeezing)) >= closing:
            assert squeezed == squeezing


@given(st.tuples(LEVELS, LEVELS, LEVELS, LEVELS), st.tuples(*[st.floats(-1e-3, 1e-3)] * 4))
def test_the_coupling_has_no_jump(levels, step):
    near = [min(1.0, max(0.0, level + change)) for level, change in zip(levels, step, strict=True)]
    gone = np.abs(np.subtract(eyelids.coupled(*near), eyelids.coupled(*levels)))
    assert gone.max() <= 3e-3 + 1e-12


@given(LEVELS, LEVELS, LEVELS, LEVELS)
def test_coupling_twice_is_coupling_once(closing, squeezing, other_closing, other_squeezing):
    one = eyelids.coupled(closing, squeezing, other_closing, other_squeezing)
    other = eyelids.coupled(other_closing, other_squeezing, closing, squeezing)
    assert eyelids.coupled(*one, *other) == pytest.approx(one, abs=1e-12)


def test_closing_one_eye_squeezes_it_and_closing_both_does_not(face):
    cheek = np.argmin(np.linalg.norm(FACES[face].vertices - FACES[face].landmarks["infraorbital_l"], axis=1))
    wink, blink = posed(face, **{f"{CLOSE}_l": 1}), posed(face, **{CLOSE: 1})
    half_squeezed = posed(face, **{CLOSE: 1, f"{SQUEEZE}_l": 0.5})
    left = TABLES[face].vertex[0]
    np.testing.assert_allclose(wink[left], half_squeezed[left], atol=1e-7)
    assert wink[cheek, 1] > blink[cheek, 1] + 0.001
    assert opening(face, wink, "r") == pytest.approx(opening(face, FACES[face].vertices, "r"), abs=1e-7)


def test_the_lids_take_the_gaze_that_the_eye_hole_leaves(face):
    tables = eyeballs.prepare(FACES[face])
    values = FacePose.of(gaze_yaw=0.8, gaze_pitch=0.2).array
    pitch = eyeballs.eye_angles(tables, values, 0)[1]
    np.testing.assert_allclose(moved(face, values)[TABLES[face].vertex[0]],
                               posed(face, gaze_pitch=pitch)[TABLES[face].vertex[0]], atol=1e-7)  # fmt: skip


TIGHTEN = "orbicularis_oculi_preseptalis"


def test_the_lower_lids_own_muscle_raises_it_and_keeps_half_of_the_eye_open(face):
    rest, tight = FACES[face].vertices, posed(face, **{TIGHTEN: 1})
    assert 0.5 < opening(face, tight) / opening(face, rest) < 0.9
    (upper, lower), (_, raised) = edges(face, rest), edges(face, tight)
    np.testing.assert_allclose(edges(face, tight)[0][1:-1], upper[1:-1], atol=3e-4)
    assert (raised[:, 1] - lower[:, 1]).max() > 1e-3


def test_it_agrees_with_the_artists_squint(face):
    model = FACES[face]
    row = agreement(model, posed(face, **{TIGHTEN: 1}) - model.vertices, squint(model))
    assert row.cosine > 0.85
    assert row.covered > 0.8


def squint(model):
    return sum(model.shapes[f"eyeSquint{side}"].dense(len(model.vertices)) for side in ("Left", "Right"))


def test_a_shut_eye_is_not_tightened_further(face):
    shut = posed(face, **{CLOSE: 1})
    np.testing.assert_allclose(posed(face, **{CLOSE: 1, TIGHTEN: 1}), shut, atol=5e-4)
    assert largest_gap(face, posed(face, **{CLOSE: 1, TIGHTEN: 1})) < largest_gap(face, shut) + 1e-5


def test_the_lids_slant_with_an_inner_brow_that_rises_alone(face):
    rest = FACES[face].vertices
    upper = np.array(FACES[face].eyelids.rings["l"][FACES[face].eyelids.edge_ring].upper)
    inward = upper[np.argsort(np.abs(rest[upper, 0]))]
    inner, outer = inward[2 : len(inward) // 3], inward[-len(inward) // 3 : -2]

    def lifted(**muscles):
        return posed(face, **muscles)[:, 1] - rest[:, 1]

    sad = lifted(frontalis_medialis=1)
    assert sad[inner].mean() > 1e-4
    assert sad[outer].mean() < -1e-4
    np.testing.assert_array_equal(posed(face, frontalis_medialis=1, frontalis_lateralis=1), rest)


@pytest.mark.parametrize("way", [-1.0, 1.0])
def test_the_lids_go_along_with_an_eye_that_comes_out_or_sinks_in(face, way):
    model, tables = FACES[face], TABLES[face]
    move = posed(face, eye_thrust=way) - model.vertices
    for side, name in enumerate("lr"):
        ring = model.eyelids.rings[name][0]
        margin = move[ring.upper + ring.lower]
        np.testing.assert_allclose(margin[:, 2], way * eyeballs.FARTHEST, atol=2e-5)
        np.testing.assert_allclose(margin[:, :2], 0.0, atol=2e-5)
        far = np.linalg.norm(move[tables.vertex[side].ravel()], axis=1)
        assert far.max() < 1.1 * eyeballs.FARTHEST
    away = np.min([np.linalg.norm(model.vertices - model.eye_centre(name), axis=1) for name in "lr"], axis=0)
    assert not move[away > model.landmarks.eye_separation].any()
    for closed in ({}, {CLOSE: 1.0}, {CLOSE: 1.0, SQUEEZE: 1.0}):
        before, after = posed(face, **closed), posed(face, eye_thrust=way, **closed)
        assert largest_gap(face, after) < largest_gap(face, before) + 1e-4
