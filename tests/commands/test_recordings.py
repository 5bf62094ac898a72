"""``agentface play``, ``check`` and ``convert`` with every kind of performance."""

from __future__ import annotations

import json
import signal
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

from agentface.cli import cli
from agentface.face import Face
from agentface.io.performances.kinds import load
from agentface.mpeg4.fap_file import read_fap, write_fap
from agentface.mpeg4.fap_stream import FapStream
from agentface.parameters import parameter
from tests.io.performances.conftest import GOOD, PY_FEAT


def call(*arguments):
    return CliRunner().invoke(cli, [*map(str, arguments)], prog_name="agentface")


def done(*arguments):
    result = call(*arguments)
    assert result.exit_code == 0, result.output
    return result


def failed(*arguments, code=1):
    result = call(*arguments)
    assert result.exit_code == code, result.output
    assert isinstance(result.exception, SystemExit)
    return result.stderr


@pytest.fixture(autouse=True)
def _quick(monkeypatch):
    """Without waiting for what only a window needs at once."""
    monkeypatch.setattr(Face, "warm_up", lambda _, **__: None)


def put(folder, kind, name=None):
    suffix = {"emotionml": ".xml", "poses-json": ".json", "poses-npz": ".npz", "fap": ".fap"}.get(kind, ".csv")
    path = folder / (name or f"{kind}{suffix}")
    path.write_bytes(GOOD[kind])
    return path


@pytest.fixture
def smile(tmp_path):
    """A FAP file of twelve frames: the corners go up, the jaw drops, the head turns."""
    rise = np.sin(np.linspace(0, np.pi, 12))
    values, mask = np.zeros((12, 68), int), np.zeros((12, 68), bool)
    for number, most in ((3, 400), (12, 200), (13, 200), (53, 150), (54, 150), (49, 8000)):
        values[:, number - 1], mask[:, number - 1] = np.rint(most * rise), True
    path = tmp_path / "smile.fap"
    rest = np.zeros((12, 4), int), np.zeros((12, 6), int)
    path.write_text(write_fap(FapStream("2.0", "a smile", 12.5, values, mask, *rest)))
    return path


