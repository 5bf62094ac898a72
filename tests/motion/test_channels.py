"""The channels blended: against a plain account of each parameter by itself, and with channels of a program's own."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from agentface import EmotionState, Face
from agentface.emotion.inference import default_inference
from agentface.emotion.state import EMOTIONS
from agentface.errors import InvalidValueError, UnknownNameError
from agentface.head.model import load_model
from agentface.motion.blink import CLOSE_S, HOLD_S, OPEN_S
from agentface.motion.channel import Rank
from agentface.motion.conflicts import CHANNELS, default_conflicts
from agentface.motion.emotion import EmotionChannel
from agentface.motion.envelope import Envelope
from agentface.motion.mixer import Mixer
from agentface.parameters import COUNT, MUSCLES, NAMES, PARAMETERS, FacePose, indices_of, parameter

GAINS = load_model("amber").gains
FADES = st.sampled_from([0.0, 0.05, 0.2, 0.7])


class Oracle:
    """What a face shows, put together for each parameter by itself, as it was before there were ranks."""

    def __init__(self):
        self.emotion = EmotionChannel(default_inference())  # whose course has tests of its own
        self.set = {known.name: Envelope(1) for known in PARAMETERS if known.kind not in ("gaze", "head")}
        self.by_hand = {name: Envelope(1) for name in self.set}
        self.angles = {
            known.name: Envelope(1, known.low, known.high) for known in PARAMETERS if known.kind in ("gaze", "head")
        }
        self.closure, self.opens_in = Envelope(1), math.inf

    def feel(self, emotions, fade):
        self.emotion.change(EmotionState.of(emotions), fade, None)

    def hold(self, muscle, value, fade):
        for name in (NAMES[index] for index in indices_of(muscle)):
            if value is None:
                self.by_hand[name].move(0.0, fade)
                continue
            if self.by_hand[name].value[0] == 0.0:
                self.set[name].move(value, 0.0)
            self.set[name].move(value, fade)
            self.by_hand[name].move(1.0, fade)

    def turn(self, name, angle, fade):
        self.angles[name].move(angle, fade)

    def blink(self):
        self.closure.move(1.0, CLOSE_S)
        self.opens_in = CLOSE_S + HOLD_S

    def let_go(self, fade):
        self.feel({}, fade)
        for name in self.by_hand:
            self.by_hand[name].move(0.0, fade)
        for name in self.angles:
            self.angles[name].move(0.0, fade)

    def advance(self, dt):
        self.emotion.advance(dt)
        for envelope in (*self.set.values(), *self.by_hand.values(), *self.angles.values()):
            envelope.advance(dt)
        if self.opens_in <= dt:
            self.closure.advance(self.opens_in)
            self.closure.move(0.0, OPEN_S)
            self.closure.advance(dt - self.opens_in)
            self.opens_in = math.inf
        else:
            self.opens_in -= dt
            self.closure.advance(dt)

    def pose(self):
        closure = float(self.closure.value[0])
        shown, felt = {}, np.zeros(len(self.emotion.names))
        self.emotion.write(felt, np.ones_like(felt))
        by_name = dict(zip(self.emotion.names, felt.tolist(), strict=True))
        for muscle in MUSCLES:
            for index in indices_of(muscle):
                value = float(GAINS[index]) * by_name[NAMES[index]]
                if muscle == "orbicularis_oculi_palpebralis":
                    value += closure * (1.0 - value)
                if muscle == "levator_palpebrae":
                    value *= 1.0 - closure
                name = NAMES[index]
                weight = float(self.by_hand[name].value[0])
                shown[name] = (1.0 - weight) * value + weight * float(self.set[name].value[0])
        shown |= {name: float(envelope.value[0]) for name, envelope in self.angles.items()}
        shares = {known.name for known in PARAMETERS if known.unit == "share"}  # which no deed here touches
        return [0.0 if name in shares else shown[name] for name in NAMES]


OWN = tuple(name for name in CHANNELS if name not in ("arkit", "tracker"))
"""That of ARKit's weights is there from the first of them on."""
ANGLE_NAMES = tuple(known.name for known in PARAMETERS if known.unit == "rad")
DEEDS = st.one_of(
    st.tuples(st.just("feel"), st.dictionaries(st.sampled_from(EMOTIONS), st.floats(0, 1), max_size=3), FADES),
    st.tuples(st.just("hold"), st.sampled_from((*MUSCLES, "risorius_l")), st.none() | st.floats(0, 1), FADES),
    st.tuples(st.just("turn"), st.sampled_from(ANGLE_NAMES), st.floats(-0.17, 0.4), FADES),
    st.tuples(st.just("blink")),
    st.tuples(st.just("let_go"), FADES),
)


