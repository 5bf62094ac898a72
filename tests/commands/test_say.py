"""``agentface say``: what is seen, when it is heard, and what goes wrong."""

from __future__ import annotations

import json
import os
import subprocess
import sys

import numpy as np
import pytest
from click.testing import CliRunner

from agentface.cli import cli
from agentface.face import Face
from agentface.io.sound import write_wav
from agentface.live.heard import HeardRecorder
from agentface.parameters import NAMES
from agentface.speech.sound import Sound
from agentface.speech.voices.flite import Flite
from tests.clocks import ServedClock, send
from tests.display import on_a_virtual_display
from tests.tools import require

SMALL = ("--size", "64x64", "--fps", "25")
RATE = 16_000


def call(command, *arguments, **options):
    return CliRunner().invoke(cli, [command, *map(str, arguments)], prog_name="agentface", **options)


def fail(*arguments, code=1, **options):
    result = call("say", *arguments, **options)
    assert result.exit_code == code, result.output
    assert isinstance(result.exception, SystemExit)
    assert "Traceback" not in result.stderr
    return result.stderr


def heard(path):
    import av

    with av.open(str(path)) as file:
        frames = list(file.decode(audio=0))
        rate, start = frames[0].sample_rate, float(frames[0].time)
        samples = np.concatenate([frame.to_ndarray()[0] for frame in frames])
        return np.concatenate([np.zeros(round(start * rate)), samples]), rate


def onset(samples, rate):
    return float(np.argmax(np.abs(samples) > 0.1 * np.abs(samples).max())) / rate


@pytest.fixture
def jaws(monkeypatch):
    """How far the jaw is open at each step."""
    require("flite")
    noted, step = [], Face.step

    def watched(face, dt):
        geometry = step(face, dt)
        noted.append(float(face.pose.array[NAMES.index("jaw_open")]))
        return geometry

    monkeypatch.setattr(Face, "step", watched)
    return noted


def recording(folder, phones, samples):
    """A recording with the times of its phones."""
    write_wav(folder / "a.wav", Sound(samples, RATE))
    path = folder / "a.json"
    path.write_text(json.dumps({"format": "agentface phones", "version": 1, "sound": "a.wav", "phones": phones}))
    return path


