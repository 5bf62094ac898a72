"""The web application: what is served where."""

from __future__ import annotations

import asyncio
import json
from collections.abc import Callable, Mapping
from concurrent.futures import Future
from typing import Any, cast

from starlette.applications import Starlette
from starlette.requests import Request as HttpRequest
from starlette.responses import FileResponse, JSONResponse, PlainTextResponse, Response
from starlette.routing import Route, WebSocketRoute
from starlette.websockets import WebSocket, WebSocketDisconnect

from agentface.clock import Clock
from agentface.errors import AgentFaceError, InvalidValueError, ServerError, UnknownNameError
from agentface.io.osc.rate_limit import RateLimit
from agentface.io.web.asked import ASKED, request_of
from agentface.io.web.errors_json import error_json
from agentface.io.web.frames import MODES, Mode
from agentface.io.web.hub import Client, Hub
from agentface.io.web.inbox import Inbox
from agentface.io.web.openapi import openapi
from agentface.io.web.page_files import FOLDER
from agentface.io.web.stage import FaceStage
from agentface.requests import Request

_ICON = "/favicon.ico"
LARGEST_MESSAGE = 64 * 1024
"""Bytes of one message of a page."""
_MESSAGES_AT_ONCE, _MESSAGES_A_SECOND = 480.0, 240.0
_ANSWER_S = 10.0
_NO_PAGE = """expected the page of this package in {folder}, got none: it is built with node.
make page builds it; everything but the page works without."""


