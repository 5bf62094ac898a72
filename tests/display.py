"""A virtual display for a program."""

from __future__ import annotations

import os


def on_a_virtual_display(*server: str) -> list[str]:
    """The words before a command that run it there, with ``server`` arguments for Xvfb.

    xvfb-run takes the first number that is free, and two that look at the same time take the same one: each process of
    the tests begins to look elsewhere.
    """
    number = 100 + os.getpid() % 30_000
    arguments = [f"--server-args={' '.join(server)}"] if server else []
    return ["xvfb-run", "--auto-servernum", f"--server-num={number}", *arguments]