@pytest.mark.gl
def test_a_phone_is_seen_when_it_is_heard(tmp_path, jaws):
    samples = np.zeros(2 * RATE, np.int16)
    samples[RATE : RATE + RATE // 2] = 8000 * np.sign(np.sin(np.arange(RATE // 2) * 0.2))
    path = recording(tmp_path, [["sil", 0, 1.0], ["aa", 1.0, 1.5], ["sil", 1.5, 2.0]], samples)
    result = call("say", "--phones", path, "-o", tmp_path / "a.mp4", "--liveliness", 0, *SMALL)
    assert result.exit_code == 0, result.output
    assert onset(*heard(tmp_path / "a.mp4")) == pytest.approx(1.0, abs=0.004)
    jaw = np.array(jaws)
    times = np.arange(len(jaw)) / 25
    wide = times[jaw > 0.5 * jaw.max()]
    assert 0.5 * (wide[0] + wide[-1]) == pytest.approx(1.25, abs=0.04), "the opening stands about the sound's middle"
    assert times[-1] == pytest.approx(2.0 + 1.0 - 0.04, abs=1e-6)
    assert jaw[0] == 0.0
    assert jaw[-1] < 0.01


@pytest.mark.slow
@pytest.mark.gl
def test_a_text_is_filmed_with_its_voice_the_same_each_time(tmp_path, jaws):
    films = [tmp_path / f"{name}.mp4" for name in "ab"]
    for film in films:
        result = call("say", "[joy] Papa saw. [wow]", "-o", film, *SMALL, "--emotion", "surprise=0.2")
        assert result.exit_code == 0, result.output
        assert "[wow] names no emotion" in result.stderr
    spoken = Flite().speak("Papa saw.")
    samples, rate = heard(films[0])
    assert rate == RATE
    original = spoken.sound.samples / 32768
    shared = min(len(samples), len(original))
    assert np.corrcoef(samples[:shared], original[:shared])[0, 1] > 0.95
    assert max(jaws) > 0.1
    assert films[0].read_bytes() == films[1].read_bytes()


@pytest.mark.slow
@pytest.mark.gl
def test_a_recording_is_filmed_by_ear_and_by_its_text(tmp_path, jaws):
    pytest.importorskip("pocketsphinx")
    write_wav(tmp_path / "a.wav", Flite().speak("Father saw a large car.").sound)
    for words in ([], ["[joy] Father saw a large car."]):
        jaws.clear()
        result = call("say", *words, "--audio", tmp_path / "a.wav", "-o", tmp_path / "a.mp4", *SMALL)
        assert result.exit_code == 0, result.output
        assert max(jaws) > 0.15
        assert len(heard(tmp_path / "a.mp4")[0])


@pytest.mark.slow
@pytest.mark.gl
def test_the_standard_input_and_numbered_pictures(tmp_path, jaws):
    result = call("say", "-", "-o", tmp_path / "a-%03d.png", "--size", "32x32", "--fps", "5", input="Aha.")
    assert result.exit_code == 0, result.output
    assert len(list(tmp_path.glob("a-*.png"))) > 8
    assert max(jaws) > 0.05
    assert "10000" in fail("-", input="a" * 10_001)


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ([], "TEXT"),
        (["Hi.", "--phones", "a.json"], "TEXT"),
        (["--audio", "a.wav", "--phones", "a.json"], "--audio"),
        (["--audio", "a.wav", "--voice", "slt"], "--voice goes without a recording"),
        (["--phones", "a.json", "--rate", "2"], "--rate goes without a recording"),
        (["Hi.", "--size", "64x64"], "--size goes with -o"),
        (["Hi.", "--fps", "25"], "--fps goes with -o"),
        (["Hi.", "--rate", "3"], "0.5<=x<=2"),
        (["Hi.", "--emotion", "joy"], "NAME=V"),
    ],
)
def test_usage(options, said):
    assert said in fail(*options, code=2)


def test_what_cannot_be_said_is_one_error_and_leaves_no_film(tmp_path):
    require("flite")
    film = tmp_path / "a.mp4"
    for options, said in (
        (["..."], "something that can be spoken"),
        (["Hi.", "--voice", "slz"], "slt"),
        (["Hallo.", "--voice", "slt", "--language", "de"], "English"),
        (["привет"], "--language"),
        (["--audio", tmp_path / "no.wav"], "no.wav"),
        (["--phones", tmp_path / "no.json"], "no.json"),
    ):
        assert said in fail(*options, "-o", film)
        assert not film.exists()


def test_a_missing_voice_is_one_error(tmp_path, monkeypatch):
    monkeypatch.setenv("PATH", str(tmp_path))
    assert "apt-get install flite" in fail("Hi.", "--voice", "rms", "-o", tmp_path / "a.mp4")


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"version": 2}, "version"),
        ({"sound": "b.wav"}, "b.wav"),
        ({"extra": 1}, "extra"),
        ({"phones": []}, "one phone or more"),
        ({"phones": [["p", 0, 0.1], ["xyzzy", 0.1, 0.2]]}, "phones.1"),
        ({"phones": [["p", 0, 0.1], ["a", 0.05, 0.2], ["t", 0.1]]}, "phones.2"),
        ({"phones": [["p", 0.2, 0.1]]}, "phones.0"),
        ({"phones": "p"}, "phones"),
    ],
)
def test_faults_of_a_recording_s_times_are_told_with_their_place(tmp_path, change, said):
    path = recording(tmp_path, [["p", 0, 0.1]], np.ones(RATE, np.int16))
    assert "good" in call("check", path).stdout
    path.write_text(json.dumps(json.loads(path.read_text()) | change, indent=1))
    assert said in fail("--phones", path, "-o", tmp_path / "a.mp4")
    result = call("check", path)
    assert result.exit_code == 1
    assert said in result.stdout