def tell(mixer, deed, *arguments):
    if deed == "feel":
        mixer.emotion.change(EmotionState.of(arguments[0]), arguments[1], None)
    elif deed == "hold":
        muscle, value, fade = arguments
        mixer.muscles.release(fade, muscle) if value is None else mixer.muscles.set(muscle, value, fade)
    elif deed == "turn":
        (mixer.gaze if arguments[0].startswith("gaze") else mixer.head).turn_one(*arguments)
    elif deed == "blink":
        mixer.blink.blink()
    else:
        mixer.release(*arguments)


@pytest.mark.untraced
@given(st.lists(st.tuples(DEEDS, st.lists(st.floats(0, 0.3), max_size=4)), max_size=8))
def test_the_channels_together_show_what_each_parameter_would_by_itself(plan):
    mixer, oracle = Mixer(default_inference(), GAINS), Oracle()
    for (deed, *arguments), seconds in plan:
        tell(mixer, deed, *arguments)
        getattr(oracle, deed)(*arguments)
        for dt in (0.0, *seconds):
            mixer.advance(dt)
            oracle.advance(dt)
            np.testing.assert_allclose(mixer.pose().array, oracle.pose(), atol=2e-7)


class Fixed:
    """A channel that wants the same for ever, with a weight."""

    def __init__(self, weight=1.0, **values):
        self.names, self.weight, self.wanted = tuple(values), weight, list(values.values())
        self.seconds, self.released = 0.0, None

    def advance(self, dt):
        self.seconds += dt

    def write(self, values, weights):
        values[:] = self.wanted
        weights[:] = self.weight

    def release(self, fade):
        self.released = fade


@pytest.fixture
def mixer():
    return Mixer(default_inference())


@pytest.mark.parametrize(
    ("way", "expected"),
    [("replace", 0.5), ("max", 0.8), ("add", 1.0), ("scale", 0.4), (None, 0.8)],
)
@pytest.mark.parametrize("weight", [0.0, 0.25, 1.0])
def test_a_weight_lies_between_without_and_with(mixer, way, expected, weight):
    mixer.add("below", Fixed(jaw_open=0.8), priority=0)
    mixer.add("above", Fixed(weight, jaw_open=0.5), priority=1, way=way)
    summed = 1.3 if way == "add" else expected
    assert mixer.pose()["jaw_open"] == pytest.approx(min((1 - weight) * 0.8 + weight * summed, 1.0))


def test_the_higher_priority_has_the_last_word_whatever_came_first(mixer):
    mixer.add("second", Fixed(jaw_open=0.2), priority=50, way="replace")
    mixer.add("first", Fixed(jaw_open=0.9), priority=20, way="replace")
    assert mixer.pose()["jaw_open"] == pytest.approx(0.2)
    mixer.add("third", Fixed(jaw_open=0.4), priority=50, way="replace")
    assert mixer.pose()["jaw_open"] == pytest.approx(0.4)
    mixer.muscles.set("jaw_open", 0.6, 0.0)
    assert mixer.pose()["jaw_open"] == pytest.approx(0.6)


def test_angles_add_up_and_stay_within_their_range(mixer):
    mixer.head.turn((0.25, 0.0, 0.0), 0.0)
    mixer["sway"] = Fixed(head_yaw=0.125, head_roll=-9.0)
    pose = mixer.pose()
    assert pose["head_yaw"] == 0.375
    assert pose["head_roll"] == parameter("head_roll").low


def test_exceptions_go_by_parameter_then_muscle_then_group(mixer):
    rank = Rank(
        10,
        "replace",
        priorities={"mouth": 20, "risorius": 30, "risorius_l": 40},
        ways={"brow": "max", "procerus": "add", "procerus_r": "scale"},
    )
    priorities = {"mentalis_l": 20, "risorius_r": 30, "risorius_l": 40, "jaw_open": 10}
    assert {name: rank.priority_of(name) for name in priorities} == priorities
    ways = {"frontalis_medialis_l": "max", "procerus_l": "add", "procerus_r": "scale", "jaw_open": "replace"}
    assert {name: rank.way_of(name) for name in ways} == ways
    assert Rank(0).way_of("head_yaw") == "add"
    assert Rank(0).way_of("jaw_open") == "max"


