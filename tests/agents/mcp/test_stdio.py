"""The command as programs start it: a child that talks over its standard streams."""

from __future__ import annotations

import asyncio
import json
import os
import signal
import subprocess
import sys
import threading

import anyio
import pytest

pytest.importorskip("mcp")

from mcp.client.client import Client
from mcp.client.stdio import StdioServerParameters, stdio_client

from agentface.agents.mcp.stdio import LONGEST_LINE, lines

COMMAND = [sys.executable, "-m", "agentface", "mcp", "--view", "none", "--liveliness", "0"]
# numpy's forms are there at once
ENVIRONMENT = {**os.environ, "NUMBA_DISABLE_JIT": "1"}
HELLO = {
    "jsonrpc": "2.0",
    "id": 1,
    "method": "initialize",
    "params": {"protocolVersion": "2025-06-18", "capabilities": {}, "clientInfo": {"name": "test", "version": "1"}},
}


@pytest.mark.slow
@pytest.mark.untraced
def test_a_client_starts_it_moves_the_face_and_ends_it():
    async def run():
        parameters = StdioServerParameters(command=COMMAND[0], args=COMMAND[1:], env=ENVIRONMENT)
        async with Client(stdio_client(parameters)) as client:
            tools = (await client.list_tools()).tools
            done = await client.call_tool("set_emotion", {"emotion": "joy", "intensity": 0.6})
            wrong = await client.call_tool("set_emotion", {"emotion": "jolly"})
            return tools, done, wrong

    tools, done, wrong = asyncio.run(run())
    assert len(tools) == 12
    assert done.structured_content["emotion"]["happiness"] == 0.6
    assert "Known: happiness" in wrong.content[0].text


@pytest.fixture
def child():
    pipe = subprocess.PIPE
    with subprocess.Popen(COMMAND, stdin=pipe, stdout=pipe, stderr=pipe, text=True, env=ENVIRONMENT) as process:
        yield process
        process.kill()


def send(child, *messages):
    for message in messages:
        child.stdin.write((message if isinstance(message, str) else json.dumps(message)) + "\n")
    child.stdin.flush()


def answers(child, count):
    return [json.loads(child.stdout.readline()) for _ in range(count)]


@pytest.mark.slow
@pytest.mark.untraced
def test_nothing_but_the_protocol_is_on_its_output_and_it_ends_with_its_input(child):
    ask = {"jsonrpc": "2.0", "id": 2, "method": "tools/call", "params": {"name": "status", "arguments": {}}}
    send(child, HELLO, {"jsonrpc": "2.0", "method": "notifications/initialized"}, "no json at all", "", ask)
    told = answers(child, 2)
    assert [answer["id"] for answer in told] == [1, 2]
    assert told[0]["result"]["serverInfo"]["name"] == "agentface"
    assert told[1]["result"]["structuredContent"]["face"] == "amber"
    rest, complaints = child.communicate(timeout=120)
    assert all(json.loads(line)["jsonrpc"] == "2.0" for line in rest.splitlines())
    assert "Traceback" not in complaints
    assert child.returncode == 0


@pytest.mark.slow
@pytest.mark.untraced
def test_it_ends_when_it_is_told_to_though_its_input_goes_on(child):
    send(child, HELLO)
    assert answers(child, 1)[0]["id"] == 1
    child.send_signal(signal.SIGTERM)
    assert child.wait(120) == 0


def read(*parts: bytes) -> list[str]:
    """What comes of bytes that are written one after the other."""
    ours, theirs = os.pipe()

    def write():
        for part in parts:
            os.write(theirs, part)
        os.close(theirs)

    async def run():
        return [line async for line in lines(ours)]

    writer = threading.Thread(target=write)
    writer.start()
    try:
        return anyio.run(run)
    finally:
        writer.join()
        os.close(ours)


def test_lines_come_whole_however_they_are_cut():
    assert read(b"one\ntw", b"o\n", b"", b"thr", b"ee") == ["one", "two", "three"]
    assert read() == []
    assert read("é\n".encode()[:1], "é\n".encode()[1:]) == ["é"]
    assert read(b"\xff\n") == ["\ufffd"]


def test_a_line_without_end_is_not_kept():
    got = read(b"a\n", b"x" * (3 * LONGEST_LINE), b"\nb\n")
    assert (got[0], got[-1]) == ("a", "b")
    assert sum(map(len, got)) < 200


def test_reading_ends_when_it_is_cancelled():
    ours, theirs = os.pipe()

    async def run():
        with anyio.move_on_after(0.05) as scope:
            async for line in lines(ours):
                pytest.fail(line)
        return scope.cancelled_caught

    assert anyio.run(run)
    os.close(ours)
    os.close(theirs)


def test_a_file_is_read_to_its_end(tmp_path):
    path = tmp_path / "messages"
    path.write_text("one\ntwo\n")

    async def run():
        with path.open() as file:
            return [line async for line in lines(file.fileno())]

    assert anyio.run(run) == ["one", "two"]
