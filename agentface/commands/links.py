"""What a served face is linked with beside OSC: other programs' avatars, pages."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from agentface.commands.streams import say

if TYPE_CHECKING:
    from agentface.live.loop import Sink, Source


@dataclass(slots=True)
class Links:
    """What the loop asks and shows for them, and what is said about it at the start."""

    sources: list[Source] = field(default_factory=list)
    sinks: list[Sink] = field(default_factory=list)
    told: list[str] = field(default_factory=list)

    def announce(self) -> None:
        """Say where each sends and listens."""
        for line in self.told:
            say(line)