@pytest.mark.parametrize("kind", GOOD)
def test_check_knows_every_kind(kind, tmp_path):
    path = put(tmp_path, kind)
    assert done("check", path).stdout == f"{path}: good\n"
    path.write_bytes(GOOD[kind][: len(GOOD[kind]) // 2])
    result = call("check", path)
    assert result.exit_code == 1
    assert f"\n  {path}" in result.stdout


def test_faps_that_are_played_are_measured_frame_by_frame(smile, tmp_path):
    out = tmp_path / "shown.fap"
    done("play", smile, "--fap-out", out)
    asked, shown = read_fap(smile.read_text()), read_fap(out.read_text())
    assert (len(shown), shown.rate, shown.name) == (12, 12.5, "a smile")
    assert shown.mask[:, 2:].all()
    given = asked.mask.any(axis=0)
    missed = np.abs(shown.values - asked.values)[:, given]
    assert (missed <= 0.06 * np.abs(asked.values[:, given]).max(axis=0) + 1).all()
    assert missed[0].max() <= 1, "the first frame is hit, and the face does not come to it from rest"


def test_faps_of_another_rate_are_those_of_the_same_motion(smile, tmp_path):
    out = tmp_path / "shown.fap"
    done("play", smile, "--fap-out", out, "--fps", "25")
    done("play", smile, "--fap-out", tmp_path / "own.fap")
    twice, once = read_fap(out.read_text()), read_fap((tmp_path / "own.fap").read_text())
    assert (len(twice), twice.rate) == (23, 25.0)
    np.testing.assert_array_equal(twice.values[::2], once.values)


@pytest.mark.parametrize("kind", ["openface", "py-feat", "poses-json", "emotionml"])
def test_other_kinds_are_measured_too(kind, tmp_path):
    out = tmp_path / "shown.fap"
    done("play", put(tmp_path, kind), "--fap-out", out)
    shown = read_fap(out.read_text())
    assert len(shown) == {"openface": 3, "py-feat": 2, "poses-json": 3, "emotionml": 23}[kind]
    assert shown.rate == 30.0
    assert shown.values.any()


@pytest.mark.gl
@pytest.mark.parametrize("kind", ["fap", "openface", "poses-npz"])
def test_every_kind_is_filmed(kind, tmp_path):
    film = tmp_path / "a-%03d.png"
    done("play", put(tmp_path, kind), "-o", film, "--size", "64x64", "--fps", "10")
    assert len(list(tmp_path.glob("*.png"))) == {"fap": 6, "openface": 6, "poses-npz": 6}[kind]


def test_a_table_becomes_poses_and_poses_a_table(tmp_path):
    table = put(tmp_path, "openface")
    done("convert", table, tmp_path / "a.npz")
    done("convert", tmp_path / "a.npz", tmp_path / "b.csv")
    again = load(tmp_path / "b.csv")[1]
    first = load(table)[1]
    poses = [stream.performance().poses for stream in (first, again)]
    np.testing.assert_allclose(poses[1], poses[0], atol=1e-5)


def test_what_is_converted_to_its_own_kind_is_written_cleanly(tmp_path):
    wild = GOOD["fap"].replace(b"\n", b"\r\n").replace(b" ", b"\t")
    (tmp_path / "wild.fap").write_bytes(b"# found\r\n" + wild.rstrip())
    done("convert", tmp_path / "wild.fap", tmp_path / "clean.fap")
    assert (
        read_fap((tmp_path / "clean.fap").read_text()).values.tolist() == read_fap(GOOD["fap"].decode()).values.tolist()
    )
    assert b"\t" not in (tmp_path / "clean.fap").read_bytes().replace(b"\t", b"", 3)


def test_a_summary_in_json(tmp_path):
    table = put(tmp_path, "py-feat")
    said = json.loads(done("convert", table, tmp_path / "a.json", "--json", "-", "--file-fps", "10").stdout)
    assert said["in"] == {
        "file": str(table),
        "kind": "py-feat",
        "frames": 2,
        "rate_hz": None,
        "duration_s": 0.1,
        "notes": [],
    }
    assert said["out"]["kind"] == "poses-json"
    assert said["out"]["frames"] == 2
    assert load(tmp_path / "a.json")[1].duration_s == pytest.approx(0.1)


def test_emotions_become_poses(tmp_path):
    done("convert", put(tmp_path, "emotionml"), tmp_path / "a.json")
    assert load(tmp_path / "a.json")[1].rate_hz == 60.0


def test_notes_are_told_and_long_lists_cut(tmp_path):
    path = tmp_path / "a.csv"
    path.write_text(PY_FEAT.replace("AU43", "AU99").replace("AU01", "AU98"))
    said = done("convert", path, tmp_path / "a.json").stderr
    assert "AU99, left out" in said
    assert "AU98, left out" in said


def test_what_a_face_cannot_show_of_faps_is_told(tmp_path):
    values, mask = np.zeros((2, 68), int), np.zeros((2, 68), bool)
    values[:, 2], mask[:, 2] = 90_000, True
    faps = FapStream("2.1", "a", 25, values, mask, np.zeros((2, 4), int), np.zeros((2, 6), int))
    (tmp_path / "a.fap").write_text(write_fap(faps))
    said = done("convert", tmp_path / "a.fap", tmp_path / "a.json").stderr
    assert "FAP 3: expected what this face can show, got more, in 2 of 2 frames" in said


def test_visemes_and_expressions_of_faps_are_shown(tmp_path):
    mask = np.zeros((2, 68), bool)
    mask[:, :2] = True
    high = np.array([[10, 0, 63, 0]] * 2), np.array([[1, 63, 0, 0, 0, 0]] * 2)
    faps = FapStream("2.1", "a", 25, np.zeros((2, 68), int), mask, *high)
    (tmp_path / "a.fap").write_text(write_fap(faps))
    done("convert", tmp_path / "a.fap", tmp_path / "a.json")
    played = load(tmp_path / "a.json")[1]
    assert {"jaw_open", "zygomaticus_major_l"} <= {*played.moved}
    assert played.poses[1, parameter("zygomaticus_major_l").index] > 0.5


def test_emotions_stay_emotions(tmp_path):
    done("convert", put(tmp_path, "emotionml"), tmp_path / "again.xml")
    assert load(tmp_path / "again.xml")[1].cues == load(tmp_path / "emotionml.xml")[1].cues


def test_strict_makes_notes_faults(tmp_path):
    path = tmp_path / "a.csv"
    path.write_text(PY_FEAT.replace("AU43", "AU99"))
    assert "AU99, left out" in failed("play", path, "--strict", "--fap-out", tmp_path / "a.fap")
    assert call("check", "--strict", path).exit_code == 1
    assert "note: " in done("check", path).stdout


def test_nothing_is_written_when_it_is_told_to_end(monkeypatch, smile, tmp_path):
    step = Face.step

    def interrupted(face, dt):
        signal.raise_signal(signal.SIGINT)
        return step(face, dt)

    monkeypatch.setattr(Face, "step", interrupted)
    said = failed("play", smile, "--fap-out", tmp_path / "a.fap", code=130)
    assert "nothing is written" in said
    failed("convert", put(tmp_path, "poses-json"), tmp_path / "b.fap", code=130)
    assert not list(tmp_path.glob("[ab].fap"))


def test_usage(smile, tmp_path):
    assert "--fap-out goes without -o" in failed("play", smile, "-o", "a.mp4", "--fap-out", "b.fap", code=2)
    assert "--loop goes without --fap-out" in failed("play", smile, "--loop", "--fap-out", "b.fap", code=2)
    assert "ends in one of" in failed("convert", smile, tmp_path / "a.mp4")
    assert "no folder" in failed("convert", smile, tmp_path / "no" / "a.json")
    assert "no folder" in failed("play", smile, "--fap-out", tmp_path / "no" / "a.fap")
    assert not (tmp_path / "a.fap").exists()


def test_faults_are_told_before_a_face_is_made(monkeypatch, tmp_path):
    monkeypatch.setattr(Face, "__init__", None)
    path = tmp_path / "a.fap"
    path.write_bytes(GOOD["fap"][:-300])
    for arguments in (("play", path, "--fap-out", tmp_path / "b.fap"), ("convert", path, tmp_path / "b.json")):
        assert failed(*arguments).startswith(f"{path}:")
    assert list(tmp_path.iterdir()) == [path]


def test_a_stranger_is_told_what_is_known(tmp_path):
    path = tmp_path / "notes.txt"
    path.write_text("hello")
    assert "MPEG-4 FAPs (.fap)" in failed("play", path, "-o", tmp_path / "a.mp4")


def test_weights_of_a_phone_play_and_are_written(tmp_path):
    take = put(tmp_path, "live-link")
    done("play", take, "--fap-out", tmp_path / "shown.fap")
    assert len(read_fap((tmp_path / "shown.fap").read_text())) == 3
    done("convert", take, tmp_path / "take.npz")
    done("convert", tmp_path / "take.npz", tmp_path / "again.csv", "--to", "live-link")
    one, again = (load(path)[1] for path in (take, tmp_path / "again.csv"))
    assert again.weights.shape == one.weights.shape
    np.testing.assert_allclose(again.times_s, one.times_s, atol=1e-4)
    assert 0.0 <= again.weights.min() <= again.weights.max() <= 1.0
    assert again.angles.any()


def test_faps_of_an_emotion_become_that_emotion(tmp_path):
    done("convert", Path("examples/surprise_then_joy.fap").resolve(), tmp_path / "felt.xml", "--fps", 10)
    cues = {cue.emotion: np.array(cue.samples) for cue in load(tmp_path / "felt.xml")[1].cues}
    assert cues["surprise"][:12].max() == pytest.approx(1.0, abs=0.05)
    assert cues["happiness"][20:28] == pytest.approx(50 / 63, abs=0.03)
    assert max([0.0, *(samples.max() for name, samples in cues.items() if name not in ("surprise", "happiness"))]) < 0.1
