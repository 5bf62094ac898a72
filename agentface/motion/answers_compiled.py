"""``answers`` compiled."""

from __future__ import annotations

from agentface.conventions import Doubles
from agentface.kernel import kernel


@kernel()
def push(ring: Doubles, rows: Doubles) -> None:
    """As ``push_in_numpy`` of ``answers``, with the same arguments."""
    kept = len(ring) - len(rows)
    for place in range(len(ring)):
        ring[place] = ring[place + len(rows)] if place < kept else rows[place - kept]


@kernel()
def all_(rows: Doubles, row: Doubles) -> bool:
    """As ``all_in_numpy`` of ``answers``, with the same arguments."""
    for number in range(len(rows)):
        for place in range(len(row)):
            if rows[number, place] != row[place]:
                return False
    return True


@kernel()
def curve(rows: Doubles, part: float, out: Doubles) -> None:
    """As ``curve_in_numpy`` of ``answers``, with the same arguments."""
    old, new = 0.5 * (1.0 - part) ** 2, 0.5 * part**2
    middle = 0.5 + part - part**2
    shares = (old / 3.0, (middle + old) / 3.0, 1.0 / 3.0, (middle + new) / 3.0, new / 3.0)
    for place in range(len(out)):
        same, mean = True, 0.0
        for number in range(len(shares)):
            same = same and rows[number, place] == rows[0, place]
            mean += shares[number] * rows[number, place]
        out[place] = rows[0, place] if same else mean
