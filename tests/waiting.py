"""Waiting for what other threads and processes do."""

from __future__ import annotations

import time
from collections.abc import Callable


def until(condition: Callable[[], object], meanwhile: Callable[[], object] = lambda: time.sleep(0.005)) -> None:
    """Wait until ``condition`` holds.

    How long that takes is the machine's matter, so no verdict depends on it: where it never comes to pass, the limit
    of every test (``timeout`` in pyproject.toml) ends the waiting and shows where.
    """
    while not condition():
        meanwhile()
