"""What contact needs a frame."""

from __future__ import annotations

from typing import NamedTuple

from agentface.conventions import Floats, Indices
from agentface.deform.morphs import JawSlides


class ContactTables(NamedTuple):
    """What contact needs a frame.

    Attributes:
        grid: ``(R, N)`` vertices of the lips, as in :class:`agentface.deform.mouth.lip_grid.LipGrid`.
        lips: ``(R, U + L)``, the columns of the upper lip, then those of the lower one.
        first, last: the rings between which the lips may touch, both included.
        seam: the ring where they touch.
        upper, lower: ``(U,)``, ``(L,)``: the columns of either lip from the left corner to the right one, of which
            the first and the last belong to the corners.
        overlap_upper, overlap_lower: ``(U,)``, ``(L,)`` m, how far the lips overlap in height there at rest.
        fall: ``(R,)`` 0..1, how much of the push reaches a ring.
        tip: ``(R,)`` 0..1, how much of a bite reaches a ring of the lower lip.
        vertex: ``(K,)`` vertices before the teeth.
        kept: ``(2, K)`` m, how near each may come to the upper and the lower arch; negative: as near as it likes.
        relief: ``(K,)`` 0..1, how much nearer it may come in a bite: to the crowns, which lie behind the gum's arch.
        softness: ``(2, K)`` m, over which the push sets in.
        arch: ``(2, 4)``, the numbers of both :class:`agentface.deform.mouth.dental_arch.Arch`.
        crowns: ``(2, 4)``, the numbers of the arches of the crowns by themselves.
        bitten: ``(L,)`` 0..1, how much of a bite reaches a column of the lower lip; ``bared (U,)`` of the upper.
        hinge, widest, jaw, slides: the turn of the lower arch, and how far it slides before.
        press, shut_from: where press stands in a pose, and the level from which it shuts the lips.
        seal, bite: where these stand in a pose.
        morphs: ``(H,)`` where what moves lips or jaw by a shape stands.
    """

    grid: Indices
    lips: Indices
    first: int
    last: int
    seam: int
    upper: Indices
    lower: Indices
    overlap_upper: Floats
    overlap_lower: Floats
    fall: Floats
    tip: Floats
    vertex: Indices
    kept: Floats
    relief: Floats
    softness: Floats
    arch: Floats
    crowns: Floats
    bitten: Floats
    bared: Floats
    hinge: Floats
    widest: float
    jaw: int
    slides: JawSlides
    press: int
    shut_from: float
    seal: int
    bite: int
    morphs: Indices
