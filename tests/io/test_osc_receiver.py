from __future__ import annotations

import json
import math

import numpy as np
import pytest
from osc_bytes import bundle, message

from agentface import EmotionState, Face
from agentface.errors import InvalidValueError, UnknownNameError
from agentface.io.osc.codec import decode
from agentface.io.osc.receiver import ANSWERS_A_SECOND, ANSWERS_AT_ONCE, Receiver
from agentface.io.osc.schedule import FURTHEST_S, MOST
from agentface.requests import SetMuscle
from agentface.speech.synthesizer import Synthesizer
from agentface.talk.talker import Talker
from tests.clocks import ManualClock
from tests.heads import head_model
from tests.voices import FakeVoice

ME = ("127.0.0.1", 1)


class Desk:
    """A receiver on a clock of its own, with what it answered."""

    def __init__(self, model):
        self.clock = ManualClock()
        self.face = Face(model, clock=self.clock)
        self.answers = []
        self.receiver = Receiver(self.face, lambda packet, sender: self.answers.append((packet, sender)), self.clock)

    def take(self, *packets, sender=ME):
        self.receiver.take([(packet, sender) for packet in packets])

    def said(self):
        """The answers since the last call, decoded."""
        said = [decode(packet)[0] for packet, _ in self.answers]
        self.answers.clear()
        return said

    @property
    def state(self):
        return self.face.emotion


@pytest.fixture(scope="module")
def model():
    return head_model()


@pytest.fixture
def desk(model):
    return Desk(model)


def test_emotion_with_fade_and_hold(desk):
    desk.take(message("/agentface/emotion", "sfff", "joy", 0.5, 0.1, 0.2))
    assert desk.state == EmotionState.of(happiness=0.5)
    desk.face.step(0.29)
    assert desk.face.status()["shown"]["emotion"]["happiness"] == 0.5
    desk.face.step(0.2)
    assert desk.state == EmotionState()
    assert not desk.answers


def test_emotion_keeps_the_others_and_emotions_does_not(desk):
    desk.take(message("/agentface/emotion", "sf", "anger", 0.25))
    desk.take(message("/agentface/emotion", "sf", "fear", 0.5))
    assert desk.state == EmotionState.of(anger=0.25, fear=0.5)
    desk.take(message("/agentface/emotions", "sfsf", "disgust", 0.75, "sad", 0.5))
    assert desk.state == EmotionState.of(disgust=0.75, sadness=0.5)
    desk.take(message("/agentface/neutral"))
    assert desk.state == EmotionState()


def test_muscle_gaze_head_blink_and_whole_numbers(desk):
    desk.take(
        message("/agentface/muscle", "sf", "zygomaticus_major_l", 0.5),
        message("/agentface/muscle", "si", "jaw_open", 1),
        message("/agentface/gaze", "fff", 10, -5, 0),
        message("/agentface/head", "ffd", 20, 5, 3),
        message("/agentface/blink"),
    )
    desk.face.step(0.09)
    assert desk.face.pose["orbicularis_oculi_palpebralis_l"] == 1.0
    desk.face.step(1.0)
    pose = desk.face.pose
    assert pose["zygomaticus_major_l"] == 0.5
    assert pose["zygomaticus_major_r"] == 0.0
    assert pose["jaw_open"] == 1.0
    assert desk.face.status()["gaze_deg"] == [10, -5]
    assert math.degrees(pose["head_yaw"]) == pytest.approx(20)
    assert desk.face.message_counts.messages == 5


