"""How what the mouth says, and what the face feels, share the muscles: values and weights of the speech channel.

Everywhere ``what is shown = value of speech + keep * what is felt``; as a channel that replaces with a weight of
``1 - keep``, this needs nothing of what is felt.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from agentface.conventions import Doubles, Indices
from agentface.kernel import can_compile
from agentface.motion.conflicts import SpeechYields
from agentface.motion.shares import Shares, share_in_numpy
from agentface.parameters import NAMES, indices_of
from agentface.speech.articulation import Articulation


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
        """What a sample ``(P + 2,)`` wants of ``names``, as values and weights of a channel that replaces.

        Numbers of the sample that are out of their ranges count as their limits.
        """
        self._share(sample, self._shares, values, weights)


def _kernel() -> Callable[..., None]:
    from agentface.motion.shares_compiled import share

    return share
