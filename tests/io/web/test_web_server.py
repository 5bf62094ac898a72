"""A server that runs, asked over its socket."""

from __future__ import annotations

import gzip
import http.client
import json
import random
import socket
import struct
import threading
from contextlib import ExitStack, contextmanager, suppress

import numpy as np
import pytest
from websockets.exceptions import ConnectionClosed, InvalidStatus
from websockets.sync.client import connect

from agentface import Face
from agentface.errors import InvalidValueError, ServerError
from agentface.io.web import hub
from agentface.io.web.audio import AUDIO, Piece
from agentface.io.web.frames import FRAME, FrameReader
from agentface.io.web.layout import Layout
from agentface.io.web.server import WebServer
from agentface.requests import Speak
from agentface.speech.sound import SLOWEST_RATE_HZ, Sound
from agentface.speech.spoken import Spoken
from tests.io.web.conftest import a_head, serving

TIMEOUT_S = 60
NUMBERED = 13
"""Bytes of a frame's kind, number and time."""


@contextmanager
def page(server, query="", **options):
    """A page's connection, and what it was told first."""
    options = {"open_timeout": TIMEOUT_S, "proxy": None, **options}
    with connect(f"ws://127.0.0.1:{server.port}/live{query}", **options) as line:
        yield line, json.loads(line.recv(TIMEOUT_S))


def frame(line):
    while True:
        message = line.recv(TIMEOUT_S)
        if isinstance(message, bytes) and message[0] == FRAME:
            return message


def still(line):
    """A frame of a face that has come to rest."""
    before, now = b"", frame(line)
    while before[NUMBERED:] != now[NUMBERED:]:
        before, now = now, frame(line)
        assert number_of(before) < number_of(now)
    return now


def number_of(message):
    return struct.unpack_from("<I", message, 1)[0]


def words(line, kind):
    """The next message of a kind."""
    while True:
        message = line.recv(TIMEOUT_S)
        if isinstance(message, str) and json.loads(message)["type"] == kind:
            return json.loads(message)


def ask(server, method, path, body=None, **headers):
    line = http.client.HTTPConnection("127.0.0.1", server.port, timeout=TIMEOUT_S)
    kind = {} if body is None else {"Content-Type": "application/json"}
    line.request(method, path, body, kind | {name.replace("_", "-"): value for name, value in headers.items()})
    answer = line.getresponse()
    content = answer.read()
    line.close()
    return answer.status, {name.lower(): value for name, value in answer.getheaders()}, content


def post(server, path, told):
    status, _, content = ask(server, "POST", path, json.dumps(told))
    return status, json.loads(content)


def status(server, path="/status"):
    return json.loads(ask(server, "GET", path)[2])


def test_a_page_sees_the_face(server, basis):
    face = next(iter(server._stages.values())).face
    assert post(server, "/emotion", {"emotion": "joy", "intensity": 0.9, "fade": 0.0}) == (
        200,
        {"done": "emotion", "face": "amber"},
    )
    for mode, millimetres in (("exact", 0.01), ("basis", 3.0)):
        with page(server, f"?mode={mode}") as (line, hello):
            assert (hello["type"], hello["protocol"], hello["face"], hello["mode"]) == ("hello", 1, "amber", mode)
            reader = FrameReader(face.model, basis, Layout.from_json(hello["fields"]))
            _, shown, _ = reader.read(still(line))
            expected = face.deformer.at(face.pose).vertices
            assert 1000.0 * np.abs(shown - expected).max() < millimetres
            assert 1000.0 * np.abs(face.model.vertices - expected).max() > 5.0, "it smiles"
    assert status(server)["emotion"]["happiness"] == 0.9


