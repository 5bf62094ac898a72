""":class:`Actor`: a face that another thread steps, asked from asyncio."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from concurrent.futures import CancelledError, Future, ThreadPoolExecutor
from typing import TypeVar

from agentface.agents.drawing import Drawing, Painter
from agentface.conventions import Bytes
from agentface.errors import ServerError
from agentface.face import Face
from agentface.io.web.inbox import Inbox
from agentface.motion.doing import Doing
from agentface.requests import Request

_T = TypeVar("_T")
_LOOK_AGAIN_S = 0.02
ANSWER_S = 10.0
"""A face that has not taken a request in by then is not stepped."""


class Actor:
    """Has the requests of tools applied by the loop that steps ``face``, whose source ``inbox`` is.

    Args:
        face: what is asked; a step of the loop is what does it.
        inbox: a source of that loop.
        look: of pictures; the face's own when None.
    """

    def __init__(self, face: Face, inbox: Inbox, look: str | None = None) -> None:
        self.face, self.inbox = face, inbox
        self._painter = Painter(face.model, look)
        self._thread = ThreadPoolExecutor(1, thread_name_prefix="agentface-picture")

    async def apply(self, request: Request) -> Doing | None:
        """Apply a request; raises what ``Face.apply`` raises, and ServerError for a face that is not stepped."""
        return await self.call(lambda: self.face.apply(request))

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

    async def call(self, call: Callable[[], _T]) -> _T:
        """What ``call`` returns or raises between two steps."""
        future: Future[_T] = self.inbox.ask(call)
        try:
            return await asyncio.wait_for(asyncio.wrap_future(future), ANSWER_S)
        except (TimeoutError, CancelledError, asyncio.CancelledError) as error:
            if isinstance(error, asyncio.CancelledError) and not future.cancelled():
                raise
            raise ServerError("expected a face that runs, got one that has ended or is busy") from None

    async def picture(self, drawing: Drawing) -> Bytes:
        """The face as it is shown; raises GraphicsError."""
        geometry = await self.call(self.face.geometry.copy)
        loop = asyncio.get_running_loop()
        return await loop.run_in_executor(self._thread, self._painter.draw, geometry, drawing)

    def close(self) -> None:
        """Draw no more; may be called twice."""
        self._painter.close()
        self._thread.shutdown()
