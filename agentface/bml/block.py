""":class:`Block`: a BML block as records, free of XML and of any face.

Source: Behavior Markup Language 1.0, core specification and core extensions (SAIBA, 2011).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Literal, Self, TypeAlias

from agentface.errors import Fault
from agentface.speech.spoken import Spoken

Composition: TypeAlias = Literal["MERGE", "APPEND", "REPLACE"]
COMPOSITIONS: tuple[Composition, ...] = ("MERGE", "APPEND", "REPLACE")
STARTS, ENDS = "start", "end"
STROKE = (STARTS, "ready", "strokeStart", "stroke", "strokeEnd", "relax", ENDS)
"""The sync points of whatever has a stroke."""
POINTS: dict[str, tuple[str, ...]] = {
    "face": (STARTS, "attackPeak", "relax", ENDS),
    "face_shift": (STARTS, ENDS),
    "gaze": (STARTS, "ready", "relax", ENDS),
    "gaze_shift": (STARTS, ENDS),
    "head": STROKE,
    "head_direction_shift": (STARTS, ENDS),
    "speech": (STARTS, ENDS),
    "wait": (STARTS, ENDS),
    "other": STROKE,
}
"""The sync points of each kind of behavior in their order; a speech has those of its text between its own."""


@dataclass(frozen=True, slots=True)
class SyncPoint:
    """A sync point: of a behavior of this block, or of another one; without a behavior, the start of the block."""

    behavior: str = ""
    name: str = STARTS
    block: str = ""

    def __str__(self) -> str:
        return ":".join(part for part in (self.block, self.behavior or "bml", self.name) if part)


@dataclass(frozen=True, slots=True)
class SyncTime:
    """So many seconds after a sync point, before it where they are negative."""

    point: SyncPoint
    offset_s: float = 0.0


@dataclass(frozen=True, slots=True)
class Show:
    """What a face behavior shows: an emotion by name, or an action unit by number; ``side`` is ``l``, ``r`` or None."""

    what: str | int
    level: float
    side: str | None = None


@dataclass(frozen=True, slots=True)
class Aim:
    """What is looked at: degrees to the person's left and up from between the eyes, so many metres away."""

    yaw_deg: float
    pitch_deg: float
    distance_m: float
    head_share: float = 0.0
    """How much of the way the head turns, 0..1."""


@dataclass(frozen=True, slots=True)
class Nod:
    """A gesture of the head by its name in ``rules/gestures.yaml``, at ``amount`` 0..1, so often."""

    gesture: str
    amount: float
    times: int = 1


@dataclass(frozen=True, slots=True)
class Text:
    """What a speech says: a piece, a sync point by its name, a piece, ..., a piece."""

    pieces: tuple[str, ...]
    syncs: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Behavior:
    """One behavior of a block.

    Attributes:
        id: unique in the block.
        kind: of ``POINTS``.
        line: of the document.
        does: what is shown, looked at, done or said; None for what waits, or is not a face's.
        usual_s: seconds between one sync point and the next, where nothing else says them.
        anchors: the sync points that are told when to be, each once.
    """

    id: str
    kind: str
    line: int
    does: tuple[Show, ...] | Aim | Nod | Text | None
    usual_s: tuple[float, ...]
    anchors: tuple[tuple[str, SyncTime], ...] = ()

    @property
    def points(self) -> tuple[str, ...]:
        """The names of its sync points in their order."""
        if isinstance(self.does, Text):
            return (STARTS, *self.does.syncs, ENDS)
        return POINTS[self.kind]

    @property
    def holds(self) -> int | None:
        """The place of the sync point after which it lasts longer where it has more time than usual."""
        return self.points.index("relax") - 1 if self.kind in ("face", "gaze") else None


@dataclass(frozen=True, slots=True)
class Precedence:
    """That one sync point is not later than another.

    ``before``: the earlier one makes room for the later one; else the later one waits.
    """

    earlier: SyncTime
    later: SyncTime
    line: int
    before: bool = False


@dataclass(frozen=True, slots=True)
class Meeting:
    """That sync points are at the same time."""

    points: tuple[SyncTime, ...]
    line: int


@dataclass(frozen=True, slots=True)
class Block:
    """One block, as :func:`agentface.io.bml.reader.read_bml` reads it.

    Attributes:
        id: what others and the feedback call it.
        behaviors: in the order of the document.
        composition: how it comes to what plays already.
        character: for whom it is; empty for whoever gets it.
        orders, meetings: its constraints.
        path: what messages call the document.
        notes: what of it is not shown as it is written.
        spoken: the speeches that are spoken already, by the id of the behavior.
    """

    id: str
    behaviors: tuple[Behavior, ...]
    composition: Composition = "MERGE"
    character: str = ""
    orders: tuple[Precedence, ...] = ()
    meetings: tuple[Meeting, ...] = ()
    path: Path = Path("block.bml")
    notes: tuple[Fault, ...] = field(default=(), compare=False)
    spoken: tuple[tuple[str, Spoken], ...] = field(default=(), compare=False)

    @property
    def speeches(self) -> tuple[Behavior, ...]:
        """The behaviors that say something."""
        return tuple(behavior for behavior in self.behaviors if behavior.kind == "speech")

    def voiced(self, spoken: Mapping[str, Spoken]) -> Self:
        """The same with its speeches spoken."""
        return replace(self, spoken=tuple(spoken.items()))
