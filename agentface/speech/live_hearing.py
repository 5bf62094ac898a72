""":class:`LiveHearing`: the phones of a sound while it comes. English."""

from __future__ import annotations

from itertools import accumulate

import numpy as np

from agentface.errors import InvalidValueError
from agentface.speech.phones import Phone
from agentface.speech.recognizer import FRAME_S, HEARD_HZ, QUIET, heard_parts, is_filler, open_recognizer
from agentface.speech.sound import Samples
from agentface.speech.voices.voice import SILENCE

SURE_S = 0.2
"""What ended so long before the newest sound is heard about as well as in a whole recording."""
_FRAME = round(FRAME_S * HEARD_HZ)
_PAUSE_S = 0.2
_LONG_S, _LONGEST_S = 5.0, 30.0
"""The recogniser begins anew in the first pause after so long, and after so long at the latest: it keeps all that it
has heard since, and looks through it every time."""
_KEPT_S = 2.0
"""Phones that ended so long ago are forgotten."""
_NOTHING = np.zeros(0, np.int16)


class LiveHearing:
    """Hears one sound after the other, each piece by piece.

    Of what was heard last it may think better when more comes: :attr:`phones` are its newest opinion. About as good as
    :func:`agentface.speech.hearing.heard` is on a recording for what ended ``SURE_S`` ago. Times count from the
    beginning of the sound.

    Raises SpeechError where there is no pocketsphinx.
    """

    def __init__(self) -> None:
        self._decoder = open_recognizer(phone_loop=True)
        self._hears = False
        self._rest = _NOTHING
        self._done: list[Phone] = []
        self._begun_s = 0.0
        self._energies: list[float] = []
        self._parts: list[tuple[str, int, int]] = []

    @property
    def phones(self) -> tuple[Phone, ...]:
        """Without gaps, pauses among them as ``sil``, until :attr:`heard_s`; those of long ago are left out."""
        return (*self._done, *self._now())

    @property
    def heard_s(self) -> float:
        """How much of the sound it has heard, in seconds."""
        return self._begun_s + len(self._energies) * FRAME_S

    def feed(self, samples: Samples) -> None:
        """Hear the next piece, ``(N,)`` int16 at ``HEARD_HZ``; raises InvalidValueError for another type."""
        if samples.ndim != 1 or samples.dtype != np.int16:
            raise InvalidValueError("samples", "int16 of shape (N,)", f"{samples.dtype} of shape {samples.shape}")
        rest = np.concatenate([self._rest, samples])
        whole = len(rest) // _FRAME * _FRAME
        self._rest = rest[whole:]
        if not whole:
            return
        if not self._hears:
            self._decoder.start_utt()
            self._hears = True
        self._decoder.process_raw(rest[:whole].astype("<i2").tobytes(), no_search=False, full_utt=False)
        squares = np.mean(rest[:whole].astype(np.float64).reshape(-1, _FRAME) ** 2, axis=1)
        self._energies += squares.tolist()
        self._parts = heard_parts(self._decoder)
        if self._may_begin_anew():
            self._close()

    def end(self) -> None:
        """No more comes: :attr:`phones` are final."""
        self._close()

    def begin(self) -> None:
        """Forget the sound, and hear another one."""
        self._close()
        self._rest, self._done, self._begun_s = _NOTHING, [], 0.0

    def pronounce(self, word: str) -> tuple[str, ...]:
        """The phones of a word in CMU's dictionary; none where it is not in there."""
        found = self._decoder.lookup_word(word)
        return tuple(found.split()) if found else ()

    def _may_begin_anew(self) -> bool:
        length = len(self._energies) * FRAME_S
        if length < _LONG_S:
            return False
        pause = round(_PAUSE_S / FRAME_S)
        return length >= _LONGEST_S or max(self._energies[-pause:]) <= QUIET**2

    def _close(self) -> None:
        """End the recogniser's utterance and keep what came of it."""
        if not self._hears:
            return
        self._decoder.end_utt()
        self._hears = False
        self._parts = heard_parts(self._decoder)
        now = self._now()
        self._begun_s, self._energies, self._parts = self.heard_s, [], []
        self._done = [phone for phone in (*self._done, *now) if phone.end_s > self._begun_s - _KEPT_S]

    def _now(self) -> list[Phone]:
        """The phones of the recogniser's utterance."""
        sums = [0.0, *accumulate(self._energies)]
        end = len(self._energies)
        found: list[Phone] = []
        last = 0
        for name, begins, ends in self._parts:
            first, until = max(begins, last), min(ends, end)
            if until <= first or is_filler(name) or sums[until] - sums[first] <= QUIET**2 * (until - first):
                continue
            if first > last:
                found.append(self._phone(SILENCE, last, first))
            found.append(self._phone(name, first, until))
            last = until
        if end > last:
            found.append(self._phone(SILENCE, last, end))
        return found

    def _phone(self, name: str, first: int, until: int) -> Phone:
        return Phone(name, self._begun_s + first * FRAME_S, self._begun_s + until * FRAME_S)
