"""Ask a face to say a text."""

from __future__ import annotations

from collections.abc import Hashable
from dataclasses import dataclass

from agentface.emotion.state import canonical_or_neutral
from agentface.errors import InvalidValueError, UnknownNameError
from agentface.motion.doing import Doing
from agentface.requests.request import Movable, Request
from agentface.speech.script import Script
from agentface.speech.synthesizer import Order
from agentface.speech.voices.choose import ENGLISH, check_voice
from agentface.speech.voices.voice import check_speech_rate


@dataclass(frozen=True, slots=True)
class Say(Request):
    """A text, spoken sentence by sentence; emotions in brackets, as in ``[joy] Hello``, are shown at their words.

    Attributes:
        text: at most ``MOST_CHARACTERS`` characters, of which some can be spoken.
        voice: the name of a voice; None for the best that the machine has for the language.
        language: its English name, or its code.
        rate: how fast, 0.5..2.
        interrupt: in place of what is said and what waits; else after it.

    Noted, it stands beside the requests that come of it, which are noted in their time.
    """

    text: str
    voice: str | None = None
    language: str = ENGLISH
    rate: float = 1.0
    interrupt: bool = False

    def __post_init__(self) -> None:
        script_of(self.text)
        check_voice(self.voice, self.language)
        if not isinstance(self.interrupt, bool):
            raise InvalidValueError("interrupt", "true or false", self.interrupt)
        self._keep(rate=check_speech_rate(self.rate))

    @property
    def key(self) -> tuple[Hashable, ...]:
        """Each text by itself."""
        return type(self).__name__, self.text

    def apply(self, face: Movable) -> Doing:
        """Tell the face's talker."""
        order = Order(script_of(self.text), self.voice, self.language, self.rate)
        return face.talker.say(self.text, order, interrupt=self.interrupt)


def script_of(text: str) -> Script:
    """The sentences of a text and the emotions of its tags; raises InvalidValueError."""
    return Script.of(text, emotion_of)


def emotion_of(name: str) -> str | None:
    """The emotion that a tag's name means, ``neutral`` among them; None where nobody knows it."""
    try:
        return canonical_or_neutral(name)
    except UnknownNameError:
        return None
