from __future__ import annotations

import os
import subprocess
import sys
import wave
from pathlib import Path

import numpy as np
import pytest

from agentface.errors import DataError, InvalidValueError, OutputError
from agentface.io import sound as reading
from agentface.io.sound import read_sound, write_wav
from agentface.io.video import VideoWriter
from agentface.speech.sound import Sound, mixed

RATE = 16_000
SIZE = (64, 48)


def tone(seconds: float, rate: int = RATE, hz: float = 440.0) -> np.ndarray:
    return (12_000 * np.sin(2 * np.pi * hz * np.arange(round(seconds * rate)) / rate)).astype(np.int16)


def click(at_s: float, seconds: float, rate: int = RATE) -> Sound:
    samples = np.zeros(round(seconds * rate), np.int16)
    samples[round(at_s * rate) :][: rate // 50] = tone(0.02, rate, 1000.0)
    return Sound(samples, rate)


def onset(samples: np.ndarray, rate: int) -> float:
    """When it is first louder than a tenth of its loudest."""
    loud = np.abs(samples.astype(np.float64))
    return float(np.argmax(loud > 0.1 * loud.max())) / rate


def pitch(sound: Sound) -> float:
    spectrum = np.abs(np.fft.rfft(sound.samples))
    return float(np.argmax(spectrum)) * sound.rate_hz / len(sound.samples)


def wav(path: Path, samples: np.ndarray, rate: int, channels: int = 1, width: int = 2) -> Path:
    with wave.open(str(path), "wb") as file:
        file.setnchannels(channels)
        file.setsampwidth(width)
        file.setframerate(rate)
        file.writeframes(samples.tobytes())
    return path


def test_what_is_written_is_read_again(tmp_path):
    sound = Sound(np.random.default_rng(3).integers(-32768, 32767, 5000, np.int16), RATE)
    write_wav(tmp_path / "a.wav", sound)
    assert read_sound(tmp_path / "a.wav") == sound
    with pytest.raises(OutputError):
        write_wav(tmp_path / "no" / "a.wav", sound)


@pytest.mark.parametrize("rate", [8000, 11025, 22050, 44100, 48000, 96000])
def test_any_rate_becomes_the_one_that_is_asked_for(rate, tmp_path):
    sound = read_sound(wav(tmp_path / "a.wav", tone(1.0, rate), rate))
    assert sound.rate_hz == RATE
    assert sound.duration_s == pytest.approx(1.0, abs=0.005)
    assert pitch(sound) == pytest.approx(440.0, abs=1.0)


def test_channels_are_mixed_and_other_widths_are_read(tmp_path):
    left = np.stack([tone(0.5), np.zeros(RATE // 2, np.int16)], axis=1)
    stereo = read_sound(wav(tmp_path / "a.wav", left, RATE, channels=2))
    assert np.abs(stereo.samples).max() == pytest.approx(6_000, rel=0.2)
    eight = read_sound(wav(tmp_path / "b.wav", (128 + tone(0.5) // 256).astype(np.uint8), RATE, width=1))
    assert pitch(eight) == pytest.approx(440.0, abs=2.0)


def test_compressed_sound_and_the_sound_of_a_film(tmp_path):
    import av

    for name, codec in (("a.mp3", "mp3"), ("a.ogg", "libopus"), ("a.flac", "flac")):
        with av.open(str(tmp_path / name), "w") as file:
            stream = file.add_stream(codec, rate=RATE)
            stream.layout = "mono"
            frame = av.AudioFrame.from_ndarray(tone(1.0)[None], format="s16", layout="mono")
            frame.sample_rate = RATE
            for packet in (*stream.encode(frame), *stream.encode(None)):
                file.mux(packet)
        sound = read_sound(tmp_path / name)
        assert pitch(sound) == pytest.approx(440.0, abs=1.0)
        assert sound.duration_s == pytest.approx(1.0, abs=0.1)
    film(tmp_path / "a.mp4", Sound(tone(1.0), RATE), 30, 1.0)
    assert pitch(read_sound(tmp_path / "a.mp4")) == pytest.approx(440.0, abs=1.0)


@pytest.mark.parametrize(
    ("name", "content"),
    [
        ("empty.wav", b""),
        ("text.wav", b"hello, here is no sound\n" * 100),
        ("noise.mp3", b"\x00\xffID3" + bytes(range(256)) * 3),
        ("cut.wav", b"RIFF\x00\x00\x00\x00WAVEfmt "),
        ("list.m3u8", b"#EXTM3U\n#EXT-X-TARGETDURATION:1\n#EXTINF:1,\na.wav\n#EXT-X-ENDLIST\n"),
        ("list.wav", b"ffconcat version 1.0\nfile a.wav\n"),
    ],
)
def test_what_is_no_sound_is_one_error(name, content, tmp_path):
    wav(tmp_path / "a.wav", tone(1.0), RATE)
    (tmp_path / name).write_bytes(content)
    with pytest.raises(DataError, match=name):
        read_sound(tmp_path / name)


def test_missing_silent_and_endless_files(tmp_path, monkeypatch):
    for path in (tmp_path / "none.wav", tmp_path):
        with pytest.raises(DataError, match="a sound file"):
            read_sound(path)
    film(tmp_path / "mute.mp4", None, 30, 0.2)
    with pytest.raises(DataError, match="one without"):
        read_sound(tmp_path / "mute.mp4")
    with pytest.raises(DataError, match="an empty one"):
        read_sound(wav(tmp_path / "a.wav", np.zeros(0, np.int16), RATE))
    monkeypatch.setattr(reading, "LONGEST_S", 0.5)
    with pytest.raises(DataError, match=r"at most 0\.5 s"):
        read_sound(wav(tmp_path / "b.wav", tone(0.6), RATE))


def test_what_is_no_sound_is_refused():
    for samples, rate in ((tone(1.0)[None], RATE), (tone(1.0).astype(float), RATE), (tone(1.0), 0), (tone(1.0), 16e3)):
        with pytest.raises(InvalidValueError, match="sound"):
            Sound(samples, rate)
    with pytest.raises(InvalidValueError, match="3600 s"):
        Sound(np.zeros(3601 * 4000, np.int16), 4000)
    mutable = tone(0.1)
    sound = Sound(mutable, RATE)
    mutable[:] = 0
    assert np.abs(sound.samples).max() > 10_000


def test_sounds_are_mixed_in_their_time():
    low, high = Sound(np.full(800, 1000, np.int16), 8000), Sound(np.full(1600, 30_000, np.int16), 16_000)
    total = mixed([(0.05, low), (0.1, high), (-0.05, low)], 16_000)
    assert total.duration_s == pytest.approx(0.2)
    assert np.median(total.samples[900:1500]) == pytest.approx(1000, abs=2)
    assert total.samples[1700] == pytest.approx(31_000, rel=0.05)
    assert total.samples[300] == pytest.approx(1000, rel=0.05), "what begins before is heard from there on"
    assert mixed([], RATE).duration_s == 0.0
    assert mixed([(0.0, high)] * 3, RATE).samples.max() == 32767


def test_a_sound_that_is_ended_fades():
    sound = Sound(np.full(16_000, 10_000, np.int16), RATE)
    cut = sound.until(0.5)
    assert cut.duration_s == 0.5
    assert (cut.samples[:7680] == 10_000).all()
    assert np.abs(np.diff(cut.samples.astype(int))).max() < 100
    assert cut.samples[-1] == 0
    assert sound.until(2.0) is sound
    assert sound.until(-1.0).duration_s == 0.0
    assert pitch(Sound(tone(1.0), RATE).at_rate(48_000)) == pytest.approx(440.0, abs=1.0)


def film(
    path: Path, sound: Sound | None, fps: float, seconds: float, *, flash_s: float = 0.0, start: float = 0.0
) -> None:
    with VideoWriter(path, SIZE, fps, sound=sound) as video:
        for frame in range(round(seconds * fps)):
            lit = frame >= round(flash_s * fps)
            video.add(np.full((SIZE[1], SIZE[0], 3), 255 if lit else 0, np.uint8), start + frame / fps)


def heard(path: Path) -> tuple[np.ndarray, int]:
    """The samples of a film as a player hears them: with silence before the first."""
    import av

    with av.open(str(path)) as file:
        frames = list(file.decode(audio=0))
        rate = frames[0].sample_rate
        start = round(float(frames[0].time) * rate)
        return np.concatenate([np.zeros(start), *(frame.to_ndarray()[0] for frame in frames)]), rate


def flash(path: Path) -> float:
    import av

    with av.open(str(path)) as file:
        return next(float(f.time) for f in file.decode(video=0) if f.to_ndarray(format="gray").mean() > 128)


@pytest.mark.parametrize(("rate", "fps"), [(16_000, 30), (22_050, 60), (8_000, 25), (48_000, 24)])
def test_a_film_is_heard_when_it_is_seen(rate, fps, tmp_path):
    path = tmp_path / "a.mp4"
    for at in (0.5, 3.0):
        film(path, click(at, 4.0, rate), fps, 4.0, flash_s=at)
        samples, heard_rate = heard(path)
        assert heard_rate == rate
        assert onset(samples, rate) == pytest.approx(at, abs=0.004)
        assert flash(path) == pytest.approx(at, abs=1.0 / fps)
        assert len(samples) / rate == pytest.approx(4.0, abs=2 * 1024 / rate)


def test_a_sound_ends_with_its_film_and_a_film_goes_on_after_its_sound(tmp_path):
    path = tmp_path / "a.mp4"
    film(path, Sound(tone(3.0), RATE), 30, 1.0)
    samples, _ = heard(path)
    assert len(samples) / RATE == pytest.approx(1.0, abs=0.13)
    film(path, Sound(tone(0.5), RATE), 30, 2.0)
    samples, _ = heard(path)
    assert np.abs(samples[round(0.7 * RATE) :]).max() < 0.01 < np.abs(samples[: round(0.4 * RATE)]).max()
    with pytest.raises(InvalidValueError, match="rate of a film"):
        VideoWriter(path, SIZE, sound=Sound(tone(0.5, 5000), 5000))


KILLED = (
    "import numpy as np, os, sys; from agentface.io.video import VideoWriter\n"
    "from agentface.speech.sound import Sound\n"
    f"video = VideoWriter(sys.argv[1], {SIZE}, 30, sound=Sound(np.full(8000, 9999, np.int16), {RATE}))\n"
    f"for i in range(120): video.add(np.full(({SIZE[1]}, {SIZE[0]}, 3), i, np.uint8), i / 30)\n"
    "os._exit(9)"
)


def test_a_killed_film_with_sound_plays_up_to_there(tmp_path):
    import av

    path = tmp_path / "a.mp4"
    subprocess.run([sys.executable, "-c", KILLED, str(path)], check=False, timeout=240, env=os.environ.copy())
    with av.open(str(path)) as file:
        assert len(list(file.decode(video=0))) >= 90


def test_the_same_sound_gives_the_same_bytes(tmp_path):
    contents = []
    for name in ("a.mp4", "b.mp4"):
        film(tmp_path / name, click(0.5, 1.0), 30, 1.0)
        contents.append((tmp_path / name).read_bytes())
    assert contents[0] == contents[1]
