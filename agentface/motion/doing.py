""":class:`Doing`: something that a face was asked for and that takes its time."""

from __future__ import annotations

from agentface.errors import AgentFaceError


class Doing:
    """Something that waits for its turn, goes on, and is over.

    Attributes:
        begun: whether its turn has come.
        outcome: None until it is over; then True when it came to its end, False when it did not. Set to False before it
            has begun, it never does.
        error: what went wrong, if that is why it is over.
    """

    __slots__ = ("begun", "error", "outcome")

    def __init__(self, *, begun: bool = False) -> None:
        self.begun = begun
        self.outcome: bool | None = None
        self.error: AgentFaceError | None = None

    def end(self, *, whole: bool) -> None:
        """It is over; the first word counts."""
        if self.outcome is None:
            self.outcome = whole
