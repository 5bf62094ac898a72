"""A web server of files, and the heads and frames that it gives to pages."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache, partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import Any

import numpy as np

from agentface.deform.geometry import FaceGeometry
from agentface.face import Face
from agentface.head.look import load_look
from agentface.head.model import HeadModel
from agentface.io.web.basis import Basis
from agentface.io.web.frames import rigid_values
from agentface.io.web.head_file import encode_head
from agentface.io.web.modes import ModeSet
from agentface.io.web.unfinished import Unfinished
from tests.tools import PAGE

_SETTLED_S = 4.0


class Files:
    """Where the files lie, and at which address they are."""

    def __init__(self, folder: Path, address: str) -> None:
        self.folder, self.address = folder, address

    def add(self, name: str, content: bytes | str) -> str:
        """Serve another; its address."""
        (self.folder / name).write_bytes(content.encode() if isinstance(content, str) else content)
        return f"{self.address}/{name}"

    def head(self, face: str, look: str | None = None) -> str:
        """The address of a head without a basis: for exact frames."""
        name = f"{face}-{look or 'own'}.glb"
        if not (self.folder / name).exists():
            model = settled(face)[0].model
            self.add(name, encode_head(model, load_look(model, look), no_basis(model)))
        return f"{self.address}/{name}"


class _Handler(SimpleHTTPRequestHandler):
    def log_message(self, *_: Any) -> None:
        pass


@contextmanager
def serve_files(folder: Path) -> Iterator[Files]:
    """Serve a folder, with the built page in it, while the block lasts."""
    for path in PAGE.iterdir():
        (folder / path.name).write_bytes(path.read_bytes())
    with ThreadingHTTPServer(("127.0.0.1", 0), partial(_Handler, directory=str(folder))) as server:
        thread = threading.Thread(target=server.serve_forever)
        thread.start()
        yield Files(folder, f"http://127.0.0.1:{server.server_port}")
        server.shutdown()
        thread.join()


def no_basis(model: HeadModel) -> Basis:
    """A basis in which nothing moves."""
    skin, tongue = (
        ModeSet(np.zeros((1, count, 3), np.int16), np.zeros(1, np.float32))
        for count in (len(model.vertices), len(model.parts["tongue"].attributes["POSITION"]))
    )
    return Basis(skin, tongue)


@cache
def settled(name: str, emotion: str | None = None) -> tuple[Face, FaceGeometry]:
    """A face that has shown an emotion for a while and drawn breath, and how it then is."""
    face = Face(name)
    face.set_parameter("breath", 0.8)
    if emotion is not None:
        face.set_emotion(emotion, 1.0)
    geometry = face.step(_SETTLED_S)
    return face, geometry.copy()


def exact_frame(model: HeadModel, geometry: FaceGeometry) -> dict[str, Any]:
    """A frame of all vertices as a page's reader gives it, unrounded."""
    skin = Unfinished(model).skin(geometry) - model.vertices
    tongue = geometry.tongue - model.parts["tongue"].attributes["POSITION"]
    values = {**rigid_values(geometry), "vertices": skin, "tongue_vertices": tongue}
    return {name: np.asarray(value, np.float64).ravel().tolist() for name, value in values.items()}
