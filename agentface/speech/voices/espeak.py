"""espeak-ng: more than a hundred languages, under the GPL; a library that is loaded in a process of its own."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np

from agentface.errors import InvalidValueError, SpeechError, UnknownNameError
from agentface.speech.alphabets import phone_table
from agentface.speech.phones import Phone
from agentface.speech.sound import Sound
from agentface.speech.voices.child import Child
from agentface.speech.voices.voice import SILENCE, TOOL_S, Voiced, cannot_pronounce, check_speech_rate, word_start

ESPEAK = "espeak"
_SCRIPT = Path(__file__).with_name("espeak_child.py")
_MISSING = "expected the library libespeak-ng.so.1, got none; install it, on Debian:  apt-get install libespeak-ng1"
_LETTERS = str.maketrans({"\u03b5": "\u025b"})
"""Its Danish has a Greek letter."""
_CLOSURE_S = 0.06
"""A silence inside a word that is no longer belongs to the phone before it."""


class Espeak:
    """espeak-ng's voice of one language, known by its code (``de``, ``pt-br``) or its name in English (``german``).

    Raises UnknownNameError for another language, SpeechError where there is no espeak-ng.
    """

    def __init__(self, language: str = "en-us") -> None:
        self._child = Child(_SCRIPT, "espeak-ng")
        try:
            codes = self._languages()
            asked = language.strip().lower() if isinstance(language, str) else ""
            if asked not in codes:
                raise UnknownNameError("language", language, tuple(codes))
        except BaseException:
            self.close()
            raise
        self.language, self._voice = codes[asked]
        self.name = f"{ESPEAK} ({self.language})"

    def speak(self, sentence: str, rate: float = 1.0, marks: Sequence[int] = ()) -> Voiced:
        """Speak a sentence."""
        request = {"text": sentence, "voice": self._voice, "rate": check_speech_rate(rate)}
        answer, samples = self._asked(request)
        try:
            sound = Sound(np.frombuffer(samples, "<i2").astype(np.int16), answer["rate_hz"])
            phones = _phones(answer["phones"], sound.duration_s)
            words = sorted((int(place) - 1, float(ms) / 1000.0) for ms, place in answer["words"])
        except (KeyError, TypeError, ValueError, InvalidValueError) as error:
            self.close()
            raise SpeechError(f"expected espeak-ng to tell phones and a sound, got {error}") from error
        if all(phone.symbol == SILENCE for phone in phones):
            raise cannot_pronounce(sentence, self.name)
        end = next(phone.end_s for phone in reversed(phones) if phone.symbol != SILENCE)
        befores = [word_start(sentence, mark) for mark in marks]
        times = (next((at for place, at in words if place >= before), end) for before in befores)
        return Voiced(sound, phones, tuple(min(at, end) for at in times))

    def close(self) -> None:
        """End the process."""
        self._child.close()

    def _languages(self) -> dict[str, tuple[str, str]]:
        codes = self._asked({})[0].get("languages")
        if not isinstance(codes, dict) or not codes:
            raise SpeechError("expected espeak-ng to have languages, got none; install it again: espeak-ng-data")
        return {str(name): (str(code), str(voice)) for name, (code, voice) in codes.items()}

    def _asked(self, request: dict[str, Any]) -> tuple[dict[str, Any], bytes]:
        answer, samples = self._child.ask(request, TOOL_S)
        if answer.get("error") == "missing":
            raise SpeechError(_MISSING)
        if "error" in answer:
            raise SpeechError(f"expected espeak-ng to speak, got: {answer['error']}")
        return answer, samples


def _phones(events: Sequence[tuple[float, str]], until_s: float) -> tuple[Phone, ...]:
    """The phones of events of time in ms and IPA: each lasts until the next one."""
    starts = sorted(
        (min(max(float(ms) / 1000.0, 0.0), until_s), place, str(ipa)) for place, (ms, ipa) in enumerate(events)
    )
    ends = [at for at, _, _ in starts[1:]] + [until_s]
    phones = [Phone(SILENCE, 0.0, starts[0][0])] if starts and starts[0][0] > 0.0 else []
    for (at, _, ipa), end in zip(starts, ends, strict=True):
        symbol = _symbol(ipa)
        if end <= at:
            continue
        before = phones[-1] if phones else None
        joins = symbol is None or (symbol == SILENCE and end - at <= _CLOSURE_S) or symbol == SILENCE == _name(before)
        if before is not None and joins:
            phones[-1] = Phone(before.symbol, before.start_s, end)
        else:
            phones.append(Phone(symbol or SILENCE, at, end))
    return tuple(phones)


def _name(phone: Phone | None) -> str:
    return "" if phone is None else phone.symbol


@lru_cache(maxsize=1000)
def _symbol(ipa: str) -> str | None:
    """A phone as the mouth knows it; None for what is none: a sign by itself, or ``(en)``, a change of language."""
    symbol = ipa.translate(_LETTERS).strip("-. '_|")
    if not symbol:
        return SILENCE
    try:
        phone_table().looks([symbol], "ipa")
    except UnknownNameError:
        return None
    return symbol
