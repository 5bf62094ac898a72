"""When the phones of a word are said whose beginning is known: by what is heard meanwhile."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np

from agentface.conventions import Doubles
from agentface.errors import UnknownNameError
from agentface.speech.alphabets import phone_table
from agentface.speech.phones import Phone
from agentface.speech.timed_words import TimedWord
from agentface.speech.voices.voice import SILENCE

_FRAME_S = 0.01
_LEAST = 3
"""Frames that a phone lasts, where the word has so many."""
_ALIKE = 0.3
"""What it counts that a vowel is heard where another vowel is said, or a consonant; the same viseme counts 1."""
_OFF = 0.01
"""What it counts against a phone to be said a frame away from where it would be without ears."""
_LETTER_S, _SHORTEST_LETTER_S, _LAST_S = 0.07, 0.02, 0.1
"""What a word takes whose end nobody knows, a letter and in all, and at least."""
_PAUSE_S = 0.1
_VOWELS = frozenset(("aa", "E", "ih", "iy", "oh", "ou"))


def fitted(phones: Sequence[Phone], heard: Sequence[Phone]) -> list[Phone]:
    """The phones of one word, one after the other, laid out anew within the same time.

    Their order is kept, and they are moved to where they are heard, as far as anything is.
    """
    start, end = phones[0].start_s, phones[-1].end_s
    frames = round((end - start) / _FRAME_S)
    near = [phone for phone in heard if phone.end_s > start and phone.start_s < end]
    if len(phones) < 2 or frames < 2 * len(phones) or not near:
        return list(phones)
    times: Doubles = np.asarray(start + (np.arange(frames) + 0.5) * _FRAME_S, np.float64)
    at = np.searchsorted([phone.end_s for phone in near], times, side="right")
    sounds = [_viseme(near[place].symbol) if place < len(near) else None for place in at]
    scores = np.array([_score(phone, times, sounds) for phone in phones])
    edges = start + _edges(scores, min(_LEAST, frames // len(phones))) * _FRAME_S
    edges[-1] = end
    return [Phone(phone.symbol, first, last) for phone, (first, last) in zip(phones, pairwise(edges), strict=True)]


def with_end(word: TimedWord, after: TimedWord | None, heard: Sequence[Phone]) -> TimedWord:
    """A word with an end: its own, or that of the silence, of the next word, or of a usual word, whichever is first."""
    if word.end_s is not None:
        end = word.end_s
    else:
        letters = len(word.text.strip())
        end = word.start_s + _LETTER_S * letters + _LAST_S if after is None else after.start_s
        said = word.start_s + _SHORTEST_LETTER_S * letters
        pauses = [p.start_s for p in heard if p.symbol == SILENCE and p.duration_s >= _PAUSE_S and p.start_s > said]
        end = min([end, *pauses])
    return replace(word, end_s=max(word.start_s, end if after is None else min(end, after.start_s)))


def _score(phone: Phone, times: Doubles, sounds: Sequence[str | None]) -> Doubles:
    """How well it fits that a phone is said, frame by frame."""
    said = _viseme(phone.symbol)
    vowel = said in _VOWELS
    alike = [
        0.0 if sound in (None, SILENCE) else 1.0 if sound == said else _ALIKE * ((sound in _VOWELS) == vowel)
        for sound in sounds
    ]
    outside = np.maximum(phone.start_s - times, 0.0) + np.maximum(times - phone.end_s, 0.0)
    return np.array(alike) - _OFF * outside / _FRAME_S


def _edges(scores: Doubles, least: int) -> Doubles:
    """``(N + 1,)``: the frames between which each of N phones is said, so that the sum of ``scores`` is largest."""
    count, frames = scores.shape
    sums = np.concatenate([np.zeros((count, 1)), np.cumsum(scores, axis=1)], axis=1)
    best = np.full(frames + 1, -np.inf)
    best[0] = 0.0
    came = np.zeros((count, frames + 1), int)
    for row in range(count):
        lead = best - sums[row]
        top = np.maximum.accumulate(lead)
        first = np.maximum.accumulate(np.where(lead == top, np.arange(frames + 1), 0))
        best = np.full(frames + 1, -np.inf)
        best[least:] = top[:-least] + sums[row, least:]
        came[row, least:] = first[:-least]
    edges = [frames]
    for row in reversed(range(count)):
        edges.append(int(came[row, edges[-1]]))
    return np.array(edges[::-1], float)


def _viseme(symbol: str) -> str:
    """What is shown most of a sound; the symbol itself where nobody knows it."""
    try:
        return phone_table().looks([symbol])[0][0].visemes[0][0]
    except UnknownNameError:
        return symbol
