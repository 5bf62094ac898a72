"""The documents as a site: ``make docs``."""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

from tests.test_imports import MODULES

ROOT = Path(__file__).parent.parent
DOCS = ROOT / "docs"
NAVIGATION = tomllib.loads((ROOT / "zensical.toml").read_text())["project"]["nav"]


def pages(entries):
    """The files of a navigation, at any depth."""
    for entry in entries:
        for target in entry.values():
            yield from [target] if isinstance(target, str) else pages(target)


def test_the_navigation_has_every_page_once():
    named = list(pages(NAVIGATION))
    assert sorted(named) == sorted(str(path.relative_to(DOCS)) for path in DOCS.rglob("*.md"))


def test_the_reference_names_modules_that_are_there():
    named = [
        name
        for page in (DOCS / "api").glob("*.md")
        for name in re.findall(r"^::: (\S+)", page.read_text(), re.MULTILINE)
    ]
    assert len(named) == len(set(named)) > 40
    assert set(named) <= MODULES.keys()


@pytest.mark.slow
@pytest.mark.untraced
def test_the_site_is_built_without_a_complaint_and_fetches_nothing(tmp_path):
    pytest.importorskip("zensical")
    settings = (ROOT / "zensical.toml").read_text().replace('"out/site"', '"site"')
    settings = settings.replace('paths = ["."]', f'paths = ["{ROOT}"]')
    (tmp_path / "zensical.toml").write_text(settings)
    shutil.copytree(DOCS, tmp_path / "docs")
    command = [str(Path(sys.executable).with_name("zensical")), "build", "--clean", "--strict"]
    done = subprocess.run(command, check=False, capture_output=True, text=True, timeout=240, cwd=tmp_path)
    assert done.returncode == 0, done.stdout + done.stderr
    site = tmp_path / "site"
    texts = {path.relative_to(site): path.read_text() for path in site.rglob("*.html")}
    assert len(texts) > len(list(pages(NAVIGATION)))
    loaded = r"<(?:script|link|img|iframe)[^>]+(?:src|href)=\"?(?:https?:)?//"
    assert {path: found for path, text in texts.items() if (found := re.findall(loaded, text))} == {}
    face = texts[Path("api/face.html")]
    assert 'id="agentface.face.Face.set_emotion"' in face
    assert ":class:" not in face
