from __future__ import annotations

import gc
import threading
from collections import deque
from types import SimpleNamespace

import numpy as np
import pytest

from agentface.emotion.state import EmotionState
from agentface.errors import InvalidValueError
from agentface.requests import Hush, Neutral, SetEmotion, SetEmotions, Speak
from agentface.requests.say import script_of
from agentface.speech.phones import Phone
from agentface.speech.script import Script
from agentface.speech.sound import Sound
from agentface.speech.spoken import Spoken, joined, speak_line, speak_script
from agentface.speech.synthesizer import Order, Synthesizer
from agentface.talk.talker import LEAD_S, MOST_TEXTS, Talker
from tests.voices import RATE, FakeVoice
from tests.waiting import until


class Face:
    """Notes what it is asked, and when."""

    def __init__(self, voice=None):
        self.voice = voice or FakeVoice()
        self.synthesizer = Synthesizer(lambda _voice, _language, ours=self.voice: ours)
        self.talker = Talker(self, self.synthesizer)
        self.now, self.emotion, self.asked, self.mouth = 0.0, EmotionState.of(happiness=0.2), [], None

    @property
    def channels(self):
        return SimpleNamespace(speech=SimpleNamespace(status=self.mouth))

    def apply(self, request):
        if isinstance(request, SetEmotion):
            change = (
                {request.emotion: request.intensity}
                if request.emotion != "neutral"
                else dict.fromkeys(self.emotion, 0.0)
            )
            self.emotion = EmotionState.of(self.emotion.as_dict() | change)
        self.asked.append((round(self.now, 6), request))
        self.talker.notice(request)

    def say(self, text, **options):
        self.talker.say(text, Order(script_of(text)), **options)

    def run(self, seconds, dt=0.1):
        end = self.now + seconds
        while self.now < end - 1e-9:
            left = min(dt, end - self.now)
            self._pass(0.0)
            while self.talker.due_s < left:
                left -= self._pass(self.talker.due_s)
            self._pass(left)

    def _pass(self, dt):
        self.now += dt
        self.talker.advance(dt)
        return dt

    @property
    def spoken(self):
        """When each phone is said."""
        return [(round(at + r.start, 6), r.phones[0].symbol) for at, r in self.asked if isinstance(r, Speak)]

    @property
    def shown(self):
        return [(at, r.emotion, r.intensity) for at, r in self.asked if isinstance(r, SetEmotion)]


@pytest.fixture
def face():
    return Face()


def ready(face):
    face.talker.wait()


def test_sentences_follow_each_other_without_a_gap_and_are_told_before_their_turn(face):
    face.say("One. Two. Three.")
    ready(face)
    face.run(4.0)
    assert face.spoken == [(0.0, "o"), (1.0, "t"), (2.0, "t")]
    told = [at for at, _ in face.asked]
    assert told[1] == pytest.approx(1.0 - LEAD_S, abs=1e-6)
    assert [len(r.phones) for _, r in face.asked] == [1, 1, 1]


def test_the_first_sentence_does_not_wait_for_the_second():
    face = Face()
    voice = face.voice
    speak = voice.speak

    def slow_second(sentence, rate=1.0, marks=()):
        if sentence == "Two.":
            voice.go.clear()
        return speak(sentence, rate, marks)

    voice.speak = slow_second
    face.say("One. Two.")
    face.run(0.1)
    until(lambda: face.synthesizer._done)
    face.run(0.5)
    assert [symbol for _, symbol in face.spoken] == ["o"]
    face.run(2.0)
    voice.go.set()
    ready(face)
    face.run(1.0)
    assert face.spoken[1] == (pytest.approx(2.6, abs=0.11), "t"), "late, and then at once"


