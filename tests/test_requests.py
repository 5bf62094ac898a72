from __future__ import annotations

import copy
import dataclasses
import itertools
import math
import pickle

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from agentface import EmotionState, Face, requests
from agentface.bml.block import Behavior, Block
from agentface.emotion.state import ALIASES, EMOTIONS
from agentface.errors import InvalidValueError, UnknownNameError
from agentface.motion.performance import Performance
from agentface.parameters import COUNT, MUSCLES, NAMES, PARAMETERS, parameter
from agentface.requests import (
    Blink,
    Gesture,
    Hush,
    LookAt,
    Neutral,
    Play,
    PlayBlock,
    Request,
    Say,
    SetActionUnit,
    SetEmotion,
    SetEmotions,
    SetFap,
    SetFaps,
    SetGaze,
    SetHead,
    SetLiveliness,
    SetMood,
    SetMuscle,
    SetParameter,
    SetState,
    SetTracked,
    ShowViseme,
    Speak,
    TakeBack,
)
from agentface.speech.phones import Phone
from agentface.vrm.tracked import Tracked
from tests.heads import head_model

_NUMBERS = itertools.count()
FRACTIONS = st.floats(0, 1)
FADES = st.floats(0, 2)
HOLDS = st.none() | FADES | st.just("own")
PERFORMED = Performance.regular(
    10, np.repeat(np.linspace(0, 0.2, 5, dtype=np.float32)[:, None], COUNT, 1), np.ones((1, COUNT))
)


def block_that_waits(name):
    """A block of one behavior that shows nothing."""
    wait = Behavior("w", "wait", 1, None, (1.0,))
    return Block(f"{name}{next(_NUMBERS)}", (wait,))


ANY_REQUEST = st.one_of(
    st.builds(SetEmotion, st.sampled_from((*EMOTIONS, *ALIASES, "neutral")), FRACTIONS, st.none() | FADES, HOLDS),
    st.builds(SetEmotions, st.dictionaries(st.sampled_from(EMOTIONS), FRACTIONS), st.none() | FADES, HOLDS),
    st.builds(SetMood, st.dictionaries(st.sampled_from(EMOTIONS), FRACTIONS), st.none() | FADES),
    st.builds(Neutral, FADES),
    st.builds(SetMuscle, st.sampled_from(MUSCLES), st.none() | FRACTIONS, FADES),
    st.builds(SetParameter, st.sampled_from(NAMES), st.none() | FRACTIONS.map(lambda v: 0.1 * v), FADES),
    st.builds(SetActionUnit, st.sampled_from((1, 12, 30, 51)), FRACTIONS, st.sampled_from((None, "left")), FADES),
    st.builds(SetFap, st.integers(3, 68), st.integers(-100, 100), FADES),
    st.builds(SetFaps, st.dictionaries(st.integers(3, 68), st.integers(-100, 100), max_size=3)),
    st.builds(SetGaze, st.floats(-50, 50), st.floats(-40, 40), FADES),
    st.builds(LookAt, st.floats(-0.2, 0.2), st.floats(-0.2, 0.2), st.floats(0.5, 2), FADES),
    st.builds(SetHead, st.floats(-80, 80), st.floats(-60, 60), st.floats(-50, 50), FADES),
    st.builds(Blink),
    st.builds(Speak, st.sampled_from([(), (Phone("p", 0, 0.1), Phone("aa", 0.1, 0.3))]), FADES, live=st.booleans()),
    st.builds(TakeBack, st.builds(Speak, st.just((Phone("p", 0, 0.1), Phone("aa", 0.1, 0.3))))),
    st.builds(Hush),
    st.builds(Say, st.sampled_from(("Hello.", "[joy] Yes")), st.none(), st.sampled_from(("en", "de"))),
    st.builds(ShowViseme, st.sampled_from(("aa", "viseme_PP", "iy")), FRACTIONS, st.none() | FADES),
    st.builds(Gesture, st.sampled_from(("nod", "Brow Flash", "glance")), FRACTIONS),
    st.builds(SetLiveliness, FRACTIONS, st.none() | FADES),
    st.builds(SetState, st.sampled_from((None, "listening", "thinking"))),
    st.builds(SetTracked, st.builds(Tracked, expressions=FRACTIONS.map(lambda weight: (("happy", weight),)))),
    st.builds(PlayBlock, st.sampled_from("ab").map(block_that_waits)),
    st.builds(Play, st.none() | st.sampled_from([PERFORMED]), FADES),
)


