"""Sound and text go in, pictures and sound come out: nothing is lost, nothing is late, the lips close in time."""

from __future__ import annotations

import asyncio
import re
import sys
import threading
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from agentface.agents import SegmentEnd, SoundPiece, VideoFrame
from agentface.errors import InvalidValueError, SpeechError, UnknownNameError
from agentface.requests import SetEmotion
from agentface.speech.voices.flite import Flite
from tests.agents.speaking import FPS, ends_of, frames_of, noise, sound_of, speaker_of, take, take_all
from tests.clocks import ManualClock
from tests.tools import require
from tests.voices import RATE, FakeVoice, talking_face

pytest.importorskip("pocketsphinx")
SLOT = 16_000 // FPS


@pytest.fixture(scope="module")
def face():
    with talking_face() as made:
        yield made


@pytest.fixture
def speaker(face):
    with speaker_of(face) as made:
        yield made


@pytest.fixture(scope="module")
def spoken():
    require("flite")
    return Flite().speak("My mother bought a bumper map of Bombay.")


@settings(max_examples=8, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(cuts=st.lists(st.integers(0, 12_000), max_size=6), pulls=st.integers(0, 4))
def test_every_sample_comes_out_once_however_it_goes_in(face, cuts, pulls):
    sound = noise(0.75)
    edges = [0, *sorted(cuts), len(sound)]
    pieces = []
    with speaker_of(face) as speaker:
        for first, last in pairwise(edges):
            speaker.push_sound(sound[first:last], 16_000)
            pieces += take(speaker, pulls)
        speaker.end_segment()
        pieces += take_all(speaker)
    assert np.array_equal(sound_of(pieces), sound)
    assert [end.text for end in ends_of(pieces)] == [None]


def test_frames_stand_on_a_grid_and_sound_begins_with_its_frame(speaker):
    take(speaker, 3)
    speaker.push_sound(noise(1.0).tobytes(), 16_000)
    speaker.end_segment()
    pieces = take_all(speaker)
    times = [frame.time_s for frame in frames_of(pieces)]
    assert times == pytest.approx([(3 + number) / FPS for number in range(len(times))])
    sounds = [piece for piece in pieces if isinstance(piece, SoundPiece)]
    before = {id(sound): pieces[place - 1] for place, sound in enumerate(pieces) if isinstance(sound, SoundPiece)}
    assert all(before[id(sound)].time_s == pytest.approx(sound.time_s) for sound in sounds)
    assert pieces[-1] == SegmentEnd(pytest.approx(sounds[-1].time_s + sounds[-1].duration_s))
    assert sum(sound.duration_s for sound in sounds) == pytest.approx(1.0)


def test_sound_of_any_rate_and_channels_comes_out_as_one_of_ours(face):
    times = np.arange(44_100) / 44_100
    tone = (8000 * np.sin(2 * np.pi * 440 * times)).astype(np.int16)
    both = np.repeat(tone, 2)  # left and right the same
    with speaker_of(face, rate_hz=24_000) as speaker:
        for first in range(0, len(both), 882):
            speaker.push_sound(both[first : first + 882].tobytes(), 44_100, 2)
        speaker.end_segment()
        heard = sound_of(take_all(speaker))
    assert len(heard) == 24_000
    expected = 8000 * np.sin(2 * np.pi * 440 * np.arange(24_000) / 24_000)
    assert np.abs(heard - expected)[2400:-2400].max() < 4


@pytest.mark.parametrize("delay", [0.1, 0.2, 0.4])
def test_live_sound_leaves_after_its_delay_and_no_later(face, delay):
    """A frame's worth of sound comes with every frame: as fast as it is heard."""
    sound = noise(2.0)
    came, left = {}, {}
    with speaker_of(face, delay_s=delay) as speaker:
        take(speaker, 5)
        for number in range(len(sound) // SLOT + 30):
            if number * SLOT < len(sound):
                speaker.push_sound(sound[number * SLOT : (number + 1) * SLOT], 16_000)
                came[number] = number
            for piece in speaker.take():
                if isinstance(piece, SoundPiece):
                    left[len(left)] = number
        speaker.clear()
    assert len(left) == len(came)
    waits = [(left[number] - came[number]) / FPS for number in came]
    # it is the newest sound that the delay counts from, and a frame's worth goes at once
    assert min(waits) >= delay - 1 / FPS - 1e-9
    assert max(waits) <= delay + 0.1 + 1 / FPS + 1e-9


def test_sound_that_came_early_leaves_at_once(speaker):
    take(speaker, 1)
    speaker.push_sound(noise(1.0), 16_000)
    assert len(sound_of(speaker.take())) == SLOT


def test_sound_that_dries_up_goes_to_its_end_and_goes_on(speaker):
    sound = noise(1.0)
    speaker.push_sound(sound[:8100], 16_000)
    first = take(speaker, 40)
    assert np.array_equal(sound_of(first), sound[:8100])
    assert ends_of(first) == []
    assert speaker.busy
    speaker.push_sound(sound[8100:], 16_000)
    speaker.end_segment()
    rest = take_all(speaker)
    assert np.array_equal(sound_of(rest), sound[8100:])
    assert len(ends_of(rest)) == 1


def seals(pieces):
    """By the time of the sound that is heard, how far the lips are sealed."""
    began = next(piece.time_s for piece in pieces if isinstance(piece, SoundPiece))
    return [(frame.time_s - began, frame.pose["lip_seal"]) for frame in frames_of(pieces)]


def share_of_labials_shut(pieces, phones):
    shut = seals(pieces)
    labials = [phone for phone in phones if phone.symbol in ("p", "b", "m")]
    near = 0.5 / FPS
    closed = [
        any(seal > 0.5 for time, seal in shut if phone.start_s - near <= time <= phone.end_s + near)
        for phone in labials
    ]
    assert len(closed) >= 8
    return sum(closed) / len(closed)


def said(face, sound, words=(), live=False):
    """What comes out of a recording, pushed at once, or as fast as it is heard."""
    with speaker_of(face) as speaker:
        pieces = take(speaker, 1)
        if words:
            speaker.push_words(words)
        step = SLOT if live else len(sound.samples)
        for first in range(0, len(sound.samples), step):
            speaker.push_sound(sound.samples[first : first + step], sound.rate_hz)
            pieces += speaker.take() if live else []
        speaker.end_segment()
        return pieces + take_all(speaker)


@pytest.mark.parametrize("live", [False, True])
def test_lips_close_in_time_by_ear(face, spoken, live):
    pieces = said(face, spoken.sound, live=live)
    assert share_of_labials_shut(pieces, spoken.phones) >= 0.8
    vowels = [phone for phone in spoken.phones if phone.symbol in ("aa", "ae", "ah", "ay", "ao")]
    open_at = [seal for time, seal in seals(pieces) if any(v.start_s + 0.04 < time < v.end_s - 0.04 for v in vowels)]
    assert np.mean(open_at) < 0.15


def test_words_with_times_move_the_mouth_more_surely(face, spoken):
    text = "My mother bought a bumper map of Bombay."
    places = [word.start() for word in re.finditer(r"\S+", text)]
    starts = Flite().speak(text, marks=places).marks_s
    words = [(word, start) for word, start in zip(text.split(), starts, strict=True)]
    assert share_of_labials_shut(said(face, spoken.sound, words), spoken.phones) >= 0.85


def test_words_alone_tell_a_sound_without_speech(face):
    """The sound is a hum: all that the mouth knows are the words."""
    hum = (1000 * np.sin(np.arange(32_000) / 20)).astype(np.int16)
    with speaker_of(face) as speaker:
        speaker.push_words([("mama", 0.5, 1.0)])
        speaker.push_sound(hum, 16_000)
        speaker.end_segment()
        pieces = take_all(speaker)
    shut = [time for time, seal in seals(pieces) if seal > 0.5]
    assert shut
    assert min(shut) > 0.35
    assert any(0.45 < time < 0.65 for time in shut)


def test_silence_leaves_the_lips_apart(face):
    with speaker_of(face) as speaker:
        speaker.push_sound(np.zeros(16_000, np.int16), 16_000)
        speaker.end_segment()
        pieces = take_all(speaker)
    assert max(seal for _, seal in seals(pieces)) < 0.05


def test_clear_ends_it_at_once(speaker, spoken):
    take(speaker, 1)
    speaker.push_sound(spoken.sound.samples, 16_000)
    speaker.end_segment()
    speaker.push_sound(noise(0.2), 16_000)
    take(speaker, 12)
    speaker.clear()
    assert not speaker.busy
    after = take(speaker, 12)
    assert len(sound_of(after)) == 0
    assert ends_of(after) == []
    assert after[-1].pose["jaw_open"] == pytest.approx(0.0, abs=0.01)
    fresh = noise(0.2, seed=1)
    speaker.push_sound(fresh, 16_000)
    speaker.end_segment()
    assert np.array_equal(sound_of(take_all(speaker)), fresh)


def test_a_text_is_said_with_the_face_s_voice(face):
    voice = FakeVoice()
    with talking_face(voice) as other, speaker_of(other, rate_hz=RATE) as speaker:
        speaker.say("[joy] One. Two.")
        pieces = take(speaker, 1)
        other.talker.wait()
        pieces += take_all(speaker)
    heard = sound_of(pieces)
    assert np.trim_zeros(heard).tolist() == [ord("O")] * RATE + [ord("T")] * RATE
    assert ends_of(pieces) == [SegmentEnd(pytest.approx(ends_of(pieces)[0].time_s), "[joy] One. Two.")]
    assert max(frame.pose["zygomaticus_major_l"] for frame in frames_of(pieces)) > 0.2


def test_texts_and_sounds_are_said_in_their_turn(face):
    voice, sound = FakeVoice(), noise(0.5, RATE)
    with talking_face(voice) as other, speaker_of(other, rate_hz=RATE) as speaker:
        speaker.say("One.")
        speaker.push_sound(sound, RATE)
        speaker.say("Bad.")  # ends the sound
        speaker.say("Two.")
        pieces = take(speaker, 1)
        other.talker.wait()
        while speaker.busy:
            pieces += speaker.take()
            other.talker.wait()
    assert [end.text for end in ends_of(pieces)] == ["One.", None, "Bad.", "Two."]
    assert [type(end.error) for end in ends_of(pieces)] == [type(None), type(None), SpeechError, type(None)]
    heard = sound_of(pieces)
    assert np.array_equal(heard[heard != 0], np.concatenate([np.full(RATE, 79), sound[sound != 0], np.full(RATE, 84)]))


def test_who_is_late_gets_fewer_frames_and_all_of_the_sound(face):
    clock, sound = ManualClock(), noise(2.0)
    with speaker_of(face, clock=clock, ahead_s=0.0) as speaker:
        take(speaker, 1)
        speaker.push_sound(sound, 16_000)
        speaker.end_segment()
        clock.sleep(0.3)
        pieces = speaker.take()
        assert len(frames_of(pieces)) == 1
        assert pieces[-2].time_s == pytest.approx(7 / FPS)
        assert len(sound_of(pieces)) == 7 * SLOT
        clock.sleep(60.0)  # nobody asked: nothing was missed
        pieces += speaker.take()
        assert len(sound_of(pieces)) == 8 * SLOT
        pieces += take_all(speaker)
    assert np.array_equal(sound_of(pieces), sound)


def test_sound_is_given_out_ahead_of_its_time(face):
    clock = ManualClock()
    with speaker_of(face, clock=clock, ahead_s=0.2) as speaker:
        take(speaker, 10)
        idle = clock.now()
        assert idle == pytest.approx(9 / FPS)
        speaker.push_sound(noise(3.0), 16_000)
        speaker.end_segment()
        take(speaker, 6)
        assert clock.now() == pytest.approx(idle + 1 / FPS)
        take(speaker, 10)
        assert clock.now() == pytest.approx(idle + 11 / FPS)


def test_the_same_calls_give_the_same_frames(face, spoken):
    both = []
    for _ in range(2):
        face.hush()
        face.step(10.0)
        both.append(said(face, spoken.sound))
    first, second = both
    assert np.array_equal(sound_of(first), sound_of(second))
    assert np.array(seals(first)) == pytest.approx(np.array(seals(second)), abs=1e-6)


def test_the_face_is_asked_beside(speaker):
    asked = speaker.face.ask(SetEmotion("happiness", 0.9, 0.0))
    pieces = take(speaker, 2)
    assert asked.result(0) is True
    assert frames_of(pieces)[-1].pose["zygomaticus_major_l"] > 0.3
    speaker.face.ask(SetEmotion("neutral", 1.0, 0.0))
    take(speaker, 1)


def test_asyncio_gets_the_same_until_it_is_closed(face):
    sound = noise(0.5)

    async def run():
        pieces = []
        speaker = speaker_of(face)
        speaker.push_sound(sound, 16_000)
        speaker.end_segment()
        async for piece in speaker:
            pieces.append(piece)
            if isinstance(piece, SegmentEnd):
                await asyncio.to_thread(speaker.close)
        return pieces

    pieces = asyncio.run(run())
    assert np.array_equal(sound_of(pieces), sound)
    assert isinstance(pieces[0], VideoFrame)


def test_several_threads_may_push(speaker):
    def push():
        for _ in range(50):
            speaker.push_sound(np.full(160, 7, np.int16), 16_000)

    threads = [threading.Thread(target=push) for _ in range(4)]
    for thread in threads:
        thread.start()
    pieces = take(speaker, 10)
    for thread in threads:
        thread.join()
    speaker.end_segment()
    pieces += take_all(speaker)
    assert sound_of(pieces).tolist() == [7] * 32_000


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        ((b"abc", 16_000), "sound"),
        (("text", 16_000), "sound"),
        ((np.zeros(10, np.float32), 16_000), "samples"),
        ((np.zeros((2, 5), np.int16), 16_000), "samples"),
        ((np.zeros(3, np.int16), 16_000, 2), "samples"),
        ((b"ab", 100), "rate"),
        ((b"ab", 16_000.0), "rate"),
        ((b"ab", 16_000, 0), "channels"),
    ],
)
def test_what_is_no_sound_is_refused_and_changes_nothing(speaker, arguments, told):
    sound = noise(0.2)
    speaker.push_sound(sound, 16_000)
    with pytest.raises(InvalidValueError, match=told):
        speaker.push_sound(*arguments)
    speaker.end_segment()
    assert np.array_equal(sound_of(take_all(speaker)), sound)


