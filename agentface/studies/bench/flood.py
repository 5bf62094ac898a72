"""A face that another process floods with messages: whether frames are dropped, and how long a step takes."""

from __future__ import annotations

import math
import time
from collections.abc import Iterator, Sequence
from itertools import islice
from typing import Any

import numpy as np

from agentface.clock import SystemClock
from agentface.deform.protocol import DEFAULT_DEFORMER
from agentface.face import Face, MessageCounts
from agentface.head.model import HeadModel
from agentface.io.osc.codec import encode
from agentface.io.osc.server import OscServer
from agentface.live.loop import Frame
from agentface.live.loop import run as run_loop
from agentface.studies.bench.sender import sending

HZ = 60.0
A_SECOND = 1000
_LATE = 0.1
"""Of a frame: a clock that wakes up so early still means the frame after."""
_LONGEST_S = 30.0
"""So much longer than the flood is waited for its end."""


class FloodWatch:
    """A sink that notes the frames from the first message on."""

    def __init__(self, counts: MessageCounts) -> None:
        self._counts = counts
        self.times_s: list[float] = []
        self.steps_s: list[float] = []

    def show(self, frame: Frame) -> None:
        """Note a frame."""
        if self._counts.messages:
            self.times_s.append(frame.time_s)
            self.steps_s.append(frame.step_s)


def flood(model: HeadModel, seconds: float, deformer_name: str = DEFAULT_DEFORMER) -> dict[str, Any]:
    """A living face that steps 60 times a second, flooded with a thousand messages a second for so long.

    Of ten messages four are emotions, and one each a muscle, a gaze, a turn of the head, weights of ARKit, a viseme and
    a request for the status. ``flood_frames`` came from the first message to the last, ``flood_dropped_frames`` of
    their grid were left out; ``flood_step_p50_ms`` and ``flood_step_p99_ms`` are percentiles of a step with what came
    before it; ``flood_lost`` of ``flood_messages`` did not come.
    """
    packets = list(islice(_messages(), round(seconds * A_SECOND)))
    with Face(model, deformer=deformer_name, liveliness=0.6) as face:
        _prepare(face)
        watch = FloodWatch(face.message_counts)
        with OscServer(face, port=0) as server:
            times = [number / A_SECOND for number in range(len(packets))]
            with sending((server.host, server.port), times, packets, hurried=True):
                end = time.monotonic() + seconds + _LONGEST_S

                def stopped() -> bool:
                    return face.message_counts.messages >= len(packets) or time.monotonic() > end

                run_loop(face, SystemClock(), [server], [watch], fps=HZ, stopped=stopped)
        lost = len(packets) - face.message_counts.messages
    return figures(watch.times_s, watch.steps_s) | {"flood_messages": len(packets), "flood_lost": lost}


def figures(times_s: Sequence[float], steps_s: Sequence[float]) -> dict[str, Any]:
    """What frames at these times, in seconds since the loop began, and steps of so many seconds, amount to."""
    slots = {math.floor(time_s * HZ + _LATE) for time_s in times_s}
    p50, p99 = (1000.0 * float(value) for value in np.percentile(steps_s, (50, 99), method="higher"))
    return {
        "flood_frames": len(times_s),
        "flood_dropped_frames": max(slots) - min(slots) + 1 - len(slots),
        "flood_step_p50_ms": p50,
        "flood_step_p99_ms": p99,
    }


def _prepare(face: Face) -> None:
    """Load what the first of each kind needs."""
    face.warm_up()
    face.set_arkit({"jawLeft": 0.5})
    face.show_viseme("aa", 0.5, 0.1)
    face.step(1.0 / HZ)
    face.neutral()


def _messages() -> Iterator[bytes]:
    number = 0
    while True:
        share = number % 256 / 256.0
        yield encode("/agentface/muscle", "risorius", share)
        yield encode("/agentface/gaze", 20.0 * share, -10.0 * share)
        yield encode("/agentface/head", 30.0 * share, 5.0, 2.0)
        yield encode("/agentface/arkit", "browInnerUp", share, "jawLeft", share)
        yield encode("/agentface/viseme", "aa", share, 0.1)
        yield encode("/agentface/status")
        for later in range(4):
            yield encode("/agentface/emotion", "happiness", (number + later) % 256 / 256.0, 0.0)
        number += 10
