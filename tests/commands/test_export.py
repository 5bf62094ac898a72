"""``agentface export``: what it refuses, and what it says."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

from agentface.commands.export import export
from agentface.io.performances.poses_json import write_json
from agentface.io.sound import read_sound, write_wav
from agentface.motion.performance import Performance
from agentface.parameters import COUNT, indices_of
from agentface.speech.sound import Sound


def run(*arguments: object):
    return CliRunner().invoke(export, [str(argument) for argument in arguments])


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("face.obj",), "expected a FILE that ends in .glb, .vrm, .html, got '.obj'"),
        (("face",), "got 'no ending'"),
        (("face.glb", "--shapes", "exact"), "--shapes exact goes with --performance FILE"),
        (("face.vrm", "--performance", "smile.fap"), "--performance goes with a .glb"),
        (("face.vrm", "--shapes", "arkit"), "--shapes goes with a .glb"),
        (("face.glb", "--error-mm", "0"), "0.01<=x<=10"),
    ],
)
def test_what_cannot_be_is_told_before_any_work(tmp_path, arguments, said):
    name, *options = arguments
    done = run(tmp_path / name, *options)
    assert done.exit_code == 2
    assert said in done.output
    assert list(tmp_path.iterdir()) == []


def test_a_folder_that_is_not_there_is_told_first(tmp_path):
    done = run(tmp_path / "none" / "face.glb")
    assert done.exit_code != 0
    assert "no folder" in str(done.exception)


@pytest.mark.gl
@pytest.mark.slow
def test_a_performance_with_its_sound(tmp_path):
    poses = np.zeros((7, COUNT), np.float32)
    poses[:, indices_of("jaw_open")[0]] = 0.5 * np.sin(np.arange(len(poses))) ** 2
    tone = (9000 * np.sin(np.arange(8000))).astype(np.int16)
    write_wav(tmp_path / "tone.wav", Sound(tone, 16_000))
    moving = Performance.regular(10.0, poses, np.ones((1, COUNT), np.float32), sound=Path("tone.wav"))
    (tmp_path / "jaw.json").write_text(write_json(moving))
    output = tmp_path / "jaw.glb"
    done = run(output, "--performance", tmp_path / "jaw.json", "--json", tmp_path / "said.json")
    assert done.exit_code == 0, done.output
    figures = json.loads((tmp_path / "said.json").read_text())
    assert (figures["file"], figures["format"], figures["kind"]) == (str(output), "glb", "exact")
    assert figures["bytes"] == output.stat().st_size
    assert figures["error_max_mm"] <= 0.11
    assert 7 <= figures["frames"] <= 12  # the face lets go of it at its end
    assert figures["sound"] == str(tmp_path / "jaw.wav")
    assert read_sound(tmp_path / "jaw.wav").duration_s == pytest.approx(0.5, abs=0.01)
    assert "mm off" in done.output
    # a sound that is there already under the name is not written over by what was read from it
    before = (tmp_path / "tone.wav").read_bytes()
    done = run(tmp_path / "tone.glb", "--performance", tmp_path / "jaw.json", "--shapes", "arkit", "--json", "-")
    assert done.exit_code == 0, done.output
    assert (tmp_path / "tone.wav").read_bytes() == before
    assert (tmp_path / "tone.glb").stat().st_size > 10_000
