""":class:`Voice`, what speaks a sentence, and :class:`Voiced`, what comes of it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

from agentface.conventions import check_range
from agentface.errors import InvalidValueError
from agentface.speech.phones import Phone
from agentface.speech.sound import Sound

TOOL_S = 4.5
"""What a tool has not done with one sentence by then, it will not do."""
SILENCE = "sil"
SLOWEST, FASTEST = 0.5, 2.0


@dataclass(frozen=True, slots=True)
class Voiced:
    """A spoken sentence.

    Attributes:
        sound: what is heard.
        phones: one after the other, pauses among them as ``sil``, all within the sound.
        marks_s: when the characters that were asked about are spoken, in seconds.
    """

    sound: Sound
    phones: tuple[Phone, ...]
    marks_s: tuple[float, ...] = ()


class Voice(Protocol):
    """What speaks a sentence; may be asked again after an error."""

    name: str

    def speak(self, sentence: str, rate: float = 1.0, marks: Sequence[int] = ()) -> Voiced:
        """Speak a sentence, which takes at most ``TOOL_S`` seconds.

        Args:
            sentence: text; never an option or the name of a file, whatever it looks like.
            rate: how fast, 0.5..2.
            marks: places in the sentence, in characters: when is the word that begins there, or after it, heard?
                After the last one, its end.

        Raises InvalidValueError for a sentence that it cannot pronounce, SpeechError where the tool fails.
        """

    def close(self) -> None:
        """End what it has started; may be called twice."""


def check_speech_rate(rate: float) -> float:
    """``rate`` in 0.5..2; raises InvalidValueError."""
    return check_range("speech rate", rate, SLOWEST, FASTEST)


def word_start(text: str, place: int) -> int:
    """Where the word begins in which ``place`` lies; the place itself where it is in none."""
    while 0 < place < len(text) and text[place - 1].isalnum() and text[place].isalnum():
        place -= 1
    return place


def cannot_pronounce(sentence: str, voice: str) -> InvalidValueError:
    """The error for a sentence of which a voice makes nothing but a pause."""
    hint = "choose the voice of its language, as with --language ru"
    return InvalidValueError("text", f"text that the voice {voice} can pronounce", sentence[:40], hint)
