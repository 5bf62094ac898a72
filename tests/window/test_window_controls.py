import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from agentface import Face
from agentface.emotion.state import EMOTIONS, EmotionState
from agentface.errors import UnknownNameError
from agentface.parameters import MUSCLES, PARAMETERS
from agentface.requests import Blink, SetEmotion, SetMuscle, SetParameter
from agentface.window.controls import ANGLES, FADE_S, Controls, bounds
from agentface.window.history import LEVELS, History
from agentface.window.menu import GROUPS, KEYS, PRESETS, help_text, sides

NAMES = (*EMOTIONS, *(name for group in GROUPS.values() for muscle in group for name in sides(muscle)), *ANGLES)


@pytest.fixture(scope="module")
def face():
    return Face("amber", compiled=False)


@pytest.fixture
def controls(face):
    face.neutral(0.0)
    return Controls(face)


def test_the_groups_hold_every_muscle_once():
    members = [muscle for group in GROUPS.values() for muscle in group]
    assert set(MUSCLES) < set(members)
    assert len(set(members)) == len(members)
    contracted = {known.name for known in PARAMETERS if known.unit != "rad"}
    assert {name for muscle in members for name in sides(muscle)} == contracted


def test_each_digit_raises_its_emotion_by_a_quarter_up_to_one(controls):
    for digit, name in enumerate(EMOTIONS, start=1):
        for expected in (0.25, 0.5, 0.75, 1.0, 1.0):
            controls.key(str(digit))
            assert controls.face.emotion[name] == expected
    controls.key("1", shift=True)
    assert controls.face.emotion["happiness"] == 0.75
    assert controls.face.emotion["surprise"] == 1.0
    assert "happiness 0.75" in controls.title()


def test_lowering_stops_at_zero(controls):
    controls.key("2", shift=True)
    assert controls.face.emotion["sadness"] == 0.0
    assert not controls.history.can_undo


@pytest.mark.parametrize("key", ["0", "Backspace"])
def test_reset_lets_go_of_everything_in_one_step(controls, key):
    neutral = controls.values()
    controls.change({"anger": 0.4, "risorius_l": 0.0, "jaw_open": 0.5, "gaze_yaw": 7.0, "head_roll": -3.0})
    changed = controls.values()
    assert changed["risorius_l"] == 0.0, "held at rest is not the same as not held"
    controls.key(key)
    assert controls.values() == neutral
    assert "neutral" in controls.title()
    controls.undo()
    assert controls.values() == changed


def test_what_is_set_is_shown(controls):
    controls.change({"happiness": 0.5, "frontalis_medialis_l": 0.9, "gaze_pitch": -10.0, "head_yaw": 20.0})
    controls.face.step(1.0)
    pose = controls.face.pose
    assert pose["frontalis_medialis_l"] == pytest.approx(0.9)
    assert pose["frontalis_medialis_r"] == 0.0
    assert pose["zygomaticus_major_r"] > 0.2
    assert (pose["gaze_pitch"], pose["head_yaw"]) == pytest.approx((math.radians(-10), math.radians(20)))


def test_a_muscle_given_back_moves_with_the_emotion_again(controls):
    controls.change({"happiness": 1.0})
    controls.face.step(1.0)
    smile = controls.face.pose["zygomaticus_major_l"]
    controls.change({"zygomaticus_major_l": 0.0})
    controls.face.step(1.0)
    assert controls.face.pose["zygomaticus_major_l"] == 0.0
    controls.change({"zygomaticus_major_l": None})
    controls.face.step(1.0)
    assert controls.face.pose["zygomaticus_major_l"] == smile > 0.3


def test_neutral_is_a_preset_that_keeps_the_muscles(controls):
    controls.change({"anger": 0.4, "risorius_l": 0.5, "head_roll": -3.0})
    controls.preset("neutral")
    assert controls.face.emotion == EmotionState()
    assert controls.values()["risorius_l"] == 0.5
    assert controls.values()["head_roll"] == -3.0


def test_the_panel_makes_the_requests_that_other_programs_make(controls):
    noted = []
    controls.face.noted.append(noted.append)
    controls.change({"happiness": 0.5, "risorius_l": 0.25, "head_yaw": 10.0})
    controls.key("Space")
    controls.face.noted.remove(noted.append)
    assert noted == [
        SetEmotion("happiness", 0.5, FADE_S),
        SetMuscle("risorius_l", 0.25, FADE_S),
        SetParameter("head_yaw_deg", 10.0, FADE_S),
        Blink(),
    ]


def test_a_preset_sets_all_emotions_and_leaves_muscles(controls):
    controls.change({"sadness": 1.0, "jaw_open": 0.3})
    for name, state in PRESETS.items():
        controls.preset(name)
        assert controls.face.emotion == EmotionState.of(state)
    assert controls.values()["jaw_open"] == 0.3


def test_a_dragged_slider_is_one_step(controls):
    before = controls.values()
    for value in (0.1, 0.4, 0.3):
        controls.change({"fear": value}, "fear")
    controls.settle()
    controls.change({"fear": 0.9}, "fear")
    controls.undo()
    assert controls.face.emotion["fear"] == 0.3
    controls.undo()
    assert controls.values() == before
    assert not controls.history.can_undo
    controls.redo()
    assert controls.face.emotion["fear"] == 0.3


def test_a_slider_that_comes_back_is_no_step(controls):
    controls.change({"fear": 0.4}, "fear")
    controls.change({"fear": 0.0}, "fear")
    controls.settle()
    assert not controls.history.can_undo


def test_undo_leaves_what_a_message_changed_since(controls):
    controls.change({"anger": 0.6})
    controls.face.set_emotion("joy", 0.35)
    controls.face.set_muscle("mentalis", 0.2)
    controls.undo()
    assert controls.face.emotion == EmotionState.of(happiness=0.35)
    assert controls.values()["mentalis_l"] == 0.2


