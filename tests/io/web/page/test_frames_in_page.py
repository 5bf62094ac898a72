"""What the page makes of messages, good and hostile, without a server."""

from __future__ import annotations

import numpy as np
import pytest

from agentface.io.web.layout import Field, Layout

pytestmark = [pytest.mark.slow, pytest.mark.untraced]

LAYOUT = Layout([
    Field("frame", "u32"),
    Field("time_s", "f64"),
    Field("skin", "i16", 3, 1e-4),
    Field("jaw", "i16", 2, (0.5, 2.0)),
    Field("skin", "i8", 2, 0.01),
    Field("levels", "u8", 2, 1 / 255),
    Field("far", "f32", 1, 2.0),
])  # fmt: skip
VALUES = {
    "frame": 7,
    "time_s": 1.25,
    "skin": [0.1, -0.2, 0.3, 0.5, -1.0],
    "jaw": [1.0, -4.0],
    "levels": [0.0, 1.0],
    "far": 3.0,
}


@pytest.fixture(scope="module")
def page(chromium, files):
    from tests.io.web.page.conftest import opened

    with opened(chromium) as made:
        made.goto(files.add("frames.html", "<!doctype html><title>frames</title>"))
        made.evaluate("import('/agentface.js').then((all) => { window.all = all; })")
        yield made


def test_a_record_is_read_by_the_fields_it_is_told(page):
    record = bytes(1) + LAYOUT.encode(VALUES)
    read = page.evaluate(
        """([fields, bytes]) => {
          const frame = new all.FrameReader(fields).read(Uint8Array.from(bytes).buffer);
          const numbers = (value) => (typeof value === "number" ? [value] : Array.from(value));
          const rows = Object.entries(frame).map(([name, value]) => [name, numbers(value)]);
          return Object.fromEntries(rows);
        }""",
        [LAYOUT.as_json(), list(record)],
    )
    for name, expected in LAYOUT.decode(record[1:]).items():
        np.testing.assert_allclose(read[name], expected, rtol=1e-12, atol=1e-12)


def test_the_newest_frame_is_taken_once_and_what_is_no_frame_never(page):
    record = bytes(1) + LAYOUT.encode(VALUES)
    newer = bytes(1) + LAYOUT.encode(VALUES | {"frame": 8})
    taken = page.evaluate(
        """([fields, ...records]) => {
          const connection = new all.Connection('ws://127.0.0.1:1/live');
          connection.addEventListener('message', ({ detail }) => { window.told = detail; });
          const get = (bytes) => connection.readBytes(Uint8Array.from(bytes).buffer);
          const took = () => connection.take()?.frame ?? null;
          const found = [];
          get(records[0]);                                     // before hello
          found.push(took());
          const texts = ['', '{', '[]', 'null', '{"type":1}', '{"id":{}}', '{"type":"hello","fields":[]}'];
          for (const text of texts) connection.readText(text);
          connection.readText(JSON.stringify({ type: 'hello', fields }));
          get(records[0]); get(records[1]);
          found.push(took(), took());
          const wrong = [
            [], [0], records[0].slice(1), [...records[0], 0],
            [9, 1, 2], [2, 1], [2, ...Array(14).fill(255)], [2, ...Array(20).fill(255)],
          ];
          wrong.forEach(get);
          found.push(took(), connection.refused);
          connection.readText(JSON.stringify({ type: 'hello', fields: [{ name: 'x', type: 'f16', count: 1 }] }));
          get(records[0]);
          found.push(took(), window.told.error.where);
          connection.close();
          return found;
        }""",
        [LAYOUT.as_json(), list(record), list(newer)],
    )
    assert taken == [None, 8, None, None, 6, None, "hello"]


def test_a_head_of_another_version_is_refused(page, files):
    content = bytearray((files.folder / files.head("amber").rpartition("/")[2]).read_bytes())
    content = content.replace(b'"AGENTFACE_face":{"version":1', b'"AGENTFACE_face":{"version":9')
    refused = "(url) => all.Face3D.load(url).catch((error) => error.message)"
    assert "two versions" in page.evaluate(refused, files.add("other.glb", bytes(content)))
    assert "expected a binary glTF" in page.evaluate(refused, files.add("none.glb", b"no head at all"))
    assert "expected the head, got 404" in page.evaluate(refused, f"{files.address}/missing.glb")
