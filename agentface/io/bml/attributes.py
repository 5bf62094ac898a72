"""The attributes of one BML element, read one by one; what is wrong with them is told."""

from __future__ import annotations

import math
import re

from agentface.bml.block import SyncPoint, SyncTime
from agentface.io.markup import Element
from agentface.io.report import Report

_ID = re.compile(r"[^\W\d][\w.-]*")
_NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?", re.ASCII)
_OFFSET = re.compile(r"(.*?)\s*([-+])\s*((?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*", re.ASCII)
_LONGEST = 200
LONGEST_S = 3600.0


class Attributes:
    """The attributes of ``element``, which messages call ``where``; :meth:`rest` notes those nobody asked for."""

    def __init__(self, element: Element, where: str, report: Report) -> None:
        self.element, self.where, self._report = element, where, report
        self._asked = {"id"}

    def tell(self, name: str, expected: str, got: str, hint: str = "") -> None:
        """Tell what is wrong with one of them."""
        where = f"{self.where}.{name}" if name else self.where
        self._report.tell(self.element.line, where, expected, got, hint)

    def note(self, name: str, expected: str, got: str, hint: str = "") -> None:
        """Note what of them is not shown."""
        self._report.note(self.element.line, f"{self.where}.{name}" if name else self.where, expected, got, hint)

    def identity(self) -> str:
        """The id; empty where it is missing or none."""
        found = self.text("id")
        if found is None:
            self.tell("id", "an id", "none")
            return ""
        if len(found) > _LONGEST or not _ID.fullmatch(found):
            self.tell("id", "a letter, then letters, digits, . - and _", repr(found[:60]))
            return ""
        return found

    def text(self, name: str) -> str | None:
        """What it says; None where it is not there."""
        self._asked.add(name)
        value = self.element.attributes.get(name)
        return None if value is None else value.strip()

    def number(self, name: str, usual: float, low: float, high: float) -> float:
        """A number in ``low..high``; ``usual`` where it is not there, or wrong."""
        text = self.text(name)
        if text is None:
            return usual
        value = float(text) if _NUMBER.fullmatch(text) else math.nan
        if not low <= value <= high:
            self.tell(name, f"a number in {low:g}..{high:g}", repr(text[:60]))
            return usual
        return value

    def one_of(self, name: str, usual: str, known: tuple[str, ...]) -> str:
        """One of these words, in any case."""
        text = self.text(name)
        if text is None:
            return usual
        if text.upper() not in known:
            self.tell(name, f"one of {', '.join(known)}", repr(text[:60]), self._report.near(text, known))
            return usual
        return text.upper()

    def rest(self) -> None:
        """Note what is there beside what was asked for."""
        for name in self.element.attributes.keys() - self._asked:
            self.note(name[:60], "an attribute that the face knows", "another one", "it is left out")


def anchors_meant(text: str, block: str) -> list[SyncTime]:
    """What a time may mean, the likeliest first; nothing where it is no time.

    Seconds, or ``behavior:sync`` or ``block:behavior:sync`` with an offset such as ``+ 0.5``; ``bml`` is this block.
    A name may have a hyphen and a digit in it, so that what looks like an offset may be its end.
    """
    text = text.strip()
    if _NUMBER.fullmatch(text):
        seconds = float(text)
        return [SyncTime(SyncPoint(), seconds)] if math.isfinite(seconds) else []
    found = []
    point = _point(text, block)
    if point is not None:
        found.append(SyncTime(point))
    split = _OFFSET.fullmatch(text) if len(text) <= 4 * _LONGEST else None
    if split is not None:
        point, offset = _point(split[1], block), float(split[2] + split[3])
        if point is not None and abs(offset) <= LONGEST_S:
            found.append(SyncTime(point, offset))
    return found


def _point(text: str, block: str) -> SyncPoint | None:
    parts = text.strip().split(":")
    if not 2 <= len(parts) <= 3 or any(len(part) > _LONGEST or not _ID.fullmatch(part) for part in parts):
        return None
    name = parts[-1]
    if len(parts) == 3:
        return SyncPoint(parts[1], name) if parts[0] in ("bml", block) else SyncPoint(parts[1], name, parts[0])
    return SyncPoint(parts[0], name)
