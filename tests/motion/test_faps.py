from __future__ import annotations

import numpy as np
import pytest

from agentface import Face
from agentface.errors import InvalidValueError, UnknownNameError
from agentface.io.osc.addresses import Addresses
from agentface.motion.performance import HOLD_S, LET_GO_S
from agentface.mpeg4.fap_table import FAP_COUNT
from agentface.mpeg4.meter import FapMeter
from agentface.parameters import NAMES, FacePose, parameter
from agentface.requests import SetFap, SetFaps
from tests.heads import head_model


@pytest.fixture
def face():
    return Face(head_model())


def measured(face):
    return FapMeter(face.model).measure(face.geometry)


def moved(face):
    return {name for name in NAMES if face.pose[name] != 0.0}


def test_a_fap_is_shown_and_moves_what_it_determines(face):
    face.apply(SetFap(3, 500, fade=0))
    assert measured(face)[2] == pytest.approx(500, abs=25)
    assert moved(face) == {"jaw_open"}
    assert face.status()["drivers"] == {"faps": ["jaw_open"]}


def test_faps_one_by_one_are_the_frame_that_they_make():
    one, other = (Face(head_model()) for _ in range(2))
    for number, value in ((3, 400), (12, 150), (13, 150)):
        one.apply(SetFap(number, value, fade=0))
    other.set_faps({3: 400, 12: 150, 13: 150}, fade=0)
    assert one.pose == other.pose


def test_a_frame_leaves_the_emotions_what_it_does_not_name(face):
    face.set_emotion("surprise", 1.0, fade=0)
    before = face.pose
    face.set_faps({8: -100, 9: -100, 10: 200, 11: 200}, fade=0)
    assert face.pose["frontalis_medialis_l"] == before["frontalis_medialis_l"] > 0.0
    assert face.channels.drivers()["faps"]


def test_a_stream_that_stops_lets_go_smoothly(face):
    face.set_faps({3: 600}, fade=0)
    face.step(0.0)
    shown = [face.pose["jaw_open"]]
    for _ in range(120):
        face.channels.advance(0.01)
        shown.append(face.channels.pose()["jaw_open"])
    held = round(HOLD_S / 0.01)
    assert shown[held - 1] == pytest.approx(shown[0])
    assert np.all(np.diff(shown) <= 1e-9)
    assert np.abs(np.diff(shown)).max() < 0.05
    assert shown[held + round(LET_GO_S / 0.01) + 2] == 0.0
    assert face.channels.pose() == FacePose()


def test_visemes_and_expressions_come_as_fields(face):
    face.set_faps({}, viseme=(10, 0, 63, 0), expression=(1, 63, 0, 0, 0, 0), fade=0)
    assert face.pose["jaw_open"] > 0.2
    assert face.pose["zygomaticus_major_l"] > 0.5
    face.neutral(fade=0)
    assert face.pose == FacePose()


def test_what_another_frame_does_not_name_is_free_again(face):
    face.set_faps({3: 500}, fade=0)
    face.set_faps({48: 20000}, fade=0)
    assert face.pose["jaw_open"] == 0.0
    assert face.pose["head_pitch"] == pytest.approx(max(-0.2, parameter("head_pitch").low), abs=1e-3)


@pytest.mark.parametrize("number", [0, 1, 2, 69, -3, 3.0, True, "3", None])
def test_another_number_is_refused(number):
    with pytest.raises(InvalidValueError, match="FAP"):
        SetFap(number, 1.0)


@pytest.mark.parametrize("value", [float("nan"), float("inf"), 1e12, None, "1"])
def test_another_value_is_refused(value):
    with pytest.raises(InvalidValueError, match="FAP 3"):
        SetFaps({3: value})


@pytest.mark.parametrize(
    ("viseme", "expression"),
    [((1, 2, 3), None), ((15, 0, 0, 0), None), (None, (7, 0, 0, 0, 0, 0)), ((1, 0, 64, 0), None)],
)
def test_other_fields_are_refused(viseme, expression):
    with pytest.raises(InvalidValueError, match=r"FAP [12]"):
        SetFaps({}, viseme, expression)


def frame(values, viseme=(), expression=()):
    mask = [0] * FAP_COUNT
    for number in values:
        mask[number - 1] = 1
    mask[0], mask[1] = int(bool(viseme)), int(bool(expression))
    return [*mask, *viseme, *expression, *(values[number] for number in sorted(values))]


def test_a_message_is_a_line_of_a_fap_file():
    read = Addresses("amber").read
    assert read("/agentface/fap", [3, 200]) == SetFap(3, 200.0)
    assert read("/agentface/faps", frame({5: -100, 3: 7})) == SetFaps({3: 7, 5: -100})
    full = frame({68: 1, 3: 2}, viseme=(1, 2, 31, 0), expression=(1, 63, 2, 10, 0, 0))
    assert read("/agentface/faps", full) == SetFaps({3: 2, 68: 1}, (1, 2, 31, 0), (1, 63, 2, 10, 0, 0))


@pytest.mark.parametrize("cut", [1, 2, 60, 71])
def test_a_message_with_another_count_is_refused(cut):
    with pytest.raises(InvalidValueError):
        Addresses("amber").read("/agentface/faps", frame({5: -100, 3: 7})[:-cut])
    with pytest.raises(InvalidValueError):
        Addresses("amber").read("/agentface/faps", [*frame({5: -100}), *[0] * cut])


def test_arkit_weights_move_what_they_name_and_let_go():
    face = Face(head_model())
    face.set_arkit({"jawOpen": 0.5}, fade=0)
    assert face.pose["jaw_open"] == pytest.approx(0.5, abs=0.08)
    assert face.channels.drivers().keys() == {"arkit"}
    face.apply(Addresses("amber").read("/agentface/arkit", ["eyeBlinkLeft", 1.0, "eyeBlinkRight", 1.0]))
    face.channels.advance(0.05)
    pose = face.channels.pose()
    assert pose["orbicularis_oculi_palpebralis_l"] > 0.5
    assert pose["jaw_open"] == pytest.approx(0.5, abs=0.08)
    face.channels.advance(2.0)
    assert face.channels.pose() == FacePose()


@pytest.mark.parametrize("arguments", [[], ["jawOpen"], ["jawOpne", 0.5], ["jawOpen", 1.5], [3, 0.5]])
def test_other_arkit_weights_are_refused(arguments):
    with pytest.raises((InvalidValueError, UnknownNameError)):
        Addresses("amber").read("/agentface/arkit", arguments)
