"""The tools over HTTP: the SDK's client is let in, and nobody else."""

from __future__ import annotations

import asyncio
import json
from contextlib import closing, contextmanager
from http.client import HTTPConnection

import pytest

pytest.importorskip("mcp")

from mcp.client.client import Client
from mcp.client.streamable_http import streamable_http_client

from agentface.agents.mcp.http import PATH, serve_http
from agentface.agents.mcp.server import face_server
from agentface.errors import InvalidValueError, ServerError
from tests.agents.mcp.stepping import stepped
from tests.voices import talking_face

TOKEN = "-".join(["a", "token", "of", "a", "test"])
HELLO = {
    "jsonrpc": "2.0",
    "id": 1,
    "method": "initialize",
    "params": {"protocolVersion": "2025-06-18", "capabilities": {}, "clientInfo": {"name": "test", "version": "1"}},
}


@pytest.fixture(scope="module")
def actor():
    with talking_face() as face, stepped(face) as made:
        yield made


@contextmanager
def served(actor, **options):
    with serve_http(face_server(actor), "127.0.0.1", 0, **options) as address:
        yield address


def status(address, body=None, **headers):
    """What a request is answered, by its status."""
    headers = {"Content-Type": "application/json", "Accept": "application/json, text/event-stream"} | {
        name.replace("_", "-"): value for name, value in headers.items()
    }
    connection = HTTPConnection(address.host, address.port, timeout=60)
    connection.request("POST", PATH, json.dumps(body or HELLO), headers)
    with closing(connection):
        return connection.getresponse().status


def test_the_sdk_s_client_moves_the_face(actor):
    async def run(url):
        async with Client(streamable_http_client(url)) as client:
            done = await client.call_tool("set_emotion", {"emotion": "fear", "intensity": 0.5})
            wrong = await client.call_tool("gesture", {"name": "wave"})
            return done, wrong

    with served(actor) as address:
        done, wrong = asyncio.run(run(address.url))
    assert done.structured_content["emotion"]["fear"] == 0.5
    assert wrong.is_error


def test_host_and_origin_are_checked_on_the_loopback_too(actor):
    with served(actor, origins=["https://ours.example"]) as address:
        assert status(address) == 200
        assert status(address, Host="evil.example") == 403
        assert status(address, Origin="https://evil.example") == 403
        assert status(address, Origin="null") == 403
        assert status(address, Sec_Fetch_Site="cross-site") == 403
        assert status(address, Origin="https://ours.example") == 200
        assert status(address, Origin=f"http://{address.host}:{address.port}") == 200


def test_a_token_is_asked_for(actor):
    with served(actor, token=TOKEN) as address:
        assert status(address) == 401
        assert status(address, Authorization="Bearer another-token-here") == 401
        assert status(address, Authorization=f"Bearer {TOKEN}") == 200
        assert any(TOKEN in line for line in address.access.told("it"))


def test_what_is_too_large_is_refused(actor):
    with served(actor) as address:
        assert status(address, {**HELLO, "params": {"much": "x" * 300_000}}) == 413
        assert status(address) == 200


def test_an_address_that_is_taken_is_one_error(actor):
    with served(actor) as address, pytest.raises(ServerError, match=r"--http HOST:PORT"):
        serve_http(face_server(actor), "127.0.0.1", address.port)
    with pytest.raises(InvalidValueError, match="origin"):
        serve_http(face_server(actor), "127.0.0.1", 0, origins=["*"])
    with pytest.raises(ServerError, match="address of this machine"):
        serve_http(face_server(actor), "no.such.host.invalid", 0, token=TOKEN)
