"""Say how lively a face is, and what it is about."""

from __future__ import annotations

from dataclasses import dataclass

from agentface.conventions import check_duration, check_fraction
from agentface.errors import UnknownNameError
from agentface.motion.figures import STATES
from agentface.requests.request import Movable, Request


@dataclass(frozen=True, slots=True)
class SetLiveliness(Request):
    """Live between messages: 0, perfectly still, .. 1; in ``fade`` seconds, ``rules/life.yaml``'s when None."""

    liveliness: float
    fade: float | None = None

    def __post_init__(self) -> None:
        self._keep(
            liveliness=check_fraction("liveliness", self.liveliness),
            fade=None if self.fade is None else check_duration("fade", self.fade),
        )

    def apply(self, face: Movable) -> None:
        """Tell the channel of life."""
        face.channels.life.set_liveliness(self.liveliness, self.fade)


@dataclass(frozen=True, slots=True)
class SetState(Request):
    """Be about one of ``STATES``; None: speaking while the face speaks, and idle otherwise."""

    state: str | None

    def __post_init__(self) -> None:
        if self.state is not None and self.state not in STATES:
            raise UnknownNameError("state", self.state, STATES)

    def apply(self, face: Movable) -> None:
        """Tell the channel of life."""
        face.channels.life.set_state(self.state)
