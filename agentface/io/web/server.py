""":class:`WebServer`: faces in web pages."""

from __future__ import annotations

import json
import socket
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from types import TracebackType
from typing import Any, Self

from agentface.clock import Clock, SystemClock
from agentface.deform.protocol import DEFAULT_DEFORMER
from agentface.errors import InvalidValueError, ServerError
from agentface.face import Face
from agentface.io.osc.addresses import check_id
from agentface.io.web.access import Access
from agentface.io.web.audio import pieces, silence
from agentface.io.web.guard import guarded
from agentface.io.web.hub import Client, Hub
from agentface.io.web.inbox import Inbox
from agentface.io.web.serving import Serving, listen
from agentface.io.web.stage import FaceStage, HeadEncoder, Measure, basis_of, encode_head_file
from agentface.live.loop import Frame
from agentface.speech.sound import Sound

DEFAULT_HOST, DEFAULT_PORT = "127.0.0.1", 8080
MOST_FACES = 8
_HEARD_LATER_S = 0.12
"""So long before it is seen a sound is sent: it is there when its frames are."""
_NO_EXTRA = """expected the Python packages starlette, uvicorn and websockets, got no {name}: there is no web server.
Install the extra that has them:  pip install "agentface[web]\""""


class WebServer:
    """Serves pages that show faces, from its making until ``close``; as a context manager, until the block ends.

    A source and a sink for :func:`agentface.live.loop.run`: it asks of the faces what pages ask, and gives pages their
    frames. A program with a loop of its own calls ``take_in`` before each step and ``show`` after it.

    Args:
        faces: a face, which is called by its own name, or at most eight by their ids.
        host: the address to listen on; every other than the loopback's has a token.
        port: 0 for any free one.
        token: what requests have to show; beyond the loopback one is made where none is given.
        origins: the web sites whose pages may ask, beside the server's own.
        deformer: the name of the faces' deformer.
        look: the look of a single face.
        fps: frames a second.
        clock: limits rates and measures.
        told: told in a line what takes long.
        encode: makes a head's file.
        measure: finds the basis of a face.

    Raises ServerError where the extra ``web`` is missing or the address cannot be had, InvalidValueError.
    """

    def __init__(
        self,
        faces: Face | Mapping[str, Face],
        host: str = DEFAULT_HOST,
        port: int = DEFAULT_PORT,
        *,
        token: str | None = None,
        origins: Sequence[str] = (),
        deformer: str = DEFAULT_DEFORMER,
        look: str | None = None,
        fps: float = 60.0,
        clock: Clock | None = None,
        told: Callable[[str], object] = lambda _: None,
        encode: HeadEncoder = encode_head_file,
        measure: Measure = basis_of,
    ) -> None:
        _check_extra()
        self.access = Access.of(host, origins, token)
        self._clock = clock or SystemClock()
        named = _by_id(faces)
        listener = listen(host, port, "web server", "--web")
        self.host, self.port = listener.getsockname()[:2]
        options: dict[str, Any] = {"deformer": deformer, "look": look, "encode": encode, "fps": fps, "told": told}
        try:
            self._stages = {name: FaceStage(face, name, measure=measure, **options) for name, face in named.items()}
        except BaseException:
            listener.close()
            raise
        self._hub, self._inbox = Hub(), Inbox()
        self._voices = {name: _Voice(stage.face, partial(self._tell, name)) for name, stage in self._stages.items()}
        self._frame = 0
        self._closed = False
        self._serving: Serving | None = None  # who joins at once finds it
        self._serving = self._served(listener)

    @property
    def pages(self) -> int:
        """How many pages look on."""
        return len(self._hub.clients)

    @property
    def url(self) -> str:
        """Where the page is."""
        host = f"[{self.host}]" if ":" in self.host else self.host
        query = f"?token={self.access.token}" if self.access.token is not None else ""
        return f"http://{host}:{self.port}/{query}"

    def take_in(self, time_s: float = 0.0) -> None:
        """Do what pages have asked since the last call; the step that follows begins at ``time_s``."""
        for voice in self._voices.values():
            voice.now_s = time_s
        self._inbox.take_in()

    def show(self, frame: Frame) -> None:
        """Give pages the faces as the last step left them."""
        self._frame += 1
        for name, modes in self._hub.wanted.items():
            stage = self._stages[name]
            for mode in modes:
                message = stage.writer.write(mode, self._frame, frame.time_s, stage.face.geometry)
                self._call(self._hub.show, name, mode, self._frame, message)

    def close(self) -> None:
        """Stop serving; may be called twice."""
        if self._closed:
            return
        self._closed = True
        self._inbox.close()
        for voice in self._voices.values():
            voice.close()
        if self._serving is not None:
            self._serving.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def _served(self, listener: socket.socket) -> Serving:
        from agentface.io.web.app import LARGEST_MESSAGE, WebFaces, open_paths

        faces = WebFaces(self._stages, self._hub, self._inbox, self._clock)
        faces.joined = self._catch_up
        app = guarded(faces.app(), self.access, open_paths=open_paths(), clock=self._clock)
        return Serving(
            app,
            listener,
            lifespan="off",
            ws="websockets-sansio",
            ws_max_size=LARGEST_MESSAGE,
            ws_max_queue=16,
            ws_per_message_deflate=False,
            ws_ping_interval=20.0,
            ws_ping_timeout=20.0,
        )

    def _call(self, function: Callable[..., object], *arguments: object) -> None:
        """Have something done in the event loop, if there still is one."""
        loop = self._serving.loop if self._serving is not None else None
        if loop is None:
            return
        try:
            loop.call_soon_threadsafe(function, *arguments)
        except RuntimeError:  # closed
            return

    def _tell(self, face: str, message: str | bytes) -> None:
        self._call(self._hub.tell, face, message)

    def _catch_up(self, client: Client) -> None:
        """Let a page that has just come hear what is being said."""

        def rest() -> None:
            for message in self._voices[client.face].rest():
                self._call(client.tell, message)

        self._inbox.ask(rest)


