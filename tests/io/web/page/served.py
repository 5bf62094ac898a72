"""A face that is served to pages while a block lasts, by a basis that is made in seconds."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from agentface.clock import SystemClock
from agentface.deform.geometry import FaceGeometry
from agentface.face import Face
from agentface.io.web.basis import Basis, make_basis
from agentface.io.web.server import WebServer
from agentface.io.web.stage import FaceStage
from agentface.live.loop import Frame, Sink, run

_SAMPLES = 120, 40
_FPS = 20.0
_KEPT = 200


class Served:
    """A running server and its face; ``sent`` has the geometries of the frames by their numbers."""

    def __init__(self, face: Face, server: WebServer) -> None:
        self.face, self.server, self.sent = face, server, dict[int, FaceGeometry]()

    @property
    def stage(self) -> FaceStage:
        """What pages see of the face."""
        return self.server._stages[self.face.model.name]

    def show(self, frame: Frame) -> None:
        """Keep what pages get."""
        self.sent[self.server._frame] = frame.geometry.copy()
        self.sent.pop(self.server._frame - _KEPT, None)


def rough_basis(face: Face, deformer: str, *_: Any) -> Basis:
    """As :func:`agentface.io.web.stage.basis_of`, of few samples."""
    made: Basis = face.model.derived(f"tests.web.basis.{deformer}", lambda model: make_basis(model, deformer, _SAMPLES))
    return made


@contextmanager
def serving(name: str = "amber", **options: Any) -> Iterator[Served]:
    """A served face, at rest until it is asked for something."""
    face = Face(name)
    ended = threading.Event()
    options = {"port": 0, "fps": _FPS, "measure": rough_basis, **options}
    with WebServer(face, **options) as server:
        served = Served(face, server)
        sinks: list[Sink] = [server, served]
        loop = threading.Thread(
            target=lambda: run(face, SystemClock(), [server], sinks, fps=_FPS, stopped=ended.is_set)
        )
        loop.start()
        try:
            yield served
        finally:
            ended.set()
            loop.join()
    face.close()
