""":class:`Events`: who is told when something is over, and what is asked from other threads."""

from __future__ import annotations

import weakref
from collections import deque
from collections.abc import Callable
from concurrent.futures import Future
from dataclasses import dataclass
from typing import Any, Protocol

from agentface.errors import InvalidValueError, UnknownNameError
from agentface.motion.doing import Doing
from agentface.motion.mixer import Mixer
from agentface.motion.performance import LET_GO_S
from agentface.requests import Gesture, Hush, Play, PlayBlock, Request, Say, Speak, TakeBack

EVENTS = ("spoken", "hushed", "failed", "gestured", "played", "blink", "reached")
"""What a program can be told of."""


class Askable(Protocol):
    """What events need of their face."""

    def apply(self, request: Request) -> Doing | None:
        """Do what is asked."""


@dataclass(frozen=True, eq=False, slots=True)
class _Going:
    """Something that goes on or waits, what asked for it, and who waits for its end."""

    request: Request
    doing: Doing
    future: Future[bool] | None = None


class Events:
    """Tells listeners and futures of one face what is over, in the thread that steps it, after the step.

    :meth:`ask` may be called from any thread; everything else belongs to the thread that steps the face.
    """

    def __init__(self, face: Askable) -> None:
        self._face: Askable = weakref.proxy(face)
        self._calls: dict[str, list[Callable[[Any], object]]] = {name: [] for name in EVENTS}
        self._asked: deque[tuple[Request, Future[bool]]] = deque()
        self._going: list[_Going] = []
        self._happened: list[tuple[str, Any]] = []
        self._closed = False

    def on(self, event: str, call: Callable[[Any], object]) -> None:
        """Call ``call`` whenever ``event`` has happened; raises UnknownNameError."""
        if not callable(call):
            raise InvalidValueError(f"on {event}", "a function", call)
        self._listeners(event).append(call)

    def off(self, event: str, call: Callable[[Any], object]) -> None:
        """Do not call it any more; raises InvalidValueError for what was not called."""
        calls = self._listeners(event)
        if call not in calls:
            raise InvalidValueError(f"off {event}", "a function that was given to on", call)
        calls.remove(call)

    def follow(self, channels: Mixer) -> None:
        """Tell of what the face's channels do by themselves."""
        blink, emotion = channels.blink, channels.emotion
        blink.begun.append(lambda shape: self.happened("blink", shape.depth))
        emotion.reached.append(lambda: self.happened("reached", emotion.target))

    def ask(self, request: Request) -> Future[bool]:
        """Have a request applied by the next step; the future has its outcome, or what was raised.

        Of what takes no time the outcome is True. A future that is cancelled takes back what is not over yet.
        """
        if not isinstance(request, Request):
            raise InvalidValueError("request", "a Request", request)
        future: Future[bool] = Future()
        self._asked.append((request, future))
        if self._closed:
            self._refuse()
        return future

    def watch(self, request: Request, doing: Doing | None) -> None:
        """Tell when what came of a request is over."""
        if doing is not None and isinstance(request, Say | Gesture | Play):
            self._going.append(_Going(request, doing))

    def take_in(self) -> None:
        """Take back what was cancelled, then apply what was asked since the last step."""
        for going in self._going:
            if going.future is not None and going.future.cancelled():
                self._take_back(going)
        for _ in range(len(self._asked)):
            request, future = self._asked.popleft()
            if not future.cancelled():
                self._apply(request, future)

    def happened(self, event: str, value: Any) -> None:
        """Something has happened that nobody asked for by a request of its own; told after the step."""
        if self._calls[event]:
            self._happened.append((event, value))

    def settle(self) -> None:
        """Tell what is over. What a listener raises is raised; what it was not told of is told after the next step."""
        while self._happened:
            self._call(*self._happened.pop(0))
        if not any(going.doing.outcome is not None for going in self._going):
            return
        over = [going for going in self._going if going.doing.outcome is not None]
        self._going = [going for going in self._going if going.doing.outcome is None]
        while over:
            going = over.pop(0)
            try:
                self._tell(going)
            except BaseException:
                self._going = over + self._going
                raise

    def close(self) -> None:
        """Nothing more is applied: whoever still waits is told that it did not come to its end."""
        self._closed = True
        self._refuse()
        going, self._going = self._going, []
        for each in going:
            if each.future is not None:
                _resolve(each.future, outcome=False)

    def _listeners(self, event: str) -> list[Callable[[Any], object]]:
        if event not in self._calls:
            raise UnknownNameError("event", event, EVENTS)
        return self._calls[event]

    def _refuse(self) -> None:
        while self._asked:
            _resolve(self._asked.popleft()[1], outcome=False)

    def _apply(self, request: Request, future: Future[bool]) -> None:
        try:
            doing = self._face.apply(request)
        except Exception as error:  # whoever asked is told, in their own thread
            _resolve(future, error=error)
            return
        if doing is None:
            _resolve(future, outcome=True)
        else:
            self._going.append(_Going(request, doing, future))

    def _take_back(self, going: _Going) -> None:
        if going.doing.outcome is not None:
            return
        if not going.doing.begun:
            if isinstance(going.request, Speak):
                self._face.apply(TakeBack(going.request))
            going.doing.end(whole=False)
        elif isinstance(going.request, Say | Speak):
            self._face.apply(Hush())
        elif isinstance(going.request, Play):
            self._face.apply(Play(None, LET_GO_S))
        elif isinstance(going.request, PlayBlock):
            going.doing.end(whole=False)

    def _tell(self, going: _Going) -> None:
        doing = going.doing
        if going.future is not None:
            _resolve(going.future, outcome=bool(doing.outcome), error=doing.error)
            return
        for event, value in _told(going.request, doing):
            self._call(event, value)

    def _call(self, event: str, value: Any) -> None:
        for call in tuple(self._calls[event]):
            call(value)


def _told(request: Request, doing: Doing) -> list[tuple[str, Any]]:
    """The event that something is over, and what listeners are told."""
    if isinstance(request, Say):
        if doing.error is not None:
            return [("failed", doing.error)]
        return [("spoken" if doing.outcome else "hushed", request.text)]
    if not doing.outcome:
        return []
    if isinstance(request, Gesture):
        return [("gestured", request.name)]
    return [("played", request.performance)] if isinstance(request, Play) else []


def _resolve(future: Future[bool], *, outcome: bool = False, error: BaseException | None = None) -> None:
    if not future.set_running_or_notify_cancel():
        return
    if error is not None:
        future.set_exception(error)
    else:
        future.set_result(outcome)
