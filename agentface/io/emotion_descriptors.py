"""What an ``<emotion>`` of EmotionML shows: its categories, dimensions, appraisals or action tendencies as the six."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import islice

import numpy as np

from agentface.emotion.state import EMOTIONS
from agentface.emotion.vocabularies import TYPES, mixture_of
from agentface.io.emotion_curves import Curve, CurveReader, together
from agentface.io.emotion_vocabularies import BIG6, INTENSITY, Declared, Vocabularies
from agentface.io.emotionml_grammar import SETS, Grammar, shortened
from agentface.io.markup import Element
from agentface.io.report import Report

Shown = list[tuple[str, Curve]]
"""Emotions, or ``neutral``, and how strong each is."""
_SCALES = ("dimension", "appraisal")
_MOST_NAMES = 100


@dataclass(frozen=True, slots=True)
class Descriptor:
    """One descriptor of an emotion; without a value or a trace, ``curve`` is None."""

    line: int
    where: str
    name: str
    vocabulary: Declared
    curve: Curve | None


class DescriptorReader:
    """Reads the descriptors of the emotions of one document."""

    def __init__(self, grammar: Grammar, vocabularies: Vocabularies, report: Report) -> None:
        self._grammar, self._vocabularies, self._report = grammar, vocabularies, report
        self._curves = CurveReader(grammar, report)
        self._unsaid: list[tuple[int, str, str, str, str]] = []

    def read(self, children: list[Element], sets: dict[str, str], where: str) -> tuple[Shown, float | None]:
        """What the face shows, and how long the longest trace lasts, in milliseconds; None without any.

        Of the kinds of descriptors, which describe one emotion in several ways, the first that says something to the
        face is shown: categories, dimensions, appraisals, action tendencies.
        """
        found = {kind: self._descriptors(kind, children, sets, where) for kind in TYPES}
        intensity = self._intensity(children, found["dimension"], where)
        everything = [descriptor.curve for kind in TYPES for descriptor in found[kind]] + [intensity]
        lasts = [curve.lasts_ms for curve in everything if curve and curve.lasts_ms]
        self._unsaid.clear()
        shown: Shown | None = None
        for kind in TYPES:
            said = [one for one in found[kind] if (kind, one.name) != ("dimension", INTENSITY)]
            before = len(self._unsaid)
            shown = (self._scales if kind in _SCALES else self._words)(said, intensity or Curve.constant(1.0))
            if shown is not None:
                del self._unsaid[:before]
                break
        if shown is None and not self._unsaid and found["dimension"]:
            self._later(found["dimension"][0], "an emotion", "an intensity alone", "it says how much, and not of what")
        for unsaid in self._unsaid:
            self._report.note(*unsaid)
        return shown or [], max(lasts, default=None)

    def _descriptors(self, kind: str, children: list[Element], sets: dict[str, str], where: str) -> list[Descriptor]:
        found: dict[str, Descriptor] = {}
        for child in (child for child in children if child.name == kind):
            name = child.attributes.get("name", "").strip()
            place = f"{where}.{kind} {name or '?'}"
            self._grammar.children(child, place)
            curve = self._curves.curve(child, place)
            told = len(self._report.faults)
            if kind == "dimension" and curve is None and "value" not in child.attributes and not child.children:
                self._report.tell(child.line, place, "a value or a trace", "neither")
            vocabulary = self._vocabulary(kind, child, sets, place)
            if vocabulary is None:
                continue
            self._check_name(vocabulary, name, child, place)
            if name in found:
                self._report.tell(child.line, place, f"each {kind} once in an emotion", f"the {kind} a second time")
            if len(self._report.faults) == told:
                found[name] = Descriptor(child.line, place, name, vocabulary, curve)
        return list(found.values())

    def _vocabulary(self, kind: str, child: Element, sets: dict[str, str], where: str) -> Declared | None:
        uri = sets.get(SETS[kind])
        if uri is None:
            hint = f'like category-set="{BIG6}"' if kind == "category" else ""
            expected = f"the attribute {SETS[kind]} of <emotion> or <emotionml>"
            self._report.tell(child.line, where, expected, "none", hint)
            return None
        return self._vocabularies.of(kind, uri)

    def _check_name(self, vocabulary: Declared, name: str, child: Element, where: str) -> None:
        if not name:
            self._report.tell(child.line, where, "a name", "nothing")
        elif vocabulary.names is not None and name not in vocabulary.names:
            meant = mixture_of(name, vocabulary.type)
            names = islice(vocabulary.names, _MOST_NAMES)
            same = next((other for other in names if meant and vocabulary.mixture(other) == meant), None)
            hint = f"did you mean {same}?" if same else self._report.near(name, vocabulary.names)
            self._report.tell(child.line, where, "a name of the vocabulary", shortened(name), hint)

    def _intensity(self, children: list[Element], dimensions: list[Descriptor], where: str) -> Curve | None:
        """What descriptors without a value take: the dimension of that name, or the element of earlier drafts."""
        curve = next((dimension.curve for dimension in dimensions if dimension.name == INTENSITY), None)
        found = [child for child in children if child.name == "intensity"]
        for second in found[1:]:
            self._report.tell(second.line, where, "one intensity", "a second one")
        for element in found[:1]:
            hint = "EmotionML 1.0 has the dimension intensity of the vocabulary intensity-dimension instead"
            self._report.note(element.line, where, "no <intensity>, which is of earlier drafts", "one", hint)
            self._grammar.children(element, f"{where}.intensity")
            drafted = self._curves.curve(element, f"{where}.intensity")
            if drafted is None and "value" not in element.attributes and not element.children:
                self._report.tell(element.line, f"{where}.intensity", "a value or a trace", "neither")
            curve = curve or drafted
        return curve

    def _words(self, said: list[Descriptor], intensity: Curve) -> Shown | None:
        """What categories or action tendencies show; None where the face knows none of them."""
        known = False
        shown: Shown = []
        for one in said:
            mixture = one.vocabulary.mixture(one.name)
            if mixture is None:
                names = [
                    name for name in islice(one.vocabulary.names or (), _MOST_NAMES) if one.vocabulary.mixture(name)
                ]
                hint = self._report.near(one.name, names or EMOTIONS)
                self._later(one, "an emotion that the face shows", shortened(one.name), hint)
                continue
            known = True
            curve = one.curve or intensity
            shown += [(emotion, Curve(curve.samples * share, curve.rate_hz)) for emotion, share in mixture.items()]
        return shown if known else None

    def _scales(self, said: list[Descriptor], intensity: Curve) -> Shown | None:
        """What dimensions or appraisals show; None where none of them says anything to the face."""
        scales = said[0].vocabulary.scales([one.name for one in said]) if said else None
        for one in said:
            if scales is None or one.name not in scales.names:
                hint = self._report.near(one.name, scales.names if scales else ())
                self._later(one, "a name that says something to the face", shortened(one.name), hint)
        speaking = [one for one in said if scales and one.name in scales.names]
        if scales is None or not any(scales.says(one.name) for one in speaking):
            for one in speaking:
                self._later(one, "what the face shows", repr(one.name), "alone it says nothing of which emotion it is")
            return None
        levels, rate = together([one.curve or intensity for one in speaking])
        weights = scales.shown({one.name: column for one, column in zip(speaking, levels.T, strict=True)})
        return [
            (emotion, Curve(np.ascontiguousarray(column), rate))
            for emotion, column in zip(EMOTIONS, weights.T, strict=True)
            if column.any()
        ]

    def _later(self, one: Descriptor, expected: str, got: str, hint: str) -> None:
        self._unsaid.append((one.line, one.where, expected, got, hint))
