"""``rules/life.yaml``: the figures of a living face."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import cache
from pathlib import Path
from typing import Annotated

import numpy as np
from pydantic import AfterValidator, Field

from agentface.cache import prepared, stamp_of
from agentface.config import Document, Table
from agentface.motion.course import LATE_S
from agentface.resources import rules_file

STATES = ("idle", "listening", "thinking", "speaking")
"""What a face can be about."""
IDLE, SPEAKING = STATES[0], STATES[3]


def _ordered(pair: list[float]) -> list[float]:
    if pair[0] > pair[1]:
        raise ValueError("expected a range from the smaller to the larger number")
    return pair


Share = Annotated[float, Field(ge=0, le=1)]
Seconds = Annotated[float, Field(gt=0, le=600)]
Degrees = Annotated[float, Field(ge=0, le=60)]
Range = Annotated[list[Seconds], Field(min_length=2, max_length=2), AfterValidator(_ordered)]
Shares = Annotated[list[Share], Field(min_length=2, max_length=2), AfterValidator(_ordered)]
Limit = Annotated[list[Annotated[float, Field(gt=0, le=60)]], Field(min_length=2, max_length=2)]


class Dial(Table):
    """What the liveliness means."""

    natural: Annotated[float, Field(gt=0, le=1)]
    fade_s: Seconds


class StateRow(Table):
    """What a face does when it is about one thing."""

    blinks_per_minute: Annotated[float, Field(ge=0.1, le=60)]
    at_s: Seconds
    away_s: Seconds
    smallest_deg: Annotated[float, Field(ge=0, le=50)]
    largest_deg: Annotated[float, Field(gt=0, le=50)]
    sway: Annotated[float, Field(ge=0, le=4)]
    pupils: Annotated[float, Field(ge=-1, le=1)]
    upward: Share
    gestures: dict[str, Seconds]


class BlinkFigures(Table):
    """How the lids close, and when."""

    close_s: Range
    hold_s: Range
    open_s: Range
    apart_s: Seconds
    half: Share
    half_depth: Shares
    double: Share
    double_after_s: Range
    per_degree: Share
    most: Share
    sentence_end: Share


class SaccadeFigures(Table):
    """How the eyes leap, and drift between."""

    scale_deg: Annotated[float, Field(gt=0, le=60)]
    over: Annotated[float, Field(gt=0)]
    largest_p: Annotated[float, Field(gt=0)]
    shortest_s: Seconds
    per_degree_s: Annotated[float, Field(ge=0, le=1)]
    directions: dict[Annotated[int, Field(ge=0, lt=360)], Annotated[float, Field(ge=0)]]
    limit_deg: Limit
    stay_s: Seconds
    drift_deg: Annotated[float, Field(ge=0, le=2)]
    drift_hz: Range
    head_beyond_deg: Degrees
    head_share: Share
    head_s: Seconds

    def chance_of(self, degrees: float) -> float:
        """The P of a saccade of so many degrees, at most ``largest_p``."""
        return min(self.over * math.exp(-degrees / self.scale_deg), self.largest_p)


class LookFigures(Table):
    """How eyes and head share what is looked at."""

    head_beyond: Share
    head_gain: Annotated[float, Field(ge=1, le=10)]
    eyes_keep: Share
    head_limit_deg: Limit
    head_after_s: Annotated[float, Field(ge=0, le=10)]
    head_s: Seconds
    head_per_degree_s: Annotated[float, Field(ge=0, le=1)]


class HeadFigures(Table):
    """How far the head sways."""

    yaw_deg: Annotated[float, Field(ge=0, le=10)]
    pitch_deg: Annotated[float, Field(ge=0, le=10)]
    roll_deg: Annotated[float, Field(ge=0, le=10)]
    hz: Range


class BreathFigures(Table):
    """How often and how deep."""

    per_minute: Range
    depth: Shares
    in_share: Annotated[float, Field(ge=0.1, le=0.9)]
    head_deg: Annotated[float, Field(ge=0, le=10)]
    nostrils: Share
    chest: Share


class PupilFigures(Table):
    """How restless they are."""

    waves: Share
    hz: Range


class BeatFigures(Table):
    """What stressed words do."""

    strength: Shares
    brows: Share
    apart_s: Seconds


class SideFigures(Table):
    """How late one side may be."""

    lag_s: Annotated[float, Field(ge=0, le=LATE_S)]


class LifeTable(Table):
    """The whole file."""

    dial: Dial
    states: dict[str, StateRow]
    blinks: BlinkFigures
    saccades: SaccadeFigures
    look_at: LookFigures
    head: HeadFigures
    breathing: BreathFigures
    pupils: PupilFigures
    beats: BeatFigures
    sides: SideFigures


def load_life(path: str | Path) -> LifeTable:
    """The table at ``path``; raises DataError with every fault of it."""
    document = Document(path)
    table = document.collect(LifeTable)
    states = document.data.get("states") if isinstance(document.data, dict) else None
    if isinstance(states, dict):
        for name in sorted({*states, *STATES}, key=str):
            if name not in STATES:
                document.fault(("states", name), f"one of {', '.join(STATES)}", repr(name))
            elif name not in states:
                document.fault(("states", name), "this key", "nothing")
    if table is not None:
        _check(document, table)
    document.check()
    assert table is not None, "a document without faults is parsed"  # noqa: S101 - for the type checker
    return table


def _check(document: Document, table: LifeTable) -> None:
    saccades = table.saccades
    if not sum(saccades.directions.values()) > 0.0:
        document.fault(("saccades", "directions"), "a direction above 0 per cent", "none")
    if saccades.largest_p >= saccades.over:
        document.fault(("saccades", "largest_p"), f"a number below {saccades.over:g}", f"{saccades.largest_p:g}")
    if table.look_at.eyes_keep > table.look_at.head_beyond:
        expected = f"a number up to head_beyond, {table.look_at.head_beyond:g}"
        document.fault(("look_at", "eyes_keep"), expected, f"{table.look_at.eyes_keep:g}")
    for name, row in table.states.items():
        if row.smallest_deg >= row.largest_deg:
            where = ("states", name, "smallest_deg")
            document.fault(where, f"less than largest_deg, {row.largest_deg:g}", f"{row.smallest_deg:g}")
        for key, mean in (("at_s", row.at_s), ("away_s", row.away_s)):
            if mean <= saccades.stay_s:
                document.fault(("states", name, key), f"more than stay_s, {saccades.stay_s:g}", f"{mean:g}")
        if 60.0 / row.blinks_per_minute <= table.blinks.apart_s:
            expected = f"fewer than one in apart_s, {table.blinks.apart_s:g} s"
            document.fault(("states", name, "blinks_per_minute"), expected, f"{row.blinks_per_minute:g}")


def drawn(random: np.random.Generator, span: Sequence[float]) -> float:
    """A number drawn evenly from a range."""
    return float(random.uniform(span[0], span[1]))


@cache
def default_life() -> LifeTable:
    """The table that comes with agentface, read once."""
    path = rules_file("life.yaml")
    return prepared(stamp_of([path]), "life", lambda: load_life(path))
