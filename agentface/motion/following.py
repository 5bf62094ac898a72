"""What of speech the rest of the face follows: that it speaks, which syllables are stressed, where sentences end."""

from __future__ import annotations

from typing import Protocol

from agentface.motion.utterance import Utterance

AHEAD_S = 0.3
"""So long before it is said, a sound is told: a nod is at its lowest when the stress is."""
_VOWELS = frozenset(("aa", "E", "ih", "oh", "ou", "iy"))
_SILENCE = "sil"
_STRESSED_S, _MOST_STRESSED_S = 0.09, 0.16
"""Vowels that last as long as the one begin to be stressed, and are so wholly as long as the other; ours."""
_PAUSE_S = 0.15
"""A silence that lasts as long ends a sentence, or a part of one; ours."""


class Follower(Protocol):
    """What follows: a living face. All times are in s from the time to which it was advanced."""

    def speaking(self, speaks: bool, in_s: float = 0.0) -> None:
        """Speech begins, or ends."""

    def beat(self, stress: float = 1.0, in_s: float = 0.0) -> None:
        """A syllable is stressed, 0..1."""

    def sentence_ends(self, in_s: float = 0.0) -> None:
        """A sentence ends."""


class Following:
    """Tells a follower of utterances as they are said."""

    def __init__(self, follower: Follower) -> None:
        self._follower = follower
        self._speaks = False
        self._told = 0.0

    def tell(self, utterance: Utterance | None, since: float, now: float, ended: float) -> None:
        """Tell what there is to tell of the ``utterance`` that is said ``now``, if any.

        ``since`` is the time to which the follower was advanced, ``ended`` when the last utterance did.
        """
        if self._speaks and utterance is None:
            self._follower.speaking(False, ended - since)
            self._follower.sentence_ends(ended - since)
        elif utterance is not None and not self._speaks:
            self._follower.speaking(True, utterance.began - since)
        self._speaks = utterance is not None
        if utterance is None:
            return
        after, self._told = max(self._told, utterance.began + AHEAD_S), now + AHEAD_S
        for viseme, start, length in utterance.sounds(after, self._told):
            if viseme == _SILENCE and length >= _PAUSE_S:
                self._follower.sentence_ends(start - since)
            elif viseme in _VOWELS and length >= _STRESSED_S:
                self._follower.beat(min(length / _MOST_STRESSED_S, 1.0), start + 0.5 * length - since)
