"""The bar of what takes long, where there is a terminal to show it."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager

from agentface.commands.streams import console


@contextmanager
def progress(name: str, total: float | None) -> Iterator[Callable[[float], None]]:
    """Gives what takes how much is done, of ``total``; without that there is no bar."""
    from rich.progress import Progress

    terminal = console()
    if total is None or not terminal.is_terminal:
        yield lambda _: None
        return
    with Progress(console=terminal) as shown:  # rich's own columns end with the time left
        task = shown.add_task(name, total=total)
        yield lambda done: shown.update(task, completed=done)
