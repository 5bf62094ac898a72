"""Another implementation of OSC, liblo, talks to a running ``agentface serve`` and reads its answers."""

from __future__ import annotations

import json
import os
import re
import socket
import subprocess
import sys
import threading

import pytest
from liblo import oscdump, oscsend
from osc_bytes import message

from tests.tools import require

pytestmark = [pytest.mark.slow, pytest.mark.untraced]


@pytest.fixture(scope="module")
def port():
    """The port of a server in a process of its own."""
    require("oscsend", "oscdump")
    command = [sys.executable, "-m", "agentface", "serve", "--osc", "127.0.0.1:0"]
    environment = os.environ | {"PYTHONUNBUFFERED": "1"}
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True, env=environment) as server:
        watchdog = threading.Timer(280, server.kill)
        watchdog.start()
        try:
            yield int(re.search(r"127\.0\.0\.1:(\d+)", server.stdout.readline())[1])
        finally:
            watchdog.cancel()
            server.terminate()


@pytest.fixture
def client(port):
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as client:
        client.connect(("127.0.0.1", port))
        client.settimeout(200)
        yield client


def answer(client: socket.socket, address: str, tags: str = "", *values: object) -> bytes:
    client.send(message(address, tags, *values))
    return client.recv(65536)


def status(client: socket.socket) -> dict:
    packet = answer(client, "/agentface/status")
    return json.loads(packet[packet.index(b"{") :].rstrip(b"\0"))


def test_what_oscsend_sends_moves_the_face(port, client):
    oscsend(port, "/agentface/emotion", "sff", "joy", 0.75, 0.0)
    oscsend(port, "/agentface/emotion", "sdi", "anger", 0.25, 0)
    oscsend(port, "/agentface/muscle", "sf", "frontalis_medialis_l", 0.5)
    oscsend(port, "/agentface/head", "iii", 10, 0, 0)
    said = status(client)
    assert said["emotion"]["happiness"] == 0.75
    assert said["emotion"]["anger"] == 0.25
    assert sum(said["errors"].values()) == 0
    oscsend(port, "/agentface/neutral", "f", 0.0)
    assert status(client)["emotion"] == dict.fromkeys(said["emotion"], 0.0)


def test_oscdump_reads_the_status(client, tmp_path):
    (line,) = oscdump(answer(client, "/agentface/status"), tmp_path)
    read = re.fullmatch(r'/agentface/status s "(.*)"', line)
    assert read, line
    assert json.loads(read[1])["face"] == "amber"


def test_oscdump_reads_an_error(client, tmp_path):
    (line,) = oscdump(answer(client, "/agentface/emotion", "sf", "joi", 0.5), tmp_path)
    assert line.startswith('/agentface/error sss "/agentface/emotion" "')
    assert "joi" in line
