"""``pairs`` compiled."""

from __future__ import annotations

from agentface.conventions import Doubles
from agentface.kernel import kernel
from agentface.motion.pairs import Pairs


@kernel()
def held_back(wanted: Doubles, start: Doubles, target: Doubles, pairs: Pairs, out: Doubles) -> None:
    """As ``held_back_in_numpy`` of ``pairs``, with the same arguments."""
    out[:] = 0.0
    for number in range(len(wanted)):
        row = out[number]
        for pair in range(len(pairs.first)):
            ratio = pairs.priorities[pair, 0] / pairs.priorities[pair, 1]
            for turn in range(2):
                going, coming = pairs.first[pair], pairs.second[pair]
                if turn:
                    going, coming, ratio = coming, going, 1.0 / ratio
                x = max(wanted[number, going] - target[going], 0.0)
                y = max(wanted[number, coming] - start[coming], 0.0)
                row[going] = max(row[going], min(x, y / ratio))
                row[coming] = max(row[coming], min(y, ratio * x))