def test_the_mouth_is_driven_by_visemes(desk):
    desk.take(message("/agentface/viseme", "sf", "aa", 1.0), message("/agentface/viseme", "sff", "PP", 1.0, 0.5))
    desk.face.step(1.0)
    opened = desk.face.pose["jaw_open"]
    assert opened > 0.1
    desk.take(message("/agentface/hush"))
    desk.face.step(0.2)
    assert desk.face.pose["jaw_open"] == 0.0
    desk.take(message("/agentface/visemes", "sffsff", "p", 0.0, 0.1, "AA1", 0.1, 0.4))
    desk.face.step(0.2)
    assert desk.face.status()["speech"] == {"phone": "AA1", "ends_in_s": 0.2, "waiting": 0}
    desk.take(message("/agentface/visemes", "sff", "iy", 0.1, 0.6))
    assert desk.face.status()["speech"]["ends_in_s"] == pytest.approx(0.6, abs=1e-3)
    desk.take(message("/agentface/hush"))
    assert desk.face.status()["speech"] is None
    assert not desk.answers


def test_parameters_and_points_reach_what_is_no_muscle(desk):
    desk.take(
        message("/agentface/parameter", "sf", "head_roll", 0.25),
        message("/agentface/parameter", "sf", "head_pitch_deg", -10.0),
        message("/agentface/parameter", "sf", "mentalis", 0.5),
        message("/agentface/look_at", "ffff", 0.0, 0.0, 1.0, 0.0),
    )
    desk.face.step(1.0)
    pose = desk.face.pose
    assert (pose["head_roll"], pose["mentalis_l"], pose["mentalis_r"]) == (0.25, 0.5, 0.5)
    assert math.degrees(pose["head_pitch"]) == pytest.approx(-10, abs=1e-4)
    assert math.degrees(pose["gaze_pitch"]) > 8
    assert pose["gaze_vergence"] > 0.01
    assert not desk.answers


def test_what_only_the_face_can_refuse_is_answered_too(desk):
    desk.take(message("/agentface/look_at", "fff", 0.0, 0.0, -1.0))
    (answer,) = desk.said()
    assert answer.arguments[0] == "/agentface/look_at"
    assert "in front of the eyes" in answer.arguments[1]
    assert desk.face.message_counts.errors == {"malformed": 0, "unknown": 0, "rejected": 1}
    assert desk.face.message_counts.messages == 0


def test_what_the_face_refuses_takes_the_place_of_nothing(desk):
    desk.take(
        message("/agentface/gaze", "fff", 10.0, 0.0, 0.0),
        message("/agentface/gaze", "fff", 20.0, 0.0, 0.0),
        message("/agentface/look_at", "fff", 0.0, 0.0, -1.0),
        message("/agentface/look_at", "fff", 0.0, 0.0, -2.0),
    )
    desk.face.step(1.0)
    assert desk.face.status()["gaze_deg"] == [20, 0]
    assert [answer.arguments[0] for answer in desk.said()] == ["/agentface/look_at"] * 2
    assert desk.face.message_counts.messages == 2


def test_neutral_as_an_emotion_keeps_the_muscles(desk):
    desk.take(message("/agentface/emotion", "sf", "joy", 0.5), message("/agentface/muscle", "sf", "risorius", 0.5))
    desk.take(message("/agentface/emotion", "sf", "neutral", 1.0))
    assert desk.state == EmotionState()
    assert desk.face.held
    desk.take(message("/agentface/emotions", "sfsf", "happy", 0.75, "neutral", 0.25))
    assert desk.state == EmotionState.of(happiness=0.75)


def test_a_program_adds_an_address_of_its_own(desk):
    def wink(arguments):
        (side,) = arguments
        return SetMuscle(f"orbicularis_oculi_palpebralis_{side}", 1.0, 0.0)

    desk.receiver.addresses.add("/avatar/wink", wink)
    desk.take(message("/avatar/wink", "s", "l"))
    assert desk.face.pose["orbicularis_oculi_palpebralis_l"] == 1.0
    desk.take(bundle(message("/avatar/wink", "s", "r"), date=desk.clock.date() + 1))
    assert desk.face.pose["orbicularis_oculi_palpebralis_r"] == 0.0
    desk.clock.sleep(1.0)
    desk.take()
    assert desk.face.pose["orbicularis_oculi_palpebralis_r"] == 1.0
    desk.take(message("/avatar/wink", "s", "x"), message("/avatar/wink"))
    assert [answer.arguments[0] for answer in desk.said()] == ["/avatar/wink", "/avatar/wink"]
    assert desk.face.message_counts.errors == {"malformed": 0, "unknown": 0, "rejected": 2}
    desk.receiver.addresses.remove("/avatar/wink")
    desk.take(message("/avatar/wink", "s", "l"))
    assert desk.face.message_counts.errors["unknown"] == 1