def test_texts_wait_their_turn_and_interrupt(face):
    ended = []
    face.talker.ended.append(ended.append)
    face.say("One. Two.")
    face.say("Three.")
    assert face.talker.texts == ("One. Two.", "Three.")
    ready(face)
    face.run(2.5)
    assert face.spoken == [(0.0, "o"), (1.0, "t"), (2.0, "t")]
    assert ended == ["One. Two."]
    hushed = []
    face.talker.hushed.append(lambda: hushed.append(face.now))
    face.say("Now!", interrupt=True)
    assert hushed == [2.5]
    ready(face)
    face.run(2.0)
    assert face.spoken[-1] == (2.5, "n")
    assert face.asked[-1][1].interrupt
    assert ended == ["One. Two.", "Now!"]


@pytest.mark.parametrize("request_", [Hush(), Speak((Phone("a", 0, 1),), interrupt=True)])
def test_hush_ends_everything(face, request_):
    hushed = []
    face.talker.hushed.append(lambda: hushed.append(face.now))
    face.say("[joy] One. [sad] Two.")
    face.say("Three.")
    ready(face)
    face.run(0.5)
    face.apply(request_)
    assert hushed == [0.5]
    assert face.emotion["happiness"] == pytest.approx(0.2)
    count = len(face.asked)
    face.run(5.0)
    assert len(face.asked) == count
    assert face.talker.texts == ()
    assert face.talker.due_s == np.inf
    face.say("Four.")
    ready(face)
    face.run(0.2)
    assert [symbol for _, symbol in face.spoken][-1] == "f"


def test_what_is_spoken_in_another_way_does_not_end_it(face):
    face.say("One. Two.")
    ready(face)
    face.run(0.2)
    face.apply(Speak((Phone("a", 0, 1),)))
    face.run(1.5)
    assert [symbol for _, symbol in face.spoken] == ["o", "a", "t"]


@pytest.mark.parametrize("dt", [0.1, 1 / 30, 1 / 144, 0.7])
def test_emotions_come_at_their_words_and_go(dt):
    face = Face()
    face.talker.latency_s = 0.0
    face.say("[surprise:0.5] Tom said [joy] hello. [neutral] Yes.")
    ready(face)
    face.run(dt, dt)
    face.run(4.0, dt)
    start = face.spoken[0][0]
    assert [(round(at - start, 6), *rest) for at, *rest in face.shown] == [
        (0.0, "surprise", 0.5),
        (0.09, "surprise", 0.0),
        (0.09, "happiness", 0.7),
        (1.0, "neutral", 1.0),
    ]


def test_after_a_text_the_face_is_as_before(face):
    face.say("[joy] One. [sad] Two [joy:1] three.")
    ready(face)
    face.run(1.5)
    assert face.emotion["happiness"] == 1.0
    face.run(2.0)
    assert face.emotion == EmotionState.of(happiness=0.2)
    assert face.shown[-1][0] == pytest.approx(2.0, abs=1e-6)


@pytest.mark.parametrize("request_", [Neutral(), SetEmotion("happiness", 0.9), SetEmotions({"happiness": 0.9})])
def test_what_somebody_else_makes_it_feel_outlasts_the_text(face, request_):
    face.say("[joy:0.5] One.")
    ready(face)
    face.run(0.5)
    face.apply(request_)
    face.run(2.0)
    assert face.asked[-1] == (0.5, request_)


def test_it_waits_for_what_others_say(face):
    face.mouth = {"ends_in_s": 1.0}
    face.say("One.")
    ready(face)
    face.run(1.0)
    assert not face.asked
    face.mouth = {"ends_in_s": 0.0}
    face.run(0.1)
    assert face.spoken == [(1.0, "o")]
    assert face.asked[0][1].live


def test_sounds_are_heard_when_they_are_seen(face):
    heard = []
    face.talker.latency_s = 0.06
    face.talker.heard.append(lambda sound, in_s: heard.append((round(face.now + in_s, 6), chr(sound.samples[0]))))
    face.say("One. Two.")
    ready(face)
    face.run(3.0)
    assert [(round(at - 0.06, 6), symbol.upper()) for at, symbol in face.spoken] == heard


