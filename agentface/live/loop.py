"""The one loop in which a face runs: sources are asked, the face is stepped, sinks are given the frame.

A source is what tells a face what to do: a server, a document that is played. A sink is where its frames go: a film.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass, replace
from typing import Protocol

from agentface.clock import Clock
from agentface.conventions import check_rate
from agentface.deform.geometry import FaceGeometry
from agentface.face import Face
from agentface.parameters import FacePose


class Source(Protocol):
    """Tells its face what to do."""

    def take_in(self, time_s: float) -> None:
        """Ask of the face what is new since the last call.

        ``time_s`` is when the step that follows begins, in seconds since the loop did.
        """


@dataclass(frozen=True, slots=True)
class Frame:
    """The face at one instant.

    Attributes:
        time_s: seconds since the loop began.
        step_s: how long it took to get there, in seconds of the loop's clock.
        pose: every animation parameter.
        geometry: the deformed face; its arrays hold until the next step, those of a ``copy`` for good.
    """

    time_s: float
    step_s: float
    pose: FacePose
    geometry: FaceGeometry

    def copy(self) -> Frame:
        """The same frame with arrays of its own."""
        return replace(self, geometry=self.geometry.copy())


class Sink(Protocol):
    """Takes frames."""

    def show(self, frame: Frame) -> None:
        """Take one; what is kept beyond the call has to be copied. The next step waits for the return."""


def run(
    face: Face,
    clock: Clock,
    sources: Sequence[Source] = (),
    sinks: Sequence[Sink] = (),
    *,
    fps: float = 60.0,
    duration: float = math.inf,
    longest_step_s: float = math.inf,
    stopped: Callable[[], bool] = lambda: False,
    held: AbstractContextManager[object] | None = None,
    beside: Sequence[Face] = (),
) -> int:
    """Step ``face`` up to ``fps`` times a second, until ``stopped`` or until ``duration`` seconds are over.

    The frames stand on a grid of ``1 / fps`` s. A step takes the time that passed since the one before: where it is
    late, fewer frames show the same motion. With the machine's clock that is real time; with a ``FrameClock``, which
    waits for nothing, the sinks set the pace, and no frame is left out.

    Args:
        face: what is moved.
        clock: measures and waits; one that wakes up early brings the next frame forward.
        sources: asked in their order before each step; what they have is for this face.
        sinks: given the frame in their order after it.
        fps: frames a second, more than 0 and at most 1000.
        duration: seconds.
        longest_step_s: the face takes no larger step, whatever the clock says.
        stopped: asked before each frame.
        held: entered while the face is asked and stepped: a lock where another thread uses the face, too.
        beside: other faces that are stepped with it; the frames are those of ``face``.

    Returns the number of frames. Raises InvalidValueError for another ``fps``, and whatever sources and sinks raise.
    """
    fps = check_rate("fps", fps)
    exclusive = nullcontext() if held is None else held
    start = last = clock.now()
    frames = slot = 0
    while not stopped():
        now = clock.now()
        if now - start >= duration:
            break
        with exclusive:
            for source in sources:
                source.take_in(last - start)
            dt = min(now - last, longest_step_s)
            geometry = face.step(dt)
            for other in beside:
                other.step(dt)
            frame = Frame(now - start, clock.now() - now, face.pose, geometry)
        for sink in sinks:
            sink.show(frame)
        last = now
        frames += 1
        slot = max(slot + 1, math.ceil((clock.now() - start) * fps))
        clock.sleep(start + slot / fps - clock.now())
    return frames
