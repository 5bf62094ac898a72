""":class:`Spoken`: what is heard, the phones of it, and what is shown at which word."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from agentface.errors import InvalidValueError
from agentface.speech.phones import Phone
from agentface.speech.script import Line, Script
from agentface.speech.sound import Sound
from agentface.speech.tags import Tag
from agentface.speech.voices.voice import Voice, Voiced


@dataclass(frozen=True, slots=True)
class Spoken:
    """A sentence or more, ready to be shown and heard.

    Attributes:
        sound: what is heard.
        phones: one after the other, seconds from its start.
        tags: what is asked for, with the seconds at which its word begins.
        text: what is said, as far as it is known.
    """

    sound: Sound
    phones: tuple[Phone, ...]
    tags: tuple[tuple[float, Tag], ...] = ()
    text: str = ""

    @classmethod
    def of(cls, utterance: Voiced, line: Line | None = None) -> Spoken:
        """What an utterance is, whose marks are the tags of ``line``."""
        if line is None:
            return cls(utterance.sound, utterance.phones)
        tags = tuple(zip(utterance.marks_s, line.tags, strict=True))
        return cls(utterance.sound, utterance.phones, tags, line.text)

    @property
    def duration_s(self) -> float:
        """Until nothing is heard or said any more, in seconds."""
        return max(self.sound.duration_s, self.phones[-1].end_s if self.phones else 0.0)


def speak_line(voice: Voice, line: Line, rate: float = 1.0) -> Spoken:
    """One sentence; raises what the voice raises."""
    return Spoken.of(voice.speak(line.text, rate, [tag.at for tag in line.tags]), line)


def speak_script(voice: Voice, script: Script, rate: float = 1.0) -> Spoken:
    """A whole text; raises what the voice raises."""
    return joined(speak_line(voice, line, rate) for line in script.lines)


def joined(parts: Iterable[Spoken]) -> Spoken:
    """One after the other; raises InvalidValueError for none, or for sounds of several rates."""
    parts = tuple(parts)
    rates = {part.sound.rate_hz for part in parts}
    if len(rates) != 1:
        raise InvalidValueError("sounds", "one or more of the same rate", sorted(rates))
    rate = rates.pop()
    pieces, phones, tags, start = [], [], [], 0.0
    for part in parts:
        phones += shifted(part.phones, start)
        tags += [(start + at, tag) for at, tag in part.tags]
        count = round((start + part.duration_s) * rate) - round(start * rate)
        piece = np.zeros(count, np.int16)
        piece[: len(part.sound.samples)] = part.sound.samples[:count]
        pieces.append(piece)
        start += part.duration_s
    text = " ".join(part.text for part in parts if part.text)
    return Spoken(Sound(np.concatenate(pieces), rate), tuple(phones), tuple(tags), text)


def shifted(phones: Sequence[Phone], by_s: float) -> list[Phone]:
    """The same phones so much later."""
    return [replace(phone, start_s=phone.start_s + by_s, end_s=phone.end_s + by_s) for phone in phones]