class WebFaces:
    """The faces of an application, and the ways to them.

    Args:
        stages: the faces by their ids.
        hub: who looks on.
        inbox: where what they ask waits for the faces' thread.
        clock: limits rates and measures.
    """

    def __init__(self, stages: Mapping[str, FaceStage], hub: Hub, inbox: Inbox, clock: Clock) -> None:
        self.stages, self.hub, self.inbox, self.clock = stages, hub, inbox, clock
        self.joined: Callable[[Client], None] = lambda _: None
        """Called when a page has been told hello."""

    def app(self) -> Starlette:
        """The application, to be guarded."""
        post = [Route(path, self._asked, methods=["POST"]) for path in ("/{name}", "/faces/{face}/{name}")]
        return Starlette(
            routes=[
                Route("/", _page),
                Route(_ICON, lambda _: Response(status_code=204)),
                Route("/{file}.js", _page),
                Route("/licences.txt", _page),
                Route("/openapi.json", lambda _: JSONResponse(openapi())),
                Route("/status", self._status),
                Route("/faces", self._faces),
                Route("/faces/{face}/status", self._status),
                Route("/faces/{face}/head.glb", self._head),
                *post,
                WebSocketRoute("/live", self._live),
            ],
            exception_handlers={AgentFaceError: _refused, 404: _not_found, 405: _not_found},
        )

    def stage(self, face: str | None) -> FaceStage:
        """The face of this id, the first one without; raises UnknownNameError."""
        if face is None:
            return next(iter(self.stages.values()))
        if face not in self.stages:
            raise UnknownNameError("face", face, tuple(self.stages))
        return self.stages[face]

    def ask(self, stage: FaceStage, name: Any, told: Any) -> Future[None]:
        """Have a request applied with the next frame; raises what is wrong with it."""
        try:
            request = request_of(name, told)
        except AgentFaceError:
            self.inbox.ask(lambda: _count(stage, "rejected"))
            raise
        return self.inbox.ask(lambda: _apply(stage, request))

    async def _asked(self, asked: HttpRequest) -> Response:
        name = asked.path_params["name"]
        if name not in ASKED:
            raise UnknownNameError("request", name, tuple(ASKED))
        stage = self.stage(asked.path_params.get("face") or asked.query_params.get("face"))
        await _answer(self.ask(stage, name, _body(asked, await asked.body())))
        return JSONResponse({"done": name, "face": stage.name})

    async def _status(self, asked: HttpRequest) -> Response:
        face = asked.path_params.get("face") or asked.query_params.get("face")
        return JSONResponse(await self.status(face))

    async def status(self, face: str | None) -> dict[str, Any]:
        """What a face is doing, or, where there are several and none is named, what each of them is."""
        if face is not None or len(self.stages) == 1:
            return await _answer(self.inbox.ask(self.stage(face).face.status))
        stages = self.stages
        return await _answer(self.inbox.ask(lambda: {"faces": {name: stages[name].face.status() for name in stages}}))

    async def _faces(self, _: HttpRequest) -> Response:
        rows = [
            {
                "face": name,
                "model": stage.face.model.name,
                "deformer": stage.deformer,
                "looks": list(stage.looks),
                "fps": stage.fps,
                "pages": sum(client.face == name for client in self.hub.clients),
            }
            for name, stage in self.stages.items()
        ]
        return JSONResponse({"faces": rows})

    async def _head(self, asked: HttpRequest) -> Response:
        stage = self.stage(asked.path_params["face"])
        head = await asyncio.to_thread(stage.head, asked.query_params.get("look"))
        kept = "private, max-age=31536000, immutable" if asked.query_params.get("v") == head.etag else "no-cache"
        headers = {"ETag": f'"{head.etag}"', "Cache-Control": kept, "Vary": "Accept-Encoding, Origin"}
        if head.etag in asked.headers.get("if-none-match", ""):
            return Response(status_code=304, headers=headers)
        if "gzip" in asked.headers.get("accept-encoding", ""):
            return Response(head.packed, headers=headers | {"Content-Encoding": "gzip"}, media_type="model/gltf-binary")
        return Response(head.content, headers=headers, media_type="model/gltf-binary")

    async def _live(self, socket: WebSocket) -> None:
        await socket.accept()
        try:
            if self.hub.full:
                raise ServerError("web server: expected fewer pages at once, got one more; close some")
            stage, mode = self.stage(socket.query_params.get("face")), _mode(socket.query_params.get("mode"))
            hello = await asyncio.to_thread(stage.hello, mode, socket.query_params.get("look"))
        except AgentFaceError as error:
            await socket.send_text(json.dumps({"type": "error", **error_json(error)}))
            await socket.close(1008)
            return
        client = Client(_sender(socket), stage.name, mode, self.clock)
        client.tell(json.dumps(hello))
        self.hub.join(client)
        self.joined(client)
        await _until_one_ends(client.run(), self._listen(socket, stage, client))
        self.hub.leave(client)

    async def _listen(self, socket: WebSocket, stage: FaceStage, client: Client) -> None:
        rate = RateLimit(self.clock, _MESSAGES_AT_ONCE, _MESSAGES_A_SECOND)
        while True:
            message = await socket.receive()
            if message["type"] == "websocket.disconnect":
                return
            if not rate.take():
                client.tell(_error(None, ServerError("expected fewer messages a second, got too many")))
                await asyncio.sleep(0.1)
                await socket.close(1008)
                return
            answer = await self._heard(message.get("text"), stage, client)
            if answer is not None:
                client.tell(answer)

    async def _heard(self, text: str | None, stage: FaceStage, client: Client) -> str | None:
        """The answer to what a page says; None for what needs none."""
        told: Any = None
        try:
            told = _json("message", text)
            if not isinstance(told, dict):
                raise InvalidValueError("message", "an object", type(told).__name__)
            if isinstance(told.get("ack"), int):
                client.confirm(told["ack"])
                return None
            name = told.get("request")
            if name == "status":
                return json.dumps({"type": "status", **_id(told), "status": await self.status(stage.name)})
            await _answer(self.ask(stage, name, told.get("args")))
        except AgentFaceError as error:
            return _error(told, error)
        return json.dumps({"type": "done", **_id(told)})


