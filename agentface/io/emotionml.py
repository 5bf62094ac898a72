"""EmotionML documents as scores: the six emotions in time.

Source: Emotion Markup Language 1.0, W3C Recommendation 22 May 2014; Vocabularies for EmotionML, W3C Note 1 April 2014.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from agentface.emotion.score import Cue, Score
from agentface.errors import DataError, Fault
from agentface.io.emotion_descriptors import DescriptorReader, Shown
from agentface.io.emotion_times import LASTS_MS, Timing, read_timing, spans_of
from agentface.io.emotion_vocabularies import Vocabularies
from agentface.io.emotionml_grammar import NAMESPACE, SETS, Grammar
from agentface.io.markup import Element, read_xml
from agentface.io.report import Report

LARGEST_FILE = 2 * 1024 * 1024
MOST_EMOTIONS = 10_000


def read_emotionml(data: bytes, where: Path | str = "document.xml", *, strict: bool = False) -> Score:
    """What a document tells the face to show, and when; ``where`` is what messages call it.

    An emotion is shown by its categories, or by its dimensions, appraisals or action tendencies, as the mixture of the
    six that :mod:`agentface.emotion.vocabularies` makes of them: as strong as their ``value`` or ``trace``, or without
    either as the emotion's intensity, or 1. A ``confidence`` is left out. Times are as in
    :func:`agentface.io.emotion_times.spans_of`; without any, an emotion lasts as long as its longest trace, or 2 s.

    A document that the Recommendation allows is a score; what of it is not shown is in the score's ``notes``, and takes
    its time. Raises DataError with every fault: XML that is not well-formed or has a document type, what the
    Recommendation does not allow, more than ``LARGEST_FILE`` bytes or ``MOST_EMOTIONS`` emotions; with ``strict``,
    every note.
    """
    report = Report(Path(where))
    if len(data) > LARGEST_FILE:
        report.tell(None, "", f"at most {LARGEST_FILE} bytes", "more")
        report.check()
    score = _DocumentReader(report).read(read_xml(data, report.path))
    if strict and score.notes:
        raise DataError(score.notes)
    return score


def load_emotionml(path: str | Path, *, strict: bool = False) -> Score:
    """The score of the document at ``path``; raises DataError as :func:`read_emotionml` does."""
    path = Path(path)
    try:
        with path.open("rb") as file:
            data = file.read(LARGEST_FILE + 1)
    except OSError as error:
        raise DataError([Fault(path, None, "", "a readable file", error.strerror or type(error).__name__)]) from error
    return read_emotionml(data, path, strict=strict)


@dataclass(frozen=True, slots=True)
class _Emotion:
    timing: Timing
    shown: Shown


class _DocumentReader:
    """Reads one document."""

    def __init__(self, report: Report) -> None:
        self._report, self._grammar = report, Grammar(report)
        self._vocabularies = Vocabularies(self._grammar, report)
        self._descriptors = DescriptorReader(self._grammar, self._vocabularies, report)

    def read(self, root: Element) -> Score:
        """The score of the document; raises DataError with every fault of it."""
        elements, sets = self._parts(root)
        emotions = [self._emotion(element, sets, number) for number, element in enumerate(elements, start=1)]
        spans = spans_of([emotion.timing for emotion in emotions], self._report)
        self._report.check()
        if not emotions:
            hint = "the face stays neutral"
            self._report.note(root.line, "", "at least one emotion", "none", hint)
        cues = [
            Cue(name, start, end, tuple(curve.samples.tolist()), curve.rate_hz)
            for emotion, (start, end) in zip(emotions, spans, strict=True)
            for name, curve in emotion.shown
            if end > start
        ]
        notes = sorted(self._report.notes, key=lambda note: note.line or 0)
        return Score(cues, notes, max((end for _, end in spans), default=LASTS_MS / 1000.0))

    def _parts(self, root: Element) -> tuple[list[Element], dict[str, str]]:
        """The emotions of the document, and the sets that its root gives them."""
        if root.namespace != NAMESPACE or root.name not in ("emotionml", "emotion"):
            got = f"<{root.name[:60]}> of {root.namespace[:60] or 'no namespace'}"
            self._report.tell(root.line, "", f"<emotionml> or <emotion> of the namespace {NAMESPACE}", got)
            self._report.check()
        if root.name == "emotion":
            return [root], {}
        children = self._grammar.children(root, "emotionml")
        self._grammar.version(root, "emotionml")
        for child in children:
            if child.name == "vocabulary":
                self._vocabularies.declare(child)
        self._vocabularies.check_sets(root, "emotionml")
        elements = [child for child in children if child.name == "emotion"]
        if len(elements) > MOST_EMOTIONS:
            line = elements[MOST_EMOTIONS].line
            self._report.tell(line, "", f"at most {MOST_EMOTIONS} emotions", f"{len(elements)}")
            self._report.check()
        return elements, root.attributes

    def _emotion(self, element: Element, sets: dict[str, str], number: int) -> _Emotion:
        where = f"emotion {number}"
        children = self._grammar.children(element, where)
        self._grammar.version(element, where)
        self._grammar.identity(element, where)
        self._grammar.words(element, "expressed-through", where)
        self._vocabularies.check_sets(element, where)
        shown, lasts_ms = self._descriptors.read(children, {**sets, **element.attributes}, where)
        if not any(child.name in SETS for child in children):
            self._report.tell(element.line, where, f"at least one of {', '.join(SETS)}", "none")
        for child in children:
            if child.name == "reference":
                self._grammar.reference(child, f"{where}.reference")
        return _Emotion(read_timing(element, self._grammar, self._report, where, lasts_ms), shown)
