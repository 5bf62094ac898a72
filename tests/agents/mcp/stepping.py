"""A face that runs for the tools, in a thread of its own."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from contextlib import contextmanager

from agentface.agents.mcp.actor import Actor
from agentface.face import Face


@contextmanager
def stepped(face: Face) -> Iterator[Actor]:
    """The actor of a face that another thread steps, 20 ms at a time, as fast as it can."""
    made, over = Actor(face.model), threading.Event()
    made.made.set_result(face)

    def steps() -> None:
        while not over.wait(0.001):
            made.take_in()
            face.step(0.02)

    thread = threading.Thread(target=steps)
    thread.start()
    yield made
    over.set()
    thread.join()
    made.close()
