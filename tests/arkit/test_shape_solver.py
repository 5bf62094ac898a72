"""ARKit's weights to poses and back: what moves, what comes back, what is refused."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from agentface.arkit.sampled_shapes import SKIN_SHAPES, sample_shapes
from agentface.arkit.shape_solver import ShapeSolver, arkit_place
from agentface.deform.crowd import Crowd
from agentface.deform.eyes import eyeballs
from agentface.errors import InvalidValueError, UnknownNameError
from agentface.head.arkit import ARKIT_SHAPES
from agentface.head.model import load_model
from agentface.parameters import COUNT, HIGH, LOW, NAMES, NEUTRAL, FacePose, indices_of, parameter
from agentface.studies.bench.arkit import errors, made, mixed, run
from tests.arkit.solvers import rows_of, solver_of

FACES = ("amber", "onyx")
PAGE = Path(__file__).parents[2] / "docs" / "arkit.md"
each_face = pytest.mark.parametrize("face", FACES)


def value(found, name):
    return float(found.pose.array[parameter(name).index])


@each_face
def test_mixtures_of_five_come_back(face):
    solver, places = solver_of(face), made(rows_of(face))
    drawn, chosen = mixed(places, 40)
    found = errors(solver, drawn, chosen, places)
    assert found["error_of_five"] < 0.05
    assert found["error_of_all"] < 0.015
    assert found["error_of_five"] < 0.5 * found["on_shapes_error_of_five"], "that is what the face's answers are for"


@each_face
def test_the_muscles_make_most_shapes(face):
    rows = rows_of(face)
    assert list(rows) == list(SKIN_SHAPES)
    assert len(made(rows)) >= 37
    back = np.array([row["back"] for row in rows.values()])
    assert back.min() > 0.8
    assert np.abs(1.0 - back).mean() < 0.03
    assert np.mean([row["cosine"] for row in rows.values()]) > 0.92


def test_the_page_has_these_figures():
    table = re.findall(r"^\| (\w+) \| ([\d.]+) \| ([\d.]+) \| ([\d.]+) \| ([\d.]+) \|$", PAGE.read_text(), re.MULTILINE)
    assert [name for name, *_ in table] == list(SKIN_SHAPES)
    for name, *figures in table:
        measured = [rows_of(face)[name][key] for face in FACES for key in ("residual", "cosine")]
        assert [float(figure) for figure in figures] == pytest.approx(measured, abs=0.03), name


def test_features_are_the_skin_s_movements():
    """The same numbers by another way: the whole face deformed, its sampled vertices in millimetres."""
    solver = solver_of("amber")
    found = solver.solve_named({"mouthSmileLeft": 0.7, "browInnerUp": 0.5, "jawOpen": 0.3})
    model, readings = solver.model, solver.fit.features.readings
    face = Crowd(model).deform([found.pose])[0]
    below = face.vertices - face.wrinkles[:, None] * face.smooth_normals
    moved = 1e3 * (below - model.vertices)[readings.vertex, readings.axis]
    np.testing.assert_allclose(solver.fit.features.matrix @ moved, found.features, atol=0.02 * np.abs(moved).max())


def test_the_target_is_the_artists_shapes():
    solver = solver_of("amber")
    model, readings = solver.model, solver.fit.features.readings
    shape = model.shapes["mouthSmileLeft"].dense(len(model.vertices))
    drawn = 1e3 * shape[readings.vertex, readings.axis]
    place = SKIN_SHAPES.index("mouthSmileLeft")
    np.testing.assert_allclose(sample_shapes(model).ways[place], drawn, atol=1e-4)
    kept = np.linalg.norm(solver.fit.shapes[place]) / (sample_shapes(model).scale * np.linalg.norm(drawn))
    assert kept == pytest.approx(1.0, abs=0.01), "the basis holds it"


@each_face
def test_no_weight_leaves_the_face_at_rest(face):
    solver = solver_of(face)
    found = solver.solve(np.zeros(52))
    np.testing.assert_allclose(found.pose.array, NEUTRAL, atol=0.01)
    assert not solver.weights(NEUTRAL).round(2).any()


@pytest.mark.parametrize(
    ("weights", "muscles"),
    [
        ({"eyeBlinkLeft": 1.0, "eyeBlinkRight": 1.0}, {"orbicularis_oculi_palpebralis_l": 0.9}),
        ({"browInnerUp": 1.0}, {"frontalis_medialis_l": 0.5, "frontalis_medialis_r": 0.5}),
        ({"jawForward": 0.5}, {"jaw_thrust": 0.4}),
        ({"jawLeft": 1.0}, {"jaw_shift": 0.9}),
        ({"jawRight": 1.0}, {"jaw_shift": -0.9}),
        ({"mouthRight": 1.0}, {"mouth_shift": -0.9}),
        ({"cheekPuff": 1.0}, {"cheek_puff_l": 0.9, "cheek_puff_r": 0.9}),
        ({"mouthFunnel": 1.0}, {"orbicularis_oris_funnel_upper_l": 0.9, "orbicularis_oris_funnel_lower_r": 0.9}),
        ({"mouthDimpleRight": 1.0}, {"buccinator_r": 0.9}),
        ({"tongueOut": 0.6}, {"tongue_out": 0.59}),
        ({"mouthRollLower": 1.0}, {"orbicularis_oris_roll_lower_l": 0.9}),
    ],
    ids="-".join,
)
def test_a_shape_is_made_by_its_muscle(weights, muscles):
    found = solver_of("amber").solve_named(weights)
    for name, least in muscles.items():
        assert value(found, name) * np.sign(least) >= abs(least), name


def test_only_what_is_named_moves():
    solver = solver_of("amber")
    found = solver.solve_named({"browInnerUp": 0.8})
    moved = [name for name, moves in zip(NAMES, found.moves, strict=True) if moves]
    assert {parameter(name).group for name in moved} == {"brow"}
    assert [name for name in NAMES if value(found, name)] == [name for name in moved if value(found, name)], (
        "nothing else"
    )
    before = FacePose(np.where(np.arange(COUNT) == indices_of("jaw_open")[0], np.float32(0.4), NEUTRAL))
    again = solver.solve_named({"eyeLookUpLeft": 1.0}, before)
    assert [name for name, moves in zip(NAMES, again.moves, strict=True) if moves] == ["gaze_pitch"]
    assert value(again, "jaw_open") == np.float32(0.4)
    assert not solver.solve_named({}).moves.any()


def test_all_weights_move_all_that_has_a_shape():
    moves = solver_of("amber").solve(np.zeros(52)).moves
    groups = {known.group for known in map(parameter, NAMES) if not moves[known.index] and known.kind != "contact"}
    assert groups <= {"ears", "head", "eyes", "tongue", "nose and cheek", "chest"}
    assert moves[list(indices_of("gaze_vergence"))].all()


@given(
    yaws=st.tuples(st.floats(-0.7, 0.7), st.floats(-0.3, 0.3)),
    pitch=st.floats(-0.7, 0.7),
)
@settings(max_examples=15)
def test_eyes_come_back(yaws, pitch):
    """Inside the ellipse of the eye's hole, whatever the lids do."""
    solver = solver_of("amber")
    left, right = yaws[0], np.clip(yaws[0] + yaws[1], -0.7, 0.7)
    weights = np.zeros(52)
    for name, share in (
        ("eyeLookOutLeft", left), ("eyeLookInLeft", -left), ("eyeLookInRight", right), ("eyeLookOutRight", -right),
        ("eyeLookUpLeft", pitch), ("eyeLookUpRight", pitch), ("eyeLookDownLeft", -pitch), ("eyeLookDownRight", -pitch),
    ):  # fmt: skip
        weights[ARKIT_SHAPES.index(name)] = max(share, 0.0)
    found = solver.solve(weights)
    if np.hypot(max(abs(left), abs(right)), pitch) < 0.98:
        expected = weights.copy()
        limit = np.degrees(0.5 * (right - left) * np.radians(solver.model.eyes.yaw_limit_deg))
        if -10.0 <= limit <= 25.0:  # further outward the eyes do not go from each other
            np.testing.assert_allclose(solver.weights(found.pose.array), expected, atol=0.03)
    for side in (0, 1):
        yaw, _ = eyeballs.eye_angles(eyeballs.prepare(solver.model), found.pose.array, side)
        assert yaw * (left, right)[side] >= -1e-6, "to the person's left where the left eye looks out"