@pytest.mark.parametrize(("text", "said"), [("One. Bad. Two.", "no"), ("Worse.", "ZeroDivisionError")])
def test_what_goes_wrong_is_told_and_ends_its_text_alone(face, text, said):
    failed, ended = [], []
    face.talker.failed.append(failed.append)
    face.talker.ended.append(ended.append)
    face.say(text)
    face.say("Four.")
    ready(face)
    face.run(3.0)
    assert [said in str(error) for error in failed] == [True]
    assert face.talker.error is failed[0]
    assert ended == [text, "Four."]
    assert "Two." not in face.voice.said
    assert face.spoken[-1][1] == "f"


def test_phones_that_the_mouth_does_not_know_are_told_and_stop_nothing(face):
    failed, heard = [], []
    face.talker.failed.append(failed.append)
    face.talker.heard.append(lambda sound, in_s: heard.append(in_s))
    face.say("9 lives. One.")
    ready(face)
    face.run(3.0)
    assert len(failed) == len(heard) == 1
    assert face.spoken == [(1.0, "o")]
    assert face.talker.texts == ()


def test_texts_that_wait_are_limited(face):
    face.voice.go.clear()
    for _ in range(MOST_TEXTS):
        face.say("One.")
    with pytest.raises(InvalidValueError, match="waiting"):
        face.say("Two.")
    face.say("Three.", interrupt=True)
    face.voice.go.set()
    ready(face)
    face.run(0.3)
    assert [symbol for _, symbol in face.spoken] == ["t"]
    assert face.talker.texts == ("Three.",)


def test_a_face_that_is_gone_takes_its_voices_along():
    face = Face()
    voice = face.voice
    face.say("One.")
    ready(face)
    threads = [thread for thread in threading.enumerate() if thread.name == "agentface-voice"]
    assert threads
    del face
    gc.collect()
    until(lambda: voice.closed)
    for thread in threads:
        thread.join()


def test_a_closed_synthesizer_is_silent():
    synthesizer = Synthesizer(lambda *_: FakeVoice())
    synthesizer.close()
    synthesizer.ask(Order(Script.of("One.")))
    synthesizer.wait()
    assert synthesizer.take() is None
    synthesizer.close()


def test_parts_are_joined_to_the_sample():
    voice = FakeVoice()
    script = script_of("[joy] Ah. Be it [sad] so. Ce.")
    whole = speak_script(voice, script)
    parts = [speak_line(voice, line) for line in script.lines]
    assert whole == joined(parts)
    assert whole.duration_s == 3.0
    assert [(p.symbol, p.start_s, p.end_s) for p in whole.phones] == [("a", 0, 1), ("b", 1, 2), ("c", 2, 3)]
    assert [chr(whole.sound.samples[round(at * RATE)]) for at in (0.0, 0.999, 1.0, 2.5)] == ["A", "A", "B", "C"]
    assert [(at, tag.name) for at, tag in whole.tags] == [(0.0, "happiness"), (pytest.approx(1.06), "sadness")]
    assert whole.text == "Ah. Be it so. Ce."
    short = Spoken(Sound(np.zeros(80, np.int16), RATE), (Phone("a", 0, 0.5),))
    assert joined([short, short]).sound.duration_s == 1.0, "phones may outlast their sound"
    with pytest.raises(InvalidValueError, match="rate"):
        joined([short, Spoken(Sound(np.zeros(80, np.int16), 16_000), ())])


def test_nothing_waits_for_voices():
    face = Face()
    face.voice.go.clear()
    face.say("One.")
    face.run(1.0)
    assert not face.asked
    face.voice.go.set()
    ready(face)
    face.run(0.1)
    assert face.spoken == [(pytest.approx(1.0, abs=1e-6), "o")]
    assert isinstance(deque(face.asked).pop()[1], Speak)
