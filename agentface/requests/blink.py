"""Ask for a blink."""

from __future__ import annotations

from dataclasses import dataclass

from agentface.requests.request import Movable, Request


@dataclass(frozen=True, slots=True)
class Blink(Request):
    """Blink once."""

    def apply(self, face: Movable) -> None:
        """Tell the blinks' channel."""
        face.channels.blink.blink()