def test_an_added_address_may_do_its_own_work(desk):
    taken = []
    desk.receiver.addresses.add("/avatar/note", taken.append)
    desk.take(message("/avatar/note", "if", 3, 0.5))
    assert taken == [(3, 0.5)]
    assert desk.face.message_counts.messages == 1


@pytest.mark.parametrize(
    "address", ["", "avatar", "/", "/a//b", "/a/", "/a b", "/a*", "/{a}", "/ä", None, "/agentface/blink",
                "/agentface/amber/blink", "/agentface/status", "/taken"],
)  # fmt: skip
def test_a_wrong_or_taken_address_is_not_added(desk, address):
    desk.receiver.addresses.add("/taken", lambda arguments: None)
    with pytest.raises(InvalidValueError, match="address"):
        desk.receiver.addresses.add(address, lambda arguments: None)


def test_only_what_was_added_is_removed(desk):
    for address in ("/agentface/blink", "/none"):
        with pytest.raises(UnknownNameError):
            desk.receiver.addresses.remove(address)


def test_neutral_takes_its_fade(desk):
    desk.take(message("/agentface/emotion", "sff", "joy", 1.0, 0.0), message("/agentface/neutral", "f", 2.0))
    desk.face.step(1.0)
    assert 0.3 < desk.face.status()["shown"]["emotion"]["happiness"] < 0.7
    desk.face.step(1.0)
    assert desk.face.status()["shown"]["emotion"]["happiness"] == 0.0