def test_a_closed_mouth_needs_an_opened_jaw():
    solver = solver_of("amber")
    closed, alone = (solver.solve_named({"mouthClose": 1.0, "jawOpen": jaw}) for jaw in (0.0, 0.4))
    np.testing.assert_allclose(closed.pose.array, NEUTRAL, atol=0.02)
    opened = solver.solve_named({"mouthClose": 0.0, "jawOpen": 0.4})
    assert np.linalg.norm(alone.features) < np.linalg.norm(opened.features)
    assert solver.weights(alone.pose.array)[arkit_place("mouthClose")] > 0.15


def test_a_stream_is_followed_closely_and_calmly():
    solver, frames = solver_of("amber"), 40
    draw = np.random.default_rng(5)
    one, other = (np.where(draw.random(52) < 0.2, draw.random(52), 0.0) for _ in range(2))
    rise = 0.5 - 0.5 * np.cos(np.linspace(0.0, np.pi, frames))[:, None]
    stream = one + rise * (other - one)
    found, poses, missed = None, [], []
    for weights in stream:
        found = solver.solve(weights, previous=found)
        poses.append(found.pose.array)
        missed.append(np.abs(solver.weights(found.pose.array) - weights).mean())
    poses = np.array(poses)
    assert ((poses >= LOW) & (poses <= HIGH)).all()
    assert np.mean(missed[5:]) < 0.05
    step = np.abs(np.diff(poses, axis=0)).max(axis=1)
    assert step.max() < 0.05 + 4.0 * np.abs(np.diff(stream, axis=0)).max() + 1e-6, (
        "no muscle jumps while the weights go slowly"
    )


