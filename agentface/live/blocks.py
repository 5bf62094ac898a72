"""A BML block that is played: the source of what a document tells a face."""

from __future__ import annotations

from agentface.bml.block import Block
from agentface.face import Face
from agentface.requests import PlayBlock

SETTLES_S = 0.5
"""What the face takes to come to rest when a block is over."""


class BlockSource:
    """Plays ``block`` to ``face`` from the start of the loop; with ``again``, anew whenever it has come to rest."""

    def __init__(self, face: Face, block: Block, *, again: bool = False) -> None:
        self._face, self._block, self._again = face, block, again
        self._begins_s: float | None = 0.0
        face.blocks  # noqa: B018  # made now, so that it is stepped with the face from the first step on

    def take_in(self, time_s: float) -> None:
        """Ask for the block when it has come due."""
        if self._begins_s is None and self._again and not self._face.blocks.blocks:
            self._begins_s = time_s + SETTLES_S
        if self._begins_s is not None and time_s >= self._begins_s:
            self._begins_s = None
            self._face.apply(PlayBlock(self._block))
