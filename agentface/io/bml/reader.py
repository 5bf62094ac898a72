"""BML documents as blocks.

Source: Behavior Markup Language 1.0, core specification and core extensions (SAIBA, 2011). What they forbid is told
with its line; what is not a face's is left out and noted.
"""

from __future__ import annotations

import re
from codecs import BOM_UTF8, BOM_UTF16_BE, BOM_UTF16_LE
from dataclasses import replace
from pathlib import Path

from agentface.bml.block import COMPOSITIONS, ENDS, STARTS, Behavior, Block, Meeting, Precedence, SyncPoint, SyncTime
from agentface.bml.order import check_order
from agentface.bml.table import bml_table
from agentface.bml.timetable import schedule
from agentface.errors import DataError, Fault
from agentface.io.bml.attributes import LONGEST_S, Attributes, anchors_meant
from agentface.io.bml.behaviors import NAMESPACE, SPACES, BehaviorReader
from agentface.io.markup import Element, read_xml
from agentface.io.report import Report

LARGEST_FILE = 256 * 1024
MOST_BEHAVIORS = 100
MOST_CONSTRAINTS = 300
_BOTH = (STARTS, ENDS)
_ROOT = re.compile(rb"(?>(?>\s+|<\?.*?\?>|<!--.*?-->)*)<(?:[\w.-]+:)?bml[\s>/]", re.DOTALL)


def is_bml(begin: bytes) -> bool:
    """Whether a document that begins so has the root of BML."""
    begin = begin[:65536]
    if begin.startswith((BOM_UTF16_LE, BOM_UTF16_BE)):
        begin = begin.decode("utf-16", "ignore").encode("utf-8", "ignore")
    return _ROOT.match(begin.removeprefix(BOM_UTF8)) is not None


def read_bml(data: bytes | str, where: Path | str = "block.bml") -> Block:
    """The block of a document; ``where`` is what messages call it.

    Raises DataError with every fault: XML that is not well-formed or has a document type, what BML does not allow,
    sync points that nobody has or that wait for themselves, more than ``LARGEST_FILE`` bytes, ``MOST_BEHAVIORS``
    behaviors or ``MOST_CONSTRAINTS`` constraints. What a face does not show is in the block's ``notes``, and a fault
    where it is ``<required>``.
    """
    report = Report(Path(where))
    data = data.encode("utf-8", "replace") if isinstance(data, str) else data
    if len(data) > LARGEST_FILE:
        report.tell(None, "", f"at most {LARGEST_FILE} bytes", "more")
        report.check()
    return _BlockReader(report).read(read_xml(data, report.path, texts=("text",)))


def load_bml(path: str | Path) -> Block:
    """The block of the document at ``path``; raises DataError as :func:`read_bml` does."""
    path = Path(path)
    try:
        with path.open("rb") as file:
            data = file.read(LARGEST_FILE + 1)
    except OSError as error:
        raise DataError([Fault(path, None, "", "a readable file", error.strerror or type(error).__name__)]) from error
    return read_bml(data, path)


