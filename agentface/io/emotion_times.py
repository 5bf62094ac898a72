"""When the emotions of an EmotionML document begin and end: its absolute, relative and missing times made one.

Source: Emotion Markup Language 1.0, W3C Recommendation 22 May 2014, section 2.4, "References and time".
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from agentface.emotion.score import LONGEST_S
from agentface.io.emotionml_grammar import Grammar, shortened
from agentface.io.markup import Element
from agentface.io.report import Report

LASTS_MS = 2000.0
"""An emotion of which a document does not say how long it lasts."""
_LONGEST_MS = 1000.0 * LONGEST_S


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


def read_timing(element: Element, grammar: Grammar, report: Report, where: str, lasts_ms: float | None) -> Timing:
    """What an ``<emotion>`` says about its time; ``lasts_ms`` is how long its longest trace lasts.

    What is not allowed is told: numbers that are none, an end that is not start plus duration. Where absolute and
    relative times are given, the absolute ones count, which is noted.
    """
    lasts = min(max(lasts_ms or LASTS_MS, 1.0), 2.0 * _LONGEST_MS)
    start, end, duration = (grammar.whole(element, name, where) for name in ("start", "end", "duration"))
    offset = grammar.whole(element, "offset-to-start", where, signed=True)
    reference = grammar.address(element, "time-ref-uri", where)
    anchor = element.attributes.get("time-ref-anchor-point", "start").strip()
    if anchor not in ("start", "end"):
        report.tell(element.line, f"{where}.time-ref-anchor-point", "start or end", shortened(anchor))
    relative = [name for name in ("offset-to-start", "time-ref-uri") if name in element.attributes]
    if relative and (start is not None or end is not None):
        report.note(element.line, where, "absolute or relative times", f"{relative[0]} beside start or end")
    if start is not None and end is not None:
        if end < start or duration not in (None, 0, end - start):
            got = f"start {start}, end {end}" + ("" if duration is None else f", duration {duration}")
            report.tell(element.line, where, "an end that is start plus duration", got)
        duration = max(end - start, 0)
    elif end is not None:
        start = end - round(duration or lasts)
    return Timing(
        line=element.line,
        where=where,
        lasts=lasts,
        name=element.attributes["id"].strip() if "id" in element.attributes else None,
        start=start,
        duration=duration or None,  # the Recommendation's default, 0, says no more than that it happened
        offset=offset,
        reference=reference,
        anchor=anchor,
    )


def spans_of(timings: Sequence[Timing], report: Report) -> list[tuple[float, float]]:
    """Start and end of each emotion in seconds, the earliest of them at 0 or later, all within ``LONGEST_S``.

    Absolute times count from the earliest of them. An emotion that says nothing of its start follows the one before
    it in the document. What something outside of the document is the reference of counts from the beginning, which is
    noted where it might be an emotion's id. Noted, too, are emotions that count from each other in a circle, of which
    one stands at 0, and those that are cut at ``LONGEST_S``, or left out, whose start and end are then the same.
    """
    names = _names(timings, report)
    epoch = min((timing.start for timing in timings if timing.start is not None), default=0.0)
    spans: dict[int, tuple[float, float]] = {}
    for index in range(len(timings)):
        chain: dict[int, None] = {}  # from an emotion to the one that it counts from, and on
        link: int | None = index
        while link is not None and link not in spans:
            if link in chain:
                _note_circle(timings[link], report)
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
            expected = f"an end within {LONGEST_S:g} s of the first start"
            report.note(timing.line, timing.where, expected, f"{end:g} s", "what comes later is left out")
    return [(min(start, LONGEST_S), min(end, LONGEST_S)) for start, end in placed]


def _names(timings: Sequence[Timing], report: Report) -> dict[str, int]:
    names: dict[str, int] = {}
    for index, timing in enumerate(timings):
        if timing.name is not None:
            names.setdefault(f"#{timing.name}", index)
    for timing in timings:
        reference = timing.reference or ""
        if reference.startswith("#") and reference not in names:
            hint = (
                f"{report.near(reference, names)} It is taken for something outside of the document, at its beginning"
            )
            where = f"{timing.where}.time-ref-uri"
            report.note(timing.line, where, "the id of an emotion", shortened(reference), hint.strip())
    return names


def _note_circle(timing: Timing, report: Report) -> None:
    got = "a circle of emotions that count from each other"
    report.note(timing.line, timing.where, "times that lead to a start", got, "this one is put at the beginning")


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