class _Voice:
    """What a face says, on its way to pages; all of it in the faces' thread."""

    def __init__(self, face: Face, tell: Callable[[str | bytes], None]) -> None:
        self.now_s = 0.0
        self._talker, self._tell = face.talker, tell
        self._parts: list[tuple[float, Sound]] = []
        self._talker.heard.append(self._hear)
        self._talker.hushed.append(self._hush)
        self._talker.ended.append(self._end)
        self._latency_s = self._talker.latency_s
        self._talker.latency_s = max(self._latency_s, _HEARD_LATER_S)

    def rest(self) -> list[bytes]:
        """What is being heard and what waits to be."""
        return [piece.encode() for start, sound in self._current() for piece in pieces(sound, start, self.now_s)]

    def close(self) -> None:
        self._talker.heard.remove(self._hear)
        self._talker.hushed.remove(self._hush)
        self._talker.ended.remove(self._end)
        self._talker.latency_s = self._latency_s

    def _current(self) -> list[tuple[float, Sound]]:
        self._parts = [(start, sound) for start, sound in self._parts if start + sound.duration_s > self.now_s]
        return self._parts

    def _hear(self, sound: Sound, in_s: float) -> None:
        start = self.now_s + in_s + self._talker.latency_s
        self._current().append((start, sound))
        for piece in pieces(sound, start):
            self._tell(piece.encode())

    def _hush(self) -> None:
        self._parts = []
        self._tell(silence(self.now_s).encode())

    def _end(self, text: str) -> None:
        self._tell(json.dumps({"type": "spoken", "text": text}))


def _check_extra() -> None:
    try:
        import starlette  # noqa: F401
        import uvicorn  # noqa: F401
        import websockets  # noqa: F401
    except ImportError as error:
        raise ServerError(_NO_EXTRA.format(name=error.name)) from error


def _by_id(faces: Face | Mapping[str, Face]) -> dict[str, Face]:
    if not isinstance(faces, Mapping):
        return {faces.model.name: faces}
    if not 1 <= len(faces) <= MOST_FACES:
        raise InvalidValueError("faces", f"1 to {MOST_FACES}", len(faces))
    return {check_id(name): face for name, face in faces.items()}