def test_a_channel_comes_goes_and_is_told_of_time_and_neutral(mixer):
    before, breath = mixer.pose(), Fixed(head_pitch=0.25)
    mixer["breath"] = breath
    assert mixer["breath"] is breath
    assert list(mixer) == [*OWN, "breath"]
    mixer.advance(0.5)
    mixer.release(0.3)
    assert (breath.seconds, breath.released) == (0.5, 0.3)
    assert mixer.pose()["head_pitch"] == 0.25
    other = Fixed(head_pitch=0.125)
    mixer["breath"] = other
    assert mixer.pose()["head_pitch"] == 0.125
    del mixer["breath"]
    assert mixer.pose() == before
    assert "breath" not in mixer


def test_a_channel_that_wants_nothing_is_left_out(mixer):
    class Quiet(Fixed):
        def write(self, values, weights):
            super().write(values, weights)
            return False

    mixer.emotion.change({"fear": 0.5}, 0.0, None)
    before = mixer.pose()
    mixer.add("quiet", Quiet(jaw_open=1.0, head_yaw=1.0), way="replace")
    assert mixer.pose() == before


def test_the_same_pose_comes_back_until_something_changes(mixer):
    mixer.emotion.change({"fear": 0.5}, 0.1, None)
    moving = mixer.pose()
    mixer.advance(0.05)
    assert mixer.pose() != moving
    mixer.advance(0.1)
    still = mixer.pose()
    mixer.advance(1.0)
    assert mixer.pose() is still
    mixer.blink.blink()
    mixer.advance(0.05)
    assert mixer.pose() != still


@pytest.mark.parametrize("name", OWN)
def test_the_faces_own_channels_stay(mixer, name):
    assert mixer[name] is getattr(mixer, name)
    with pytest.raises(InvalidValueError, match="stay"):
        del mixer[name]
    with pytest.raises(InvalidValueError, match="own"):
        mixer[name] = Fixed(jaw_open=1.0)
    assert list(mixer) == list(OWN)


@pytest.mark.parametrize(
    "add",
    [
        lambda mixer: mixer.add("", Fixed(jaw_open=1.0)),
        lambda mixer: mixer.add("a", Fixed(jaw_opening=1.0)),
        lambda mixer: mixer.add("a", Fixed(risorius=1.0)),
        lambda mixer: mixer.add("a", Fixed(jaw_open=1.0), way="sum"),
        lambda mixer: mixer.add("a", Fixed(jaw_open=1.0), priority=101),
        lambda mixer: mixer.add("a", Fixed(jaw_open=1.0), priority=0.5),
        lambda mixer: mixer["a"],
        lambda mixer: mixer.__delitem__("a"),
    ],
)
def test_what_is_wrong_with_a_channel_is_told_and_nothing_added(mixer, add):
    with pytest.raises((InvalidValueError, UnknownNameError)):
        add(mixer)
    assert list(mixer) == list(OWN)
    assert mixer.pose() == FacePose()


def test_a_parameter_twice_in_one_channel_is_refused(mixer):
    twice = Fixed(jaw_open=1.0)
    twice.names = ("jaw_open", "jaw_open")
    with pytest.raises(InvalidValueError, match="once"):
        mixer.add("a", twice)


def test_a_channel_of_no_numbers_is_named(mixer):
    mixer["broken"] = Fixed(jaw_open=math.nan)
    with pytest.raises(InvalidValueError, match="channel broken"):
        mixer.pose()
    del mixer["broken"]
    assert mixer.pose() == FacePose()


def test_a_face_moves_with_a_channel_of_a_program():
    face = Face(load_model("amber"), compiled=False)
    rest = face.step(0.0).vertices.copy()
    face.channels["breath"] = Fixed(jaw_open=0.5)
    assert np.abs(face.step(0.01).vertices - rest).max() > 1e-3
    assert face.status()["shown"]["contractions"]["jaw_open"] == 0.5
    face.neutral(0.2)
    assert face.channels["breath"].released == 0.2
    del face.channels["breath"]
    np.testing.assert_array_equal(face.step(0.01).vertices, rest)


def test_the_tables_default_rank_is_for_channels_of_programs():
    conflicts = default_conflicts()
    assert conflicts.rank("breath") == conflicts.rank("anything")
    assert conflicts.rank("emotion").priority < conflicts.rank("breath").priority < conflicts.rank("muscles").priority
    assert conflicts.rank("blink").way_of("levator_palpebrae_r") == "scale"
    assert len(NAMES) == COUNT
