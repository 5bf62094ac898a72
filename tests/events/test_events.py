"""Listeners and futures: each thing asked for is told of once, with what became of it, in the thread that steps."""

from __future__ import annotations

import gc
import threading
import weakref

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from agentface.errors import InvalidValueError, SpeechError, UnknownNameError
from agentface.events.events import EVENTS
from agentface.live.notes import Replay
from agentface.motion.blink import BlinkShape
from agentface.motion.performance import Performance
from agentface.parameters import COUNT
from agentface.requests import Gesture, Hush, Neutral, Play, Say, SetEmotion, Speak, TakeBack
from tests.voices import talking_face


@pytest.fixture
def face():
    with talking_face() as made:
        yield made


OVER = ("spoken", "hushed", "failed", "gestured", "played")
"""The events of what was asked for."""


@pytest.fixture
def told(face):
    assert set(OVER) < set(EVENTS)
    said = []
    for name in OVER:
        face.on(name, lambda value, name=name: said.append((name, value)))
    return said


def run(face, seconds, dt=0.05):
    for _ in range(round(seconds / dt)):
        face.step(dt)


def performance(seconds):
    return Performance(np.array([0.0, seconds]), np.zeros((2, COUNT)), np.ones((2, COUNT)))


def test_a_text_is_told_when_it_is_said(face, told):
    face.say("One. Two.", wait=True)
    run(face, 1.9)
    assert told == []
    run(face, 0.3)
    assert told == [("spoken", "One. Two.")]
    run(face, 3.0)
    assert len(told) == 1


def test_texts_that_are_hushed_are_told_each(face, told):
    face.say("One.", wait=True)
    face.say("Two.", wait=True)
    run(face, 0.5)
    face.hush()
    run(face, 0.05)
    assert told == [("hushed", "One."), ("hushed", "Two.")]


def test_the_text_that_failed_is_told_and_not_the_one_before_it(face, told):
    face.say("One.", wait=True)
    face.say("Bad.", wait=True)
    face.say("Three.", wait=True)
    run(face, 3.0)
    (first, one), (second, error), (third, three) = told
    assert (first, one, second, third, three) == ("spoken", "One.", "failed", "spoken", "Three.")
    assert isinstance(error, SpeechError)


def test_a_gesture_is_told_when_it_ends_by_itself(face, told):
    length = face.channels.gestures.gestures["nod"].length_s
    face.gesture("nod")
    run(face, length - 0.1)
    assert told == []
    run(face, 0.3)
    assert told == [("gestured", "nod")]
    face.gesture("nod")
    run(face, 0.1)
    face.gesture("nod")
    run(face, length + 0.5)
    assert told == [("gestured", "nod")] * 2, "the one that was replaced did not end"


def test_a_performance_is_told_at_its_last_frame(face, told):
    first, second = performance(0.5), performance(0.2)
    face.play(first)
    run(face, 0.4)
    assert told == []
    run(face, 0.2)
    assert told == [("played", first)]
    face.play(first)
    run(face, 0.1)
    face.play(second)
    run(face, 0.5)
    assert told == [("played", first), ("played", second)]


def test_a_listener_may_ask_for_more(face):
    said = []

    def again(text):
        said.append(text)
        if len(said) < 3:
            face.say("More.", wait=True)

    face.on("spoken", again)
    face.say("One.", wait=True)
    run(face, 4.0)
    assert said == ["One.", "More.", "More."]


def test_a_listener_is_called_as_often_as_it_was_given_until_it_is_taken_away(face):
    said = []
    face.on("gestured", said.append)
    face.on("gestured", said.append)
    face.off("gestured", said.append)
    face.gesture("nod")
    run(face, 2.0)
    assert said == ["nod"]
    face.off("gestured", said.append)
    face.gesture("nod")
    run(face, 2.0)
    assert said == ["nod"]


def test_a_listener_that_raises_is_heard_and_keeps_nothing_from_the_next_step(face):
    said = []

    def fail(name):
        raise ZeroDivisionError(name)

    face.on("gestured", fail)
    face.on("played", said.append)
    face.gesture("nod")
    length = face.channels.gestures.gestures["nod"].length_s
    face.play(performance(length))
    with pytest.raises(ZeroDivisionError):
        run(face, length + 1.0, dt=length + 1.0)
    assert said == []
    face.step(0.05)
    assert len(said) == 1