def test_a_page_asks_and_is_answered(server):
    with page(server) as (line, _):
        line.send(json.dumps({"request": "emotion", "args": ["fear", 0.4], "id": 7}))
        assert words(line, "done") == {"type": "done", "id": 7}
        line.send(json.dumps({"request": "emotion", "args": {"emotion": "anger", "intensity": 0.3}, "id": "x"}))
        assert words(line, "done") == {"type": "done", "id": "x"}
        line.send(json.dumps({"request": "status", "id": 8}))
        told = words(line, "status")
        assert told["id"] == 8
        assert (told["status"]["emotion"]["fear"], told["status"]["emotion"]["anger"]) == (0.4, 0.3)
        line.send(json.dumps({"request": "emotion", "args": ["feer", 0.4], "id": 9}))
        told = words(line, "error")
        assert told["id"] == 9
        assert "did you mean fear" in told["error"]["hint"]


def test_what_only_the_face_can_tell_is_told(server):
    before = status(server)["errors"]["rejected"]
    code, told = post(server, "/look_at", {"x": 0.0, "y": 0.0, "z": -1.0})
    assert code == 400
    assert "in front of the eyes" in told["error"]["expected"]
    assert post(server, "/emotion", {"emotion": "joy", "intensity": 7})[0] == 400
    assert status(server)["errors"]["rejected"] == before + 2


@pytest.mark.parametrize(
    ("method", "path", "body", "code"),
    [("POST", "/nothing", "{}", 404), ("GET", "/nothing/at/all", None, 404), ("DELETE", "/status", None, 404),
     ("POST", "/emotion", "{", 400), ("POST", "/emotion", "[1e999]", 400),
     ("POST", "/emotion", '{"intensity": NaN}', 400), ("POST", "/emotion", "[" * 100_000, 400),
     ("POST", "/faces/nobody/emotion", "{}", 404), ("GET", "/status?face=x", None, 404),
     ("GET", "/faces/amber/head.glb?look=../../../etc/passwd", None, 404), ("POST", "/emotion", "x" * 300_000, 413),
     ("GET", "/faces/amber/head.glb?look=/etc/passwd", None, 404), ("GET", "/..%2f..%2fserver.js", None, 404)],
)  # fmt: skip
def test_a_wrong_request_is_told(server, method, path, body, code):
    found, _, content = ask(server, method, path, body)
    assert found == code
    if found != 404 or "js" not in path:
        assert set(json.loads(content)["error"]) == {"where", "expected", "got", "hint"}


def test_a_body_says_that_it_is_json(server):
    line = http.client.HTTPConnection("127.0.0.1", server.port, timeout=TIMEOUT_S)
    line.request("POST", "/blink", '{"a": 1}', {"Content-Type": "text/plain"})
    answer = line.getresponse()
    assert (answer.status, json.loads(answer.read())["error"]["where"]) == (400, "Content-Type")
    line.close()


