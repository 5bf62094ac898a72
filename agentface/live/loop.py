"""The loop of a face without a window: steps in real time, frames to a video."""

from __future__ import annotations

import math
from collections.abc import Callable
from threading import Event

from agentface.clock import Clock
from agentface.face import Face


def run_live(
    face: Face,
    clock: Clock,
    stop: Event,
    *,
    fps: float = 60.0,
    duration: float = math.inf,
    on_frame: Callable[[float], None] = lambda _: None,
) -> int:
    """Step ``face`` ``fps`` times a second until ``stop`` is set or ``duration`` seconds are over.

    A step takes the time that passed since the one before, so that a slow machine shows fewer frames of the same
    motion. ``on_frame`` gets the seconds since the start after every step. Returns the number of frames.
    """
    start = last = clock.now()
    frames = slot = 0
    while not stop.is_set():
        now = clock.now()
        if now - start >= duration:
            break
        face.step(now - last)
        on_frame(now - start)
        last = now
        frames += 1
        slot = max(slot + 1, math.ceil((clock.now() - start) * fps))
        clock.sleep(start + slot / fps - clock.now())
    return frames
