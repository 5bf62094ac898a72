"""Where the cards of a side run: from the parting down the head, clumped to locks."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from agentface.conventions import Doubles
from agentface.view.hair.locks import Locks, clumped
from agentface.view.hair.ribbons import unit_rows
from agentface.view.hair.sheets import parts_along, resampled
from agentface.view.hair.visible import Flags

CARDS, _ROWS = 32, 22
"""On each side; points along each."""
_TO_THE_FRONT = 1.25
"""The exponent with which they gather at the face."""
_JITTER = 0.8
"""Of the space between cards, by which they stand off their places."""
_SHORTEST, _LONGEST, _MOSTLY_LONG, _ALIKE = 0.88, 1.0, 0.5, 0.35
"""Parts of the whole length, and the exponent of chance between them; up to where along it all lie side by side."""
_WISPS, _WISPS_UP_TO = 4, 0.22
"""Every how many cards at the face one is a wisp; up to which place on the side."""


@dataclass(frozen=True, slots=True)
class CardWays:
    """Where the cards of a side run on the hull.

    ``t (R,)`` 0..1 along each; ``root (N,)`` of each and ``place (N, R)`` 0 at the face to 1 at the nape, ``space
    (N,)`` from one to the next of them; ``part (N, R)`` of the length of hair there, ``middle (N, R, 3)`` m, ``along
    (N, R)`` m from the root, and ``aside (N, R, 3)`` m to the next card.
    """

    t: Doubles
    root: Doubles
    place: Doubles
    space: Doubles
    part: Doubles
    middle: Doubles
    along: Doubles
    aside: Doubles

    @classmethod
    def drawn(cls, paths: Doubles, locks: Locks, rng: np.random.Generator) -> CardWays:
        """On ``paths (C, K, 3)`` m, one in each of equal parts of them."""
        last, t = len(paths) - 1.0, parts_along(_ROWS)
        chance = (np.arange(CARDS) + rng.uniform(0.0, _JITTER, CARDS)) / CARDS
        root = chance**_TO_THE_FRONT
        share = _SHORTEST + (_LONGEST - _SHORTEST) * rng.random(CARDS)[:, None] ** _MOSTLY_LONG
        lines = _between(paths, last * root)
        lengths = np.linalg.norm(np.diff(lines, axis=1), axis=2).sum(axis=1)
        # side by side as far as they lie on the head, so that none cuts through another
        alike = np.median(lengths) / lengths[:, None]
        part = alike * t + (share - alike) * np.clip((t - _ALIKE) / (1.0 - _ALIKE), 0.0, 1.0) ** 1.5
        middle, along = resampled(lines, part)
        before, behind = (
            resampled(_between(paths, np.clip(last * root + step, 0.0, last)), part)[0] for step in (-1.0, 1.0)
        )
        space = _TO_THE_FRONT / CARDS * chance ** (_TO_THE_FRONT - 1.0)
        aside = 0.5 * len(paths) * space[:, None, None] * (behind - before)
        aside = _sheared(aside, unit_rows(np.gradient(middle, axis=1)))
        lock = locks.middle(root)
        middle = middle + clumped(t)[:, None] * (resampled(_between(paths, last * lock), part)[0] - middle)
        place = root[:, None] + clumped(t) * (lock - root)[:, None]
        return cls(t, root, place, space, part, middle, along, aside)

    def wisps(self) -> Flags:
        """``(N,)``: which of them are wisps."""
        return np.asarray((self.root < _WISPS_UP_TO) & (np.arange(CARDS) % _WISPS == _WISPS - 1))


def _sheared(aside: Doubles, along: Doubles) -> Doubles:
    """``aside (..., 3)`` with no more of it ``along (..., 3)`` the hair than across."""
    part = (aside * along).sum(-1, keepdims=True)
    across = aside - part * along
    most = np.linalg.norm(across, axis=-1, keepdims=True)
    return np.asarray(across + np.clip(part, -most, most) * along)


def _between(paths: Doubles, column: Doubles) -> Doubles:
    """``(N, K, 3)``: the paths at ``column (N,)`` of ``paths (C, K, 3)``."""
    low = np.minimum(column.astype(int), len(paths) - 2)
    part = (column - low)[:, None, None]
    return np.asarray((1.0 - part) * paths[low] + part * paths[low + 1])