@pytest.fixture
def face():
    return Face(head_model(), compiled=False)


def motion(face, plan):
    """Poses of a face that is told ``plan`` and never deformed."""
    poses = []
    for request in plan:
        face.apply(request)
        for _ in range(3):
            face.channels.advance(0.07)
            poses.append(face.channels.pose())
    return poses


def test_every_kind_is_tried_here():
    made = {name for name, kind in vars(requests).items() if isinstance(kind, type) and issubclass(kind, Request)}
    assert made - {"Request"} == {
        "SetEmotion", "SetEmotions", "Neutral", "SetMuscle", "SetParameter", "SetActionUnit", "SetGaze", "LookAt",
        "SetHead", "Blink", "Play", "SetFap", "SetFaps", "SetArkit", "SetMood", "Speak", "Hush", "ShowViseme",
        "Gesture", "SetLiveliness", "SetState",
        "Say", "PlayBlock", "TakeBack", "SetTracked",
    }  # fmt: skip


@given(ANY_REQUEST)
def test_a_request_compares_hashes_pickles_copies_and_stays(request_):
    for twin in (pickle.loads(pickle.dumps(request_)), copy.deepcopy(request_), dataclasses.replace(request_)):  # noqa: S301
        assert type(twin) is type(request_)
        assert twin == request_
        assert hash(twin) == hash(request_)
        assert twin.key == request_.key
    fields = dataclasses.fields(request_)
    if fields:
        with pytest.raises(dataclasses.FrozenInstanceError):
            setattr(request_, fields[0].name, None)


@pytest.mark.untraced
@given(st.lists(ANY_REQUEST, max_size=6))
def test_noted_requests_give_the_same_motion_again(plan):
    first, second, noted = Face(head_model()), Face(head_model()), []
    first.noted.append(noted.append)
    shown = motion(first, plan)
    assert noted == plan
    assert motion(second, pickle.loads(pickle.dumps(noted))) == shown  # noqa: S301 - our own bytes


def test_the_methods_of_a_face_make_requests(face):
    noted = []
    face.noted.append(noted.append)
    face.set_emotion("joy", 0.5, fade=0.1, hold=1.0)
    face.set_emotion({"sad": 0.25})
    face.set_mood({"joy": 0.5}, fade=1)
    face.set_mood({})
    face.set_mood()
    face.neutral()
    face.set_muscle("risorius", 0.5)
    face.set_muscle("risorius", None, fade=0)
    face.set_parameter("head_roll_deg", 10)
    face.set_action_unit(12, "C", side="left")
    face.set_faps({3: 10}, viseme=[1, 0, 63, 0])
    face.set_jaw(0.3)
    face.set_gaze(10, -5)
    face.look_at(np.array([0.1, 0.0, 0.6]))
    face.set_head(10, 20)
    face.blink()
    face.speak([("p", 0, 0.1), ("AA1", 0.1, 0.3)], rate=1.2, interrupt=True)
    face.show_viseme("aa", 0.5, 1)
    face.hush()
    face.gesture("brow-flash", 0.5)
    face.set_liveliness(0.3)
    face.set_state("listening")
    face.say("Yes.", rate=1.5, interrupt=True)
    face.play(None, fade=0.1)
    assert noted == [
        SetEmotion("happiness", 0.5, 0.1, 1.0),
        SetEmotions(EmotionState.of(sadness=0.25)),
        SetMood(EmotionState.of(happiness=0.5), 1.0),
        SetMood(EmotionState()),
        SetMood(EmotionState()),
        Neutral(0.25),
        SetMuscle("risorius", 0.5),
        SetMuscle("risorius", None, 0.0),
        SetParameter("head_roll", math.radians(10)),
        SetActionUnit(12, 0.5, "l"),
        SetFaps(((3, 10.0),), (1, 0, 63, 0)),
        SetMuscle("jaw_open", 0.3),
        SetGaze(10.0, -5.0),
        LookAt(0.1, 0.0, 0.6),
        SetHead(10.0, 20.0, 0.0),
        Blink(),
        Speak((Phone("p", 0.0, 0.1), Phone("AA1", 0.1, 0.3)), rate=1.2, interrupt=True),
        ShowViseme("aa", 0.5, 1.0),
        Hush(),
        Gesture("brow_flash", 0.5),
        SetLiveliness(0.3),
        SetState("listening"),
        Say("Yes.", rate=1.5, interrupt=True),
        Play(None, 0.1),
    ]


