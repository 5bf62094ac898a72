"""Sinks that are slower than the face: they get the newest frame, and the face does not wait for them."""

from __future__ import annotations

import threading
from collections.abc import Callable
from contextlib import AbstractContextManager
from types import TracebackType
from typing import Self

from agentface.live.loop import Frame, Sink


class Mailbox:
    """Keeps the newest frame until another thread takes it.

    Attributes:
        dropped: how many frames were replaced before they were taken.
    """

    def __init__(self) -> None:
        self.dropped = 0
        self._frame: Frame | None = None
        self._closed = False
        self._changed = threading.Condition()

    def show(self, frame: Frame) -> None:
        """Keep a copy of ``frame``."""
        own = frame.copy()
        with self._changed:
            self.dropped += self._frame is not None
            self._frame = own
            self._changed.notify()

    def close(self) -> None:
        """No frame follows: who waits for one goes on."""
        with self._changed:
            self._closed = True
            self._changed.notify()

    def take(self, timeout_s: float | None = None) -> Frame | None:
        """The newest frame that was not taken yet; None when none comes in time, or any more."""
        with self._changed:
            self._changed.wait_for(lambda: self._frame is not None or self._closed, timeout_s)
            frame, self._frame = self._frame, None
            return frame


class LiveSink:
    """A sink in a thread of its own, from the beginning of a ``with`` block until its end.

    The face never waits: the sink gets the newest frame when it is done with the one before, and what came between is
    ``dropped``, and counted. The last frame of the block is shown.

    Args:
        opened: opens the sink, in the thread, which is the one that also uses and closes it, as OpenGL demands.

    What ``opened`` raises comes out of the beginning of the block, what the sink raises out of the next ``show``, or
    out of the end of the block.
    """

    def __init__(self, opened: Callable[[], AbstractContextManager[Sink]]) -> None:
        self._opened = opened
        self._mail = Mailbox()
        self._ready = threading.Event()
        self._error: BaseException | None = None
        self._thread = threading.Thread(target=self._work, name="agentface-sink", daemon=True)
        self.shown = 0

    @property
    def dropped(self) -> int:
        """The number of frames that the sink was too slow for."""
        return self._mail.dropped

    def show(self, frame: Frame) -> None:
        """Keep ``frame`` until the sink takes it, or a newer one comes."""
        self._tell()
        self._mail.show(frame)

    def __enter__(self) -> Self:
        self._thread.start()
        self._ready.wait()
        self._tell()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._mail.close()
        self._thread.join()
        if error is None:
            self._tell()

    def _tell(self) -> None:
        error, self._error = self._error, None
        if error is not None:
            raise error

    def _work(self) -> None:
        try:
            with self._opened() as sink:
                self._ready.set()
                while (frame := self._mail.take()) is not None:
                    sink.show(frame)
                    self.shown += 1
        except BaseException as error:  # handed to the thread that waits
            self._error = error
        finally:
            self._ready.set()
