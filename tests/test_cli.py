from __future__ import annotations

import json
import re
import shutil
import subprocess
import sys

import numpy as np
import pytest
from click.testing import CliRunner

from agentface.cli import COMMANDS, cli
from agentface.errors import GraphicsError
from agentface.resources import face_folder, rules_file

FACE_OPTIONS = ("--face", "--deformer")


def call(*arguments):
    return CliRunner().invoke(cli, [str(argument) for argument in arguments], prog_name="agentface")


def fail(*arguments, code=1):
    """Run a command that must fail cleanly; its message."""
    result = call(*arguments)
    assert result.exit_code == code, result.output
    assert isinstance(result.exception, SystemExit)
    assert "Traceback" not in result.stderr
    return result.stderr


def pixels(path):
    from PIL import Image

    with Image.open(path) as image:
        return np.asarray(image)


def test_help_is_light_and_names_every_command():
    script = (
        "import sys; from click.testing import CliRunner; from agentface.cli import cli\n"
        "print(CliRunner().invoke(cli, ['--help']).output)\n"
        "assert not {'numpy', 'numba', 'moderngl', 'pydantic', 'rich', 'PIL', 'av'} & set(sys.modules)"
    )
    done = subprocess.run([sys.executable, "-c", script], check=True, capture_output=True, text=True, timeout=240)
    assert all(f"  {command} " in done.stdout for command in COMMANDS)


@pytest.mark.parametrize("command", COMMANDS)
def test_every_command_takes_a_face_and_a_deformer(command):
    text = call(command, "--help").output
    assert all(option in text for option in FACE_OPTIONS)


@pytest.mark.slow
@pytest.mark.gl
def test_render_all_options(tmp_path):
    path = tmp_path / "face.png"
    options = (
        "--emotion happiness=0.6,surprise=0.2 --emotion fear=0.1 --muscle risorius_l=0.5 --gaze -20,5 --jaw 0.3"
        " --size 160x120 --quality portrait --camera three-quarter --face onyx --deformer geometric"
    )
    result = call("render", *options.split(), "-o", path)
    assert result.exit_code == 0, result.output
    assert pixels(path).shape == (120, 160, 3)


@pytest.mark.slow
@pytest.mark.gl
def test_render_is_what_face_render_gives(tmp_path):
    from agentface import Face

    path = tmp_path / "face.png"
    assert call("render", "--emotion", "anger=1", "--size", "96x96", "-o", path).exit_code == 0
    face = Face()
    face.set_emotion("anger", 1.0, fade=0.0)
    # one picture takes the numpy forms, a running face the compiled ones: 1e-7 m apart
    off = np.abs(pixels(path).astype(int) - face.render((96, 96))).max(axis=2) > 2
    assert off.mean() < 0.001


@pytest.mark.gl
def test_render_reaches_what_is_no_muscle_and_knows_neutral(tmp_path):
    plain, same, turned, alike = (tmp_path / f"{name}.png" for name in ("plain", "same", "turned", "alike"))
    small = ("--size", "96x96", "-o")
    for path, options in (
        (plain, ()),
        (same, ("--emotion", "neutral=1")),
        (turned, ("--parameter", "head_yaw_deg=30,gaze_pitch=0.2", "--parameter", "mentalis_l=0.5")),
        (alike, ("--parameter", "gaze_pitch=0.2,head_yaw=0.5235988,mentalis_l=0.5")),
    ):
        assert call("render", *options, *small, path).exit_code == 0
    assert plain.read_bytes() == same.read_bytes()
    assert turned.read_bytes() == alike.read_bytes()
    assert (pixels(turned) != pixels(plain)).any()


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--emotion", "hapiness=0.5"], "did you mean happiness"),
        (["--emotion", "happiness=1.5"], "0..1"),
        (["--emotion", "happiness=nan"], "finite"),
        (["--muscle", "biceps=0.5"], "biceps"),
        (["--gaze", "80,0"], "gaze_yaw_deg"),
        (["--jaw", "2"], "jaw_open"),
        (["--parameter", "head_yow=0.5"], "head_yaw"),
        (["--parameter", "head_yaw_deg=90"], "-80..80"),
        (["--emotion", "neutral=2"], "0..1"),
        (["--face", "nobody"], "known: amber, onyx"),
        (["--deformer", "jelly"], "known: geometric"),
    ],
)
def test_render_says_what_is_wrong_and_writes_nothing(tmp_path, options, message):
    assert message in fail("render", *options, "-o", tmp_path / "a.png")
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("name", ["no/such/folder/a.png", "a.gif", "a"])
def test_render_checks_its_output_first(tmp_path, name):
    assert name in fail("render", "-o", tmp_path / name)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    "options",
    [
        ["--emotion", "happiness"],
        ["--emotion", "happiness=much"],
        ["--emotion", "fear=1", "--emotion", "fear=0.5"],
        ["--size", "big"],
        ["--size", "0x10"],
        ["--gaze", "1"],
        ["--gaze", "1,2", "--look-at", "0,0,1"],
        ["--camera", "behind"],
        ["--quality", "best"],
        ["--jaw", "wide"],
    ],
)
def test_usage_errors_are_code_2(tmp_path, options):
    fail("render", *options, "-o", tmp_path / "a.png", code=2)


