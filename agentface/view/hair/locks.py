"""How long hair clumps and waves: one field for each side, so that what lies side by side moves together."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from agentface.conventions import Doubles
from agentface.mesh.smoothstep import smoothstep

_SEED = 41, 42
"""Of the left side and of the right: cards and the sheets below them wave alike."""
LOCKS, _UNEQUAL = 13, (0.45, 1.6)
"""On each side; their widths as parts of the mean."""
_KNOTS = 8
"""Places on each side between which waves change."""
_WAVE_LENGTH, _WAVE_SIZE = (0.105, 0.140), (0.45, 1.0)
"""Metres from wave to wave, and how high they are beside the highest."""
_STEP = -0.12, 0.28
"""Turns by which waves lag behind those one knot nearer to the face."""
_STRAIGHT, _WAVY = 0.050, 0.150
"""Metres from the root up to where hair lies straight, and from where on waves are whole."""
_OWN, _OWN_LENGTH = 0.35, 0.072
"""How high a lock's own waves are beside those of all, and how long in metres."""
_AT_FACE, _FRAMING = 0.6, 0.2
"""How high waves are at the face, where they would go into it, beside others; up to which place."""
_AT_NAPE, _NAPE = 0.25, 0.82
"""How high they are at the nape, where those of both sides meet; from which place on."""
_CLUMPED, _CLUMPED_FROM, _CLUMPED_TO = 0.45, 0.22, 0.95
"""How far hair comes to the middle of its lock, and the parts of its length between which it does."""


@dataclass(frozen=True, slots=True)
class Locks:
    """The locks of a side and its waves, over the place from the face, 0, to the nape, 1.

    ``bounds (L + 1,)`` of the locks; ``start (L,)`` turns of their own waves; ``lag``, ``length``, ``size`` ``(K,)`` of
    the waves of all, at places evenly apart.
    """

    bounds: Doubles
    start: Doubles
    lag: Doubles
    length: Doubles
    size: Doubles

    @classmethod
    def of_side(cls, sign: float) -> Locks:
        """The same ones each time."""
        rng = np.random.default_rng(_SEED[int(sign < 0.0)])
        widths = rng.uniform(*_UNEQUAL, LOCKS)
        bounds = np.concatenate([[0.0], np.cumsum(widths)]) / widths.sum()
        lag = np.cumsum(rng.uniform(*_STEP, _KNOTS))
        return cls(bounds, rng.random(LOCKS), lag, rng.uniform(*_WAVE_LENGTH, _KNOTS), rng.uniform(*_WAVE_SIZE, _KNOTS))

    def number(self, place: Doubles) -> np.typing.NDArray[np.intp]:
        """``(N,)``: the lock that ``place (N,)`` is in."""
        return np.asarray(np.clip(np.searchsorted(self.bounds, place, "right") - 1, 0, len(self.start) - 1))

    def middle(self, place: Doubles) -> Doubles:
        """``(N,)``: the place of the middle of the lock that ``place (N,)`` is in."""
        number = self.number(place)
        return np.asarray(0.5 * (self.bounds[number] + self.bounds[number + 1]))

    def inside(self, place: Doubles) -> Doubles:
        """``(N,)``: 1 in the middle of a lock, 0 at its sides."""
        number = self.number(place)
        half = 0.5 * (self.bounds[number + 1] - self.bounds[number])
        return np.asarray(1.0 - (np.abs(place - self.middle(place)) / half) ** 2)

    def waves(self, place: Doubles, along: Doubles) -> tuple[Doubles, Doubles]:
        """``(N, R)`` each: how far hair swings aside and outward at ``along (N, R)`` m, parts of the highest wave."""
        turn, grown = self._turn(place, along)
        return grown * np.sin(turn), grown * np.cos(turn)

    def own(self, place: Doubles, along: Doubles) -> Doubles:
        """``(N, R)``: how far each lock swings aside by itself, as a part of the same."""
        turn = 2.0 * np.pi * (along / _OWN_LENGTH + self.start[self.number(place)][:, None])
        return np.asarray(_OWN * self._turn(place, along)[1] * np.sin(turn))

    def _turn(self, place: Doubles, along: Doubles) -> tuple[Doubles, Doubles]:
        """``(N, R)`` each: radians that the waves have turned, and how high they are."""
        lag, length, size = (self._between(knots, place) for knots in (self.lag, self.length, self.size))
        turn = 2.0 * np.pi * (along / length + lag)
        between = _AT_FACE + (1.0 - _AT_FACE) * smoothstep(0.0, _FRAMING, place)
        between = (between * (1.0 - (1.0 - _AT_NAPE) * smoothstep(_NAPE, 1.0, place)))[:, None]
        return turn, between * size * smoothstep(_STRAIGHT, _WAVY, along)

    def _between(self, knots: Doubles, place: Doubles) -> Doubles:
        return np.asarray(np.interp(place, np.linspace(0.0, 1.0, len(knots)), knots)[:, None])


def clumped(t: Doubles) -> Doubles:
    """How far hair has come to the middle of its lock at the part ``t`` of its length."""
    return np.asarray(_CLUMPED * smoothstep(_CLUMPED_FROM, _CLUMPED_TO, t))