def open_paths() -> frozenset[str]:
    """What needs no token: the page and its programs, which are no secret."""
    return frozenset({"/", _ICON, *(f"/{file.name}" for file in FOLDER.glob("*"))})


def _apply(stage: FaceStage, request: Request | None) -> None:
    counts = stage.face.message_counts
    try:
        if request is not None:
            stage.face.apply(request)
    except AgentFaceError:
        counts.errors["rejected"] += 1
        raise
    counts.messages += 1


def _count(stage: FaceStage, kind: str) -> None:
    stage.face.message_counts.errors[kind] += 1


async def _answer(future: Future[Any]) -> Any:
    try:
        return await asyncio.wait_for(asyncio.wrap_future(future), _ANSWER_S)
    except (asyncio.CancelledError, TimeoutError) as error:
        if isinstance(error, asyncio.CancelledError) and not future.cancelled():
            raise
        raise ServerError("web server: expected a face that runs, got one that has ended or is busy") from None


def _body(asked: HttpRequest, body: bytes) -> Any:
    if not body:
        return {}
    kind = asked.headers.get("content-type", "").partition(";")[0].strip().lower()
    if kind != "application/json":
        raise InvalidValueError("Content-Type", "application/json", kind)
    return _json("body", body)


def _json(where: str, text: bytes | str | None) -> Any:
    try:
        return json.loads(text or b"", parse_constant=_no_number)
    except (ValueError, RecursionError) as error:
        raise InvalidValueError(where, "JSON", f"{type(error).__name__}: {error}"[:200]) from None


def _no_number(name: str) -> Any:
    raise ValueError(f"{name} is no number")


def _mode(name: str | None) -> Mode:
    if name is not None and name not in MODES:
        raise UnknownNameError("mode", name, MODES)
    return name or MODES[0]


def _id(told: Any) -> dict[str, Any]:
    """The id of a message that has one that can be repeated."""
    known = told.get("id") if isinstance(told, dict) else None
    return {"id": known} if isinstance(known, int) or (isinstance(known, str) and len(known) <= 64) else {}


def _error(told: Any, error: AgentFaceError) -> str:
    return json.dumps({"type": "error", **_id(told), **error_json(error)})


def _sender(socket: WebSocket) -> Callable[[bytes | str], Any]:
    async def send(message: bytes | str) -> None:
        if isinstance(message, str):
            await socket.send_text(message)
        else:
            await socket.send_bytes(message)

    return send


async def _until_one_ends(*parts: Any) -> None:
    tasks = [asyncio.ensure_future(part) for part in parts]
    try:
        await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
    finally:
        for task in tasks:
            task.cancel()
        for ended in await asyncio.gather(*tasks, return_exceptions=True):
            if isinstance(ended, Exception) and not isinstance(ended, (WebSocketDisconnect, OSError, RuntimeError)):
                raise ended


async def _page(asked: HttpRequest) -> Response:
    name = "index.html" if asked.url.path == "/" else asked.url.path[1:]
    if not (FOLDER / "index.html").is_file():
        return PlainTextResponse(_NO_PAGE.format(folder=FOLDER), 404 if name != "index.html" else 200)
    if name not in {path.name for path in FOLDER.iterdir()}:
        return await _not_found(asked, Exception())
    return FileResponse(FOLDER / name, headers={"Cache-Control": "no-cache", "X-Content-Type-Options": "nosniff"})


async def _refused(_: HttpRequest, error: Exception) -> Response:
    status = 503 if isinstance(error, ServerError) else 400
    if isinstance(error, UnknownNameError) and error.kind in ("face", "request", "look"):
        status = 404
    return JSONResponse(error_json(cast("AgentFaceError", error)), status)


async def _not_found(asked: HttpRequest, _: Exception) -> Response:
    what = f"{asked.method} {asked.url.path}"[:200]
    return JSONResponse(error_json(InvalidValueError("path", "one of /openapi.json", what)), 404)
