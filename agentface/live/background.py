"""The loop in a thread of its own, beside one that is busy with a window."""

from __future__ import annotations

import math
import threading
from collections.abc import Sequence
from contextlib import AbstractContextManager
from types import TracebackType
from typing import Self

from agentface.clock import Clock
from agentface.face import Face
from agentface.live.loop import Frame, Sink, Source, run
from agentface.live.newest import Mailbox

SLOWEST_HZ = 30.0
"""So often the face is stepped whether or not a frame is asked for."""


class Background:
    """Runs the loop from the beginning of a ``with`` block until its end, and makes a frame whenever it is asked.

    A window that keeps up shows the face as it is at that moment; one that does not, loses frames, and the face goes
    on.

    Args:
        face: whoever uses it in the block holds ``held``.
        clock: tells the time.
        sources: as in :func:`run`.
        held: kept while the face is asked and stepped.
        sinks: given each frame, also those that nobody asks for, while ``held`` is kept.
        duration: seconds until it ends by itself.
        longest_step_s: as in :func:`run`.

    What sources and face raise comes out of ``frame``, or out of the end of the block.
    """

    def __init__(
        self,
        face: Face,
        clock: Clock,
        sources: Sequence[Source],
        held: AbstractContextManager[object],
        *,
        sinks: Sequence[Sink] = (),
        duration: float = math.inf,
        longest_step_s: float = math.inf,
    ) -> None:
        self._face, self._clock, self._sources, self._held = face, clock, sources, held
        self._sinks = sinks
        self._duration, self._longest_step_s = duration, longest_step_s
        self._mail, self._passed_over = Mailbox(), 0
        self._asked, self._stop = threading.Event(), threading.Event()
        self._error: BaseException | None = None
        self._thread = threading.Thread(target=self._work, name="agentface-loop", daemon=True)

    @property
    def running(self) -> bool:
        """Whether there will be another frame."""
        return self._thread.is_alive()

    @property
    def dropped(self) -> int:
        """The number of frames that were never given out."""
        return self._mail.dropped + self._passed_over

    def frame(self, timeout_s: float) -> Frame | None:
        """A frame made now, or, where that takes more than ``timeout_s``, the newest one, or None."""
        earlier = self._mail.take(0.0)
        self._asked.set()
        frame = self._mail.take(timeout_s)
        self._passed_over += frame is not None and earlier is not None
        self._tell()
        return frame or earlier

    def __enter__(self) -> Self:
        self._thread.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._stop.set()
        self._asked.set()
        self._thread.join()
        if error is None:
            self._tell()

    def _tell(self) -> None:
        error, self._error = self._error, None
        if error is not None:
            raise error

    def _work(self) -> None:
        try:
            run(
                self._face,
                _Asked(self._clock, self._asked),
                self._sources,
                [self._mail, *(_Exclusive(sink, self._held) for sink in self._sinks)],
                duration=self._duration,
                longest_step_s=self._longest_step_s,
                stopped=self._stop.is_set,
                held=self._held,
            )
        except BaseException as error:  # handed to the thread that waits
            self._error = error
        finally:
            self._mail.close()


class _Exclusive:
    """A sink that may look at the face, too."""

    def __init__(self, sink: Sink, held: AbstractContextManager[object]) -> None:
        self._sink, self._held = sink, held

    def show(self, frame: Frame) -> None:
        with self._held:
            self._sink.show(frame)


class _Asked:
    """A clock that is woken up when a frame is asked for."""

    def __init__(self, clock: Clock, asked: threading.Event) -> None:
        self.now, self.date, self._asked = clock.now, clock.date, asked

    def sleep(self, _seconds: float) -> None:
        # Not until the loop's next slot: with a window at almost the same rate there would be two steps for each frame.
        self._asked.wait(1.0 / SLOWEST_HZ)
        self._asked.clear()