@pytest.mark.parametrize("call", ["on", "off"])
def test_an_unknown_event_is_one_error(face, call):
    with pytest.raises(UnknownNameError, match="spoken"):
        getattr(face, call)("speken", print)


def test_what_was_not_given_is_not_taken_away(face):
    with pytest.raises(InvalidValueError, match="off spoken"):
        face.off("spoken", print)
    with pytest.raises(InvalidValueError, match="function"):
        face.on("spoken", "print")


def test_what_is_asked_is_applied_by_the_next_step(face):
    asked = face.ask(SetEmotion("joy", 0.5, 0.0))
    assert face.emotion["happiness"] == 0.0
    assert not asked.done()
    face.step(0.01)
    assert asked.result(0) is True
    assert face.emotion["happiness"] == 0.5


def test_what_the_face_refuses_is_raised_by_the_future_alone(face):
    asked = face.ask(Gesture("moonwalk")), face.ask(SetEmotion("joy", 0.5, 0.0))
    face.step(0.01)
    assert isinstance(asked[0].exception(0), UnknownNameError)
    assert asked[1].result(0) is True
    with pytest.raises(InvalidValueError, match="a Request"):
        face.ask("joy")


def test_a_text_s_voice_that_fails_is_raised(face):
    asked = face.ask(Say("Bad."))
    for _ in range(200):
        face.step(0.01)
        face.talker.wait()
    assert isinstance(asked.exception(0), SpeechError)


def test_outcomes_of_sounds_in_their_turn(face):
    first, second, now = (
        face.ask(Speak.of([("aa", 0.0, 0.5)])),
        face.ask(Speak.of([("PP", 0.0, 0.5)])),
        face.ask(Speak.of([], interrupt=False)),
    )
    run(face, 0.45)
    assert (first.done(), second.done(), now.result(0)) == (False, False, True)
    run(face, 0.1)
    assert (first.result(0), second.done()) == (True, False)
    face.speak([("iy", 0.0, 0.5)], interrupt=True)
    face.step(0.01)
    assert second.result(0) is False


def test_cancelled_before_its_turn_it_never_begins(face, told):
    face.say("One.", wait=True)
    second = face.ask(Say("Two."))
    face.step(0.01)
    face.talker.wait()
    third = face.ask(Say("Three."))
    face.step(0.01)
    face.talker.wait()
    second.cancel()
    run(face, 2.5)
    assert third.result(0) is True
    assert told == [("hushed", "Two."), ("spoken", "One."), ("spoken", "Three.")]
    sounds = face.ask(Speak.of([("aa", 0.0, 0.3)])), face.ask(Speak.of([("PP", 0.0, 0.3)])), face.ask(Say("Six."))
    sounds[2].cancel()
    face.step(0.01)
    sounds[1].cancel()
    run(face, 0.4)
    assert sounds[0].result(0) is True
    assert face.channels.speech.status is None
    run(face, 1.0)
    assert len(told) == 3


def test_phones_that_are_taken_back_while_they_wait_are_not_replayed(face):
    noted, phones = [], [("PP", 0.0, 0.3)]
    face.noted.append(lambda request: noted.append((0.0, request)))
    face.speak([("aa", 0.0, 0.3)])
    kept, taken = face.ask(Speak.of(phones)), face.ask(Speak.of(phones))
    face.step(0.01)
    taken.cancel()
    face.step(0.01)
    with talking_face() as again:
        Replay(again, noted, 60.0).take_in(0.0)
        for each in (face, again):
            assert each.channels.speech.status["waiting"] == 2, "one of them is passed over when its turn comes"
            run(each, 0.75)
            assert each.channels.speech.status is None
    assert kept.result(0) is True
    assert noted[-1][1] == TakeBack(Speak.of(phones))


def test_every_blink_is_told_once_with_how_far_it_closes():
    for liveliness in (0.0, 1.0):  # lively, one eye is late
        with talking_face(liveliness=liveliness) as face:
            blinks = []
            face.channels.life.set_state("thinking")
            face.on("blink", blinks.append)
            face.channels.blink.blink()
            face.channels.blink.blink(BlinkShape(0.5), in_s=0.5)
            run(face, 0.4)
            assert blinks == [1.0]
            run(face, 0.3)
            assert blinks == [1.0, 0.5]