@pytest.mark.parametrize(
    ("packet", "reason"),
    [
        (message("/agentface/emotion", "sf", "hapiness", 0.5), "hapiness"),
        (message("/agentface/emotion", "sf", "joy", math.nan), "finite"),
        (message("/agentface/emotion", "sf", "joy", math.inf), "finite"),
        (message("/agentface/emotion", "sf", "joy", 1.5), "0..1"),
        (message("/agentface/emotion", "sf", "joy", -0.5), "0..1"),
        (message("/agentface/emotion", "ss", "joy", "much"), "number"),
        (message("/agentface/emotion", "ff", 0.5, 0.5), "emotion"),
        (message("/agentface/emotion", "s", "joy"), "name intensity"),
        (message("/agentface/emotion"), "name intensity"),
        (message("/agentface/emotion", "sffff", "joy", 1, 1, 1, 1), "name intensity"),
        (message("/agentface/emotion", "sff", "joy", 0.5, -1.0), "seconds"),
        (message("/agentface/emotion", "sfff", "joy", 0.5, 1.0, math.nan), "finite"),
        (message("/agentface/emotions"), "pairs"),
        (message("/agentface/emotions", "sfs", "joy", 0.5, "fear"), "pairs"),
        (message("/agentface/emotions", "sfsf", "fear", 0.5, "nothing", 0.5), "nothing"),
        (message("/agentface/emotions", "sfsf", "joy", 0.5, "happy", 0.5), "once"),
        (message("/agentface/emotions", "sfsf", "fear", 0.5, "joy", 2.0), "0..1"),
        (message("/agentface/neutral", "s", "now"), "number"),
        (message("/agentface/muscle", "sf", "biceps", 0.5), "biceps"),
        (message("/agentface/muscle", "sf", "gaze_yaw", 0.5), "gaze_yaw"),
        (message("/agentface/muscle", "sf", "risorius", 7.0), "0..1"),
        (message("/agentface/muscle", "fs", 0.5, "risorius"), "muscle"),
        (message("/agentface/parameter", "sf", "head_yow", 0.5), "head_yaw"),
        (message("/agentface/parameter", "sf", "head_yaw", 2.0), "-1.39"),
        (message("/agentface/parameter", "sf", "head_yaw_deg", 81.0), "-80..80"),
        (message("/agentface/parameter", "s", "head_yaw"), "name value"),
        (message("/agentface/look_at", "ff", 0, 0), "x y z"),
        (message("/agentface/look_at", "fff", 0, 0, math.inf), "finite"),
        (message("/agentface/gaze", "ff", 80, 0), "-50..50"),
        (message("/agentface/gaze", "f", 80), "yaw_deg"),
        (message("/agentface/head", "ff", 1, 2), "roll"),
        (message("/agentface/viseme", "sf", "aaa", 1), "viseme"),
        (message("/agentface/viseme", "sf", "aa", 2), "0..1"),
        (message("/agentface/viseme", "s", "aa"), "name weight"),
        (message("/agentface/visemes"), "triples"),
        (message("/agentface/visemes", "sf", "aa", 0), "triples"),
        (message("/agentface/visemes", "sff", "xyzzy", 0, 1), "xyzzy"),
        (message("/agentface/visemes", "sff", "aa", 1, 0), "before its start"),
        (message("/agentface/visemes", "sff", "aa", 0, math.inf), "finite"),
        (message("/agentface/hush", "s", "now"), "no arguments"),
        (message("/agentface/blink", "ff", 1, 1), "no arguments"),
        (message("/agentface/blink", "f", math.nan), "no arguments"),
        (message("/agentface/blink", "s", "now"), "no arguments"),
        (message("/agentface/status", "ff", 1, 1), "no arguments"),
        (message("/agentface/neutral", "ff", 1, 1), "[fade_s]"),
        (message("/agentface/neutral", "f", -1), "seconds"),
        (message("/agentface/emotion", "sf", "joy", 1.00001), "0..1"),
        (message("/agentface/emotion", "sI", "joy"), "number"),
        (bundle(message("/agentface/emotion", "sf", "joy", 0.5), date=2e9), "ahead"),
        (bundle(message("/agentface/emotion", "sf", "joy", 0.5), date=1_000_000_000.0 + FURTHEST_S + 1), "ahead"),
    ],
)
def test_a_wrong_message_is_answered_and_changes_nothing(desk, packet, reason):
    desk.take(message("/agentface/emotion", "sff", "sadness", 0.5, 0))
    before = desk.face.status()
    desk.take(packet)
    (answer,) = desk.said()
    address, said, hint = answer.arguments
    assert answer.address == "/agentface/error"
    assert packet.partition(b"\0")[0].decode() in (address, "#bundle")
    assert reason in said + hint
    after = desk.face.status()
    assert after["errors"] == {"malformed": 0, "unknown": 0, "rejected": 1}
    assert after | {"errors": before["errors"]} == before
    desk.face.step(1000.0)
    assert desk.state == EmotionState.of(sadness=0.5)


@pytest.mark.parametrize("seed", range(3))
def test_200_kb_of_garbage_is_counted_and_answered(desk, seed):
    desk.take(message("/agentface/emotion", "sf", "sadness", 0.5))
    source = np.random.default_rng(seed)
    packets = [source.bytes(source.choice([1, 3, 17, 400, 1472, 8193])) for _ in range(300)]
    assert sum(map(len, packets)) > 200_000
    desk.take(*packets)
    assert desk.face.message_counts.errors == {"malformed": 300, "unknown": 0, "rejected": 0}
    assert desk.state == EmotionState.of(sadness=0.5)
    answers = desk.said()
    assert {answer.address for answer in answers} == {"/agentface/error"}
    assert len(answers) == ANSWERS_AT_ONCE
    desk.take(message("/agentface/status"))
    assert desk.said()[0].address == "/agentface/status"


