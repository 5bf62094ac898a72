from __future__ import annotations

import threading

import pytest

from agentface import Face
from agentface.clock import ManualClock
from agentface.live.loop import run_live
from tests.heads import head_model


@pytest.fixture
def face():
    return Face(head_model())


def test_frames_fall_on_a_grid(face):
    seen = []
    assert run_live(face, ManualClock(), threading.Event(), fps=20, duration=1.0, on_frame=seen.append) == 20
    assert seen == pytest.approx([frame / 20 for frame in range(20)])


def test_a_slow_machine_skips_frames_and_keeps_the_time(face):
    clock = ManualClock()
    seen = []

    def draw(time):
        seen.append(time)
        clock.sleep(0.12)

    face.set_emotion("joy", 1.0, fade=1.0)
    run_live(face, clock, threading.Event(), fps=20, duration=0.55, on_frame=draw)
    assert seen == pytest.approx([0.0, 0.15, 0.3, 0.45])
    share = 0.45**3 * (10 - 15 * 0.45 + 6 * 0.45**2)
    assert face.status()["shown"]["emotion"]["happiness"] == pytest.approx(share, abs=1e-4)


def test_it_stops_when_told(face):
    stop = threading.Event()
    assert run_live(face, ManualClock(), stop, on_frame=lambda _: stop.set()) == 1
