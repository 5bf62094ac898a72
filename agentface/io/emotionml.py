"""EmotionML documents as scores: the six emotions in time.

Source: Emotion Markup Language 1.0, W3C Recommendation 22 May 2014; Vocabularies for EmotionML, W3C Note 1 April 2014.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

from agentface.conventions import ROUNDING
from agentface.emotion.score import FASTEST_HZ, Cue, Score
from agentface.errors import DataError, Fault, did_you_mean
from agentface.io.emotion_times import Timing, spans_of
from agentface.io.emotion_vocabularies import BIG6, INTENSITY, Vocabularies, is_id, published, shown_as
from agentface.io.markup import Element, read_xml

NAMESPACE = "http://www.w3.org/2009/10/emotionml"
LARGEST_FILE = 1024 * 1024
MOST_EMOTIONS = 10_000
LASTS_MS = 2000.0
"""An emotion of which a document does not say how long it lasts."""

_SETS = ("category-set", "dimension-set", "appraisal-set", "action-tendency-set")
_TIMES = ("start", "end", "duration", "offset-to-start", "time-ref-uri", "time-ref-anchor-point")
_OTHERS = ("dimension", "appraisal", "action-tendency")
_ATTRIBUTES = {
    "emotionml": ("version", *_SETS),
    "emotion": ("version", "id", "expressed-through", *_SETS, *_TIMES),
    "category": ("name", "value", "confidence"),
    "intensity": ("value", "confidence"),
    "trace": ("freq", "samples"),
    "reference": ("uri", "role", "media-type"),
    "vocabulary": ("type", "id"),
    "item": ("name",),
}
_CHILDREN = {
    "emotionml": ("emotion", "vocabulary", "info"),
    "emotion": ("category", "intensity", *_OTHERS, "reference", "info"),
    "category": ("trace",),
    "intensity": ("trace",),
    "trace": (),
    "reference": (),
    "vocabulary": ("item", "info"),
    "item": ("info",),
}
_ROLES = ("expressedBy", "experiencedBy", "triggeredBy", "targetedAt")
_NUMBER = re.compile(r"[-+]?(?:\d+(?:\.\d*)?|\.\d+)(?:[eE][-+]?\d+)?", re.ASCII)
_WHOLE = re.compile(r"[-+]?\d{1,15}", re.ASCII)
_HERTZ = re.compile(r"(\d+(?:\.\d*)?)\s*Hz", re.ASCII)

Curve = tuple[tuple[float, ...], float]
"""Samples, and how many of them a second; 0 for a constant."""


def read_emotionml(data: bytes, where: Path | str = "document.xml") -> Score:
    """What a document tells the face to show, and when; ``where`` is what messages call it.

    The categories of the published vocabularies, or of one in the document, that mean one of the six or ``neutral``
    become cues of their ``value`` or ``trace``; without either, of the emotion's ``intensity``, or 1. Dimensions,
    appraisals and action tendencies are left out, and so is every ``confidence``. Beside emotions with categories, one
    that has only others takes its time and shows nothing; the score's ``notes`` say so. Times are as in
    :func:`agentface.io.emotion_times.spans_of`; without any, an emotion lasts as long as its longest trace, or 2 s.

    Raises DataError with every fault: XML that is not well-formed or has a document type, what the Recommendation
    does not allow, other vocabularies, categories that the face does not show, no emotion with a category, more than
    ``LARGEST_FILE`` bytes, ``MOST_EMOTIONS`` emotions, or an hour.
    """
    path = Path(where)
    if len(data) > LARGEST_FILE:
        raise DataError([Fault(path, None, "", f"at most {LARGEST_FILE} bytes", "more")])
    reader = _DocumentReader(path)
    cues = reader.read(read_xml(data, path))
    if reader.faults:
        raise DataError(sorted(reader.faults, key=lambda fault: fault.line or 0))
    return Score(cues, reader.notes)


def load_emotionml(path: str | Path) -> Score:
    """The score of the document at ``path``; raises DataError as :func:`read_emotionml` does."""
    path = Path(path)
    try:
        with path.open("rb") as file:
            data = file.read(LARGEST_FILE + 1)
    except OSError as error:
        raise DataError([Fault(path, None, "", "a readable file", error.strerror or type(error).__name__)]) from error
    return read_emotionml(data, path)


@dataclass(slots=True)
class _Emotion:
    timing: Timing
    curves: list[tuple[str, Curve]]
    others: str


class _DocumentReader:
    """Reads one document, and notes every fault on the way."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.faults: list[Fault] = []
        self.notes: list[Fault] = []
        self._vocabularies = Vocabularies()

    def read(self, root: Element) -> list[Cue]:
        if root.namespace != NAMESPACE or root.name not in ("emotionml", "emotion"):
            got = f"<{root.name}> of {root.namespace or 'no namespace'}"
            self._tell(root.line, "", f"<emotionml> or <emotion> of the namespace {NAMESPACE}", got)
            return []
        whole = root.name == "emotionml"
        children = self._children(root, "emotionml") if whole else [root]
        if whole:
            self._version(root, "emotionml")
            for child in children:
                if child.name == "vocabulary":
                    self._vocabularies.declare(child, self._items(child), self._tell)
        elements = [child for child in children if child.name == "emotion"]
        if len(elements) > MOST_EMOTIONS:
            got = f"{len(elements)}"
            self._tell(elements[MOST_EMOTIONS].line, "", f"at most {MOST_EMOTIONS} emotions", got)
            return []
        sets = root.attributes if whole else {}
        emotions = [self._emotion(element, sets, number) for number, element in enumerate(elements, start=1)]
        self._note_others(emotions)
        spans = spans_of([emotion.timing for emotion in emotions], self._tell, self._note)
        if self.faults:
            return []
        return [
            Cue(name, start, end, *curve)
            for emotion, (start, end) in zip(emotions, spans, strict=True)
            for name, curve in emotion.curves
        ]

    def _tell(self, line: int, where: str, expected: str, got: str, hint: str = "") -> None:
        self.faults.append(Fault(self.path, line, where, expected, got, hint))

    def _note(self, line: int, where: str, expected: str, got: str, hint: str = "") -> None:
        self.notes.append(Fault(self.path, line, where, expected, got, hint))

    def _note_others(self, emotions: list[_Emotion]) -> None:
        """Emotions with nothing that the face shows are left out beside others, and a fault where there is no other."""
        say = self._note if any(emotion.others == "" for emotion in emotions) else self._tell
        for emotion in emotions:
            if emotion.others:
                timing = emotion.timing
                say(timing.line, timing.where, "a category", emotion.others, "the face shows categories alone")

    def _children(self, element: Element, where: str) -> list[Element]:
        """The children that may be there; the others, and attributes that may not, are told."""
        known = _ATTRIBUTES[element.name]
        for name in element.attributes:
            if name not in known:
                hint = did_you_mean(name, known)
                self._tell(element.line, where, "no such attribute", repr(name), hint)
        allowed = _CHILDREN[element.name]
        for child in element.children:
            if child.namespace != NAMESPACE or child.name not in allowed:
                place = "" if child.namespace == NAMESPACE else f" of {child.namespace or 'no namespace'}"
                hint = did_you_mean(child.name, allowed) if allowed else ""
                self._tell(child.line, where, "no such element", f"<{child.name}>{place}", hint)
        return [child for child in element.children if child.namespace == NAMESPACE and child.name in allowed]

    def _version(self, element: Element, where: str) -> None:
        version = element.attributes.get("version", "nothing" if element.name == "emotionml" else "1.0")
        if version.strip() != "1.0":
            self._tell(element.line, f"{where}.version", "1.0", version)

    def _items(self, vocabulary: Element) -> list[Element]:
        items = [child for child in self._children(vocabulary, "vocabulary") if child.name == "item"]
        for item in items:
            self._children(item, "vocabulary.item")
        return items

    def _emotion(self, element: Element, sets: dict[str, str], number: int) -> _Emotion:
        where = f"emotion {number}"
        children = self._children(element, where)
        self._version(element, where)
        sets = {**sets, **element.attributes}
        intensity = self._intensity(children, sets, where)
        curves: dict[str, tuple[str, Curve]] = {}
        for child in children:
            if child.name == "category":
                self._category(child, sets.get("category-set"), where, curves, intensity)
            elif child.name == "reference":
                self._reference(child, f"{where}.reference")
        others = ""
        lasting = [curve for _, curve in curves.values()]
        if not any(child.name == "category" for child in children):
            unseen = [child for child in children if child.name in _OTHERS]
            others = " and ".join(dict.fromkeys(child.name for child in unseen))
            lasting = [curve for child in unseen if (curve := self._curve(child, f"{where}.{child.name}"))]
            if not others:
                self._tell(element.line, where, "a category", "none", "the face shows categories alone")
        longest = max((1000.0 * len(samples) / rate for samples, rate in lasting if rate), default=LASTS_MS)
        return _Emotion(self._timing(element, where, longest), list(curves.values()), others)

    def _reference(self, element: Element, where: str) -> None:
        self._children(element, where)
        if not element.attributes.get("uri", "").strip():
            self._tell(element.line, f"{where}.uri", "what it refers to", "nothing")
        role = element.attributes.get("role", _ROLES[0]).strip()
        if role not in _ROLES:
            self._tell(element.line, f"{where}.role", f"one of {', '.join(_ROLES)}", repr(role))

    def _intensity(self, children: list[Element], sets: dict[str, str], where: str) -> Curve:
        """What categories without a value take: the dimension of that name, or the element of earlier drafts."""
        found = [child for child in children if child.name == "intensity"]
        if sets.get("dimension-set", "").strip() == INTENSITY:
            found += [child for child in children if child.name == "dimension" and _name(child) == "intensity"]
        for second in found[1:]:
            self._tell(second.line, where, "one intensity", "a second one")
        if not found:
            return (1.0,), 0.0
        if found[0].name == "intensity":
            self._children(found[0], f"{where}.intensity")
        curve = self._curve(found[0], f"{where}.intensity")
        if curve is None:
            self._tell(found[0].line, f"{where}.intensity", "a value or a trace", "neither")
        return curve or ((1.0,), 0.0)

    def _category(
        self, element: Element, chosen: str | None, where: str, curves: dict[str, tuple[str, Curve]], intensity: Curve
    ) -> None:
        name = _name(element)
        where = f"{where}.category {name or '?'}"
        curve = self._curve(element, where) or intensity
        self._children(element, where)
        known = self._vocabularies.names(chosen)
        if known is None:
            hint = f'category-set="{BIG6}" is the one that the face shows'
            expected = f"the vocabulary {', '.join(published())}, or one of the document"
            self._tell(element.line, where, expected, repr(chosen) if chosen else "no category-set", hint)
            return
        emotion = shown_as(name)
        if name not in known:
            same = next((other for other in known if emotion and shown_as(other) == emotion), None)
            hint = f"did you mean {same}?" if same else did_you_mean(name, known)
            self._tell(element.line, where, "a name of the vocabulary", repr(name), hint)
        elif emotion is None:
            shown = [other for other in known if shown_as(other)]
            self._tell(element.line, where, "an emotion that the face shows", repr(name), did_you_mean(name, shown))
        elif name in curves:
            self._tell(element.line, where, "each category once in an emotion", "the category a second time")
        else:
            curves[name] = (emotion, curve)

    def _curve(self, element: Element, where: str) -> Curve | None:
        """The value or the trace of an element; None where it has neither, or none that can be read."""
        self._number(element, "confidence", where)
        traces = [child for child in element.children if (child.namespace, child.name) == (NAMESPACE, "trace")]
        value = self._number(element, "value", where)
        if not traces:
            return None if value is None else ((value,), 0.0)
        if len(traces) > 1 or "value" in element.attributes:
            self._tell(traces[-1].line, where, "a value or one trace", "more than that")
        return self._trace(traces[0], f"{where}.trace")

    def _number(self, element: Element, attribute: str, where: str) -> float | None:
        text = element.attributes.get(attribute)
        return None if text is None else self._fraction(text, element.line, f"{where}.{attribute}")

    def _fraction(self, text: str, line: int, where: str) -> float | None:
        number = float(text) if _NUMBER.fullmatch(text.strip()) else -1.0
        if not -ROUNDING <= number <= 1.0 + ROUNDING:
            self._tell(line, where, "a number in 0..1", repr(text))
            return None
        return min(max(number, 0.0), 1.0)

    def _trace(self, element: Element, where: str) -> Curve | None:
        self._children(element, where)
        rate = _HERTZ.fullmatch(element.attributes.get("freq", "").strip())
        hertz = float(rate[1]) if rate else 0.0
        if not 0.0 < hertz <= FASTEST_HZ:
            got = repr(element.attributes.get("freq", "nothing"))
            expected = f"more than 0 and at most {FASTEST_HZ:g} Hz, like 10Hz"
            self._tell(element.line, f"{where}.freq", expected, got)
        texts = element.attributes.get("samples", "").split()
        samples = [self._fraction(text, element.line, f"{where}.samples") for text in texts]
        if not samples:
            self._tell(element.line, f"{where}.samples", "at least one number", "none")
        values = tuple(sample for sample in samples if sample is not None)
        return (values, hertz) if values and hertz > 0.0 else None

    def _timing(self, element: Element, where: str, lasts: float) -> Timing:
        given = element.attributes
        start, end, duration = (self._whole(element, name, where) for name in ("start", "end", "duration"))
        offset = self._whole(element, "offset-to-start", where, signed=True)
        relative = [name for name in ("offset-to-start", "time-ref-uri") if name in given]
        if relative and (start is not None or end is not None):
            self._tell(element.line, where, "absolute or relative times", f"{relative[0]} beside start or end")
        if start is not None and end is not None:
            if end < start or duration not in (None, 0, end - start):
                got = f"start {start}, end {end}" + ("" if duration is None else f", duration {duration}")
                self._tell(element.line, where, "an end that is start plus duration", got)
            duration = max(end - start, 0)
        elif end is not None:
            start = end - round(duration or lasts)
        name = given["id"].strip() if "id" in given else None
        if name is not None and not is_id(name):
            self._tell(element.line, f"{where}.id", "an id that begins with a letter", repr(name))
        anchor = given.get("time-ref-anchor-point", "start").strip()
        if anchor not in ("start", "end"):
            self._tell(element.line, f"{where}.time-ref-anchor-point", "start or end", repr(anchor))
        return Timing(
            line=element.line,
            where=where,
            lasts=lasts,
            name=name,
            start=start,
            duration=duration or None,  # the Recommendation's default, 0, says no more than that it happened
            offset=offset,
            reference=given["time-ref-uri"].strip() if "time-ref-uri" in given else None,
            anchor=anchor,
        )

    def _whole(self, element: Element, attribute: str, where: str, *, signed: bool = False) -> int | None:
        text = element.attributes.get(attribute)
        if text is None:
            return None
        number = int(text) if _WHOLE.fullmatch(text.strip()) else None
        if number is None or (number < 0 and not signed):
            expected = "a whole number of milliseconds" + ("" if signed else ", zero or more")
            self._tell(element.line, f"{where}.{attribute}", expected, repr(text))
            return None
        return number


def _name(element: Element) -> str:
    return element.attributes.get("name", "").strip()