@pytest.mark.parametrize(
    "address",
    [
        "/other/emotion",
        "/agentface",
        "/agentface/",
        "/agentface/visage",
        "/agentface/onyx/emotion",
        "/*",
        "/*/*/*/*",
        "/agentface/{emotion",
        "/agentface/[e",
        "/agentface/e?",
        "//emotion",
        "/agentface/" + "*" * 300,
    ],
)
def test_unknown_addresses_are_counted_and_not_answered(desk, address):
    desk.take(message(address, "sf", "joy", 0.5))
    assert desk.face.message_counts.errors == {"malformed": 0, "unknown": 1, "rejected": 0}
    assert not desk.answers
    assert desk.state == EmotionState()


def test_a_mood_is_what_brief_expressions_return_to_until_it_is_cleared(desk):
    desk.take(message("/agentface/mood", "sfsf", "joy", 0.5, "surprise", 0.25))
    assert desk.state == desk.face.mood == EmotionState.of(happiness=0.5, surprise=0.25)
    desk.take(message("/agentface/emotion", "sfff", "anger", 0.9, 0.1, 0.5))
    assert desk.state["anger"] > 0.5
    desk.face.step(0.7)
    for _ in range(3):
        assert desk.state == desk.face.mood
        desk.take(message("/agentface/neutral"))
    assert desk.face.status()["mood"]["happiness"] == 0.5
    desk.take(message("/agentface/mood"))
    assert desk.state == desk.face.mood == EmotionState()
    assert not desk.answers


@pytest.mark.parametrize(
    "packet",
    [
        message("/agentface/mood", "sf", "calm", 0.5),
        message("/agentface/mood", "sfsf", "joy", 0.5, "happy", 0.5),
        message("/agentface/mood", "sf", "joy", 1.5),
        message("/agentface/mood", "sfs", "joy", 0.5, "fear"),
        message("/agentface/mood", "T"),
    ],
)
def test_a_wrong_mood_is_answered_and_changes_nothing(desk, packet):
    desk.take(message("/agentface/mood", "sf", "joy", 0.5))
    desk.take(packet)
    assert [answer.address for answer in desk.said()] == ["/agentface/error"]
    assert desk.state == desk.face.mood == EmotionState.of(happiness=0.5)


def test_an_emotion_may_take_its_own_time(desk):
    desk.take(message("/agentface/emotion", "sfNs", "surprise", 0.9, "own"))
    desk.face.step(0.9)
    assert desk.face.status()["shown"]["emotion"]["surprise"] == 0.9
    desk.face.step(1.0)
    assert desk.state == EmotionState()


@pytest.mark.parametrize(
    "address",
    [
        "/agentface/{emotion,moods}", "/agentface/e*n", "/agentface/emotio?", "/agentface/[!a-df-z]motion",
        "/*/emotion", "/agentface/*/emotion", "/agentface/{amber,onyx}/emotion", "/agentface/a????/[d-f]motion",
    ],
)  # fmt: skip
def test_patterns_are_matched(desk, address):
    desk.take(message(address, "sf", "joy", 0.5))
    assert desk.state == EmotionState.of(happiness=0.5)
    assert desk.face.message_counts.messages == 1
    assert desk.face.message_counts.errors == {"malformed": 0, "unknown": 0, "rejected": 0}


def test_a_pattern_means_each_address_by_itself(desk):
    desk.receiver.addresses.add("/avatar/muscles", lambda arguments: SetMuscle(*arguments, 0.0))
    desk.take(message("/{agentface,avatar}/muscle*", "sf", "risorius", 0.5))
    assert desk.face.message_counts.messages == 2
    desk.take(message("/agentface/{muscle,emotion,status}", "sf", "jaw_open", 0.5))
    assert desk.face.held["jaw_open"] == 0.5
    refused = [answer.arguments[0] for answer in desk.said()]
    assert refused == ["/agentface/emotion", "/agentface/status"]
    desk.take(message("/agentface/stat*"))
    assert desk.said()[0].address == "/agentface/status"