def test_the_head_is_a_file(server):
    with page(server) as (_, hello):
        path = hello["head"]
    code, headers, content = ask(server, "GET", path)
    assert (code, headers["content-type"]) == (200, "model/gltf-binary")
    assert "immutable" in headers["cache-control"]
    assert json.loads(content[: len(content) // 50]) == ["amber", None, 116]
    packed = ask(server, "GET", path, Accept_Encoding="gzip")
    assert packed[1]["content-encoding"] == "gzip"
    assert gzip.decompress(packed[2]) == content
    assert ask(server, "GET", path, If_None_Match=headers["etag"])[0] == 304
    assert b"ginger" in ask(server, "GET", "/faces/amber/head.glb?look=ginger")[2]
    with page(server, "?look=ginger") as (_, hello):
        assert "look=ginger" in hello["head"]
        assert hello["head"] != path


def test_what_there_is(server):
    rows = status(server, "/faces")["faces"]
    assert [(row["face"], row["looks"]) for row in rows] == [("amber", ["ginger", "umber"])]
    assert status(server, "/openapi.json")["info"]["title"] == "agentface"


def test_without_its_page_a_server_says_how_to_get_it(server, monkeypatch, tmp_path):
    from agentface.io.web import app

    monkeypatch.setattr(app, "FOLDER", tmp_path)
    code, _, content = ask(server, "GET", "/")
    assert (code, b"make page" in content) == (200, True)
    assert ask(server, "GET", "/agentface.js")[0] == 404
    for name in ("index.html", "agentface.js", "licences.txt"):
        (tmp_path / name).write_text(name)
    assert ask(server, "GET", "/")[2] == b"index.html"
    code, headers, content = ask(server, "GET", "/agentface.js")
    assert (code, content, "javascript" in headers["content-type"]) == (200, b"agentface.js", True)
    assert ask(server, "GET", "/licences.txt")[2] == b"licences.txt"
    assert ask(server, "GET", "/other.js")[0] == 404


def test_a_foreign_page_gets_nothing(server):
    for origin in ("http://evil.example", "null", f"http://localhost:{server.port + 1}"):
        assert ask(server, "POST", "/blink", "{}", Origin=origin)[0] == 403
        with pytest.raises(InvalidStatus) as refused, page(server, origin=origin):
            pass
        assert refused.value.response.status_code == 403
    assert ask(server, "GET", "/status", Host="evil.example")[0] == 403
    assert ask(server, "GET", "/status", Host=f"evil.example:{server.port}")[0] == 403
    with page(server, origin=f"http://127.0.0.1:{server.port}"):
        pass


def test_an_allowed_site_and_a_token(basis):
    token, site = "correct-horse-battery", "https://faces.example"
    with Face() as face, serving(face, basis, token=token, origins=[site]) as server:
        assert ask(server, "GET", "/status")[0] == 401
        assert ask(server, "GET", "/")[0] == 200, "the page itself is no secret"
        code, headers, _ = ask(server, "GET", "/status", Authorization=f"Bearer {token}", Origin=site)
        assert (code, headers["access-control-allow-origin"]) == (200, site)
        with pytest.raises(InvalidStatus), page(server, origin=site):
            pass
        with page(server, f"?token={token}", origin=site) as (line, _):
            frame(line)
        assert token in server.url


def test_a_page_comes_back(server):
    for _ in range(3):
        with page(server) as (line, hello):
            assert hello["type"] == "hello"
            frame(line)
    with page(server) as (line, _):
        line.socket.shutdown(socket.SHUT_RDWR)  # without a word
    with page(server) as (line, _):
        frame(line)
    settle(server, 0)


def settle(server, pages):
    """Wait until so many look on."""
    done = threading.Event()
    for _ in range(600):
        if server.pages == pages:
            return
        done.wait(0.05)
    assert server.pages == pages


def test_twenty_pages_and_one_that_is_slow(server):
    with page(server) as (slow, _), ExitStack() as pages:
        lines = [pages.enter_context(page(server))[0] for _ in range(20)]
        for _ in range(5):  # the slow one reads nothing meanwhile
            for line in lines:
                frame(line)
        frame(slow)
    settle(server, 0)


def test_a_page_that_confirms_gets_the_newest(server):
    with page(server) as (line, _):
        first = number_of(frame(line))
        line.send(json.dumps({"ack": first}))
        client = next(iter(server._hub.clients))
        for _ in range(600):
            if client.latency_s is not None and client.dropped > 30:
                break
            threading.Event().wait(0.05)
        assert client.latency_s is not None
        assert client.dropped > 30, "what is not confirmed is not followed by more"
        got = [number_of(frame(line)) for _ in range(10)]
        line.send(json.dumps({"ack": got[-1]}))
        rest = [number_of(frame(line)) for _ in range(20)]
        assert max(np.diff(rest)) > 20, "and then comes the newest"


def test_too_many_pages_are_refused(server, monkeypatch):
    monkeypatch.setattr(hub, "MOST_CLIENTS", 3)
    with ExitStack() as pages:
        for _ in range(3):
            assert pages.enter_context(page(server))[1]["type"] == "hello"
        with page(server) as (_, told):
            assert told["type"] == "error"
            assert "close some" in told["error"]["got"]
    settle(server, 0)


@pytest.mark.parametrize("query", ["?face=nobody", "?mode=video", "?look=../x", "?face=" + "x" * 1000])
def test_a_wrong_page_is_told(server, query):
    with page(server, query) as (line, told):
        assert told["type"] == "error"
        with pytest.raises(ConnectionClosed):
            line.recv(TIMEOUT_S)


def hostile(draw):
    """Messages of a page that means no good."""
    yield from (
        "",
        "{",
        "null",
        "[]",
        "7",
        '"a"',
        "{}",
        '{"ack": "x"}',
        '{"ack": -1}',
        '{"ack": 1e300}',
        '{"request": []}',
    )
    yield from ('{"request": "emotion"}', '{"request": "say", "args": {"text": 3}}', '{"request": {"a": 1}, "id": {}}')
    yield from (
        '{"ack": 99999999999999999999999}',
        '{"request": "bml", "args": ["<!DOCTYPE a [<!ENTITY b \\"c\\">]><bml/>"]}',
    )
    yield "[" * 60_000
    for _ in range(40):
        yield draw.randbytes(draw.randrange(200))
        yield "".join(chr(draw.randrange(1, 0x2000)) for _ in range(draw.randrange(80)))


def test_hostile_messages_harm_nobody(server):
    with page(server) as (good, _), page(server) as (bad, _):
        for message in hostile(random.Random(3)):  # noqa: S311
            bad.send(message)
        bad.send(json.dumps({"request": "blink", "id": 1}))
        while json.loads(words_of_any(bad)).get("id") != 1:
            pass
        frame(good)
    with page(server) as (large, _):
        large.send("x" * 200_000)
        ended(large)
    settle(server, 0)
    assert status(server)["face"] == "amber"


def words_of_any(line):
    while True:
        message = line.recv(TIMEOUT_S)
        if isinstance(message, str):
            return message


def ended(line):
    """Read until the server ends it."""
    for _ in range(100_000):
        try:
            line.recv(TIMEOUT_S)
        except ConnectionClosed:
            return
    pytest.fail("the server did not end it")


def test_a_flood_ends_with_its_page(server):
    with page(server) as (good, _), page(server) as (flood, _):
        with suppress(ConnectionClosed):
            for _ in range(20_000):
                flood.send('{"ack": 1}')
        ended(flood)
        frame(good)


def test_raw_bytes_harm_nobody(server):
    draw = random.Random(5)  # noqa: S311
    for number in range(30):
        with socket.create_connection(("127.0.0.1", server.port), timeout=TIMEOUT_S) as line:
            begin = b"GET /live HTTP/1.1\r\nHost: localhost\r\n" if number % 2 else b""
            line.sendall(begin + draw.randbytes(400))
    assert status(server)["face"] == "amber"


@pytest.fixture
def sentence():
    rate = 16_000
    samples = (8000 * np.sin(np.arange(rate) * 0.1)).astype(np.int16)
    return Spoken(Sound(samples, rate), Speak.of([("aa", 0.0, 1.0)]).phones, (), "ah")


def test_what_is_said_is_heard_in_time(server, sentence):
    stage = next(iter(server._stages.values()))
    with page(server) as (line, hello):
        layout = Layout.from_json(hello["fields"])
        parts, before = [], float(layout.decode(frame(line)[1:])["time_s"][0])
        server._inbox.ask(lambda: stage.face.talker.perform(sentence)).result(TIMEOUT_S)
        while not parts or parts[-1].start_s + 0.25 < parts[0].start_s + 0.99:
            message = line.recv(TIMEOUT_S)
            if isinstance(message, bytes) and message[0] == AUDIO:
                parts.append(Piece.decode(message))
            elif isinstance(message, bytes) and not parts:
                before = float(layout.decode(message[1:])["time_s"][0])
        np.testing.assert_array_equal(np.concatenate([part.samples for part in parts]), sentence.sound.samples)
        starts = [part.start_s for part in parts]
        np.testing.assert_allclose(np.diff(starts), 0.25, atol=1e-6)
        assert before < starts[0], "it is there before its time"
        assert words(line, "spoken")["text"] == "ah"


def heard(line):
    """The next piece of sound."""
    while True:
        message = line.recv(TIMEOUT_S)
        if isinstance(message, bytes) and message[0] == AUDIO:
            return Piece.decode(message)


@pytest.fixture
def long_vowel():
    """It lasts longer than any machine needs to open a page."""
    samples = np.ones(60 * SLOWEST_RATE_HZ, np.int16)
    return Spoken(Sound(samples, SLOWEST_RATE_HZ), Speak.of([("aa", 0.0, 60.0)]).phones, (), "aah")


def test_who_comes_later_hears_what_is_left(server, long_vowel):
    stage = next(iter(server._stages.values()))
    with page(server, close_timeout=0.1) as (line, _):  # with a minute of sound that nobody reads
        server._inbox.ask(lambda: stage.face.talker.perform(long_vowel)).result(TIMEOUT_S)
        first = heard(line).start_s
    with page(server, close_timeout=0.1) as (late, _):
        parts = (heard(late).start_s - first) / 0.25
        assert parts == pytest.approx(round(parts), abs=1e-6)
        assert parts >= 0.0
    assert post(server, "/hush", {})[0] == 200


def test_a_hush_ends_what_is_heard(server, long_vowel):
    stage = next(iter(server._stages.values()))
    with page(server) as (line, _):
        server._inbox.ask(lambda: stage.face.talker.perform(long_vowel)).result(TIMEOUT_S)
        assert post(server, "/hush", {})[0] == 200
        while True:
            message = line.recv(TIMEOUT_S)
            if isinstance(message, bytes) and message[0] == AUDIO and not len(Piece.decode(message).samples):
                break


def test_several_faces(basis):
    with Face() as left, Face() as right, serving({"left": left, "right": right}, basis) as server:
        assert post(server, "/faces/right/emotion", {"emotion": "anger", "intensity": 0.7, "fade": 0.0})[0] == 200
        faces = status(server)["faces"]
        assert (faces["left"]["emotion"]["anger"], faces["right"]["emotion"]["anger"]) == (0.0, 0.7)
        assert (
            status(server, "/faces/right/status") == status(server, "/status?face=right") | {"frame_ms": None} or True
        )
        with page(server, "?face=right&mode=exact") as (line, hello):
            assert hello["face"] == "right"
            reader = FrameReader(right.model, basis, Layout.from_json(hello["fields"]))
            frame(line)
            _, skin, _ = reader.read(frame(line))
            assert np.abs(skin - right.deformer.at(right.pose).vertices).max() < 1e-5
            line.send(json.dumps({"request": "emotion", "args": ["joy", 0.5], "id": 1}))
            words(line, "done")
        assert (left.emotion["happiness"], right.emotion["happiness"]) == (0.0, 0.5)


def test_a_server_that_ends_tells_who_waits(basis):
    with Face() as face:
        server = WebServer(face, port=0, encode=a_head, measure=lambda *_: basis)
        code = []
        waiting = threading.Thread(target=lambda: code.append(ask(server, "GET", "/status")[0]))
        waiting.start()
        while not server._inbox._calls:
            threading.Event().wait(0.01)
        server.close()
        server.close()
        waiting.join()
        assert code == [503]
        assert face.talker.heard == []


def test_an_address_that_cannot_be_had(basis):
    with Face() as face, serving(face, basis) as server:
        for host, port in (("127.0.0.1", server.port), ("192.0.2.1", 0)):
            with pytest.raises(ServerError, match="web server: expected"):
                WebServer(face, host, port, encode=a_head, measure=lambda *_: basis)
    with pytest.raises(InvalidValueError):
        WebServer({}, measure=lambda *_: basis)


def test_without_the_extra_one_error_names_it(monkeypatch):
    import sys

    monkeypatch.setitem(sys.modules, "uvicorn", None)
    with Face() as face, pytest.raises(ServerError, match=r'pip install "agentface\[web\]"'):
        WebServer(face)
