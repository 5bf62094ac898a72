"""A thousand messages a second: no frame is dropped, and each shows the newest state.

Whether a frame comes too late depends on what else a machine does; what is tested is whether there is time for it. So
the clock here counts the processor's time of the loop and of the server's threads as theirs, and nothing else: while
the loop waits, the messages of that time are sent through a real socket, which takes none.
"""

from __future__ import annotations

import socket
import time

import pytest
from osc_bytes import message

from agentface import Face
from agentface.io.osc.server import OscServer
from agentface.live.loop import run
from tests.heads import head_model

FPS, A_SECOND = 60, 1000


class WorkClock:
    """The processor's time of what works between two waits, and the time that is waited; ``meanwhile`` gets its end."""

    def __init__(self, meanwhile):
        self._meanwhile = meanwhile
        self._passed = 0.0
        self._mark = time.process_time()

    def now(self):
        return self._passed + time.process_time() - self._mark

    def date(self):
        return 1e9 + self.now()

    def sleep(self, seconds):
        self._passed = self.now() + max(0.0, seconds)
        ours, whole = time.thread_time(), time.process_time()
        self._meanwhile(self._passed)
        self._mark = time.process_time()
        self._passed += (self._mark - whole) - (time.thread_time() - ours)  # what the server's threads have done


class Flood:
    """Sends the messages that are due; a sink that sees whether the newest of them is shown."""

    def __init__(self, face, server):
        self._face, self._server, self.sent, self.frames = face, server, 0, []
        self._client = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._client.connect((server.host, server.port))
        self._joy = face.emotion["happiness"]

    def until(self, time_s):
        before = self.sent
        while self.sent < time_s * A_SECOND:
            self._client.send(self._next())
            self.sent += 1
        end = time.monotonic() + 30
        while len(self._server._listener.waiting) < self.sent - before:
            assert time.monotonic() < end, "a datagram is lost"
            time.sleep(0.0002)

    def show(self, frame):
        assert self._face.emotion["happiness"] == self._joy
        self.frames.append(frame.time_s)

    def close(self):
        self._client.close()

    def _next(self):
        share = self.sent % 256 / 256
        match self.sent % 10:
            case 0:
                return message("/agentface/muscle", "sf", "risorius", share)
            case 1:
                return message("/agentface/gaze", "ff", 20 * share, -10 * share)
            case 2:
                return message("/agentface/head", "fff", 30 * share, 5.0, 2.0)
            case 3:
                return message("/agentface/arkit", "sfsf", "browInnerUp", share, "jawLeft", share)
            case 4:
                return message("/agentface/viseme", "sff", "aa", share, 0.1)
            case 5:
                return message("/agentface/status")
        self._joy = share
        return message("/agentface/emotion", "sff", "joy", share, 0.0)


@pytest.fixture(scope="module")
def flooded():
    """Runs a flooded face for so long, with more sinks; the flood."""
    face = Face(head_model(), liveliness=0.6)
    face.warm_up()
    face.set_arkit({"jawLeft": 0.5})  # the first of a kind loads what shows it
    face.show_viseme("aa", 0.5, 0.1)
    face.step(0.1)

    def run_for(seconds, *sinks):
        with OscServer(face, port=0) as server:
            flood = Flood(face, server)
            try:
                run(face, WorkClock(flood.until), [server], [flood, *sinks], fps=FPS, duration=seconds)
            finally:
                flood.close()
        return flood

    return run_for


@pytest.mark.slow
def test_a_thousand_messages_a_second_drop_no_frame(flooded):
    flooded(0.1)
    flood = flooded(10.0)
    assert flood.sent > 9_900
    slots = [round(time_s * FPS) for time_s in flood.frames]
    assert slots == list(range(10 * FPS))


@pytest.mark.slow
def test_frames_without_time_for_them_would_be_seen_to_be_dropped(flooded):
    class Slow:
        def show(self, frame):
            end = time.thread_time() + 1.5 / FPS
            while time.thread_time() < end:
                pass

    flood = flooded(0.5, Slow())
    assert len(flood.frames) <= 0.5 * FPS / 2