PRESSED = [("f", 1.0), ("i", 1), ("f", -0.5), ("d", 1e-3), ("T",), ("I",), ("N",), ("s", "bang"), ("S", "bang"), ("",)]
RELEASED = [("f", 0.0), ("i", 0), ("h", 0), ("F",), ("f", -0.0)]


@pytest.mark.parametrize("arguments", [*PRESSED, *RELEASED], ids=str)
def test_a_button_blinks_when_it_is_pressed(desk, arguments):
    desk.take(message("/agentface/blink", *arguments))
    desk.face.step(0.09)
    assert desk.face.pose["orbicularis_oculi_palpebralis_l"] == (1.0 if arguments in PRESSED else 0.0)
    assert desk.face.message_counts.messages == 1
    assert not desk.answers


@pytest.mark.parametrize("arguments", [*PRESSED, *RELEASED], ids=str)
def test_a_button_asks_for_the_status_when_it_is_pressed(desk, arguments):
    desk.take(message("/agentface/status", *arguments))
    assert [answer.address for answer in desk.said()] == ["/agentface/status"] * (arguments in PRESSED)


@pytest.mark.parametrize(
    ("arguments", "left", "fade"),
    [(("T",), 0.0, 0.25), (("I",), 0.0, 0.25), (("N",), 0.0, 0.25), (("s", "bang"), 0.0, 0.25), (("F",), 0.5, 0.0),
     (("f", 0.0), 0.0, 0.0), (("i", 1), 0.0, 1.0)],
)  # fmt: skip
def test_a_button_lets_go_of_everything(desk, arguments, left, fade):
    desk.take(message("/agentface/emotion", "sff", "joy", 0.5, 0.0))
    desk.take(message("/agentface/neutral", *arguments))
    assert desk.state["happiness"] == left
    desk.face.step(0.5 * fade)
    shown = desk.face.status()["shown"]["emotion"]["happiness"]
    assert 0.1 < shown < 0.3 if fade else shown == left
    assert not desk.answers


def test_symbols_arrays_and_rounded_peaks_are_taken(desk):
    desk.take(message("/agentface/emotion", "Sf", "happiness", 0.75))
    assert desk.state == EmotionState.of(happiness=0.75)
    desk.take(message("/agentface/emotions", "[sf][sf]", "joy", 0.5, "fear", 0.25))
    assert desk.state == EmotionState.of(happiness=0.5, fear=0.25)
    desk.take(message("/agentface/emotion", "sf", "happiness", 1.0000001))
    assert desk.state["happiness"] == 1.0
    desk.take(message("/agentface/emotion", "sf", "happiness", -1e-7))
    assert desk.state["happiness"] == 0.0
    desk.take(
        message("/agentface/gaze", "ff", 50.00001, -40.00001), message("/agentface/muscle", "sf", "nasalis", 1.0000001)
    )
    desk.face.step(1.0)
    assert desk.face.status()["gaze_deg"] == [50, -40]
    assert not desk.answers


def test_the_face_has_a_name_of_its_own(desk):
    desk.take(message("/agentface/amber/emotion", "sf", "joy", 0.5))
    assert desk.state == EmotionState.of(happiness=0.5)


def test_status_is_answered_after_what_came_before_it(desk):
    desk.take(
        message("/agentface/status"), message("/agentface/emotion", "sf", "joy", 0.5), message("/agentface/status")
    )
    (answer,) = desk.said()
    status = json.loads(answer.arguments[0])
    assert answer.address == "/agentface/status"
    assert status["emotion"]["happiness"] == 0.5
    assert list(status) == list(desk.face.status())
    assert status["messages"] == 3


def test_every_sender_gets_its_status(desk):
    for port in range(3):
        desk.receiver.take([(message("/agentface/status"), ("127.0.0.1", port))] * 5)
    assert [sender for _, sender in desk.answers] == [("127.0.0.1", port) for port in range(3)]


