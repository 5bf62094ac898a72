"""What EmotionML allows: its elements, their attributes, and what those may hold.

Source: Emotion Markup Language 1.0, W3C Recommendation 22 May 2014, its schema, and the assertions of its
implementation report, by whose numbers the tests are sorted.
"""

from __future__ import annotations

import re

from agentface.emotion.vocabularies import TYPES, is_word
from agentface.io.markup import Element
from agentface.io.report import Report

NAMESPACE = "http://www.w3.org/2009/10/emotionml"
SETS = {kind: f"{kind}-set" for kind in TYPES}
"""The attribute that names the vocabulary of each kind of descriptor."""
LONGEST_MS = 10**15
"""Whole numbers that are larger, which are allowed, are read as this one."""

_DESCRIPTOR = ("name", "value", "confidence")
_ATTRIBUTES = {
    "emotionml": ("version", *SETS.values()),
    "emotion": (
        *("version", "id", "expressed-through", *SETS.values()),
        *("start", "end", "duration", "offset-to-start", "time-ref-uri", "time-ref-anchor-point"),
    ),
    **dict.fromkeys(TYPES, _DESCRIPTOR),
    "intensity": ("value", "confidence"),
    "trace": ("freq", "samples"),
    "reference": ("uri", "role", "media-type"),
    "vocabulary": ("type", "id"),
    "item": ("name",),
    "info": ("id",),
}
_CHILDREN: dict[str, tuple[str, ...]] = {
    "emotionml": ("emotion", "vocabulary", "info"),
    "emotion": (*TYPES, "intensity", "reference", "info"),
    **dict.fromkeys(TYPES, ("trace",)),
    "intensity": ("trace",),
    "trace": (),
    "reference": (),
    "vocabulary": ("item", "info"),
    "item": ("info",),
}
_ROLES = ("expressedBy", "experiencedBy", "triggeredBy", "targetedAt")
_ID = re.compile(r"[^\W\d][\w.-]*")
_URI = re.compile(r"(?:[A-Za-z][A-Za-z0-9+.-]*:|[^:/?#]*(?=[/?#]|$))[^#]*(?:#[^#]*)?")
_MIME = re.compile(r"[\w!#$&^.+-]+/[\w!#$&^.+-]+(?:\s*;\s*[\w!#$&^.+-]+=(?:[\w!#$&^.+/-]+|\"[^\"]*\"))*", re.ASCII)
_WHOLE = re.compile(r"[-+]?\d+", re.ASCII)


class Grammar:
    """Checks the elements of one document, and tells what is not allowed."""

    def __init__(self, report: Report) -> None:
        self._report = report
        self._ids: set[str] = set()

    def children(self, element: Element, where: str) -> list[Element]:
        """The children that may be there, without ``<info>``; others, and attributes that may not be, are told."""
        self._attributes(element, where)
        allowed = _CHILDREN[element.name]
        known: list[Element] = []
        infos = 0
        for child in element.children:
            if child.namespace != NAMESPACE or child.name not in allowed:
                place = "" if child.namespace == NAMESPACE else f" of {child.namespace or 'no namespace'}"
                hint = self._report.near(child.name, allowed)
                self._report.tell(child.line, where, "no such element", f"<{child.name[:60]}>{place}", hint)
            elif child.name == "info":
                infos += 1
                if infos > 1:
                    self._report.tell(child.line, where, "one <info>", "a second one")
                self._info(child, f"{where}.info")
            else:
                known.append(child)
        return known

    def version(self, element: Element, where: str) -> None:
        """Tell a version that is not 1.0; ``<emotionml>`` must have one."""
        version = element.attributes.get("version", "nothing" if element.name == "emotionml" else "1.0")
        if version.strip() != "1.0":
            self._report.tell(element.line, f"{where}.version", "1.0", version[:60])

    def identity(self, element: Element, where: str) -> str | None:
        """The element's ``id``; one that is none, or another element's, is told."""
        if "id" not in element.attributes:
            return None
        name = element.attributes["id"].strip()
        if not is_id(name):
            got = shortened(name) if name else "nothing"
            self._report.tell(element.line, f"{where}.id", "an id that begins with a letter", got)
        elif name in self._ids:
            self._report.tell(element.line, f"{where}.id", "an id of its own", f"{shortened(name)} again")
        self._ids.add(name)
        return name

    def address(self, element: Element, attribute: str, where: str) -> str | None:
        """The URI that an attribute holds; None where it is not there; one that is none is told."""
        text = element.attributes.get(attribute)
        if text is not None and not _URI.fullmatch(text.strip()):
            self._report.tell(element.line, f"{where}.{attribute}", "a URI", shortened(text))
        return None if text is None else text.strip()

    def words(self, element: Element, attribute: str, where: str) -> None:
        """Tell an attribute that is there and holds no words."""
        text = element.attributes.get(attribute)
        if text is not None and not (text.split() and all(is_word(word) for word in text.split())):
            self._report.tell(element.line, f"{where}.{attribute}", "words, with blanks between them", shortened(text))

    def whole(self, element: Element, attribute: str, where: str, *, signed: bool = False) -> int | None:
        """The whole number of milliseconds that an attribute holds; None where it is not there, or told."""
        text = element.attributes.get(attribute)
        if text is None:
            return None
        if _WHOLE.fullmatch(text.strip()):
            digits = text.strip().lstrip("+-").lstrip("0") or "0"
            number = int(digits) if len(digits) <= len(str(LONGEST_MS)) else LONGEST_MS
            number = min(number, LONGEST_MS) * (-1 if text.strip().startswith("-") else 1)
            if signed or number >= 0:
                return number
        expected = "a whole number of milliseconds" + ("" if signed else ", zero or more")
        self._report.tell(element.line, f"{where}.{attribute}", expected, shortened(text))
        return None

    def reference(self, element: Element, where: str) -> None:
        """Tell what a ``<reference>`` lacks."""
        self.children(element, where)
        if self.address(element, "uri", where) is None:
            self._report.tell(element.line, f"{where}.uri", "what it refers to", "nothing")
        role = element.attributes.get("role", _ROLES[0]).strip()
        if role not in _ROLES:
            self._report.tell(element.line, f"{where}.role", f"one of {', '.join(_ROLES)}", shortened(role))
        kind = element.attributes.get("media-type")
        if kind is not None and not _MIME.fullmatch(kind.strip()):
            self._report.tell(element.line, f"{where}.media-type", "a MIME type, like video/mp4", shortened(kind))

    def _attributes(self, element: Element, where: str) -> None:
        known = _ATTRIBUTES[element.name]
        for name in element.attributes:
            if name not in known:
                self._report.tell(
                    element.line, where, "no such attribute", shortened(name), self._report.near(name, known)
                )

    def _info(self, element: Element, where: str) -> None:
        self._attributes(element, where)
        self.identity(element, where)
        inside = list(element.children)
        while inside:
            child = inside.pop()
            if child.namespace == NAMESPACE:
                self._report.tell(child.line, where, "elements of other namespaces", f"<{child.name}>")
            inside += child.children


def is_id(text: str) -> bool:
    """Whether it may identify an element: it begins with a letter or an underscore, and has no colon."""
    return _ID.fullmatch(text) is not None


def shortened(text: str) -> str:
    """A text between quotes, as messages show it."""
    return repr(text if len(text) <= 60 else text[:57] + "...")
