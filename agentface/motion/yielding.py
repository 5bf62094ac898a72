"""How what the mouth says, and what the face feels, share the muscles: values and weights of the speech channel.

Everywhere ``what is shown = value of speech + keep * what is felt``; as a channel that replaces with a weight of
``1 - keep``, this needs nothing of what is felt.
"""

from __future__ import annotations

import math

import numpy as np

from agentface.conventions import Doubles
from agentface.motion.conflicts import SpeechYields
from agentface.parameters import NAMES, indices_of
from agentface.speech.articulation import Articulation

_POWER = 8.0
"""The power of the mean that is nearly the smaller of two."""


class Yielding:
    """Makes values and weights of a sample of speech (:mod:`agentface.speech.coarticulation`).

    ``names`` are the parameters, sides apart, that visemes move or that give way to them.
    """

    def __init__(self, articulation: Articulation, yields: SpeechYields) -> None:
        plain = list(dict.fromkeys((*articulation.names, *yields.shares)))
        places = [(index, row) for row, name in enumerate(plain) for index in indices_of(name)]
        self.names = tuple(NAMES[index] for index, _ in places)
        self._rows = np.array([row for _, row in places])
        shares = np.array([yields.shares.get(name, (0.0, 0.0, 0.0)) for name in plain])
        self._speaking, self._rounding, self._closure = np.ascontiguousarray(shares.T)
        self._said = len(articulation.names)
        self._rounds, self._closes = (
            tuple(articulation.names.index(name) for name in names if name in articulation.names)
            for names in (yields.rounds, yields.closes)
        )
        self._jaw = articulation.jaw
        self._offset, self._keep, self._part = np.zeros(len(plain)), np.ones(len(plain)), np.ones(len(plain))

    def write(self, sample: Doubles, values: Doubles, weights: Doubles) -> None:
        """What a sample ``(P + 2,)`` wants of ``names``, as values and weights of a channel that replaces."""
        offset, keep, part = self._offset, self._keep, self._part
        said, tight, speaking = sample[: self._said], sample[-2], sample[-1]
        rounding, closure = _together(said, self._rounds), _together(said, self._closes)
        offset[: self._said] = said
        widest = 1.0 / math.expm1(tight) if tight > 0.0 else math.inf
        offset[self._jaw] = _smaller(offset[self._jaw], widest)
        np.abs(offset, out=keep)
        np.subtract(1.0, keep, out=keep)
        for shares, level in (
            (self._speaking, speaking),
            (self._rounding, rounding),
            (self._closure, closure),
        ):
            np.multiply(shares, -level, out=part)
            part += 1.0
            keep *= part
        keep[self._jaw] = _smaller(keep[self._jaw], widest - offset[self._jaw])
        np.subtract(1.0, keep, out=keep)
        np.divide(offset, keep, out=offset, where=keep > 0.0)
        np.take(offset, self._rows, out=values)
        np.take(keep, self._rows, out=weights)


def _together(said: Doubles, places: tuple[int, ...]) -> float:
    """0..1, as much as any of some parameters, and more where several go together."""
    left = 1.0
    for place in places:
        left *= 1.0 - max(float(said[place]), 0.0)
    return 1.0 - left


def _smaller(one: float, other: float) -> float:
    """Nearly the smaller of two that are not negative, at most 8 % less, and without a corner."""
    if min(one, other) <= 0.0:
        return 0.0
    ratio = min(one, other) / max(one, other)
    return float(min(one, other) / (1.0 + ratio**_POWER) ** (1.0 / _POWER))
