from __future__ import annotations

import errno
import json
import socket
import threading

import pytest
from osc_bytes import message

from agentface import EmotionState, Face
from agentface.errors import ServerError
from agentface.io import datagrams
from agentface.io.datagrams import MOST_WAITING
from agentface.io.osc import server as server_module
from agentface.io.osc.codec import decode
from agentface.io.osc.server import OscServer
from tests.heads import head_model
from tests.waiting import until

WHO = "OSC server", "--osc"


@pytest.fixture(scope="module")
def model():
    return head_model()


@pytest.fixture
def face(model):
    return Face(model)


@pytest.fixture
def server(face):
    with OscServer(face, port=0) as server:
        yield server


@pytest.fixture
def client(server):
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as client:
        client.connect((server.host, server.port))
        client.settimeout(0.05)
        yield client


def step(server):
    server.take_in()
    for face in server._receiver._faces.values():
        face.step(0.01)


def hear(server, client):
    """The next answer, while the face is stepped."""
    while True:
        step(server)
        try:
            return decode(client.recv(65536))[0]
        except TimeoutError:
            continue


def wait_for(condition, server):
    until(condition, lambda: step(server))


def test_a_message_over_a_socket_and_the_status(server, client):
    client.send(message("/agentface/emotion", "sff", "joy", 0.5, 0))
    client.send(message("/agentface/status"))
    status = json.loads(hear(server, client).arguments[0])
    assert status["emotion"]["happiness"] == status["shown"]["emotion"]["happiness"] == 0.5


def test_errors_come_back_to_the_sender(face, server, client):
    client.send(message("/agentface/emotion", "sf", "joi", 0.5))
    answer = hear(server, client)
    assert answer.address == "/agentface/error"
    assert answer.arguments[0] == "/agentface/emotion"
    client.send(b"/agentface/emotion\0\0,sf")
    assert hear(server, client).arguments[0] == "/agentface/emotion"
    client.send(b"\xff" * 60_000)
    assert "more than" in hear(server, client).arguments[1]
    client.send(b"")
    assert hear(server, client).arguments[0] == ""
    assert face.message_counts.errors == {"malformed": 3, "unknown": 0, "rejected": 1}


def test_a_flood_leaves_the_newest_state_and_no_queue(face, server, client):
    for number in range(20_000):
        client.send(message("/agentface/emotion", "sf", "joy", number / 20_000))
        if number % 500 == 0:
            step(server)
            assert len(server._listener.waiting) <= MOST_WAITING

    def last_word():  # repeated: the system drops what comes faster than it is read
        client.send(message("/agentface/emotion", "sf", "joy", 0.25))
        step(server)

    until(lambda: face.emotion == EmotionState.of(happiness=0.25), last_word)
    step(server)
    wait_for(lambda: not server._listener.waiting, server)
    assert face.message_counts.errors == {"malformed": 0, "unknown": 0, "rejected": 0}


def test_without_steps_the_oldest_are_dropped(face, server, client):
    for number in range(3 * MOST_WAITING):
        packet = message("/agentface/emotion", "sf", "joy", number / (3 * MOST_WAITING))
        client.send(packet)
        if number % 64 == 63:  # no more at once than the system keeps
            until(lambda: server._listener.waiting and server._listener.waiting[-1][0] == packet)  # noqa: B023 - done before it changes
    assert len(server._listener.waiting) == MOST_WAITING
    step(server)
    assert face.emotion["happiness"] > 0.9
    assert face.message_counts.messages == MOST_WAITING


def test_a_sender_that_is_gone_does_not_stop_the_server(face, server, client):
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as gone:
        gone.connect((server.host, server.port))
        gone.send(message("/agentface/status"))
    wait_for(lambda: face.message_counts.messages == 1, server)
    client.send(message("/agentface/status"))
    assert hear(server, client).address == "/agentface/status"


def test_a_taken_port_is_one_clear_error(face, server):
    with pytest.raises(ServerError, match=f"port {server.port} of 127.0.0.1.*--osc"):
        OscServer(face, port=server.port)
    with pytest.raises(ServerError, match="no such host"):
        OscServer(face, "no such host.invalid")


@pytest.mark.parametrize("host", ["127.0.0.1", "localhost", "LOCALHOST"])
@pytest.mark.parametrize("there", [(socket.AF_INET, "127.0.0.1"), (socket.AF_INET6, "::1")], ids=["v4", "v6"])
def test_whatever_localhost_means_it_is_heard_and_answered(face, host, there):
    family, place = there
    with OscServer(face, host, 0) as server, socket.socket(family, socket.SOCK_DGRAM) as client:
        client.connect((place, server.port))
        client.settimeout(0.05)
        client.send(message("/agentface/emotion", "sf", "joy", 0.5))
        wait_for(lambda: face.emotion["happiness"] == 0.5, server)
        client.send(message("/agentface/status"))
        assert hear(server, client).address == "/agentface/status"


def test_the_loopback_is_all_that_it_listens_on(server):
    places = {listener.getsockname()[0] for listener in server._listener.sockets}
    assert places == {"127.0.0.1", "::1"}
    assert {listener.getsockname()[1] for listener in server._listener.sockets} == {server.port}


def test_one_address_alone_is_taken_at_its_word(face):
    with OscServer(face, "::1", 0) as server:
        assert [listener.getsockname()[0] for listener in server._listener.sockets] == ["::1"]


def test_a_machine_without_ipv6_listens_on_what_it_has(face, monkeypatch):
    listen = datagrams._listen

    def without(host, port, who):
        if ":" in host:
            raise ServerError("none") from OSError(errno.EADDRNOTAVAIL, "none")
        return listen(host, port, who)

    monkeypatch.setattr(datagrams, "_listen", without)
    with OscServer(face, port=0) as server:
        assert [listener.getsockname()[0] for listener in server._listener.sockets] == ["127.0.0.1"]


def test_a_port_taken_under_the_other_address_is_told_or_passed_over(face):
    with socket.socket(socket.AF_INET6, socket.SOCK_DGRAM) as taken:
        taken.bind(("::1", 0))
        port = taken.getsockname()[1]
        with pytest.raises(ServerError, match=f"port {port} of ::1"):
            OscServer(face, port=port)


def test_what_the_system_refuses_is_blamed_on_nobody_else():
    error = datagrams._refused("127.0.0.1", 80, PermissionError(errno.EACCES, "Permission denied"), WHO)
    assert "the right to listen on port 80" in str(error)
    assert "program" not in str(error)
    error = datagrams._refused("10.9.8.7", 7400, OSError(errno.EADDRNOTAVAIL, "Cannot assign requested address"), WHO)
    assert "an address of this machine, got '10.9.8.7'" in str(error)
    assert "program" not in str(error)


def test_closing_frees_the_port_and_the_thread(face):
    def listening():
        return [thread for thread in threading.enumerate() if thread.name == "agentface-osc"]

    before = listening()
    server = OscServer(face, port=0)
    assert len(listening()) == len(before) + 2
    server.close()
    server.close()
    assert listening() == before
    OscServer(face, port=server.port).close()


def test_it_listens_on_this_machine_alone_by_default(server):
    assert server.host == "127.0.0.1"
    assert (server_module.DEFAULT_HOST, server_module.DEFAULT_PORT) == ("127.0.0.1", 7400)
