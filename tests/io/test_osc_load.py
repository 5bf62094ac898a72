"""A thousand messages a second: none is lost, each frame shows the newest, and no frame has more to do for them.

Time is counted, not taken: work takes none, and while the loop waits for the next frame its messages come through a
real socket. How long frames take on a machine, ``agentface bench latency`` measures.
"""

from __future__ import annotations

import cProfile
import gc
import socket
import time
from collections import Counter
from pathlib import Path
from types import CodeType

import numpy as np
import pytest
from osc_bytes import message

import agentface
from agentface import Face
from agentface.io.osc.server import OscServer
from agentface.live.loop import run
from agentface.motion.stream import STREAM_FADE_S
from agentface.requests import (
    FADE_S,
    GAZE_FADE_S,
    HEAD_FADE_S,
    SetArkit,
    SetEmotion,
    SetGaze,
    SetHead,
    SetMuscle,
    ShowViseme,
)
from tests.clocks import ManualClock
from tests.heads import head_model

FPS, FRAMES, KINDS = 60, 120, 7
SELDOM, OFTEN = 1, 3
"""How many messages of each kind a frame: 420 and 1260 a second."""
PACKAGE = str(Path(agentface.__file__).parent)


def messages(share):
    """One of each kind; shares are whole 256ths, which OSC's float32 keeps."""
    yield message("/agentface/muscle", "sf", "risorius", share)
    yield message("/agentface/gaze", "ff", 20 * share, -10 * share)
    yield message("/agentface/head", "fff", 30 * share, 5.0, 2.0)
    yield message("/agentface/arkit", "sfsf", "browInnerUp", share, "jawLeft", share)
    yield message("/agentface/viseme", "sff", "aa", share, 0.125)
    yield message("/agentface/status")
    yield message("/agentface/emotion", "sff", "joy", share, 0.0)


def requests(share):
    """What they ask."""
    return [
        SetMuscle("risorius", share, FADE_S),
        SetGaze(20 * share, -10 * share, GAZE_FADE_S),
        SetHead(30 * share, 5.0, 2.0, HEAD_FADE_S),
        SetArkit({"browInnerUp": share, "jawLeft": share}, STREAM_FADE_S),
        ShowViseme("aa", share, 0.125),
        SetEmotion("happiness", share, 0.0, None),
    ]


class FloodedClock(ManualClock):
    """Passes only while the loop waits, and has the flood go on meanwhile."""

    flood = None

    def sleep(self, seconds):
        super().sleep(seconds)
        self.flood.go_on()


class Flood:
    """Sends ``times`` messages of each kind a frame, no two alike; as a sink it takes down what every frame showed.

    Attributes:
        sent: how many messages; what the last of each kind said stands in ``said``, one share a frame.
        asked: what was asked of the face before each frame.
        poses: what each frame showed.
    """

    def __init__(self, face, server, times):
        self._server, self._times = server, times
        self.sent, self.said, self.asked, self.poses = 0, [], [], []
        self._new = []
        face.noted.append(self._new.append)
        self._client = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._client.connect((server.host, server.port))

    def go_on(self):
        share = len(self.said) * 37 % 256 / 256
        for back in reversed(range(self._times)):
            for packet in messages((share + back / 4) % 1.0):
                self._client.send(packet)
                self.sent += 1
        self.said.append(share)
        # for one that is lost it waits in vain, as long as a test may take
        while len(self._server._listener.waiting) < KINDS * self._times:
            time.sleep(0.0002)

    def show(self, frame):
        self.asked.append(self._new.copy())
        self.poses.append(frame.pose.array.copy())
        self._new.clear()

    def close(self):
        self._client.close()


class Work:
    """Counts the calls of each of the package's functions while a face is told something, stepped, or asked."""

    def __init__(self, face):
        self._profile = cProfile.Profile()
        for name in ("apply", "step", "status"):
            setattr(face, name, self._watched(getattr(face, name)))

    def calls(self):
        counts = Counter()
        for entry in self._profile.getstats():
            if isinstance(entry.code, CodeType) and entry.code.co_filename.startswith(PACKAGE):
                counts[entry.code.co_qualname] += entry.callcount
        return counts

    def _watched(self, function):
        def watched(*arguments):
            self._profile.enable()
            try:
                return function(*arguments)
            finally:
                self._profile.disable()

        return watched


def flood_of(times, frames, watch=lambda face: None):
    """A living face that is told so much for so many frames: the flood, the counts, and what ``watch`` gave."""
    clock = FloodedClock()
    face = Face(head_model(), liveliness=0.6, clock=clock)
    watched = watch(face)
    with OscServer(face, port=0, clock=clock) as server:
        flood = clock.flood = Flood(face, server, times)
        try:
            assert run(face, clock, [server], [flood], fps=FPS, duration=(frames - 0.5) / FPS) == frames
        finally:
            flood.close()
        server.take_in()  # what came after the last frame
        assert not server._listener.waiting
    return flood, face.message_counts, watched


@pytest.fixture(scope="module")
def flooded():
    """Floods by how many messages of each kind come a frame, their counts and the calls that they took."""
    flood_of(SELDOM, 5)  # the first of a kind prepares what shows it
    gc.disable()  # what others left, such as a face that is to close its voices, is not this face's work
    try:
        return {times: flood_of(times, FRAMES, Work) for times in (SELDOM, OFTEN)}
    finally:
        gc.enable()


@pytest.mark.parametrize("times", [SELDOM, OFTEN])
def test_of_a_thousand_messages_a_second_none_is_lost(flooded, times):
    flood, counts, _ = flooded[times]
    assert flood.sent == FRAMES * KINDS * times
    assert counts.messages == flood.sent
    assert not any(counts.errors.values())


@pytest.mark.parametrize("times", [SELDOM, OFTEN])
def test_each_frame_is_asked_the_newest_of_each_kind_and_nothing_else(flooded, times):
    flood, _, _ = flooded[times]
    assert flood.asked == [[], *map(requests, flood.said[:-1])]


def test_what_came_between_is_not_seen(flooded):
    seldom, often = flooded[SELDOM][0], flooded[OFTEN][0]
    np.testing.assert_array_equal(often.poses, seldom.poses)
    assert len(np.unique(often.poses, axis=0)) == FRAMES


def test_a_frame_has_no_more_to_do_when_more_messages_come(flooded):
    seldom, often = flooded[SELDOM][2].calls(), flooded[OFTEN][2].calls()
    told = FRAMES * (KINDS - 1)
    assert (often["Face.step"], often["Face.apply"], often["Face.status"]) == (FRAMES, told, FRAMES)
    assert often == seldom
