"""How long a message takes to be seen: from another process's datagram to the first frame that has changed."""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from itertools import pairwise
from statistics import median
from typing import Any

import numpy as np

from agentface.clock import SystemClock
from agentface.deform.protocol import DEFAULT_DEFORMER
from agentface.errors import GraphicsError
from agentface.face import Face
from agentface.io.osc.codec import encode
from agentface.io.osc.server import OscServer
from agentface.live.loop import Frame
from agentface.live.loop import run as run_loop
from agentface.parameters import FacePose
from agentface.studies.bench.flood import flood
from agentface.studies.bench.sender import sending

HZ = 60.0
_WARM = 10
"""So many messages at first do not count."""
_LONGEST_S = 30.0
"""So much longer than the messages take is waited for the last of them."""


class ChangeWatch:
    """A sink that notes when the face first showed each of some levels of happiness.

    Attributes:
        shown_s: by the number of a level, the time of the machine when the first frame was there that shows it.
    """

    def __init__(self, face: Face, levels: Sequence[float]) -> None:
        self._face, self._numbers = face, {level: number for number, level in enumerate(levels)}
        self._pose: FacePose | None = None
        self.shown_s: dict[int, float] = {}
        self.times_s: list[float] = []
        self.steps_s: list[float] = []

    def show(self, frame: Frame) -> None:
        """Note a frame."""
        now = time.monotonic()
        self.times_s.append(frame.time_s)
        self.steps_s.append(frame.step_s)
        if self._pose is not None and frame.pose != self._pose:
            number = self._numbers.get(self._face.emotion["happiness"])
            if number is not None:
                self.shown_s.setdefault(number, now)
        self._pose = frame.pose


def run(
    model: Any = None, messages: int = 300, deformer_name: str = DEFAULT_DEFORMER, flood_s: float = 10.0
) -> dict[str, Any]:
    """Milliseconds from sending to the first changed frame, with the server stepping 60 times a second.

    ``p50_ms`` and ``p99_ms`` are percentiles of all messages, ``lost`` how many were not shown; ``frame_ms``, from a
    frame to the next, and ``step_ms``, what of that the face is at work, are medians; ``late_frames`` came half a frame
    late or more. A message waits for the next frame, at most one whole one. ``picture_ms`` is apart from all that: what
    a picture of 1280 x 720 takes afterwards, null without OpenGL. Then a flood of ``flood_s`` seconds (:func:`flood`).
    """
    if model is None:
        from agentface.head.model import load_model

        model = load_model()
    draw = np.random.default_rng(0)
    count = messages + _WARM
    # far apart from one to the next, each once, and exact in OSC's float32
    levels = [(number % 2 + number / count) / 2 for number in range(count)]
    levels = [float(np.float32(level)) for level in levels]
    due_s = np.cumsum(draw.uniform(2.2 / HZ, 4.0 / HZ, count)).tolist()
    with Face(model, deformer=deformer_name) as face, OscServer(face, port=0) as server:
        face.warm_up()
        watch = ChangeWatch(face, levels)
        sent = _exchange(face, server, watch, due_s, levels)
        shown = _figures(sent, watch, skipped=_WARM) | {"picture_ms": _picture_ms(face)}
    return shown | flood(model, flood_s, deformer_name)


def _exchange(
    face: Face, server: OscServer, watch: ChangeWatch, due_s: Sequence[float], levels: Sequence[float]
) -> list[float]:
    """When each message was sent, by the clock that all processes share."""
    packets = [encode("/agentface/emotion", "happiness", level, 0.0) for level in levels]
    with sending((server.host, server.port), due_s, packets, hurried=False) as times:
        end = time.monotonic() + due_s[-1] + _LONGEST_S

        def stopped() -> bool:
            return len(levels) - 1 in watch.shown_s or time.monotonic() > end

        run_loop(face, SystemClock(), [server], [watch], fps=HZ, stopped=stopped)
    return times


def _figures(sent_s: Sequence[float], watch: ChangeWatch, skipped: int = 0) -> dict[str, Any]:
    taken = _taken(sent_s, watch.shown_s, skipped)
    frames = [1000.0 * (after - before) for before, after in pairwise(watch.times_s)]
    p50, p99 = (float(value) for value in np.percentile(taken, (50, 99), method="higher"))
    return {
        "p50_ms": p50,
        "p99_ms": p99,
        "frame_ms": median(frames),
        "step_ms": 1000.0 * median(watch.steps_s),
        "late_frames": sum(frame > 1500.0 / HZ for frame in frames),
        "frames": len(watch.times_s),
        "messages": len(sent_s) - skipped,
        "lost": len(sent_s) - skipped - len(taken),
    }


def _taken(sent_s: Sequence[float], shown_s: Mapping[int, float], skipped: int) -> list[float]:
    """What each message that was shown has taken, in ms."""
    numbers = [number for number in range(skipped, len(sent_s)) if number in shown_s]
    return [1000.0 * (shown_s[number] - sent_s[number]) for number in numbers]


def _picture_ms(face: Face, rounds: int = 9) -> float | None:
    times = []
    try:
        for turn in range(rounds + 1):
            face.step(1.0 / HZ)
            start = time.perf_counter()
            face.render()
            if turn:
                times.append(1000.0 * (time.perf_counter() - start))
    except GraphicsError:
        return None
    return median(times)
