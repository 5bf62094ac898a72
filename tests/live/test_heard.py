"""What a film that is drawn while the face runs has for its sound."""

from __future__ import annotations

import threading

import numpy as np
import pytest

from agentface.live.heard import LiveSound
from agentface.live.loop import Frame
from agentface.speech.sound import Sound

RATE = 8000
HALF = Sound(np.full(RATE // 2, 1000, np.int16), RATE)


class Talker:
    def __init__(self):
        self.heard, self.hushed, self.latency_s, self.now_s = [], [], 0.0, 5.0

    def say(self, sound, in_s=0.0):
        for tell in self.heard:
            tell(sound, in_s)

    def hush(self):
        for tell in self.hushed:
            tell()


class Speaking:
    def __init__(self):
        self.talker = Talker()

    def step(self, sound, time_s, dt):
        self.talker.now_s += dt
        sound.show(Frame(time_s, dt, None, None))


@pytest.fixture
def face():
    return Speaking()


def begins(samples):
    return np.flatnonzero(samples)[0] / RATE


def test_a_sentence_is_heard_from_the_moment_that_it_is_told_in_the_midst_of_a_frame(face):
    with LiveSound(face, RATE) as sound:
        face.step(sound, 0.0, 0.0)
        face.step(sound, 1.0, 1.0)
        face.talker.now_s += 0.025
        face.talker.say(HALF, 0.2)
        whole = np.concatenate([sound.part(first, 1000) for first in range(0, 2 * RATE, 1000)])
    assert begins(whole) == pytest.approx(1.225, abs=1 / RATE)
    assert np.count_nonzero(whole) == RATE // 2
    assert not face.talker.heard
    assert not face.talker.hushed


def test_before_the_first_frame_the_loop_is_at_its_beginning(face):
    with LiveSound(face, RATE) as sound:
        face.talker.say(HALF, 0.1)
        assert begins(sound.part(0, RATE)) == pytest.approx(0.1, abs=1 / RATE)


def test_what_a_device_plays_late_is_heard_when_the_mouth_shows_it(face):
    with LiveSound(face, RATE) as sound:
        face.talker.latency_s = 0.25
        face.talker.say(HALF, -0.25)
        assert begins(sound.part(0, RATE) + 0) == 0.0
        face.talker.say(HALF, 0.75)
        later = sound.part(RATE // 2, RATE)
    assert begins(later) == pytest.approx(0.5, abs=1 / RATE)


def test_it_is_cut_where_the_face_is_hushed_and_what_waits_is_not_heard(face):
    with LiveSound(face, RATE) as sound:
        face.talker.say(HALF, 0.0)
        face.talker.say(HALF, 0.5)
        face.step(sound, 0.3, 0.3)
        face.talker.hush()
        samples = sound.part(0, 2 * RATE)
    assert np.flatnonzero(samples)[-1] / RATE == pytest.approx(0.3, abs=2e-3)


def test_it_has_the_film_s_rate_and_two_at_once_add_up(face):
    with LiveSound(face, 2 * RATE) as sound:
        for _ in range(40):
            face.talker.say(HALF)
        samples = sound.part(0, 2 * RATE)
    assert samples.dtype == np.int16
    assert samples[RATE // 2] == 32767
    assert np.count_nonzero(samples) == pytest.approx(RATE, abs=200)


def test_another_thread_may_draw_meanwhile(face):
    found = []
    with LiveSound(face, RATE) as sound:
        drawing = threading.Thread(target=lambda: [found.append(sound.part(80 * k, 80)) for k in range(400)])
        drawing.start()
        for k in range(200):
            face.talker.say(HALF, 0.01 * k)
        drawing.join()
    assert sum(map(len, found)) == 32000
