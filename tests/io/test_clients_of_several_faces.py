"""Clients that others wrote, liblo's ``oscsend`` and python-osc, talk to two faces of a running ``agentface serve``."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
import threading

import pytest
from pythonosc.udp_client import SimpleUDPClient

from agentface.io.osc.codec import decode
from tests.tools import require

pytestmark = [pytest.mark.slow, pytest.mark.untraced]


@pytest.fixture(scope="module")
def port():
    command = [sys.executable, "-m", "agentface", "serve", "--osc", "127.0.0.1:0"]
    command += ["--face", "amber", "--id", "left", "--face", "onyx", "--id", "right"]
    with subprocess.Popen(
        command, stdout=subprocess.PIPE, text=True, env=os.environ | {"PYTHONUNBUFFERED": "1"}
    ) as server:
        watchdog = threading.Timer(280, server.kill)
        watchdog.start()
        try:
            line = server.stdout.readline()
            assert line.startswith("left (amber) and right (onyx) listen to OSC on 127.0.0.1:"), line
            yield int(re.search(r":(\d+)\n", line)[1])
        finally:
            watchdog.cancel()
            server.terminate()


@pytest.fixture
def client(port):
    with SimpleUDPClient("127.0.0.1", port) as client:
        yield client


def status(client, address="/agentface/status"):
    client.send_message(address, [])
    client._sock.settimeout(200)
    said = decode(client._sock.recv(65536))[0]  # python-osc's own reading ends after 4096 bytes
    assert said.address == address
    return json.loads(said.arguments[0])


def joys(client):
    return {name: face["emotion"]["happiness"] for name, face in status(client)["faces"].items()}


def test_python_osc_reaches_all_and_one(client):
    client.send_message("/agentface/emotion", ["joy", 0.75, 0.0])
    client.send_message("/agentface/right/emotion", ["joy", 0.25, 0.0])
    assert joys(client) == {"left": 0.75, "right": 0.25}
    client.send_message("/agentface/*/emotion", ["joy", 0.5])
    assert joys(client) == {"left": 0.5, "right": 0.5}
    assert status(client, "/agentface/right/status")["face"] == "onyx"


def test_oscsend_reaches_all_and_one(port, client):
    require("oscsend")

    def oscsend(address, *values):
        command = ["oscsend", "127.0.0.1", str(port), address, "sff", *values]
        subprocess.run(command, check=True, timeout=200)

    oscsend("/agentface/emotion", "joy", "1", "0")
    oscsend("/agentface/left/emotion", "joy", "0.25", "0")
    assert joys(client) == {"left": 0.25, "right": 1.0}


def test_the_error_of_one_face_names_it(client):
    client.send_message("/agentface/left/gesture", ["moonwalk"])
    said = next(iter(client.get_messages(30)))
    assert said.address == "/agentface/error"
    assert said.params[0] == "/agentface/left/gesture"
    assert "moonwalk" in said.params[1]
