""":class:`AwaitableTwins`: the calls that take their time, to be awaited."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from concurrent.futures import Future
from typing import Any

from agentface.bml.block import Block
from agentface.calls.calls import Calls
from agentface.motion.performance import Performance
from agentface.requests import Gesture, Play, PlayBlock, Say, Speak
from agentface.speech.phones import Phone


class AwaitableTwins(Calls):
    """A face's calls for asyncio: each returns, once it is over, whether it came to its end.

    Whatever loop steps the face, in whatever thread, begins with its next step; they only wait. Wrong arguments are
    raised at once, what only the face can tell, such as a gesture that it does not have, out of the ``await``.
    Cancelled, what has not begun does not begin; a text or sounds that are being said are hushed, a performance and a
    block let go, and a gesture comes to its end.
    """

    async def say_async(
        self,
        text: str,
        *,
        voice: str | None = None,
        language: str = "en",
        rate: float = 1.0,
        interrupt: bool = False,
    ) -> bool:
        """As :meth:`Face.say`, until the text is said, or hushed; raises what goes wrong with its voice."""
        return await _over(self.ask(Say(text, voice, language, rate, interrupt)))

    async def speak_async(
        self,
        visemes: Iterable[Phone | Sequence[Any]],
        *,
        start: float = 0.0,
        rate: float = 1.0,
        loudness: float = 1.0,
        interrupt: bool = False,
        live: bool = False,
        alphabet: str | None = None,
    ) -> bool:
        """As :meth:`Face.speak`, until they are said, or hushed."""
        return await _over(self.ask(Speak.of(visemes, start, rate, loudness, interrupt, live, alphabet)))

    async def gesture_async(self, name: str, strength: float = 1.0) -> bool:
        """As :meth:`Face.gesture`, until it has ended, or another one has taken its place."""
        return await _over(self.ask(Gesture(name, strength)))

    async def play_async(self, performance: Performance, *, fade: float = 0.0) -> bool:
        """As :meth:`Face.play`, until its last frame, or until something else is played."""
        return await _over(self.ask(Play(performance, fade)))

    async def play_block_async(self, block: Block) -> bool:
        """As :meth:`Face.play_block`, until it is over or replaced; raises what keeps it from being played."""
        return await _over(self.ask(PlayBlock(block)))


async def _over(future: Future[bool]) -> bool:
    import asyncio

    return await asyncio.wrap_future(future)
