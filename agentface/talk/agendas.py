""":class:`Agendas`: what one face has to do at times of its own."""

from __future__ import annotations

from collections.abc import Callable

from agentface.talk.blocks import BlockPlayer
from agentface.talk.talker import Talker


class Agendas:
    """The texts that a face has to say and the BML blocks that it has to play.

    Attributes:
        talker: what has the texts said; None for a face that has never said one.
        blocks: what plays the blocks; None for a face that has never played one.
    """

    def __init__(self) -> None:
        self.talker: Talker | None = None
        self.blocks: BlockPlayer | None = None

    def advance(self, dt: float, move: Callable[[float], None]) -> None:
        """Let ``dt`` seconds pass, for the face by ``move``, and have everything happen at its own time in them."""
        agendas = [agenda for agenda in (self.blocks, self.talker) if agenda is not None]
        for agenda in agendas:
            agenda.advance(0.0)
        while agendas and (part := min(agenda.due_s for agenda in agendas)) < dt:
            move(part)
            for agenda in agendas:
                agenda.advance(part)
            dt -= part
        move(dt)
        for agenda in agendas:
            agenda.advance(dt)

    def close(self) -> None:
        """End the voices."""
        for agenda in (self.talker, self.blocks):
            if agenda is not None:
                agenda.close()
