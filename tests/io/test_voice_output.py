from __future__ import annotations

import threading

import numpy as np
import pytest

from agentface.errors import SpeechError
from agentface.io.loudspeaker import BUFFER_S
from agentface.io.voice_output import VoiceOutput
from agentface.speech.sound import Sound
from tests.waiting import until

SOUND = Sound(np.ones(800, np.int16), 8000)


class Talker:
    def __init__(self):
        self.heard, self.hushed, self.latency_s = [], [], 0.0

    def say(self, in_s=0.0):
        for tell in self.heard:
            tell(SOUND, in_s)


class Device:
    def __init__(self):
        self.played, self.hushes, self.closed = [], 0, False

    def play(self, sound, in_s):
        self.played.append((sound, in_s))

    def hush(self):
        self.hushes += 1

    def close(self):
        self.closed = True


class Clock:
    time_s = 10.0

    def now(self):
        return self.time_s


def test_the_device_is_opened_with_the_first_sentence_which_is_then_heard_in_its_time():
    talker, device, clock, go = Talker(), Device(), Clock(), threading.Event()

    def opened():
        assert go.wait(200)
        return device

    with VoiceOutput(talker, pytest.fail, opened, clock):
        assert talker.latency_s == BUFFER_S
        talker.say(0.25)
        talker.say(1.25)
        assert not device.played, "the face does not wait"
        clock.time_s = 10.5
        go.set()
        until(lambda: len(device.played) == 2)
        assert [in_s for _, in_s in device.played] == [pytest.approx(-0.25), pytest.approx(0.75)]
        talker.say(0.5)
        assert device.played[-1] == (SOUND, 0.5)
        for hush in talker.hushed:
            hush()
        assert device.hushes == 1
    assert device.closed
    assert (talker.heard, talker.hushed, talker.latency_s) == ([], [], 0.0)


def test_what_is_hushed_before_the_device_is_there_is_never_heard():
    talker, device, go = Talker(), Device(), threading.Event()
    with VoiceOutput(talker, pytest.fail, lambda: go.wait(200) and device):
        talker.say()
        for hush in talker.hushed:
            hush()
        go.set()
        talker.say()
        until(lambda: device.played)
        assert len(device.played) == 1


def test_without_a_device_it_is_told_once_and_silent():
    talker, told = Talker(), []

    def opened():
        raise SpeechError("no device")

    with VoiceOutput(talker, told.append, opened) as output:
        for _ in range(3):
            talker.say()
        until(lambda: told)
        talker.say()
        output.close()
    assert told == ["no device"]


def test_a_device_is_not_opened_for_a_face_that_says_nothing():
    with VoiceOutput(Talker(), pytest.fail, lambda: pytest.fail("opened")):
        pass
