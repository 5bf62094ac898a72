"""What goes wrong around a picture: one clear error, nothing left behind, an exit code that is not zero."""

from __future__ import annotations

import ctypes
import os
import resource
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from click.testing import CliRunner

from agentface import resources
from agentface.cli import cli
from agentface.view.gl import context, source
from agentface.view.renderer import Renderer

SERVE = ("serve", "--osc", "127.0.0.1:0", "--duration", "0.3", "--fps", "10", "--record")
CALLS = {
    "picture": ("render", "-o", "face.png"),
    "transparent": ("render", "--alpha", "-o", "face.png"),
    "sheet": ("sheet", "--emotions", "fear", "--levels", "0.5,1", "-o", "sheet.png"),
    "film": (*SERVE, "film.mp4"),
    "film-later": (*SERVE, "film.mp4", "--every-frame"),
    "frames": (*SERVE, "face-%05d.png"),
    "frames-later": (*SERVE, "face-%05d.png", "--every-frame"),
}
every_call = pytest.mark.parametrize("call", CALLS.values(), ids=CALLS)
KINDS = {name: CALLS[name] for name in ("picture", "film", "frames-later")}
each_kind = pytest.mark.parametrize("call", KINDS.values(), ids=KINDS)
"""One call for each way that leads to a file."""


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    """An empty current folder."""
    place = tmp_path / "here"
    place.mkdir()
    monkeypatch.chdir(place)
    return place


def fail(folder, *words, code=1, size="64x64"):
    """Run a command that must fail cleanly; its message."""
    result = CliRunner().invoke(cli, [*words, "--size", size], prog_name="agentface")
    assert result.exit_code == code, result.output
    assert isinstance(result.exception, SystemExit), result.exception
    assert list(folder.iterdir()) == []
    assert "Traceback" not in result.output
    assert "expected" in result.stderr
    if code == 1:
        assert result.stderr.count("agentface: ") == 1
    return result.stderr


@every_call
def test_no_opengl(folder, monkeypatch, call):
    import moderngl

    def refuse(**_):
        raise Exception("libEGL.so not loaded")

    monkeypatch.setattr(moderngl, "create_context", refuse)
    said = fail(folder, *call)
    assert "libEGL.so not loaded" in said
    assert "apt-get install" in said


@pytest.mark.gl
def test_no_driver_at_all(folder, tmp_path):
    (tmp_path / "drivers").mkdir()
    none = os.environ | {"__EGL_VENDOR_LIBRARY_DIRS": str(tmp_path / "drivers")}
    command = [sys.executable, "-m", "agentface", *CALLS["picture"]]
    done = subprocess.run(command, check=False, capture_output=True, text=True, env=none, timeout=240)
    assert done.returncode == 1
    assert "apt-get install" in done.stderr
    assert "Traceback" not in done.stderr
    assert list(folder.iterdir()) == []


@pytest.mark.gl
@each_kind
def test_a_lost_context(folder, monkeypatch, call):
    draw = Renderer.draw

    def lose(self, *arguments, **options):
        draw(self, *arguments, **options)
        egl = ctypes.CDLL("libEGL.so.1")
        egl.eglGetCurrentDisplay.restype = ctypes.c_void_p
        assert egl.eglMakeCurrent(ctypes.c_void_p(egl.eglGetCurrentDisplay()), None, None, None)

    monkeypatch.setattr(Renderer, "draw", lose)
    said = fail(folder, *call)
    assert "lost its context" in said
    assert "start the program again" in said


@pytest.mark.parametrize("size", ["0x64", "64x0", "20000x64", "64x20000", "8193x8192", "-1x5", "1.5x2"])
@every_call
def test_sizes(folder, call, size):
    assert "1..8192" in fail(folder, *call, size=size, code=2)


@each_kind
@pytest.mark.parametrize("place", ["no/such/folder", "/proc", "face.png"])
def test_places_that_cannot_be_written(folder, tmp_path, call, place):
    if place == "face.png":
        place = str(tmp_path / "face.png")
        (tmp_path / "face.png").write_bytes(b"a file where a folder is expected")
    words = [f"{place}/{word}" if "." in word and word[0].isalpha() and word != "0.5,1" else word for word in call]
    said = fail(folder, *words)
    assert place in said
    assert "folder" in said


@each_kind
def test_an_output_that_is_a_folder(folder, tmp_path, call):
    name = next(word for word in call if word.endswith((".png", ".mp4")))
    (tmp_path / "there" / name).mkdir(parents=True)
    said = fail(folder, *[str(tmp_path / "there" / word) if word == name else word for word in call])
    assert "folder" in said or "no such files yet" in said
    assert (tmp_path / "there" / name).is_dir()


@pytest.fixture
def full_disk(monkeypatch):
    """From the first picture on, no file can be longer than 1 kB."""
    limits, render = resource.getrlimit(resource.RLIMIT_FSIZE), Renderer.render

    def fill(self, *arguments, **options):
        picture = render(self, *arguments, **options)
        resource.setrlimit(resource.RLIMIT_FSIZE, (1024, limits[1]))
        return picture

    monkeypatch.setattr(Renderer, "render", fill)
    yield
    resource.setrlimit(resource.RLIMIT_FSIZE, limits)


@pytest.mark.slow
@pytest.mark.gl
@every_call
def test_a_full_disk(folder, full_disk, call):
    said = fail(folder, *call)
    assert "File too large" in said
    assert "choose a disk" in said


@pytest.mark.gl
@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no /dev/full on this machine")
def test_a_disk_full_from_the_start(folder):
    (folder / "film.mp4").symlink_to("/dev/full")
    said = fail(folder, *CALLS["film"])
    assert "No space left" in said
    assert "free some space" in said


@pytest.fixture
def shaders(tmp_path, monkeypatch):
    """A copy of the shaders, to be broken."""
    copied = shutil.copytree(resources.data_folder("shaders"), tmp_path / "shaders")
    for module in (source, context):
        monkeypatch.setattr(module, "data_folder", {"shaders": copied}.__getitem__)
    return copied


@pytest.mark.gl
@each_kind
def test_a_broken_shader(folder, shaders, call):
    broken = shaders / "eye.frag.glsl"
    text = broken.read_text()
    broken.write_text(text.replace("void main() {", "void main() {\n    nonsense;", 1))
    line = text[: text.index("void main() {")].count("\n") + 2
    said = fail(folder, *call)
    assert f"{broken}:{line}: error: `nonsense' undeclared" in said
    assert "agentface: the shaders eye.vert.glsl and eye.frag.glsl: expected them to compile" in said


WHITE = "#version 330 core\nout vec4 pixel;\nvoid main() { pixel = vec4(1.0); }\n"
NOWHERE = "#version 330 core\nvoid main() { gl_Position = vec4(1.0); }\n"


@pytest.mark.gl
@pytest.mark.parametrize(
    ("name", "content", "message"),
    [
        ("cap.frag.glsl", None, "cap.frag.glsl"),
        ("frame.glsl", None, "frame.glsl"),
        ("eye.frag.glsl", "", "eye.frag.glsl"),
        ("part.frag.glsl", "\xff\xfe", "part.frag.glsl"),
        ("background.frag.glsl", WHITE, "'aspect' to be declared and used"),
        ("depth.vert.glsl", NOWHERE, "'ends' to be declared and used"),
        ("eye.vert.glsl", NOWHERE, "to be declared and used"),
    ],
)
def test_other_broken_shaders(folder, shaders, name, content, message):
    if content is None:
        (shaders / name).unlink()
    else:
        (shaders / name).write_text(content, encoding="latin-1")
    assert message in fail(folder, *CALLS["picture"])
