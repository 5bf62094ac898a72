"""Ask for a BML block."""

from __future__ import annotations

from collections.abc import Hashable
from dataclasses import dataclass

from agentface.bml.block import Block
from agentface.errors import InvalidValueError
from agentface.motion.doing import Doing
from agentface.requests.request import Movable, Request


@dataclass(frozen=True, slots=True)
class PlayBlock(Request):
    """Play a block as its composition says: beside what plays, after it, or in its place.

    Noted, it stands beside the requests that come of it, which are noted in their time.
    """

    block: Block

    def __post_init__(self) -> None:
        if not isinstance(self.block, Block):
            raise InvalidValueError("block", "a Block, as read_bml gives it", self.block)

    @property
    def key(self) -> tuple[Hashable, ...]:
        """Each block by itself."""
        return type(self).__name__, self.block.id

    def apply(self, face: Movable) -> Doing:
        """Tell the face's player of blocks."""
        return face.blocks.play(self.block)
