"""What people install is the wheel: it is tried outside the checkout, in an environment of its own."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import sysconfig
import tarfile
import venv
from pathlib import Path
from zipfile import ZipFile

import pytest
from click.testing import CliRunner

import agentface
from agentface.cli import cli
from agentface.resources import data_folder, face_folder
from tests.base_mesh import base_mesh
from tests.tools import PAGE, require_page

pytestmark = [pytest.mark.slow, pytest.mark.untraced]

ROOT = Path(__file__).parent.parent
TOP = {"agentface", f"agentface-{agentface.__version__}.dist-info"}


def python(*arguments: object) -> None:
    command = [sys.executable, "-m", *map(str, arguments)]
    subprocess.run(command, check=True, capture_output=True, text=True, timeout=240)


def content(wheel: Path) -> set[str]:
    with ZipFile(wheel) as archive:
        return set(archive.namelist())


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The wheel of this checkout."""
    folder = tmp_path_factory.mktemp("wheel")
    python("build", "--wheel", "--no-isolation", "--outdir", folder, ROOT)
    return next(folder.glob("*.whl"))


class Installation:
    """The wheel in a virtual environment that shares the libraries of this one, but not its agentface."""

    def __init__(self, wheel: Path, folder: Path) -> None:
        self.folder = folder
        venv.create(folder / "venv")
        self.bin = folder / "venv" / "bin"
        # .pth files inside a folder that a .pth file names, such as those of editable installs, are not read.
        site = next((folder / "venv" / "lib").glob("python*/site-packages"))
        paths = {sysconfig.get_path("purelib"), sysconfig.get_path("platlib")}
        (site / "libraries.pth").write_text("\n".join(sorted(paths)))
        python("pip", "--python", self.bin / "python", "install", "--quiet", "--no-index", "--no-deps", wheel)

    def run(self, program: str, *arguments: str) -> str:
        """What a program of the environment prints, started in an empty folder."""
        cwd = self.folder / "elsewhere"
        cwd.mkdir(exist_ok=True)
        environment = {name: value for name, value in os.environ.items() if not name.startswith(("PYTHON", "COV"))}
        command = [str(self.bin / program), *arguments]
        run = subprocess.run(
            command, cwd=cwd, env=environment, capture_output=True, text=True, timeout=240, check=False
        )
        assert run.returncode == 0, run.stderr
        return run.stdout


@pytest.fixture(scope="module")
def installation(wheel: Path, tmp_path_factory: pytest.TempPathFactory) -> Installation:
    return Installation(wheel, tmp_path_factory.mktemp("installation"))


def test_wheel_holds_the_package_and_its_data_and_nothing_else(wheel: Path):
    names = content(wheel)
    assert {name.partition("/")[0] for name in names} == TOP
    assert wheel.stat().st_size < 4_000_000
    assert "agentface/py.typed" in names
    page = {name.removeprefix("agentface/io/web/page/") for name in names if name.startswith("agentface/io/web/page/")}
    assert page == ({f"dist/{path.name}" for path in PAGE.iterdir()} if PAGE.is_dir() else set())
    shipped = {
        f"agentface/_data/{kind}/{path.relative_to(data_folder(kind)).as_posix()}"
        for kind in ("regions", "rules", "shaders")
        for path in data_folder(kind).rglob("*")
        if path.is_file()
    }
    assert {name for name in names if name.startswith("agentface/_data/")} == shipped
    assert {"agentface/_data/regions/amber/head.glb", "agentface/_data/rules/emotions.yaml"} <= shipped
    assert {f"agentface/_data/regions/{place}tissue.yaml" for place in ("", "amber/", "onyx/")} <= shipped
    assert any(name.endswith(".dist-info/licenses/LICENSE") for name in names)


def test_wheel_carries_the_page_with_its_licences(wheel: Path):
    require_page()
    with ZipFile(wheel) as archive:
        bundle, licences = (
            archive.read(f"agentface/io/web/page/dist/{name}").decode() for name in ("agentface.js", "licences.txt")
        )
    assert "agent-face" in bundle
    assert "three 0." in licences
    assert "Permission is hereby granted" in licences


def test_wheel_built_from_the_source_archive_is_the_same(wheel: Path, tmp_path: Path):
    # Without --wheel or --sdist, build makes the archive and then the wheel from the archive alone.
    python("build", "--no-isolation", "--outdir", tmp_path, ROOT)
    assert content(next(tmp_path.glob("*.whl"))) == content(wheel)
    with tarfile.open(next(tmp_path.glob("*.tar.gz"))) as archive:
        names = {name.partition("/")[2] for name in archive.getnames()}
    assert {"tests/test_wheel.py", "examples/make_demo.py", "docs/osc.md", "Makefile", "LICENSE"} <= names
    assert [name for name in names if name.startswith((".", "out/")) and name != ".gitignore"] == []


def test_installed_wheel_runs_its_commands(installation: Installation):
    home = installation.run("python", "-c", "import agentface; print(agentface.__file__)").strip()
    assert Path(home).is_relative_to(installation.folder)
    assert installation.run("agentface", "--version").split()[-1] == agentface.__version__
    assert "0 faults" not in (checked := installation.run("agentface", "check"))
    assert all(
        f"{Path(home).parent / '_data' / place}: good" in checked
        for place in ("rules", "regions/tissue.yaml", "regions/amber")
    )
    explained = json.loads(installation.run("agentface", "explain", "--emotion", "happiness=0.8", "--json", "-"))
    assert explained
    assert "zygomaticus_major" in installation.run("agentface", "explain", "--emotion", "happiness=0.8")


@pytest.mark.gl
def test_installed_wheel_renders(installation: Installation):
    from PIL import Image

    installation.run("agentface", "render", "--emotion", "joy=1", "-o", "x.png", "--size", "160x120")
    with Image.open(installation.folder / "elsewhere" / "x.png") as picture:
        assert picture.size == (160, 120)
        assert len(picture.convert("RGB").getcolors(160 * 120) or ()) > 100
    assert "three-muscles.png" in installation.run("agentface", "figures", "combination")
    assert (installation.folder / "elsewhere" / "figures" / "three-muscles.png").is_file()


@pytest.mark.slow
@pytest.mark.gl
def test_installed_wheel_makes_a_face(installation: Installation, tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    source = base_mesh().parent.parent
    monkeypatch.setenv("AGENTFACE_DATA", str(tmp_path / "data"))
    recipe = tmp_path / "sam.yaml"
    recipe.write_bytes((face_folder("amber") / "recipe.yaml").read_bytes())
    installation.run("agentface", "build", str(recipe), "--source", str(source))
    made = tmp_path / "data" / "regions" / "sam"
    assert (made / "head.glb").read_bytes() == (face_folder("amber") / "head.glb").read_bytes()
    installation.run("agentface", "render", "--face", "sam", "-o", str(tmp_path / "sam.png"), "--size", "160x120")
    amber = CliRunner().invoke(cli, ["render", "-o", str(tmp_path / "amber.png"), "--size", "160x120"])
    assert amber.exit_code == 0, amber.output
    assert (tmp_path / "sam.png").read_bytes() == (tmp_path / "amber.png").read_bytes()
