""":class:`Agendas`: what one face has to do at times of its own."""

from __future__ import annotations

from collections.abc import Callable, Iterator

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
        self._advance(0.0)
        while (part := min((agenda.due_s for agenda in self._agendas), default=dt)) < dt:
            move(part)
            self._advance(part)
            dt -= part
        move(dt)
        self._advance(dt)

    def _advance(self, dt: float) -> None:
        for agenda in self._agendas:
            agenda.advance(dt)
        if self.talker is not None:
            self.talker.advance(0.0)  # what a block has it say now

    @property
    def _agendas(self) -> Iterator[Talker | BlockPlayer]:
        return (agenda for agenda in (self.talker, self.blocks) if agenda is not None)

    def close(self) -> None:
        """End the voices."""
        for agenda in self._agendas:
            agenda.close()
