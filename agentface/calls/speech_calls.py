""":class:`SpeechCalls`: what a face says."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Iterable, Sequence
from typing import Any

from agentface.calls.calls import Calls
from agentface.requests import Hush, Say, ShowViseme, Speak
from agentface.speech.phones import Phone
from agentface.talk.talker import Talker


class SpeechCalls(Calls):
    """A face's voice and mouth."""

    @property
    @abstractmethod
    def talker(self) -> Talker:
        """What has texts said, and tells when each is heard."""

    def speak(
        self,
        visemes: Iterable[Phone | Sequence[Any]],
        *,
        start: float = 0.0,
        rate: float = 1.0,
        loudness: float = 1.0,
        interrupt: bool = False,
        live: bool = False,
        alphabet: str | None = None,
    ) -> None:
        """Move the mouth as for these sounds: name, start and end in seconds, names in any alphabet of ``phones.yaml``.

        Times count from ``start`` seconds after now, or after what is said already; ``interrupt`` says these instead.
        ``live``: more will come; times count from now, and the newest say wins from its first sound on.
        """
        self.apply(Speak.of(visemes, start, rate, loudness, interrupt, live, alphabet))

    def hush(self) -> None:
        """Say no more, now."""
        self.apply(Hush())

    def show_viseme(self, name: str, weight: float, duration: float | None = None) -> None:
        """Show a viseme at 0..1 beside others, for ``duration`` seconds, or until it is set to 0 or :meth:`hush`."""
        self.apply(ShowViseme(name, weight, duration))

    def say(
        self,
        text: str,
        *,
        voice: str | None = None,
        language: str = "en",
        rate: float = 1.0,
        interrupt: bool = False,
        wait: bool = False,
    ) -> None:
        """Say a text, sentence by sentence, when its turn has come; ``interrupt``: in place of what is said now.

        Emotions in brackets, as in ``[joy] Hello, [surprise:0.5] you``, are shown at their words. The text is spoken
        in the background and begins with the step that finds its first sentence ready; ``wait`` until all of it is, as
        in a program that steps faster than time passes, and it begins with the next one. What goes wrong in the
        background is told to ``talker.failed``; that of a text or voice is raised: InvalidValueError, UnknownNameError.
        """
        self.apply(Say(text, voice, language, rate, interrupt))
        if wait:
            self.talker.wait()
