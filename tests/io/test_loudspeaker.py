from __future__ import annotations

import os
import sys
import types
from enum import Enum

import numpy as np
import pytest

from agentface.errors import SpeechError
from agentface.io.loudspeaker import Loudspeaker
from agentface.speech.sound import Sound
from tests.waiting import until

RATE = 48_000


class FakeDevice:
    """A device that plays when it is told to."""

    def __init__(self, **options):
        self.options, self.stream, self.closed = options, None, False

    def start(self, stream):
        self.stream = stream

    def close(self):
        self.closed = True

    def heard(self, count):
        return np.frombuffer(self.stream.send(count), np.int16)


@pytest.fixture
def device(monkeypatch):
    made = []

    def make(**options):
        made.append(FakeDevice(**options))
        return made[-1]

    backends = Enum("Backend", ["ALSA", "PULSEAUDIO", "NULL", "CUSTOM"])
    formats = Enum("SampleFormat", ["SIGNED16"])
    fake = types.SimpleNamespace(PlaybackDevice=make, Backend=backends, SampleFormat=formats)
    monkeypatch.setitem(sys.modules, "miniaudio", fake)
    return made


def constant(level, seconds, rate=RATE):
    return Sound(np.full(round(seconds * rate), level, np.int16), rate)


def test_sounds_begin_in_their_time_and_add_up(device):
    with Loudspeaker() as speaker:
        play = device[0].heard
        assert not play(480).any()
        assert not speaker.busy
        speaker.play(constant(1000, 0.02), 0.01)
        speaker.play(constant(500, 0.01), 0.02)
        assert speaker.busy
        heard = np.concatenate([play(100) for _ in range(20)])
        expected = np.zeros(2000)
        expected[480:1440] += 1000
        expected[960:1440] += 500
        assert (heard == expected).all()
        assert not speaker.busy
        for _ in range(2):
            speaker.play(constant(30_000, 0.01))
        assert play(480).max() == 32767
    assert device[0].closed
    speaker.close()


def test_a_sound_that_has_begun_is_heard_from_there_on(device):
    ramp = Sound(np.arange(9600, dtype=np.int16), RATE)
    with Loudspeaker() as speaker:
        speaker.play(ramp, -0.1)
        assert (device[0].heard(4800) == np.arange(4800, 9600)).all()
        assert not device[0].heard(10).any()


def test_any_rate_is_heard_as_it_is(device):
    tone = (10_000 * np.sin(2 * np.pi * 440 * np.arange(16_000) / 16_000)).astype(np.int16)
    with Loudspeaker() as speaker:
        speaker.play(Sound(tone, 16_000))
        heard = device[0].heard(RATE)
    assert np.argmax(np.abs(np.fft.rfft(heard))) == 440
    assert np.abs(heard).max() == pytest.approx(10_000, rel=0.05)


def test_hush_fades_what_is_heard_and_drops_what_waits(device):
    with Loudspeaker() as speaker:
        speaker.play(constant(10_000, 10.0))
        speaker.play(constant(10_000, 10.0), 5.0)
        device[0].heard(4800)
        speaker.hush()
        heard = device[0].heard(RATE).astype(int)
        assert heard[0] > 9_900
        assert np.diff(heard).max() <= 0
        assert not heard[960:].any()
        assert np.abs(np.diff(heard)).max() < 100, "no click"
        assert not speaker.busy


def test_the_void_is_no_device(device):
    Loudspeaker().close()
    assert [kind.name for kind in device[0].options["backends"]] == ["ALSA", "PULSEAUDIO"]


def test_what_is_missing_is_one_error(monkeypatch, capfd):
    def broken(**_options):
        raise RuntimeError("failed to init device", -401)

    fake = types.SimpleNamespace(
        PlaybackDevice=broken, Backend=Enum("Backend", ["ALSA"]), SampleFormat=Enum("SampleFormat", ["SIGNED16"])
    )
    monkeypatch.setitem(sys.modules, "miniaudio", fake)
    with pytest.raises(SpeechError, match=r"a sound device, got none.*failed to init device"):
        Loudspeaker()
    monkeypatch.setitem(sys.modules, "miniaudio", None)
    with pytest.raises(SpeechError, match=r'pip install "agentface\[sound\]"'):
        Loudspeaker()
    os.write(2, b"here\n")
    assert capfd.readouterr().err == "here\n"


def test_the_library_plays(capfd):
    pytest.importorskip("miniaudio")
    with Loudspeaker("NULL") as speaker:
        speaker.play(constant(1000, 0.05))
        until(lambda: not speaker.busy)
    try:
        Loudspeaker().close()
    except SpeechError as error:
        assert "device" in str(error)  # noqa: PT017 - a machine with a device has none
    assert capfd.readouterr().err == ""
