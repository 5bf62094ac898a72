"""Ask for FAPs of MPEG-4."""

from __future__ import annotations

from collections.abc import Hashable, Mapping
from dataclasses import dataclass

from agentface.conventions import check_duration
from agentface.motion.stream import STREAM_FADE_S
from agentface.mpeg4.fap_stream import EXPRESSION_FIELDS, VISEME_FIELDS, check_fap, check_fields
from agentface.requests.request import Movable, Request


@dataclass(frozen=True, slots=True)
class SetFap(Request):
    """One low-level FAP of MPEG-4, beside those that are still shown.

    Attributes:
        number: 3..68.
        value: in the FAP's unit.
        fade: seconds.
    """

    number: int
    value: float
    fade: float = STREAM_FADE_S

    def __post_init__(self) -> None:
        number, value = check_fap(self.number, self.value)
        self._keep(number=number, value=value, fade=check_duration("fade", self.fade))

    @property
    def key(self) -> tuple[Hashable, ...]:
        """Each FAP by itself."""
        return type(self).__name__, self.number

    def apply(self, face: Movable) -> None:
        """Tell the FAPs' channel."""
        face.channels.faps.change(face.model, {self.number: self.value}, self.fade)


@dataclass(frozen=True, slots=True)
class SetFaps(Request):
    """A whole frame of FAPs: what it does not name is free.

    Attributes:
        faps: pairs of number, 3..68, and value in the FAP's unit; also a mapping.
        viseme: FAP 1: two visemes, blend and definition, or None without it.
        expression: FAP 2: an expression and its intensity twice, ``init_face`` and definition, or None.
        fade: seconds from the frame before.
    """

    faps: tuple[tuple[int, float], ...]
    viseme: tuple[int, ...] | None = None
    expression: tuple[int, ...] | None = None
    fade: float = STREAM_FADE_S

    def __post_init__(self) -> None:
        pairs = self.faps.items() if isinstance(self.faps, Mapping) else self.faps
        self._keep(
            faps=tuple(sorted(dict(check_fap(*pair) for pair in pairs).items())),
            viseme=None if self.viseme is None else check_fields("FAP 1", self.viseme, VISEME_FIELDS),
            expression=None if self.expression is None else check_fields("FAP 2", self.expression, EXPRESSION_FIELDS),
            fade=check_duration("fade", self.fade),
        )

    def apply(self, face: Movable) -> None:
        """Tell the FAPs' channel."""
        face.channels.faps.frame(face.model, dict(self.faps), self.viseme, self.expression, self.fade)
