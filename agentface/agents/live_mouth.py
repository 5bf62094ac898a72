""":class:`LiveMouth`: has a face's mouth say phones that are known better from frame to frame."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from agentface.face import Face
from agentface.requests import Speak
from agentface.speech.phones import Phone
from agentface.speech.voices.voice import SILENCE

_SAME_S = 1e-6
_PAST_S = 0.5
"""Phones that ended so long ago are not told again."""
_SHUT_S = 0.1


class LiveMouth:
    """Tells ``face`` what is new of the phones of one sound."""

    def __init__(self, face: Face) -> None:
        self._face = face
        self._told: tuple[Phone, ...] = ()
        self._start_s = 0.0

    def begin(self) -> None:
        """Another sound begins."""
        self._told = ()

    def tell(self, phones: Sequence[Phone], now_s: float, start_s: float) -> None:
        """Say phones, whose times count from ``start_s``; it is ``now_s`` for the face, on the same clock."""
        known = tuple(phone for phone in phones if start_s + phone.end_s > now_s - _PAST_S)
        told = () if abs(start_s - self._start_s) > _SAME_S else self._told
        self._told, self._start_s = known, start_s
        common = set(told)
        fresh = next((place for place, phone in enumerate(known) if phone not in common), len(known))
        new = list(known[fresh:])
        if not new and told and known and told[-1].end_s > known[-1].end_s:
            new = [Phone(SILENCE, known[-1].end_s, known[-1].end_s + _SHUT_S)]  # it has thought better of the last one
        if new:
            shift = start_s - now_s
            moved = [replace(phone, start_s=phone.start_s + shift, end_s=phone.end_s + shift) for phone in new]
            self._face.apply(Speak(tuple(moved), live=True))
