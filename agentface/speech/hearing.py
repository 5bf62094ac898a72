"""Phones of a recording: pocketsphinx hears them by themselves, or, better, aligns them with the text. English."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Sequence
from itertools import pairwise
from typing import Any

import numpy as np

from agentface.errors import InvalidValueError
from agentface.speech.phones import Phone
from agentface.speech.recognizer import FRAME_S, HEARD_HZ, QUIET, heard_parts, is_filler, open_recognizer
from agentface.speech.sound import Sound
from agentface.speech.voices.voice import SILENCE, Voiced, word_start

_PHONES = "AA AE AH AO AW AY B CH D DH EH ER EY F G HH IH IY JH K L M N NG OW OY P R S SH T TH UH UW V W Y Z ZH"
_MOST_WORDS = 2000
_SHORTEST_S = 0.1

Pronounce = Callable[[str], Iterable[str]]
"""The phones of a word, in ARPAbet; raises SpeechError or InvalidValueError."""


def heard(sound: Sound) -> Voiced:
    """What a loop of all phones makes of a recording at ``HEARD_HZ``; about seven frames in ten are right.

    Raises SpeechError where there is no pocketsphinx, InvalidValueError for another rate.
    """
    _check(sound)
    decoder = open_recognizer(phone_loop=True)
    _listen(decoder, sound)
    return Voiced(sound, _phones(heard_parts(decoder), sound))


def aligned(sound: Sound, text: str, pronounce: Pronounce, marks: Sequence[int] = ()) -> Voiced:
    """The phones of ``text``, of which ``sound``, at ``HEARD_HZ``, is the recording.

    Args:
        sound: all of the text, and nothing else.
        text: what is said.
        pronounce: asked for words that the dictionary does not have.
        marks: places in the text, in characters: when is the word that begins there, or after it, heard?

    Raises SpeechError where there is no pocketsphinx, InvalidValueError for a text that is not what is heard.
    """
    _check(sound)
    decoder = open_recognizer(phone_loop=False)
    words = [word for word in re.finditer(r"\S+", text) if any(map(str.isalnum, word[0]))][: _MOST_WORDS + 1]
    if not 0 < len(words) <= _MOST_WORDS:
        raise InvalidValueError("text", f"one to {_MOST_WORDS} words", len(words))
    decoder.set_align_text(" ".join(_known(decoder, word[0], number, pronounce) for number, word in enumerate(words)))
    _listen(decoder, sound)
    if not decoder.hyp():
        raise _not_heard(text)
    decoder.set_alignment()
    _listen(decoder, sound)
    # its items are gone when it goes on
    told = [
        (w.name, w.start, w.duration, [(p.name, p.start, p.duration) for p in w]) for w in decoder.get_alignment() or ()
    ]
    found = [word for word in told if not is_filler(word[0])]
    if len(found) != len(words):
        raise _not_heard(text)
    parts = [(name, start, start + count) for word in found for name, start, count in word[3]]
    befores = [word_start(text, mark) for mark in marks]
    starts = [(word.end(), spoken[1] * FRAME_S) for word, spoken in zip(words, found, strict=True)]
    end = min((found[-1][1] + found[-1][2]) * FRAME_S, sound.duration_s)
    times = (next((at for until, at in starts if until > before), end) for before in befores)
    return Voiced(sound, _phones(parts, sound), tuple(times))


def _check(sound: Sound) -> None:
    if sound.duration_s < _SHORTEST_S:
        raise InvalidValueError("sound", f"at least {_SHORTEST_S:g} s", f"{sound.duration_s:g} s")
    if sound.rate_hz != HEARD_HZ:
        raise InvalidValueError("sound rate", f"{HEARD_HZ} samples a second", sound.rate_hz)


def _listen(decoder: Any, sound: Sound) -> None:
    decoder.start_utt()
    decoder.process_raw(sound.samples.astype("<i2").tobytes(), full_utt=True)
    decoder.end_utt()


def _known(decoder: Any, word: str, number: int, pronounce: Pronounce) -> str:
    """A name under which the decoder knows how the word is said."""
    plain = word.lower().replace("\u2019", "'").strip("\"'`.,;:!?()[]{}\u2026\u201c\u201d\u2018-\u2013\u2014")
    if re.fullmatch("[a-z']+", plain) and decoder.lookup_word(plain):
        return plain
    phones = [_cmu(phone) for phone in pronounce(word)]
    named = f"word{number}"
    decoder.add_word(named, " ".join(phone for phone in phones if phone), True)
    return named


def _cmu(phone: str) -> str:
    """A phone as CMU's dictionary has it; nothing for a pause."""
    upper = phone.upper()
    return (
        upper if upper in _PHONES.split() else {"AX": "AH", "AXR": "ER", "EL": "L", "EN": "N", "EM": "M"}.get(upper, "")
    )


def _phones(parts: Sequence[tuple[str, int, int]], sound: Sound) -> tuple[Phone, ...]:
    """Phones without gaps over the whole sound of parts by frame."""
    end = sound.duration_s
    phones: list[Phone] = []
    for name, first, last in parts:
        start_s, end_s = min(first * FRAME_S, end), min(last * FRAME_S, end)
        if end_s > start_s and not is_filler(name) and _loudness(sound, start_s, end_s) > QUIET:
            phones.append(Phone(name, start_s, end_s))
    edges = [0.0, *(edge for phone in phones for edge in (phone.start_s, phone.end_s)), end]
    gaps = [(a, b) for a, b in pairwise(edges) if b > a]
    held = {phone.start_s: phone for phone in phones}
    return tuple(held.get(a, Phone(SILENCE, a, b)) for a, b in gaps)


def _loudness(sound: Sound, start_s: float, end_s: float) -> float:
    part = sound.samples[round(start_s * sound.rate_hz) : round(end_s * sound.rate_hz)].astype(np.float64)
    return float(np.sqrt(np.mean(part**2))) if len(part) else 0.0


def _not_heard(text: str) -> InvalidValueError:
    return InvalidValueError("text", "what is said in the sound, in English", text[:40])
