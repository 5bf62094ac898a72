"""``rules/envelopes.yaml``: how each emotion comes, stays and goes."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from itertools import pairwise
from pathlib import Path
from typing import Annotated

import numpy as np
from pydantic import AfterValidator, Field

from agentface.cache import prepared, stamp_of
from agentface.config import Table, load
from agentface.conventions import Doubles
from agentface.emotion.ramps import exponential_offset, exponential_onset, through
from agentface.emotion.state import EMOTIONS
from agentface.resources import rules_file

Seconds = Annotated[float | int, Field(gt=0.0, le=60.0)]
Share = Annotated[float | int, Field(ge=0.0, le=1.0)]
Point = Annotated[list[Share], Field(min_length=2, max_length=2)]


def _rising(points: list[list[float]]) -> list[list[float]]:
    return _checked(points, 0.0, 1.0)


def _falling(points: list[list[float]]) -> list[list[float]]:
    return _checked(points, 1.0, 0.0)


def _checked(points: list[list[float]], first: float, last: float) -> list[list[float]]:
    if points[0] != [0.0, first] or points[-1] != [1.0, last]:
        raise ValueError(f"expected a table from [0.0, {first}] to [1.0, {last}]")
    for (time, level), (later, next_level) in pairwise(points):
        if later - time < 0.01:
            raise ValueError(f"expected times that rise by 0.01 or more, not {later} after {time}")
        if (next_level - level) * (last - first) < 0.0:
            raise ValueError(f"expected levels that only {'rise' if last else 'fall'}, not {next_level} after {level}")
    return points


Points = Annotated[list[Point], Field(min_length=2, max_length=64)]


class Onset(Table):
    """Seconds, and levels that rise from 0 to 1 at times 0..1; without levels, the exponential ramp."""

    s: Seconds
    levels: Annotated[Points, AfterValidator(_rising)] | None = None

    def ramp(self) -> Doubles:
        """How far it has come, ``(KNOTS, 2)``."""
        return exponential_onset() if self.levels is None else through([(time, level) for time, level in self.levels])


class Offset(Table):
    """Likewise, levels that fall from 1 to 0."""

    s: Seconds
    levels: Annotated[Points, AfterValidator(_falling)] | None = None

    def ramp(self) -> Doubles:
        """How far it has gone, ``(KNOTS, 2)``."""
        if self.levels is None:
            return exponential_offset()
        return through([(time, 1.0 - level) for time, level in self.levels])


class Stay(Table):
    """Seconds."""

    s: Annotated[float | int, Field(ge=0.0, le=600.0)]


class EnvelopeRow(Table):
    """One emotion."""

    onset: Onset
    apex: Stay
    offset: Offset
    source: str


class EnvelopeRows(Table):
    """The six."""

    happiness: EnvelopeRow
    sadness: EnvelopeRow
    anger: EnvelopeRow
    fear: EnvelopeRow
    disgust: EnvelopeRow
    surprise: EnvelopeRow


class EnvelopesFile(Table):
    """The whole file."""

    emotions: EnvelopeRows
    mood: Stay


@dataclass(frozen=True, slots=True)
class Envelopes:
    """How the emotions come and go, in the order of ``EMOTIONS``.

    Attributes:
        onset_s: ``(6,)``, seconds from nothing to the height.
        apex_s: ``(6,)``, seconds that a brief expression stays there.
        offset_s: ``(6,)``, seconds until it is gone.
        ramps: ``(12, KNOTS, 2)``, the ramps of the six onsets, then those of the six offsets.
        mood_s: seconds until the face has come over to another mood.
    """

    onset_s: Doubles
    apex_s: Doubles
    offset_s: Doubles
    ramps: Doubles
    mood_s: float


def load_envelopes(path: str | Path) -> Envelopes:
    """The table at ``path``; raises DataError with every fault of it."""
    file = load(path, EnvelopesFile)
    rows: list[EnvelopeRow] = [getattr(file.emotions, emotion) for emotion in EMOTIONS]
    return Envelopes(
        np.array([float(row.onset.s) for row in rows]),
        np.array([float(row.apex.s) for row in rows]),
        np.array([float(row.offset.s) for row in rows]),
        np.stack([row.onset.ramp() for row in rows] + [row.offset.ramp() for row in rows]),
        float(file.mood.s),
    )


@cache
def default_envelopes() -> Envelopes:
    """The table that comes with agentface, read once."""
    path = rules_file("envelopes.yaml")
    return prepared(stamp_of([path]), "envelopes", lambda: load_envelopes(path))