class _BlockReader:
    """Reads one document."""

    def __init__(self, report: Report) -> None:
        self._report = report
        self._behaviors: list[Behavior] = []
        self._elements: dict[str, Attributes] = {}
        self._orders: list[Precedence] = []
        self._meetings: list[Meeting] = []
        self._constraints: list[Element] = []
        self._reader = BehaviorReader(bml_table(), report)
        self._block = ""

    def read(self, root: Element) -> Block:
        """The block; raises DataError with every fault of it."""
        if root.namespace not in SPACES or root.name != "bml":
            got = f"<{root.name[:60]}> of {root.namespace[:60] or 'no namespace'}"
            self._report.tell(root.line, "", f"<bml> of the namespace {NAMESPACE}", got)
            self._report.check()
        attributes = Attributes(root, "bml", self._report)
        self._block = attributes.identity()
        composition = attributes.one_of("composition", COMPOSITIONS[0], COMPOSITIONS)
        character = attributes.text("characterId") or ""
        attributes.rest()
        self._take(root)
        behaviors = tuple(self._anchored(behavior) for behavior in self._behaviors)
        for constraint in self._constraints:
            self._constraint(constraint)
        self._report.check()
        block = Block(
            self._block,
            behaviors,
            next(known for known in COMPOSITIONS if known == composition),
            character[:200],
            tuple(self._orders),
            tuple(self._meetings),
            self._report.path,
            tuple(sorted(self._report.notes, key=lambda note: note.line or 0)),
        )
        _check_times(block)
        return block

    def _take(self, parent: Element, *, required: bool = False) -> None:
        for child in parent.children:
            ours = child.namespace in SPACES
            if ours and child.name == "constraint":
                self._constraints.append(child)
            elif ours and child.name == "required" and not required:
                with self._report.demanding():
                    self._take(child, required=True)
            else:
                self._behavior(child)

    def _behavior(self, element: Element) -> None:
        if len(self._behaviors) >= MOST_BEHAVIORS:
            self._report.tell(element.line, "", f"at most {MOST_BEHAVIORS} behaviors", "more")
            self._report.check()
        behavior = self._reader.read(element)
        if behavior is None or not behavior.id:
            return
        if behavior.id in self._elements or behavior.id == "bml":
            self._report.tell(element.line, behavior.id, "each id once", repr(behavior.id))
            return
        self._elements[behavior.id] = Attributes(element, behavior.id, self._report)
        self._behaviors.append(behavior)

    def _anchored(self, behavior: Behavior) -> Behavior:
        attributes, anchors = self._elements[behavior.id], []
        for name in behavior.points:
            text = attributes.text(name)
            anchor = None if text is None else self._anchor(text, attributes.element, f"{behavior.id}.{name}")
            if anchor is not None:
                anchors.append((name, anchor))
        return replace(behavior, anchors=tuple(anchors))

    def _anchor(self, text: str, element: Element, where: str) -> SyncTime | None:
        """The time that a text means; None where that has to be told."""
        meant = anchors_meant(text, self._block)
        if not meant:
            form = "seconds, or a sync point such as nod1:stroke + 0.5"
            self._report.tell(element.line, where, form, repr(text[:60]))
            return None
        for anchor in meant:
            known = self._known(anchor)
            if known is not None:
                if not known.point.behavior and not known.point.block and not 0.0 <= known.offset_s <= LONGEST_S:
                    self._report.tell(element.line, where, f"0..{LONGEST_S:g} s", text[:60])
                    return None
                return known
        self._unknown(meant[-1].point, element, where)
        return None

    def _known(self, anchor: SyncTime) -> SyncTime | None:
        """An anchor with its point as blocks have it; None where no behavior has that."""
        point = anchor.point
        if point.block and point.behavior == "bml":
            return SyncTime(SyncPoint("", point.name, point.block), anchor.offset_s) if point.name in _BOTH else None
        if point.block or not point.behavior:
            return anchor
        behavior = next((each for each in self._behaviors if each.id == point.behavior), None)
        if behavior is not None:
            return anchor if point.name in behavior.points else None
        if point.behavior in ("bml", self._block):
            return SyncTime(SyncPoint(), anchor.offset_s) if point.name == STARTS else None
        return None

    def _unknown(self, point: SyncPoint, element: Element, where: str) -> None:
        behavior = next((each for each in self._behaviors if each.id == point.behavior), None)
        if behavior is None:
            hint = self._report.near(point.behavior, self._elements)
            self._report.tell(element.line, where, "the id of a behavior", repr(point.behavior[:60]), hint)
            return
        hint = self._report.near(point.name, behavior.points)
        self._report.tell(element.line, where, f"a sync point of {behavior.id}", repr(point.name[:60]), hint)

    def _constraint(self, element: Element) -> None:
        for child in element.children:
            if child.namespace not in SPACES or child.name not in ("synchronize", "before", "after"):
                self._report.tell(child.line, "constraint", "synchronize, before or after", f"<{child.name[:60]}>")
                continue
            of = [self._reference(child)] if child.name != "synchronize" or "ref" in child.attributes else []
            found = [self._reference(sync) for sync in child.children if self._is_sync(sync)]
            points = [point for point in (*of, *found) if point is not None]
            if len(of) + len(found) < 2:
                self._report.tell(child.line, "constraint", "two sync points or more", f"{len(of) + len(found)}")
            elif child.name == "synchronize":
                self._meetings.append(Meeting(tuple(points), child.line))
            elif of[0] is not None:
                before = child.name == "before"
                pairs = [(point, of[0]) if before else (of[0], point) for point in points[1:]]
                self._orders += [Precedence(earlier, later, child.line, before) for earlier, later in pairs]
            if len(self._orders) + sum(len(meeting.points) for meeting in self._meetings) > MOST_CONSTRAINTS:
                self._report.tell(child.line, "constraint", f"at most {MOST_CONSTRAINTS} of them", "more")
                self._report.check()

    def _is_sync(self, element: Element) -> bool:
        if element.namespace in SPACES and element.name == "sync":
            return True
        self._report.tell(element.line, "constraint", "<sync>", f"<{element.name[:60]}>")
        return False

    def _reference(self, element: Element) -> SyncTime | None:
        text = element.attributes.get("ref")
        if text is None:
            self._report.tell(element.line, "constraint.ref", "this attribute", "nothing")
            return None
        return self._anchor(text, element, "constraint.ref")


def _check_times(block: Block) -> None:
    """Raise DataError for times that cannot be, as far as that is known without voices and other blocks."""
    anchors = [anchor for behavior in block.behaviors for _, anchor in behavior.anchors]
    anchors += [anchor for order in block.orders for anchor in (order.earlier, order.later)]
    anchors += [anchor for meeting in block.meetings for anchor in meeting.points]
    if block.speeches or any(anchor.point.block for anchor in anchors):
        check_order(block)
    else:
        schedule(block)
