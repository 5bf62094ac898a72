"""A performance in a page that needs nothing else."""

from __future__ import annotations

import base64
import gzip
import json
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

from agentface.cli import cli
from agentface.clock import FrameClock
from agentface.errors import InvalidValueError
from agentface.face import Face
from agentface.head.look import load_look
from agentface.io.web import stage
from agentface.io.web.frames import FrameReader
from agentface.io.web.layout import Layout
from agentface.io.web.performance_page import PerformancePage
from agentface.live.loop import run
from agentface.speech.sound import Sound
from tests.io.web.page.files import settled
from tests.io.web.page.served import rough_basis
from tests.tools import require_page

pytestmark = [pytest.mark.slow, pytest.mark.untraced]

EXAMPLES = Path(__file__).parents[4] / "examples"
ELEMENT = "document.querySelector('agent-face')"
FPS = 10.0


@pytest.fixture(scope="module")
def recorded():
    """A face that becomes happy within a second, as a page; and the same as a sink kept it."""
    face = Face("amber")
    page = PerformancePage(face.model, load_look(face.model), rough_basis(face, "geometric"))
    kept = []

    class Keeper:
        def show(self, frame):
            kept.append(frame.copy())

    face.set_emotion("happiness", 1.0)
    run(face, FrameClock(FPS), sinks=[page, Keeper()], fps=FPS, duration=1.0)
    require_page()
    samples = (8000 * np.sin(np.arange(8000) * 0.3)).astype(np.int16)
    return page, kept, page.content(Sound(samples, 8000))


def test_a_recording_plays_without_a_server_and_without_a_network(chromium, tmp_path, recorded):
    from tests.io.web.page.conftest import opened

    page, kept, content = recorded
    path = tmp_path / "joy.html"
    path.write_text(content)
    with opened(chromium) as tab:
        tab.context.set_offline(offline=True)
        tab.goto(path.as_uri())
        tab.wait_for_selector("button:not([hidden])")
        stands = f"() => Array.from({ELEMENT}.face.skin.vertices)"
        first = np.reshape(tab.evaluate(stands), (-1, 3))
        tab.evaluate(f"{ELEMENT}.addEventListener('ended', () => {{ window.over = true; }})")
        tab.click("button")
        tab.wait_for_function("window.over")
        last = np.reshape(tab.evaluate(stands), (-1, 3))
    model = settled("amber")[0].model
    reader = FrameReader(model, page._basis, page._writer.layouts["basis"])
    for seen, message in ((first, page._messages[0]), (last, page._messages[-1])):
        assert np.abs(seen - reader.read(message)[1]).max() < 1e-6
    assert np.abs(last - first).max() > 0.003
    assert len(kept) == len(page._messages)


def test_a_page_holds_the_licences_of_what_is_in_it(recorded):
    content = recorded[2]
    assert "three 0." in content
    assert "Permission is hereby granted" in content
    assert content.count("</script>") == content.count("<script") == 4
    assert "http://" not in content.partition('<script type="module">')[0].replace("http://www.w3.org", "")


def test_a_page_without_frames_is_refused(recorded):
    model = settled("amber")[0].model
    with pytest.raises(InvalidValueError, match="one frame or more"):
        PerformancePage(model, load_look(model), recorded[0]._basis).record()


def test_export_writes_a_page(tmp_path, monkeypatch):
    require_page()
    monkeypatch.setattr(stage, "basis_of", rough_basis)
    path = tmp_path / "surprise.html"
    command = [
        "export",
        str(path),
        "--performance",
        str(EXAMPLES / "surprise_then_joy.fap"),
        "--fps",
        "5",
        "--json",
        "-",
    ]
    ran = CliRunner().invoke(cli, command)
    assert ran.exit_code == 0, ran.output
    told = json.loads(ran.stdout)
    assert (told["format"], told["bytes"], told["sound"]) == ("html", path.stat().st_size, False)
    record = json.loads(path.read_text().partition('id="performance">')[2].partition("</script>")[0])
    size = 1 + Layout.from_json(record["fields"]).size
    assert len(gzip.decompress(base64.b64decode(record["frames"]))) == size * told["frames"]


def test_export_of_a_page_wants_a_performance():
    ran = CliRunner().invoke(cli, ["export", "x.html"])
    assert ran.exit_code == 2
    assert "--performance FILE" in ran.output