def test_the_newest_wins_and_order_is_kept(desk):
    many = [message("/agentface/emotion", "sf", "joy", number / 1000) for number in range(1000)]
    desk.take(*many, message("/agentface/neutral"), message("/agentface/emotion", "sf", "fear", 0.25))
    assert desk.state == EmotionState.of(fear=0.25)
    desk.take(message("/agentface/emotions", "sf", "anger", 0.5), message("/agentface/emotion", "sf", "joy", 0.125))
    assert desk.state == EmotionState.of(anger=0.5, happiness=0.125)


def test_a_bundle_with_one_malformed_part_does_nothing(desk):
    desk.take(
        bundle(message("/agentface/emotion", "sf", "joy", 0.5), message("/agentface/emotion", "sf", "fear", 0.5)[:-4])
    )
    assert desk.state == EmotionState()
    assert desk.face.message_counts.errors["malformed"] == 1


def test_bundles_play_at_their_time_in_their_order(desk):
    now = desk.clock.date()
    desk.take(
        bundle(message("/agentface/emotion", "sf", "joy", 0.75), date=now + 2),
        bundle(message("/agentface/emotion", "sf", "joy", 0.25), date=now + 1),
        bundle(message("/agentface/emotion", "sf", "joy", 0.125), date=now - 3600),
    )
    assert desk.state["happiness"] == 0.125
    seen = []
    for _ in range(5):
        desk.clock.sleep(0.5)
        desk.take()
        seen.append(desk.state["happiness"])
    assert seen == [0.125, 0.25, 0.25, 0.75, 0.75]


def test_a_wrong_message_in_a_later_bundle_is_answered_now(desk):
    desk.take(bundle(message("/agentface/emotion", "sf", "joi", 0.75), date=desk.clock.date() + 2))
    assert desk.said()[0].arguments[0] == "/agentface/emotion"


def test_the_schedule_is_bounded(desk):
    packet = bundle(*[message("/agentface/blink")] * 200, date=desk.clock.date() + 5)
    desk.take(*[packet] * (MOST // 200 + 2))
    assert desk.face.message_counts.errors["rejected"] == (MOST // 200 + 2) * 200 - MOST
    assert desk.face.message_counts.messages == MOST


def test_answers_are_limited_in_time(desk):
    wrong = [message("/agentface/emotion", "sf", "joi", 0.5)] * 1000
    desk.take(*wrong)
    assert len(desk.said()) == ANSWERS_AT_ONCE
    desk.clock.sleep(0.5)
    desk.take(*wrong)
    assert len(desk.said()) == ANSWERS_A_SECOND / 2
    assert desk.face.message_counts.errors["rejected"] == 2000


def test_the_status_is_limited_over_all_senders(desk):
    desk.receiver.take([(message("/agentface/status"), ("10.0.0.1", port)) for port in range(1000)])
    assert len(desk.said()) == ANSWERS_AT_ONCE
    assert desk.face.message_counts.messages == 1000


def test_a_voice_that_fails_later_is_answered_to_who_had_it_speak(desk):
    voice = FakeVoice()
    desk.face._agendas.talker = Talker(desk.face, Synthesizer(lambda *_: voice))
    desk.take(message("/agentface/say", "s", "Bad."), sender=("127.0.0.1", 2))
    desk.take(message("/agentface/say", "s", "Good."))
    assert desk.said() == []
    desk.face.talker.wait()
    desk.face.step(0.0)
    desk.take()
    assert [sender for _, sender in desk.answers] == [("127.0.0.1", 2)]
    answer = desk.said()[0]
    assert (answer.address, answer.arguments[0]) == ("/agentface/error", "/agentface/say")
    assert "no" in answer.arguments[1]
    assert desk.face.message_counts.errors["rejected"] == 1
    assert desk.face.message_counts.messages == 1
    desk.take()
    assert desk.said() == []