def test_undo_keys(controls):
    controls.key("3")
    controls.key("Z", ctrl=True)
    assert controls.face.emotion["anger"] == 0.0
    controls.key("Z", ctrl=True, shift=True)
    assert controls.face.emotion["anger"] == 0.25
    controls.key("Z", ctrl=True)
    controls.key("Y", ctrl=True)
    assert controls.face.emotion["anger"] == 0.25
    controls.key("3", ctrl=True)
    assert controls.face.emotion["anger"] == 0.25, "Ctrl with another key is none of ours"


def test_no_number_and_unknown_names(controls):
    controls.change({"anger": math.nan})
    assert not controls.history.can_undo
    controls.change({"anger": math.inf, "gaze_yaw": -math.inf})
    assert (controls.face.emotion["anger"], controls.values()["gaze_yaw"]) == (1.0, bounds("gaze_yaw")[0])
    with pytest.raises(UnknownNameError):
        controls.change({"smile": 0.5})


def test_other_keys(controls):
    front = controls.camera
    controls.key("P")
    assert controls.camera.eye[0] > 0.3
    controls.key("F")
    assert controls.camera == front
    for unknown in ("7", "9", "Z", "", "£"):
        controls.key(unknown)
    assert controls.camera == front
    controls.key("Q")
    assert controls.quality == "portrait"
    controls.key("F2")
    assert not controls.panelled
    controls.key("S")
    controls.key("R")  # nothing to write with
    controls.key("F1")
    controls.key("Escape")
    assert not controls.helping
    assert not controls.closing, "the first Esc closes the help"
    controls.key("Escape")
    assert controls.closing
    assert not controls.history.can_undo


def test_blinking(controls):
    controls.key("Space")
    controls.face.step(0.1)
    assert controls.face.pose["orbicularis_oculi_palpebralis_l"] > 0.3


def test_the_mouse_turns_the_head_with_it_and_the_wheel_comes_nearer(controls):
    before = controls.camera
    controls.drag(50, 0)
    assert controls.camera.eye[0] < before.eye[0]  # the camera goes left: the head turns right with the mouse
    controls.drag(0, 50)
    assert controls.camera.eye[1] > before.eye[1]
    controls.wheel(2)
    assert controls.camera.distance < before.distance
    controls.wheel(-1000)
    controls.wheel(1000)
    assert np.isfinite(controls.camera.eye).all()


@pytest.mark.parametrize("view", ["front", "three-quarter", "profile"])
def test_the_picture_goes_with_the_mouse(controls, view):
    controls.look(view)
    before, height = controls.camera, 600
    project = before.projection(1.0) @ before.view()
    controls.pan(30, -12, height)
    point = np.array([*before.target, 1.0])
    there = controls.camera.projection(1.0) @ controls.camera.view() @ point
    moved = 0.5 * height * (there[:2] / there[3] - (project @ point)[:2] / (project @ point)[3])
    np.testing.assert_allclose(moved, [30, 12], atol=1e-6)
    for _ in range(100):
        controls.pan(400, 0, height)
    assert math.dist(controls.camera.target, before.target) <= 0.3


def test_the_help_names_every_key():
    for name in ("1 .. 6", "Shift", "Backspace", "Space", "F  T  P", "Ctrl Z", "F2", "Esc", "wheel", "right drag"):
        assert name in help_text()
    assert len(dict(KEYS)) == len(KEYS)


def test_history_forgets_the_oldest():
    history = History()
    for step in range(LEVELS + 5):
        history.note({"fear": step}, {"fear": step + 1})
    values = {}
    while history.can_undo:
        values = history.undo()
    assert values == {"fear": 5}
    assert history.undo() == {}


changes = st.dictionaries(
    st.sampled_from(NAMES), st.none() | st.floats(-100, 100) | st.sampled_from([0.0, 1.0]), min_size=1, max_size=4
)
keys = st.tuples(st.sampled_from("0123456FTPQHXZ"), st.booleans(), st.just(False))
actions = st.one_of(
    st.tuples(st.just("change"), changes),
    st.tuples(st.just("drag"), st.lists(changes, min_size=1, max_size=3)),
    st.tuples(st.just("key"), keys),
    st.tuples(st.sampled_from(["undo", "redo", "reset"]), st.none()),
    st.tuples(st.just("preset"), st.sampled_from(sorted(PRESETS))),
)


@pytest.mark.slow
@settings(max_examples=60)
@given(st.lists(actions, max_size=12))
def test_undo_gives_exactly_the_state_before_and_nothing_leaves_its_range(face, sequence):
    face.neutral(0.0)
    controls = Controls(face)
    past, future = [controls.values()], []  # the oracle: whole states
    for kind, argument in sequence:
        if kind == "undo" and len(past) > 1:
            future.append(past.pop())
        if kind == "redo" and future:
            past.append(future.pop())
        before = controls.values()
        perform(controls, kind, argument)
        values = controls.values()
        for name, value in values.items():
            low, high = bounds(name)
            assert value is None or low <= value <= high
        if kind not in ("undo", "redo") and values != before:
            past.append(values)
            future.clear()
        elif kind == "drag":
            future.clear()  # it came back, but was on its way
        assert values == past[-1]
    for state in reversed(past):
        assert controls.values() == state
        controls.undo()


def perform(controls, kind, argument):
    if kind == "drag":
        for change in argument:
            controls.change(change, "slider")
        controls.settle()
    elif kind == "key":
        name, shift, ctrl = argument
        controls.key(name, shift=shift, ctrl=ctrl)
    elif argument is None:
        getattr(controls, kind)()
    else:
        getattr(controls, kind)(argument)
