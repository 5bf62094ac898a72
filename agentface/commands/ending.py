"""How a program that runs is told to end: by the keyboard, a supervisor, a terminal that closes."""

from __future__ import annotations

import signal
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType

_SIGNALS = ("SIGINT", "SIGTERM", "SIGHUP", "SIGQUIT")


class Ending:
    """Counts what told the program to end; what does not listen to the first one may listen to the next.

    Attributes:
        signal: the number of the last one; None before.
    """

    def __init__(self) -> None:
        self.signal: int | None = None
        self._count = self._heard = 0

    def told(self) -> bool:
        """Whether something came since the beginning, or since ``go_on``."""
        return self._count > self._heard

    def go_on(self) -> None:
        """Take up another piece of work, which the next signal ends."""
        self._heard = self._count

    def note(self, number: int, _frame: FrameType | None = None) -> None:
        """Count one: a handler for signals."""
        self.signal = number
        self._count += 1

    @property
    def code(self) -> int:
        """What a shell calls the end by the signal that came."""
        return 128 + (self.signal or 0)


@contextmanager
def until_told() -> Iterator[Ending]:
    """In the block, signals that end programs are counted, and end nothing: no file is left half written.

    One that the program was started to ignore, as by nohup, stays ignored; SIGINT does not, as shells begin programs in
    the background without it.
    """
    ending, before = Ending(), {}
    for kind in (getattr(signal, name) for name in _SIGNALS if hasattr(signal, name)):
        if signal.getsignal(kind) is not signal.SIG_IGN or kind == signal.SIGINT:
            before[kind] = signal.signal(kind, ending.note)
    try:
        yield ending
    finally:
        for kind, handler in before.items():
            signal.signal(kind, handler)
