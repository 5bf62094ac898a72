""":class:`Synthesizer`: voices at work in a thread of their own, so that no frame waits for them."""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass

from agentface.errors import AgentFaceError, SpeechError
from agentface.speech.script import Script
from agentface.speech.spoken import Spoken, speak_line
from agentface.speech.voices.choose import ENGLISH, open_voice
from agentface.speech.voices.voice import Voice

VoiceOpener = Callable[[str | None, str], Voice]


@dataclass(frozen=True, slots=True)
class Order:
    """A text and how it is to be spoken.

    Attributes:
        script: what is said.
        voice: the name of a voice, None for the best there is for the language.
        language: its name or code.
        rate: how fast, 0.5..2.
    """

    script: Script
    voice: str | None = None
    language: str = ENGLISH
    rate: float = 1.0


@dataclass(frozen=True, slots=True)
class Done:
    """What has become of a sentence of an order: it is spoken, or what went wrong; ``last``: nothing follows."""

    order: Order
    spoken: Spoken | None
    error: AgentFaceError | None
    last: bool


class Synthesizer:
    """Speaks orders in their turn, sentence by sentence, from the first one until ``close``.

    An order of which a sentence cannot be spoken ends there.

    Args:
        opened: opens a voice by name and language.
    """

    def __init__(self, opened: VoiceOpener = open_voice) -> None:
        self._opened = opened
        self._voices: dict[tuple[str | None, str], Voice] = {}
        self._orders: deque[Order] = deque()
        self._done: deque[Done] = deque()
        self._changed = threading.Condition()
        self._thread: threading.Thread | None = None
        self._working: Order | None = None
        self._closed = False

    @property
    def waiting(self) -> int:
        """How many orders are not spoken yet."""
        with self._changed:
            return len(self._orders) + (self._working is not None)

    def ask(self, order: Order) -> None:
        """Have an order spoken."""
        with self._changed:
            if self._closed:
                return
            self._orders.append(order)
            self._changed.notify_all()
            if self._thread is None:
                self._thread = threading.Thread(target=self._work, name="agentface-voice", daemon=True)
                self._thread.start()

    def take(self) -> Done | None:
        """The next sentence that is done, if there is one; does not wait."""
        return self._done.popleft() if self._done else None

    def wait(self) -> None:
        """Until all is spoken that was asked for."""
        with self._changed:
            self._changed.wait_for(lambda: self._closed or not (self._orders or self._working))

    def drop(self) -> None:
        """Speak nothing more of what was asked for."""
        with self._changed:
            self._orders.clear()
            self._done.clear()
            self._working = None
            self._changed.notify_all()

    def close(self) -> None:
        """End the thread, as soon as a sentence at work is done, and the voices; may be called twice."""
        with self._changed:
            self._closed = True
            self._changed.notify_all()
        self.drop()
        voices, self._voices = self._voices, {}
        for voice in voices.values():
            voice.close()

    def _work(self) -> None:
        while (order := self._next()) is not None:
            lines = order.script.lines
            for number, line in enumerate(lines):
                done = Done(order, None, None, last=number == len(lines) - 1)
                try:
                    done = Done(order, speak_line(self._voice(order), line, order.rate), None, done.last)
                except AgentFaceError as error:
                    done = Done(order, None, error, last=True)
                except Exception as error:  # a thread that dies would leave the face mute
                    failure = SpeechError(f"expected the voice to speak, got {type(error).__name__}: {error}")
                    done = Done(order, None, failure, last=True)
                if not self._told(order, done) or done.last:
                    break

    def _next(self) -> Order | None:
        with self._changed:
            self._changed.wait_for(lambda: self._closed or self._orders)
            if self._closed:
                return None
            self._working = self._orders.popleft()
            return self._working

    def _told(self, order: Order, done: Done) -> bool:
        """Pass a sentence on; False where nobody wants it any more."""
        with self._changed:
            if self._working is not order:
                return False
            self._done.append(done)
            if done.last:
                self._working = None
                self._changed.notify_all()
            return True

    def _voice(self, order: Order) -> Voice:
        key = order.voice, order.language
        if key not in self._voices:
            voice = self._opened(*key)
            with self._changed:
                if self._closed:
                    voice.close()
                    raise SpeechError("expected a synthesizer that is not closed, got one after close()")
                self._voices[key] = voice
        return self._voices[key]
