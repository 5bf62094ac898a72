""":class:`Actor`: a face that another thread steps, asked from asyncio."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from typing import TypeVar

from agentface.agents.drawing import Drawing, Painter
from agentface.conventions import Bytes
from agentface.errors import ServerError
from agentface.face import Face
from agentface.head.model import HeadModel
from agentface.io.web.inbox import Inbox
from agentface.motion.doing import Doing
from agentface.requests import Request

_T = TypeVar("_T")
_LOOK_AGAIN_S = 0.02
ANSWER_S = 10.0
"""A face that has not taken a request in by then is not stepped."""

_NO_FACE = "expected a face that runs, got one that has ended or is busy"


class Actor:
    """Has the requests of tools applied by the loop that steps a face: it is a source of that loop.

    The face may still be made when tools are asked already, as its kernels take a minute to compile once: they wait.

    Args:
        model: what is asked.
        look: of pictures; the model's own when None.

    Attributes:
        made: to be given the face.
    """

    def __init__(self, model: HeadModel, look: str | None = None) -> None:
        self.model, self._inbox = model, Inbox()
        self.made: Future[Face] = Future()
        self._painter = Painter(model, look)
        self._thread = ThreadPoolExecutor(1, thread_name_prefix="agentface-picture")

    def take_in(self, _time_s: float = 0.0) -> None:
        """Do what tools asked since the last call."""
        self._inbox.take_in()

    async def apply(self, request: Request) -> Doing | None:
        """Apply a request; raises what ``Face.apply`` raises, and ServerError for a face that is not stepped."""
        return await self.call(lambda face: face.apply(request))

    async def begun(self, doing: Doing) -> None:
        """Wait until something that takes its time has begun, or will not; raises what went wrong with it."""
        while not doing.begun and doing.outcome is None:
            await asyncio.sleep(_LOOK_AGAIN_S)
        if doing.error is not None:
            raise doing.error

    async def over(self, doing: Doing) -> bool:
        """Wait until it is over; whether it came to its end. Raises what went wrong with it."""
        while doing.outcome is None:
            await asyncio.sleep(_LOOK_AGAIN_S)
        if doing.error is not None:
            raise doing.error
        return doing.outcome

    async def call(self, call: Callable[[Face], _T]) -> _T:
        """What ``call`` returns or raises between two steps."""
        while not self.made.done():
            await asyncio.sleep(_LOOK_AGAIN_S)
        if self.made.cancelled():
            raise ServerError(_NO_FACE)
        face = self.made.result()
        future: Future[_T] = self._inbox.ask(lambda: call(face))
        try:
            return await asyncio.wait_for(asyncio.wrap_future(future), ANSWER_S)
        except (TimeoutError, asyncio.CancelledError) as error:
            if isinstance(error, asyncio.CancelledError) and not future.cancelled():
                raise
            raise ServerError(_NO_FACE) from None

    async def picture(self, drawing: Drawing) -> Bytes:
        """The face as it is shown; raises GraphicsError."""
        geometry = await self.call(lambda face: face.geometry.copy())
        loop = asyncio.get_running_loop()
        return await loop.run_in_executor(self._thread, self._painter.draw, geometry, drawing)

    def close(self) -> None:
        """Let nobody wait for the face, and draw no more; may be called twice."""
        self._inbox.close()
        self.made.cancel()
        self._painter.close()
        self._thread.shutdown()
