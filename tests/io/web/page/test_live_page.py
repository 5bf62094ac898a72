"""The page with a live face: what it is told and shows, and how it comes back."""

from __future__ import annotations

import io
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from agentface.io.web.frames import FrameReader
from tests.io.web.page.served import serving
from tests.tools import require
from tests.waiting import until

pytestmark = [pytest.mark.slow, pytest.mark.untraced]

EXAMPLES = Path(__file__).parents[4] / "examples"

ELEMENT = "document.querySelector('agent-face')"
DRAWN = f"{ELEMENT}?.drawn > 2"
SHOWN = f"""
() => {{
  const {{ skin, shown, parts }} = {ELEMENT}.face, {{ place }} = parts.tongue.geometry.attributes;
  return {{ frame: shown.frame, vertices: Array.from(skin.vertices), tongue: Array.from(place.array) }};
}}
"""


@pytest.mark.parametrize("mode", ["basis", "exact"])
def test_page_has_the_vertices_of_the_engine(tab, served, mode):
    served.face.set_emotion("surprise", 1.0)
    tab.goto(f"{served.server.url}?mode={mode}")
    tab.wait_for_function(DRAWN)
    shown = tab.evaluate(SHOWN)
    served.face.set_emotion("surprise", 0.0)
    geometry, stage = served.sent[shown["frame"]], served.stage
    vertices, tongue = (np.reshape(shown[name], (-1, 3)) for name in ("vertices", "tongue"))
    reader = FrameReader(stage.face.model, stage.basis, stage.writer.layouts[mode])
    _, expected, expected_tongue = reader.read(stage.writer.write(mode, shown["frame"], 0.0, geometry))
    assert np.abs(vertices - expected).max() < 1e-6
    assert np.abs(tongue - expected_tongue).max() < 1e-6
    if mode == "exact":
        assert np.abs(vertices - geometry.vertices).max() < 1e-5
        assert np.abs(tongue - geometry.tongue).max() < 1e-5


def test_a_page_asks_and_is_answered(tab, served):
    tab.goto(served.server.url)
    tab.wait_for_function(DRAWN)
    assert tab.evaluate(f"{ELEMENT}.setEmotion('joy', 0.7, {{ fade: 0 }})")["type"] == "done"
    assert served.face.status()["emotion"]["happiness"] == pytest.approx(0.7)
    assert tab.evaluate(f"{ELEMENT}.status()")["emotion"]["happiness"] == pytest.approx(0.7)
    assert tab.evaluate(f"{ELEMENT}.setEmotion({{ joy: 0.1, fear: 0.4 }}).then((answer) => answer.type)") == "done"
    refused = tab.evaluate(f"{ELEMENT}.setEmotion('glee', 7).catch((error) => error.message)")
    assert "glee" in refused
    assert served.face.status()["emotion"]["fear"] == pytest.approx(0.4)
    tab.evaluate(f"{ELEMENT}.lookAt(0.3, 0.1, 1.0)")
    tab.evaluate(f"{ELEMENT}.request('neutral', 0)")


def test_an_element_that_is_moved_shows_its_face_again(tab, served):
    tab.goto(served.server.url)
    tab.wait_for_function(DRAWN)
    before = tab.evaluate(f"() => {{ const face = {ELEMENT}; document.body.append(face); return face.drawn; }}")
    tab.wait_for_function(f"{ELEMENT}.face && {ELEMENT}.drawn > {before} + 1")


def test_what_is_drawn_is_confirmed(tab, served):
    tab.goto(served.server.url)
    tab.wait_for_function(DRAWN)
    (client,) = served.server._hub.clients
    tab.wait_for_function(f"{ELEMENT}.drawn > 12")
    assert client.latency_s is not None


TIMES = f"""
async () => {{
  const median = (rows) => rows.sort((a, b) => a - b)[rows.length >> 1], {{ stage }} = {ELEMENT};
  const next = () => new Promise(requestAnimationFrame), frames = [], trips = [];
  await next();
  for (let i = 0, last = performance.now(); i < 60; i++) {{
    stage.draw();
    await next();
    frames.push(-last + (last = performance.now()));
  }}
  for (let i = 0; i < 60; i++) {{
    const start = performance.now();
    await (await fetch('/openapi.json', {{ cache: 'no-store' }})).text();
    trips.push(performance.now() - start);
  }}
  return [median(frames), median(trips)];
}}
"""


@pytest.mark.soak
def test_a_frame_is_confirmed_within_a_frame_of_the_page_and_a_round_trip(tab):
    late_ms = []
    with serving(fps=10.0) as there:
        tab.goto(f"{there.server.url}?quality=fast")
        tab.wait_for_function(DRAWN)
        (client,) = there.server._hub.clients
        confirm = client.confirm

        def confirmed(frame: int) -> None:
            confirm(frame)
            late_ms.append(1000.0 * client.latency_s)

        client.confirm = confirmed
        until(lambda: len(late_ms) >= 60)
        late = sorted(late_ms)[len(late_ms) // 2]
        frame, trip = tab.evaluate(TIMES)
    assert late <= frame + trip


def test_a_transparent_page_has_nothing_behind_the_face(tab, served):
    tab.goto(f"{served.server.url}?transparent&onclick=fetch('/')&server=http://127.0.0.1:1")
    tab.wait_for_function(DRAWN)
    assert tab.evaluate(f"{ELEMENT}.getAttributeNames()") == ["transparent"]
    tab.wait_for_timeout(500)
    picture = np.asarray(Image.open(io.BytesIO(tab.screenshot(omit_background=True))).convert("RGBA"))
    assert (picture[:10, :10] == 0).all()
    assert picture[picture.shape[0] // 2, picture.shape[1] // 2, 3] == 255


def test_a_page_comes_back_to_a_server_that_does(tab):
    with serving() as first:
        port, url = first.server.port, first.server.url
        tab.goto(url)
        tab.wait_for_function(DRAWN)
        tab.evaluate(
            f"() => {{ window.lost = 0; {ELEMENT}.addEventListener('disconnected', () => {{ window.lost += 1; }}); }}"
        )
    tab.wait_for_function("window.lost > 0")
    before = tab.evaluate(f"{ELEMENT}.drawn")
    with serving(port=port):
        tab.wait_for_function(f"{ELEMENT}.drawn > {before} + 2")


def test_a_page_from_elsewhere_has_to_be_allowed(tab, files, served):
    tab.goto(files.add("elsewhere.html", "<!doctype html><title>elsewhere</title>"))
    live = served.server.url.replace("http", "ws") + "live"
    assert (
        tab.evaluate(f"new Promise((ended) => {{ new WebSocket('{live}').onclose = () => ended('refused'); }})")
        == "refused"
    )
    asked = f"fetch('{served.server.url}emotion', {{ method: 'POST', mode: 'no-cors', body: '{{}}' }})"
    before = served.face.status()["messages"]
    tab.evaluate(f"{asked}.then(() => true, () => false)")
    assert served.face.status()["messages"] == before


def test_words_in_the_embedded_page_are_spoken(tab, files):
    require("flite")
    with serving(origins=[files.address]) as served:
        page = (
            (EXAMPLES / "embedded_face.html")
            .read_text()
            .replace("http://127.0.0.1:8080", served.server.url.rstrip("/"))
        )
        tab.goto(files.add("embedded.html", page))
        tab.wait_for_function(DRAWN)
        tab.fill("input", "Hello.")
        tab.press("input", "Enter")
        tab.wait_for_function("document.querySelector('output').value === 'Hello.'")
        until(lambda: served.face.status()["speech"] is None)