def test_what_waits_is_bounded(speaker):
    def often(push, times):
        for _ in range(times):
            push()

    minute, words = np.zeros(16_000 * 60, np.int16), [("word", 1.0)] * 1000
    with pytest.raises(InvalidValueError, match="600 s"):
        often(lambda: speaker.push_sound(minute, 16_000), 12)
    speaker.clear()
    with pytest.raises(InvalidValueError, match="at most 64"):
        often(lambda: speaker.say("Hello."), 65)
    speaker.clear()
    with pytest.raises(InvalidValueError, match="at most 5000"):
        often(lambda: speaker.push_words(words), 6)
    speaker.clear()


@pytest.mark.parametrize(
    "words", [[("word",)], ["word"], [("word", -1.0)], [("word", 2.0, 1.0)], [("word", "now")], [5]]
)
def test_what_is_no_word_is_refused(speaker, words):
    with pytest.raises(InvalidValueError):
        speaker.push_words(words)
    assert not speaker.busy


def test_wrong_options_and_texts_are_told(face, speaker):
    for options in ({"fps": 0}, {"rate_hz": 10}, {"delay_s": 0.0}, {"delay_s": 5}, {"ahead_s": -1}):
        with pytest.raises(InvalidValueError):
            speaker_of(face, **options)
    with pytest.raises(InvalidValueError):
        speaker.say("")
    with pytest.raises(UnknownNameError):
        speaker.say("Hello", voice="nobody")


def test_a_closed_speaker_lets_go_of_its_face(face):
    speaker = speaker_of(face)
    heard = len(face.talker.heard)
    speaker.close()
    speaker.close()
    assert len(face.talker.heard) == heard - 1
    assert face.talker.latency_s == 0.0
    with pytest.raises(InvalidValueError, match="closed"):
        speaker.take()


def test_without_pocketsphinx_one_error_names_its_extra(speaker, monkeypatch):
    monkeypatch.setitem(sys.modules, "pocketsphinx", None)
    with pytest.raises(SpeechError, match=r'pip install "agentface\[speech\]"'):
        speaker.push_sound(b"ab", 16_000)
