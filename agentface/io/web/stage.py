""":class:`FaceStage`: a face as pages see it: its basis, its head as a file, its frames, its voice."""

from __future__ import annotations

import gzip
import time
from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass
from hashlib import blake2b
from threading import Lock
from typing import Any

from agentface.cache import stamp_of
from agentface.errors import UnknownNameError
from agentface.face import Face
from agentface.head.look import load_look, look_names
from agentface.head.model import HeadModel
from agentface.io.web.basis import FEW_SAMPLES, SAMPLES, Basis, make_basis
from agentface.io.web.frames import FrameWriter, Mode

PROTOCOL = 1
Measure = Callable[[Face, str, Callable[[str], object]], Basis]
"""Finds the basis of a face and the name of its deformer; tells what takes long."""
Watch = AbstractContextManager[Callable[[float], object]]
"""Entered while something takes long; what it gives is told how much is done, 0..1."""
HeadEncoder = Callable[[HeadModel, str | None, Basis], bytes]
"""Makes the file of a head, in a look of its own, with a basis."""


@dataclass(frozen=True, slots=True)
class HeadFile:
    """A head as a GLB, for a page.

    Attributes:
        content: as it is, and ``packed`` with gzip.
        etag: changes with the content.
    """

    content: bytes
    packed: bytes
    etag: str


class FaceStage:
    """A face and what pages need of it.

    Args:
        face: what is shown.
        name: what it is called here.
        deformer: the name of its deformer.
        look: its look, a name or a path; its own when None.
        encode: makes its file.
        fps: frames a second.
        told: told what takes long.
        measure: finds its basis.
    """

    def __init__(
        self,
        face: Face,
        name: str,
        *,
        deformer: str,
        look: str | None,
        encode: HeadEncoder,
        fps: float,
        told: Callable[[str], object],
        measure: Measure,
    ) -> None:
        self.face, self.name, self.deformer, self.fps = face, name, deformer, fps
        self._look, self._encode = look, encode
        self.basis = measure(face, deformer, told)
        self.writer = FrameWriter(face.model, self.basis)
        self._heads: dict[str | None, HeadFile] = {}
        self._lock = Lock()

    @property
    def looks(self) -> tuple[str, ...]:
        """The names of the looks that a page may ask for."""
        return look_names(self.face.model)

    def head(self, look: str | None = None) -> HeadFile:
        """Its file, in its look or in another by name; made once. For any thread. Raises UnknownNameError."""
        if look is not None and look not in self.looks:  # a path is not for others to say
            raise UnknownNameError("look", look, self.looks)
        with self._lock:
            if look not in self._heads:
                content = self._encode(self.face.model, self._look if look is None else look, self.basis)
                etag = blake2b(content, digest_size=12).hexdigest()
                self._heads[look] = HeadFile(content, gzip.compress(content, 6, mtime=0), etag)
            return self._heads[look]

    def hello(self, mode: Mode, look: str | None = None) -> dict[str, Any]:
        """What a page is told first; raises UnknownNameError."""
        query = "" if look is None else f"&look={look}"
        return {
            "type": "hello",
            "protocol": PROTOCOL,
            "face": self.name,
            "model": self.face.model.name,
            "deformer": self.deformer,
            "fps": self.fps,
            "mode": mode,
            "head": f"/faces/{self.name}/head.glb?v={self.head(look).etag}{query}",
            "fields": self.writer.layouts[mode].as_json(),
        }


def basis_of(
    face: Face,
    deformer: str,
    told: Callable[[str], object] = lambda _: None,
    watched: Callable[[str], Watch] = lambda _: nullcontext(lambda _: None),
) -> Basis:
    """The basis of a face, made once on a machine; ``told`` is told when that takes a while.

    So is, in shares of it, what ``watched`` gives for the name of the work.
    """
    samples = SAMPLES if hasattr(face.deformer, "worker") else FEW_SAMPLES

    def make(model: HeadModel) -> Basis:
        told(f"measuring how {model.name} moves, for pages: once on this machine")
        start = time.perf_counter()
        with watched(f"how {model.name} moves") as done:
            made = make_basis(model, deformer, samples, done)
        told(f"measured in {time.perf_counter() - start:.0f} s")
        return made

    basis: Basis = face.model.derived(f"web.basis.{stamp_of((), deformer, repr(samples))}", make)
    return basis


def encode_head_file(model: HeadModel, look: str | None, basis: Basis) -> bytes:
    """The file of a head that the page of this package draws."""
    from agentface.io.web.head_file import encode_head

    return encode_head(model, load_look(model, look), basis)