def test_no_output_and_no_command_are_usage_errors():
    fail("render", code=2)
    fail("rendre", code=2)
    fail("explain", code=2)


def test_explain_in_text_and_json(tmp_path):
    text = call("explain", "--emotion", "fear=0.5").output
    assert "if Fear is" in text
    path = tmp_path / "why.json"
    assert call("explain", "--emotion", "fear=0.5", "anger=0.2", "--json", path).exit_code == 0
    why = json.loads(path.read_text())
    assert why["emotion"]["fear"] == 0.5
    assert why["emotion"]["anger"] == 0.2
    assert json.loads(call("explain", "--emotion", "fear=0.5", "--json", "-").stdout)["contractions"]
    assert "fera" in fail("explain", "--emotion", "fera=0.5")


@pytest.mark.slow
def test_check_finds_nothing_in_what_ships():
    result = call("check")
    assert result.exit_code == 0, result.output
    assert re.findall(r"([\w.]+): good", result.output) == ["rules", "tissue.yaml", "amber", "onyx"]


def test_check_prints_all_faults_of_all_files(tmp_path):
    shutil.copytree(face_folder("amber"), tmp_path / "face")
    jaw, muscles, rules = tmp_path / "face" / "jaw.yaml", tmp_path / "face" / "muscles.yaml", tmp_path / "emotions.yaml"
    jaw.write_text(jaw.read_text().replace("widest_deg:", "widest:"))
    muscles.write_text(muscles.read_text().replace("risorius:", "rissorius:"))
    rules.write_text(rules_file("emotions.yaml").read_text().replace("VeryBig", "Enormous", 1))
    result = call("check", tmp_path / "face", rules)
    assert result.exit_code == 1
    said = result.stdout
    assert re.search(rf"{jaw}:\d+: .*widest", said)
    assert re.search(rf"{muscles}:\d+: .*rissorius", said)
    assert re.search(rf"{rules}:\d+: .*Enormous", said)
    assert "emotions.yaml" not in call("check", "--face", "amber").output


@pytest.mark.slow
def test_check_names_files_that_it_does_not_know(tmp_path):
    (tmp_path / "cake.yaml").write_text("a: 1")
    regions = tmp_path / "regions.yaml"
    shutil.copy(face_folder("amber") / "regions.yaml", regions)
    face = shutil.copytree(face_folder("amber"), tmp_path / "good" / "amber")
    (face / "tissue.yaml").unlink()  # it takes seconds to build
    for place, said in (
        (tmp_path / "cake.yaml", "cake.yaml: expected one of emotions.yaml"),
        (tmp_path / "jaw.yaml", "nothing"),
        (regions, "head.glb"),
    ):
        result = call("check", place, "--face", face)
        assert result.exit_code == 1
        assert said in result.stdout
        assert "amber: good" in result.stdout, "one bad file does not keep the others from being checked"
    regions.unlink()
    assert "neither" in call("check", tmp_path).stdout


def test_bench_prints_what_the_benchmarks_say(monkeypatch):
    from agentface.studies import bench

    monkeypatch.setattr(bench, "run", lambda name, face, deformer: {"name": name, "inner": {"time_us": 1.23456}})
    assert json.loads(call("bench", "deform", "--json", "-").stdout) == {
        "name": "deform",
        "inner": {"time_us": 1.23456},
    }
    assert list(json.loads(call("bench", "--json", "-").stdout)) == list(bench.BENCHES)
    assert re.search(r"deform.inner.time_us +1.235", call("bench").output)


def test_all_benchmarks_but_the_one_that_draws_run_without_opengl(monkeypatch):
    from agentface.studies import bench

    def run(name, face, deformer):
        if name == "render":
            raise GraphicsError("no OpenGL:\n  libEGL.so.1 is missing")
        return {"time_us": 1.0}

    monkeypatch.setattr(bench, "run", run)
    result = call("bench", "--json", "-")
    assert result.exit_code == 0, result.output
    figures = json.loads(result.stdout)
    assert figures.pop("render") == {"not_run": "no OpenGL: libEGL.so.1 is missing"}
    assert figures == {name: {"time_us": 1.0} for name in bench.BENCHES if name != "render"}
    assert re.search(r"render.not_run +no OpenGL: libEGL", call("bench").stdout)
    assert "libEGL.so.1 is missing" in fail("bench", "render"), "what was asked for by name must run"


def test_bench_names_the_benchmarks():
    assert "known: deform, fuzzy" in fail("bench", "qq")
