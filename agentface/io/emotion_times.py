"""When the emotions of an EmotionML document begin and end: its absolute, relative and missing times made one.

Source: Emotion Markup Language 1.0, W3C Recommendation 22 May 2014, section 2.4, "References and time".
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from agentface.emotion.score import LONGEST_S
from agentface.errors import did_you_mean
from agentface.io.emotion_vocabularies import Tell


@dataclass(frozen=True, slots=True)
class Timing:
    """What one ``<emotion>`` says about its time, in milliseconds; None where it says nothing.

    Attributes:
        line: where it is in the file.
        where: what messages call it.
        lasts: how long the emotion lasts where nothing else says it.
        start: since 1970; with it no ``offset`` and no ``reference``.
        duration: more than 0.
        offset: from the anchor, which is the start of everything where there is no ``reference``.
        reference: the emotion, ``#id``, or something outside of the document that ``offset`` counts from.
        anchor: ``start`` or ``end`` of the reference.
    """

    line: int
    where: str
    lasts: float
    name: str | None = None
    start: float | None = None
    duration: float | None = None
    offset: int | None = None
    reference: str | None = None
    anchor: str = "start"


def spans_of(timings: Sequence[Timing], tell: Tell, note: Tell) -> list[tuple[float, float]]:
    """Start and end of each emotion in seconds, the earliest of them at 0 or later.

    Absolute times count from the earliest of them. An emotion that says nothing of its start follows the one before
    it in the document. What something outside of the document is the reference of counts from the beginning, which is
    noted where it might be an emotion's id. What cannot be placed is told, and stands at 0.
    """
    names = _names(timings, tell, note)
    epoch = min((timing.start for timing in timings if timing.start is not None), default=0.0)
    spans: dict[int, tuple[float, float]] = {}
    for index in range(len(timings)):
        chain: dict[int, None] = {}  # from an emotion to the one that it counts from, and on
        link: int | None = index
        while link is not None and link not in spans:
            if link in chain:
                _tell_circle(timings[link], tell)
                spans[link] = (0.0, timings[link].duration or timings[link].lasts)
                break
            chain[link] = None
            link = _counts_from(link, timings[link], names)
        for link in reversed(chain):
            if link not in spans:
                spans[link] = _span(link, timings[link], epoch, spans, names)
    first = min((start for start, _ in spans.values()), default=0.0)
    shift = min(first, 0.0)
    placed = [tuple((edge - shift) / 1000.0 for edge in spans[index]) for index in range(len(timings))]
    for timing, (_, end) in zip(timings, placed, strict=True):
        if end > LONGEST_S:
            tell(timing.line, timing.where, f"an end within {LONGEST_S:g} s of the first start", f"{end:g} s", "")
    return [(start, end) for start, end in placed]


def _names(timings: Sequence[Timing], tell: Tell, note: Tell) -> dict[str, int]:
    names: dict[str, int] = {}
    for index, timing in enumerate(timings):
        if timing.name is not None and names.setdefault(f"#{timing.name}", index) != index:
            tell(timing.line, f"{timing.where}.id", "an id of its own", f"{timing.name!r} again", "")
    for timing in timings:
        reference = timing.reference or ""
        if reference.startswith("#") and reference not in names:
            hint = f"{did_you_mean(reference, list(names))} " if names else ""
            hint += "It is taken for something outside of the document, at its beginning"
            note(timing.line, f"{timing.where}.time-ref-uri", "the id of an emotion", repr(reference), hint)
    return names


def _tell_circle(timing: Timing, tell: Tell) -> None:
    tell(timing.line, timing.where, "times that lead to a start", "a circle of emotions that count from each other", "")


def _counts_from(index: int, timing: Timing, names: dict[str, int]) -> int | None:
    if timing.start is not None:
        return None
    if timing.reference is not None:
        return names.get(timing.reference)
    return index - 1 if index and timing.offset is None else None


def _span(
    index: int, timing: Timing, epoch: float, spans: dict[int, tuple[float, float]], names: dict[str, int]
) -> tuple[float, float]:
    other = _counts_from(index, timing, names)
    if timing.start is not None:
        start = timing.start - epoch
    else:
        before = (0.0, 0.0) if other is None else spans[other]
        follows = timing.reference is None or timing.anchor == "end"
        start = before[1 if follows else 0] + (timing.offset or 0)
    return start, start + (timing.duration or timing.lasts)
