"""A virtual display for a program."""

from __future__ import annotations

import os
from itertools import count

_NUMBERS = 10
_times = count()


def on_a_virtual_display(*server: str) -> list[str]:
    """The words before a command that run it there, with ``server`` arguments for Xvfb.

    xvfb-run takes the first number that is free, and two that look at the same time take the same one: each process of
    the tests begins to look elsewhere. It does not wait for its server to end either, which takes the socket of the
    next one of that number along: no number comes again soon.
    """
    number = 100 + _NUMBERS * (os.getpid() % 3000) + next(_times) % _NUMBERS
    arguments = [f"--server-args={' '.join(server)}"] if server else []
    return ["xvfb-run", "--auto-servernum", f"--server-num={number}", *arguments]
