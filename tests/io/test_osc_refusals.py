"""Messages that are wrong: they are answered, and change nothing."""

from __future__ import annotations

import math

import numpy as np
import pytest
from osc_bytes import bundle, message

from agentface import EmotionState
from agentface.io.osc.receiver import ANSWERS_AT_ONCE
from agentface.io.osc.schedule import FURTHEST_S
from agentface.speech.synthesizer import Synthesizer
from agentface.talk.talker import Talker
from tests.voices import FakeVoice


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
