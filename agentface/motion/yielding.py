"""How what the mouth says, and what the face feels, share the muscles: values and weights of the speech channel.

Everywhere ``what is shown = value of speech + keep * what is felt``; as a channel that replaces with a weight of
``1 - keep``, this needs nothing of what is felt.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from agentface.conventions import Doubles, Indices
from agentface.kernel import can_compile
from agentface.motion.conflicts import SpeechYields
from agentface.parameters import NAMES, indices_of
from agentface.speech.articulation import Articulation

POWER = 8.0
"""The power of the mean that is nearly the smaller of two."""


class Shares(NamedTuple):
    """Who has which part of the parameters that speech moves or that give way to it."""

    said: Indices
    """``(N,)``, the place of each in a sample; that of the first one where speech does not move it."""
    moved: Doubles
    """``(N,)``, 1 where speech moves it, and else 0."""
    yields: Doubles
    """``(N, 3)``, how far it gives way to speaking, to rounding and to closure, 0..1."""
    rounds: Indices
    """The places in a sample of what rounds the lips."""
    closes: Indices
    """The places of what closes them."""
    jaw: int
    """The place of the jaw among the parameters."""


class Yielding:
    """Makes values and weights of a sample of speech (:mod:`agentface.speech.coarticulation`).

    ``names`` are the parameters, sides apart, that visemes move or that give way to them.
    """

    def __init__(self, articulation: Articulation, yields: SpeechYields, *, compiled: bool = False) -> None:
        spoken = articulation.names
        plain = list(dict.fromkeys((*spoken, *yields.shares)))
        places = [(index, name) for name in plain for index in indices_of(name)]
        self.names = tuple(NAMES[index] for index, _ in places)
        owners = [name for _, name in places]

        def among_said(names: tuple[str, ...]) -> Indices:
            return np.array([spoken.index(name) for name in names if name in spoken], np.int32)

        self._shares = Shares(
            said=np.array([spoken.index(name) if name in spoken else 0 for name in owners], np.int32),
            moved=np.array([float(name in spoken) for name in owners]),
            yields=np.array([yields.shares.get(name, (0.0, 0.0, 0.0)) for name in owners]),
            rounds=among_said(yields.rounds),
            closes=among_said(yields.closes),
            jaw=owners.index(spoken[articulation.jaw]),
        )
        self._share: Callable[..., None] = _kernel() if compiled and can_compile() else share_in_numpy

    def write(self, sample: Doubles, values: Doubles, weights: Doubles) -> None:
        """What a sample ``(P + 2,)`` wants of ``names``, as values and weights of a channel that replaces."""
        self._share(sample, self._shares, values, weights)


def share_in_numpy(sample: Doubles, shares: Shares, values: Doubles, weights: Doubles) -> None:
    """Write what a sample ``(P + 2,)`` wants into ``values`` and ``weights``, ``(N,)`` each."""
    tight, speaking = float(sample[-2]), float(sample[-1])
    levels = speaking, _together(sample[shares.rounds]), _together(sample[shares.closes])
    widest = 1.0 / math.expm1(tight) if tight > 0.0 else math.inf
    offset = sample[shares.said] * shares.moved
    offset[shares.jaw] = _smaller(float(offset[shares.jaw]), widest)
    keep = 1.0 - np.abs(offset)
    for place, level in enumerate(levels):
        keep *= 1.0 - level * shares.yields[:, place]
    keep[shares.jaw] = _smaller(float(keep[shares.jaw]), widest - float(offset[shares.jaw]))
    np.subtract(1.0, keep, out=weights)
    values[:] = offset
    np.divide(offset, weights, out=values, where=weights > 0.0)


def _together(levels: Doubles) -> float:
    """0..1, as much as any of some parameters, and more where several go together."""
    return 1.0 - float(np.prod(1.0 - np.maximum(levels, 0.0)))


def _smaller(one: float, other: float) -> float:
    """Nearly the smaller of two that are not negative, at most 8 % less, and without a corner."""
    if min(one, other) <= 0.0:
        return 0.0
    ratio = min(one, other) / max(one, other)
    return float(min(one, other) / (1.0 + ratio**POWER) ** (1.0 / POWER))


def _kernel() -> Callable[..., None]:
    from agentface.motion.yielding_compiled import share

    return share