@pytest.mark.parametrize(
    ("make", "said"),
    [
        (lambda: SetEmotion("hapiness", 0.5), "happiness"),
        (lambda: SetEmotion("fear", 1.5), "0..1"),
        (lambda: SetEmotion("fear", None), "number"),
        (lambda: SetEmotion("fear", 0.5, -1), "seconds"),
        (lambda: SetEmotion("fear", 0.5, 0, math.nan), "finite"),
        (lambda: SetEmotion("fear", 0.5, 0, "long"), "own"),
        (lambda: SetEmotion("fear", 0.5, "own"), "number"),
        (lambda: SetEmotions({"fear": 0.5}, hold=-1), "seconds"),
        (lambda: SetMood({"fear": 2.0}), "0..1"),
        (lambda: SetMood({"calm": 0.5}), "calm"),
        (lambda: SetMood({}, -1), "seconds"),
        (lambda: SetEmotions({"fear": 2.0}), "0..1"),
        (lambda: SetEmotions([0.5]), "mapping"),
        (lambda: Neutral(math.inf), "finite"),
        (lambda: SetMuscle("biceps", 0.5), "biceps"),
        (lambda: SetMuscle(["risorius"], 0.5), "risorius"),
        (lambda: SetMuscle("gaze_yaw", 0.1), "gaze_yaw"),
        (lambda: SetMuscle("risorius", True), "number"),
        (lambda: SetParameter("gaze_yow", 0.1), "gaze_yaw"),
        (lambda: SetParameter(None, 0.1), "parameter"),
        (lambda: SetParameter("gaze_yaw", 0.9), "-0.87"),
        (lambda: SetParameter("gaze_yaw_deg", 51), "-50..50"),
        (lambda: SetParameter("risorius_deg", 0.5), "risorius"),
        (lambda: SetParameter("risorius", 1.1), "0..1"),
        (lambda: SetGaze(51, 0), "-50..50"),
        (lambda: SetGaze(0, "up"), "number"),
        (lambda: SetHead(0, 61), "-60..60"),
        (lambda: LookAt(0, 0, math.nan), "finite"),
        (lambda: LookAt.of((1, 2)), "x, y and z"),
        (lambda: LookAt.of(3), "x, y and z"),
        (lambda: Speak.of("aa"), "triples"),
        (lambda: Speak.of([("aa", 0, 1), ("xyzzy", 1, 2)]), "xyzzy"),
        (lambda: Speak.of([("aa", 0, 1), ("s", 0.5, 2)]), "before the last"),
        (lambda: Speak.of([("aa", 0, 1)], rate=0), "rate"),
        (lambda: Speak.of([("aa", 0, 1)], loudness=math.nan), "loudness"),
        (lambda: Speak.of([("aa", 0, 1)], interrupt=1), "true or false"),
        (lambda: Speak.of([("aa", 0, 1)], alphabet="sampa"), "arpabet"),
        (lambda: ShowViseme("xyzzy", 1.0), "viseme"),
        (lambda: Say(3), "text"),
        (lambda: Say(" ... "), "spoken"),
        (lambda: Say("a" * 10_001), "10000"),
        (lambda: Say("Yes.", "slz"), "slt"),
        (lambda: Say("Ja.", "slt", "de"), "English"),
        (lambda: Say("Ja.", language=None), "german"),
        (lambda: Say("Yes.", rate=3), "rate"),
        (lambda: Say("Yes.", interrupt=1), "true or false"),
        (lambda: ShowViseme("aa", 1.5), "0..1"),
        (lambda: ShowViseme("aa", 0.5, -1), "seconds"),
        (lambda: Gesture(3), "a name"),
        (lambda: Gesture("nod", 2), "0..1"),
        (lambda: SetLiveliness(1.5), "0..1"),
        (lambda: SetLiveliness("0.6"), "number"),
        (lambda: SetLiveliness(0.5, -1), "seconds"),
        (lambda: SetState("busy"), "idle"),
        (lambda: SetState(3), "idle"),
        (lambda: Play("nod.fap"), "a Performance"),
        (lambda: Play(None, -1), "seconds"),
    ],
)
def test_what_is_wrong_is_refused_where_it_is_made(make, said):
    with pytest.raises((UnknownNameError, InvalidValueError), match=said):
        make()