def test_the_numpy_form_finds_the_same():
    weights = np.zeros(52)
    weights[[arkit_place("mouthSmileLeft"), arkit_place("browDownRight")]] = 0.6, 0.4
    ours, plain = solver_of("amber"), ShapeSolver(load_model("amber"), compiled=False)
    one, other = ours.solve(weights), plain.solve(weights)
    np.testing.assert_allclose(one.pose.array, other.pose.array, atol=0.03)
    np.testing.assert_allclose(ours.weights(one.pose.array), plain.weights(one.pose.array), atol=0.02)


def test_names_of_either_spelling():
    assert arkit_place("EyeBlinkLeft") == arkit_place("eyeBlinkLeft") == ARKIT_SHAPES.index("eyeBlinkLeft")
    with pytest.raises(UnknownNameError, match="mouthSmileLeft"):
        arkit_place("mouthSmileLef")


@pytest.mark.parametrize(
    "call",
    [
        lambda solver: solver.solve(np.zeros(51)),
        lambda solver: solver.solve(np.full(52, 1.5)),
        lambda solver: solver.solve(np.full(52, np.nan)),
        lambda solver: solver.solve(np.zeros(52), np.ones(3)),
        lambda solver: solver.solve_named({"jawOpen": -0.1}),
        lambda solver: solver.weights(np.zeros(3)),
        lambda solver: ShapeSolver(solver.model, steps=0),
    ],
)
def test_what_is_refused(call):
    with pytest.raises(InvalidValueError):
        call(solver_of("amber"))


def test_the_bench_measures(monkeypatch):
    figures = run("amber", mixtures=4)
    assert figures["shapes"] == rows_of("amber")
    assert figures["solve_us"] > 0.0
    assert figures["mixtures"]["error_of_five"] < 0.1
