"""The vocabularies of an EmotionML document: those that the W3C publishes, those that it declares, and others' by name.

Source: Emotion Markup Language 1.0, section 2.1.3, "Defining vocabularies"; Vocabularies for EmotionML, W3C Note
1 April 2014.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable
from dataclasses import dataclass

from agentface.emotion.vocabularies import (
    TYPES,
    Mixture,
    Scales,
    Vocabulary,
    Words,
    is_word,
    mixture_of,
    published,
    scales_with,
)
from agentface.io.emotionml_grammar import SETS, Grammar, shortened
from agentface.io.markup import Element
from agentface.io.report import Report

_PUBLISHED = ("http://www.w3.org/TR/emotion-voc/xml#", "https://www.w3.org/TR/emotion-voc/xml#")
BIG6 = f"{_PUBLISHED[0]}big6"
INTENSITY = "intensity"


@dataclass(frozen=True, slots=True)
class Declared:
    """A vocabulary that a document uses.

    Attributes:
        type: one of ``TYPES``.
        names: its items; None where they are not known, and all may be used.
        published: what they mean to the face, of one that the W3C publishes.
    """

    type: str
    names: Collection[str] | None
    published: Vocabulary | None = None

    def mixture(self, name: str) -> Mixture | None:
        """What a category or an action tendency shows; None for nothing that the face knows."""
        if isinstance(self.published, Words):
            return self.published.mixtures.get(name)
        return mixture_of(name, self.type)

    def scales(self, names: Iterable[str]) -> Scales | None:
        """The scales that have most of some names of dimensions or appraisals; None where none has any."""
        if isinstance(self.published, Scales):
            return self.published
        found = [scales for name in names if (scales := scales_with(name, self.type))]
        return max(found, key=lambda scales: len({*names} & {*scales.names}), default=None)


class Vocabularies:
    """The vocabularies of one document by the URI of their set."""

    def __init__(self, grammar: Grammar, report: Report) -> None:
        self._grammar, self._report = grammar, report
        self._known = {
            f"{base}{name}": Declared(vocabulary.type, dict.fromkeys(vocabulary.names), vocabulary)
            for name, vocabulary in published().items()
            for base in _PUBLISHED
        }
        self._others: set[tuple[str, str]] = set()

    def declare(self, element: Element) -> None:
        """Take in a ``<vocabulary>``; what it lacks is told."""
        tell = self._report.tell
        items = [child for child in self._grammar.children(element, "vocabulary") if child.name == "item"]
        name = self._grammar.identity(element, "vocabulary")
        if name is None:
            tell(element.line, "vocabulary.id", "an id that begins with a letter", "none")
        kind = element.attributes.get("type", "").strip()
        if kind not in TYPES:
            got = shortened(kind) if kind else "nothing"
            tell(element.line, "vocabulary.type", f"one of {', '.join(TYPES)}", got, self._report.near(kind, TYPES))
        if not items:
            tell(element.line, "vocabulary", "at least one <item>", "none")
        names: dict[str, None] = {}
        for item in items:
            self._grammar.children(item, "vocabulary.item")
            word = item.attributes.get("name", "").strip()
            if not is_word(word):
                tell(item.line, "vocabulary.item.name", "a word", shortened(word) if word else "nothing")
            elif word in names:
                tell(item.line, "vocabulary.item.name", "each name once", f"{shortened(word)} again")
            names[word] = None
        self._known.setdefault(f"#{name}", Declared(kind, names))

    def check_sets(self, element: Element, where: str) -> None:
        """Tell the sets that an element names and that are none, or of another kind."""
        for kind, attribute in SETS.items():
            uri = self._grammar.address(element, attribute, where)
            if uri is None:
                continue
            known = self._known.get(uri)
            if known is not None and known.type != kind:
                got = f"{shortened(uri)}, one of type {known.type or 'nothing'}"
                self._report.tell(element.line, f"{where}.{attribute}", f"a vocabulary of type {kind}", got)
            elif known is None and uri.startswith((*_PUBLISHED, "#")):
                names = [other for other, known in self._known.items() if known.type == kind]
                expected = f"one of the vocabularies of the document and the W3C, {', '.join(published_of(kind))}"
                hint = self._report.near(uri, names) if len(uri) > 1 else ""
                self._report.tell(element.line, f"{where}.{attribute}", expected, shortened(uri), hint)
            elif known is None and (kind, uri) not in self._others:
                self._others.add((kind, uri))
                expected = "a vocabulary of the W3C or of the document"
                hint = "it is not read; names that the W3C's vocabularies have, too, are taken to mean the same"
                self._report.note(element.line, f"{where}.{attribute}", expected, shortened(uri), hint)

    def of(self, kind: str, uri: str) -> Declared | None:
        """The vocabulary of a kind of descriptor; None where :meth:`check_sets` has told that there is none."""
        known = self._known.get(uri.strip())
        if known is not None:
            return known if known.type == kind else None
        return None if uri.strip().startswith((*_PUBLISHED, "#")) else Declared(kind, None)


def published_of(kind: str) -> list[str]:
    """The names of the published vocabularies of a type."""
    return [name for name, vocabulary in published().items() if vocabulary.type == kind]