def test_a_request_that_the_face_refuses_changes_nothing_and_is_not_noted(face):
    noted = []
    face.set_gaze(10, 5, fade=0)
    face.noted.append(noted.append)
    before = face.pose
    with pytest.raises(InvalidValueError, match="in front of the eyes"):
        face.look_at((0.0, 0.0, -1.0))
    with pytest.raises(UnknownNameError, match="nod"):
        face.gesture("nood")
    assert face.pose == before
    assert not noted


@pytest.mark.parametrize("known", PARAMETERS, ids=lambda known: known.name)
def test_every_parameter_can_be_set_and_released(face, known):
    face.set_emotion("fear", 0.5, fade=0)
    before = face.pose
    for value in (known.low, known.high, 0.5 * known.high):
        face.set_parameter(known.name, value, fade=0)
        assert face.pose == before.replace({known.name: value})
    face.set_parameter(known.name, None, fade=0)
    assert face.pose == before


def test_an_angle_may_be_given_in_degrees_and_leaves_the_others(face):
    face.set_head(10, 20, 30, fade=0)
    face.set_parameter("head_pitch_deg", -60, fade=0)
    turned = [math.degrees(face.pose[name]) for name in ("head_yaw", "head_pitch", "head_roll")]
    assert turned == pytest.approx([10, -60, 30], abs=1e-4)
    assert face.pose["head_pitch"] >= parameter("head_pitch").low


def test_a_program_can_have_requests_of_its_own(face):
    @dataclasses.dataclass(frozen=True)
    class Wink(Request):
        side: str

        def apply(self, face):
            face.channels.muscles.set(f"orbicularis_oculi_palpebralis_{self.side}", 1.0, 0.0)

    face.apply(Wink("l"))
    assert face.pose["orbicularis_oculi_palpebralis_l"] == 1.0
    assert face.pose["orbicularis_oculi_palpebralis_r"] == 0.0
    assert Wink("l").key == ("Wink",)


@pytest.mark.parametrize("name", ["neutral", "Neutral ", "NEUTRAL"])
def test_neutral_lets_go_of_the_emotions_and_of_nothing_else(face, name):
    face.set_emotion({"happiness": 0.8, "surprise": 0.3}, fade=0)
    face.set_muscle("risorius", 0.5, fade=0)
    face.set_head(10, 0, fade=0)
    face.set_emotion(name, 1.0, fade=0)
    assert face.emotion == EmotionState()
    assert face.held == {"risorius_l": 0.5, "risorius_r": 0.5}
    assert face.turned_deg["head_yaw"] == 10
    assert {known for known, value in face.pose.items() if value} == {"risorius_l", "risorius_r", "head_yaw"}


def test_some_neutral_leaves_as_much_as_there_is_room_for(face):
    face.set_emotion({"happiness": 0.8, "surprise": 0.3}, fade=0)
    face.set_emotion("neutral", 0.0)
    face.set_emotion("neutral", 0.05)
    assert face.emotion == EmotionState.of(happiness=0.8, surprise=0.3)
    face.set_emotion("neutral", 0.5)
    assert face.emotion == EmotionState.of(happiness=0.5, surprise=0.3)
    face.set_emotion("neutral")
    assert face.emotion == EmotionState()


def test_neutral_among_others_is_the_room_that_they_leave(face):
    seen = {"angry": 0.05, "disgust": 0.01, "fear": 0.02, "happy": 0.8, "sad": 0.02, "surprise": 0.05, "neutral": 0.05}
    face.set_emotion(seen)
    assert face.emotion == EmotionState([0.8, 0.02, 0.05, 0.02, 0.01, 0.05])
    face.set_emotion({"happy": 0.8, "neutral": 1.0})
    assert face.emotion == EmotionState()
    face.set_emotion({"neutral": 0.3})
    assert face.emotion == EmotionState()


@pytest.mark.parametrize("value", [1.5, -0.1, math.nan, "1", True])
def test_neutral_has_an_intensity_like_the_others(face, value):
    face.set_emotion("happiness", 0.8)
    for wrong in (lambda: face.set_emotion("neutral", value), lambda: face.set_emotion({"neutral": value})):
        with pytest.raises(InvalidValueError):
            wrong()
    assert face.emotion["happiness"] == 0.8