@pytest.mark.slow
@pytest.mark.gl
def test_the_sound_of_a_performance_is_in_its_film(tmp_path):
    samples = np.zeros(RATE, np.int16)
    samples[RATE // 2 :] = 9000
    write_wav(tmp_path / "a.wav", Sound(samples, RATE))
    poses = {"format": "agentface poses", "version": 1, "rate_hz": 10, "sound": "a.wav", "parameters": ["jaw_open"]}
    (tmp_path / "a.json").write_text(json.dumps(poses | {"poses": [[0.0]] * 11}))
    result = call("play", tmp_path / "a.json", "-o", tmp_path / "a.mp4", *SMALL)
    assert result.exit_code == 0, result.output
    assert onset(*heard(tmp_path / "a.mp4")) == pytest.approx(0.5, abs=0.01)
    (tmp_path / "a.wav").unlink()
    result = call("play", tmp_path / "a.json", "-o", tmp_path / "b.mp4", *SMALL)
    assert result.exit_code == 1
    assert "a.wav" in result.stderr
    assert not (tmp_path / "b.mp4").exists()


@pytest.mark.slow
@pytest.mark.gl
def test_a_server_films_what_it_says_with_its_sound(tmp_path, jaws):
    from agentface.io.osc.codec import encode

    path = tmp_path / "a.mp4"

    def agent(server):
        if len(jaws) == 10:
            send(server, encode("/agentface/say", "Father saw a large car."))
        for face in server._receiver._faces.values():
            face.talker.wait()

    with ServedClock(agent).at_work():
        options = ("--osc", "127.0.0.1:0", "--record", path, "--every-frame", "--duration", "3.98", "--liveliness", 0)
        result = call("serve", *options, *SMALL)
    assert result.exit_code == 0, result.output
    assert len(jaws) == 200
    replayed = np.array(jaws[100:])
    samples, rate = heard(path)
    assert max(jaws) > 0.15
    begun = onset(samples, rate)
    spoken = Flite().speak("Father saw a large car.")
    first = onset(spoken.sound.samples.astype(float), spoken.sound.rate_hz)
    vowel = next(p for p in spoken.phones if p.symbol == "aa")
    at = begun - first + 0.5 * (vowel.start_s + vowel.end_s)
    near = replayed[round(25 * (at - 0.1)) : round(25 * (at + 0.1))]
    assert near.max() == pytest.approx(replayed[: round(25 * (at + 0.15))].max(), rel=0.15)


def test_what_is_heard_is_cut_where_it_is_hushed():
    class Talker:
        def __init__(self):
            self.heard, self.hushed, self.latency_s = [], [], 0.06

    class Notes:
        last_s = 1.01

    class Speaking:
        talker = Talker()

    recorder = HeardRecorder(Speaking(), Notes(), 10.0)
    assert recorder.sound(RATE) is None
    with recorder:
        for tell in Speaking.talker.heard:
            tell(Sound(np.full(RATE, 1000, np.int16), RATE), 0.04)
            tell(Sound(np.full(RATE, 1000, np.int16), RATE), 1.04)
        Notes.last_s = 1.6
        for hush in Speaking.talker.hushed:
            hush()
    assert not Speaking.talker.heard
    sound = recorder.sound(RATE)
    assert onset(sound.samples, RATE) == pytest.approx(1.1, abs=1e-3)
    assert sound.duration_s == pytest.approx(1.6, abs=1e-3)


@pytest.mark.slow
@pytest.mark.untraced
@pytest.mark.gl
@pytest.mark.parametrize("words", [("[joy] Hello.",), ("--phones", "examples/hello.json")])
def test_in_a_window_it_says_its_text_and_ends(words):
    require("xvfb-run", "flite")
    command = [*on_a_virtual_display(), sys.executable, "-m", "agentface", "say", *words]
    quiet = {name: value for name, value in os.environ.items() if name not in ("DISPLAY", "WAYLAND_DISPLAY")}
    done = subprocess.run(command, check=False, capture_output=True, text=True, timeout=240, env=quiet)
    assert done.returncode == 0, done.stderr
    assert done.stderr == "" or "what is said is not heard" in done.stderr
