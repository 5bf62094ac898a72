from __future__ import annotations

import json
import threading
from contextlib import contextmanager

import pytest

from agentface import Face
from agentface.clock import SystemClock
from agentface.io.web.basis import make_basis
from agentface.io.web.server import WebServer
from agentface.live.loop import run


@pytest.fixture(scope="session")
def model():
    return Face().model


@pytest.fixture(scope="session")
def basis(model):
    """A basis of few samples: as large as another, made sooner, and less true."""
    return make_basis(model, "geometric", (120, 40))


def a_head(model, look, basis):
    """In place of a head's file: what it is made of."""
    return json.dumps([model.name, look, len(basis.skin.scales)]).encode() * 50


@contextmanager
def serving(faces, basis, **options):
    """A server whose faces run, 60 frames a second."""
    stop = threading.Event()
    faces = faces if isinstance(faces, dict) else {faces.model.name: faces}
    options = {"port": 0, "encode": a_head, "measure": lambda *_: basis, **options}
    with WebServer(faces, **options) as server:
        face, *beside = faces.values()
        loop = threading.Thread(
            target=run,
            args=(face, SystemClock(), [server], [server]),
            kwargs={"stopped": stop.is_set, "beside": beside},
            daemon=True,
        )
        loop.start()
        try:
            yield server
        finally:
            stop.set()
            loop.join()


@pytest.fixture(scope="module")
def server(basis):
    with Face() as face, serving(face, basis) as running:
        yield running
