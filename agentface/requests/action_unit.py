"""Ask for action units of FACS."""

from __future__ import annotations

from collections.abc import Hashable
from dataclasses import dataclass

from agentface.conventions import check_duration
from agentface.facs.action_units import check_intensity, check_side, check_unit
from agentface.requests.request import FADE_S, Movable, Request


@dataclass(frozen=True, slots=True)
class SetActionUnit(Request):
    """One action unit of FACS, beside what the emotions show.

    Attributes:
        number: of ``rules/action_units.yaml``; also text such as ``AU12``.
        intensity: 0..1, or one of FACS' letters A to E.
        side: ``left`` or ``right`` of the person, or None for both; kept as ``l`` and ``r``.
        fade: seconds.
    """

    number: int
    intensity: float
    side: str | None = None
    fade: float = FADE_S

    def __post_init__(self) -> None:
        self._keep(
            number=check_unit(self.number),
            intensity=check_intensity(self.intensity),
            side=check_side(self.side),
            fade=check_duration("fade", self.fade),
        )

    @property
    def key(self) -> tuple[Hashable, ...]:
        """Each unit by itself, on each side."""
        return type(self).__name__, self.number, self.side

    def apply(self, face: Movable) -> None:
        """Tell the action units' channel."""
        face.channels.action_units.set(self.number, self.intensity, self.side, self.fade)
