"""Pairs of muscles that look wrong together: in a change, the one that goes is gone before the one that comes begins.

Bui, Heylen and Nijholt (2004) settle such conflicts within one channel muscle by muscle, by priorities. A state that
the face rests in is the rules' affair and stays as they made it; only what a change adds to it is held back. Of a
pair, let x be how far the one that goes is still above its target, and y how far the one that comes is above where it
began. With r, the priority of the one over that of the other, x is lessened by min(x, y / r) and y by min(y, r x), so
that one of them is always nothing: they meet where y = r x, and the muscle of higher priority has more of the time.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from agentface.conventions import Doubles, Indices


class Pairs(NamedTuple):
    """The two muscles of each pair, by their places in ``MUSCLES``, ``(P,)`` each, and their priorities."""

    first: Indices
    second: Indices
    priorities: Doubles
    """``(P, 2)``."""


def held_back_in_numpy(wanted: Doubles, start: Doubles, target: Doubles, pairs: Pairs, out: Doubles) -> None:
    """Write into ``out (N, M)`` how much each of the contractions ``wanted (N, M)`` is held back.

    The change goes from ``start`` to ``target``, ``(M,)`` each.
    """
    out[:] = 0.0
    goes, comes = np.maximum(wanted - target, 0.0), np.maximum(wanted - start, 0.0)
    ratios = pairs.priorities[:, 0] / pairs.priorities[:, 1]
    for going, coming, ratio in ((pairs.first, pairs.second, ratios), (pairs.second, pairs.first, 1.0 / ratios)):
        x, y = goes[:, going], comes[:, coming]
        for number, row in enumerate(out):
            np.maximum.at(row, going, np.minimum(x, y / ratio)[number])
            np.maximum.at(row, coming, np.minimum(y, ratio * x)[number])