def test_it_is_told_when_the_emotions_are_where_they_go(face):
    reached = []
    face.on("reached", reached.append)
    face.set_emotion("happiness", 0.8, fade=0.5)
    run(face, 0.4)
    assert reached == []
    run(face, 0.2)
    assert [dict(state.as_dict())["happiness"] for state in reached] == [0.8]
    run(face, 1.0)
    face.set_emotion("fear", 0.5, fade=0.2)
    face.set_emotion("fear", 0.7, fade=0.2)
    run(face, 1.0)
    assert [state["fear"] for state in reached] == [0.0, 0.7]


@pytest.mark.parametrize("request_", [Say("One. Two."), Speak.of([("aa", 0.0, 2.0)])], ids=["say", "speak"])
def test_cancelled_while_it_is_said_it_is_hushed(face, request_):
    noted = []
    asked = face.ask(request_)
    face.step(0.01)
    face.talker.wait()
    run(face, 0.5)
    face.noted.append(noted.append)
    asked.cancel()
    face.step(0.01)
    assert noted == [Hush()]
    run(face, 0.2)
    assert face.channels.speech.status is None
    assert face.talker.texts == ()


def test_a_cancelled_performance_lets_go(face):
    asked = face.ask(Play(performance(5.0)))
    run(face, 0.5)
    assert face.channels.performance.time_s is not None
    asked.cancel()
    run(face, 1.0)
    assert not face.channels.performance.playing


def test_closing_tells_those_who_wait(face):
    waiting = face.ask(Say("One.")), face.ask(Neutral())
    face.step(0.01)
    late = face.ask(Neutral())
    face.close()
    after = face.ask(Neutral())
    assert waiting[1].result(0) is True
    assert [future.result(0) for future in (waiting[0], late, after)] == [False] * 3


def test_many_threads_ask_and_nothing_is_lost(face):
    futures, lock = [], threading.Lock()

    def ask(number):
        for turn in range(50):
            asked = face.ask(SetEmotion("joy", (number + turn) / 100, 0.0))
            with lock:
                futures.append(asked)

    noted = []
    face.noted.append(noted.append)
    threads = [threading.Thread(target=ask, args=(number,)) for number in range(8)]
    for thread in threads:
        thread.start()
    while any(thread.is_alive() for thread in threads):
        face.step(0.01)
    face.step(0.01)
    assert len(futures) == len(noted) == 400
    assert all(future.result(0) for future in futures)


@pytest.mark.slow
@pytest.mark.untraced
@given(st.lists(st.sampled_from(["say", "hush", "gesture", "play", "step", "cancel", "interrupt"]), max_size=25))
def test_whatever_happens_each_future_is_resolved_once_and_each_text_told_once(script):
    with talking_face() as face:
        told, futures = [], []
        for name in ("spoken", "hushed", "failed"):
            face.on(name, told.append)
        for number, action in enumerate(script):
            if action in ("say", "interrupt"):
                futures.append(face.ask(Say(f"Number {number}.", interrupt=action == "interrupt")))
                face.step(0.0)
                face.talker.wait()
            elif action == "gesture":
                futures.append(face.ask(Gesture("nod")))
            elif action == "play":
                futures.append(face.ask(Play(performance(0.3))))
            elif action == "cancel" and futures:
                futures[number % len(futures)].cancel()
            elif action == "hush":
                face.hush()
            face.step(0.4)
        run(face, 2.0 + 1.2 * len(script), dt=0.2)
        asked = [f"Number {n}." for n, action in enumerate(script) if action in ("say", "interrupt")]
        assert sorted(told) == sorted(asked)
        assert all(future.done() for future in futures)
        assert face._events._going == []


def test_a_face_that_is_dropped_is_gone_whoever_listens():
    face = talking_face()
    face.on("spoken", print)
    face.say("One.")
    future = face.ask(Neutral())
    watched = weakref.ref(face)
    face.talker.close()
    del face
    gc.collect()
    assert watched() is None
    assert not future.done()
