"""The behaviors of a BML block, each kind from its element."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

from agentface.bml.block import POINTS, Aim, Behavior, Nod, Show, Text
from agentface.bml.table import BmlTable, known_as, shows
from agentface.emotion.state import ALIASES, EMOTIONS, canonical
from agentface.errors import InvalidValueError, UnknownNameError
from agentface.facs.action_units import SIDE_NAMES, check_unit
from agentface.io.bml.attributes import LONGEST_S, Attributes
from agentface.io.markup import Element
from agentface.io.report import Report
from agentface.talk.block_speech import script_of_speech

NAMESPACE = "http://www.bml-initiative.org/bml/bml-1.0"
EXTENSIONS = "http://www.bml-initiative.org/bml/coreextensions-1.0"
SPACES = (NAMESPACE, EXTENSIONS, "")
USUAL_AMOUNT = 0.5
MOST_TIMES = 20
_DIRECTIONS = {
    "RIGHT": (-1.0, 0.0),
    "LEFT": (1.0, 0.0),
    "UP": (0.0, 1.0),
    "DOWN": (0.0, -1.0),
    "UPRIGHT": (-math.sqrt(0.5), math.sqrt(0.5)),
    "UPLEFT": (math.sqrt(0.5), math.sqrt(0.5)),
    "DOWNLEFT": (math.sqrt(0.5), -math.sqrt(0.5)),
    "DOWNRIGHT": (-math.sqrt(0.5), -math.sqrt(0.5)),
}
_FURTHEST_YAW, _FURTHEST_PITCH = 80.0, 70.0
"""Degrees; what is further aside is not in front of the eyes."""


class BehaviorReader:
    """Reads behaviors; what is wrong with them, and what of them is not shown, goes to ``report``."""

    def __init__(self, table: BmlTable, report: Report) -> None:
        self._table, self._report = table, report
        self._readers: dict[str, Callable[[Attributes], Behavior | None]] = {
            "face": lambda at: self._face(at, "face"),
            "faceLexeme": lambda at: self._face(at, "face"),
            "faceFacs": lambda at: self._face(at, "face"),
            "faceShift": lambda at: self._face(at, "face_shift"),
            "gaze": lambda at: self._gaze(at, "gaze"),
            "gazeShift": lambda at: self._gaze(at, "gaze_shift"),
            "head": self._head,
            "headDirectionShift": self._head_direction,
            "speech": self._speech,
            "wait": self._wait,
            **dict.fromkeys(("gesture", "pointing", "posture", "postureShift", "locomotion"), self._other),
        }

    @property
    def names(self) -> tuple[str, ...]:
        """The elements of the standard."""
        return tuple(self._readers)

    def read(self, element: Element) -> Behavior | None:
        """The behavior of an element; None for what has to be told, and for what takes no part at all."""
        ours = element.namespace in SPACES
        if ours and element.name not in self._readers:
            hint = self._report.near(element.name, self._readers)
            self._report.tell(element.line, "", "a behavior of BML 1.0", f"<{element.name[:60]}>", hint)
            return None
        attributes = Attributes(element, element.attributes.get("id", element.name)[:60], self._report)
        if not ours:
            return self._foreign(attributes)
        behavior = self._readers[element.name](attributes)
        if behavior is not None and behavior.kind != "other":
            for name in behavior.points:
                attributes.text(name)
            attributes.rest()
        return behavior

    def _made(self, attributes: Attributes, kind: str, does: tuple[Show, ...] | Aim | Nod | Text | None) -> Behavior:
        usual = self._table.usual_s.get(kind, (0.0,) * (len(POINTS[kind]) - 1))
        return Behavior(attributes.identity(), kind, attributes.element.line, does, usual)

    def _foreign(self, attributes: Attributes) -> Behavior | None:
        self._note_element(attributes, "a behavior of BML 1.0", f"of {attributes.element.namespace[:100]}")
        return self._made(attributes, "other", None) if "id" in attributes.element.attributes else None

    def _other(self, attributes: Attributes) -> Behavior:
        self._note_element(attributes, "what a face does", "")
        return self._made(attributes, "other", None)

    def _note_element(self, attributes: Attributes, expected: str, of: str) -> None:
        got = f"<{attributes.element.name[:60]}> {of}".strip()
        attributes.note("", expected, got, "nothing is shown; others may wait for its sync points")

    def _face(self, attributes: Attributes, kind: str) -> Behavior:
        amount = attributes.number("amount", 1.0 if attributes.element.children else USUAL_AMOUNT, 0.0, 1.0)
        if attributes.number("overshoot", 0.0, 0.0, 1.0):
            attributes.note("overshoot", "no overshoot", "some", "it is left out")
        shown = self._shown(attributes, attributes.element.name)
        parts: list[Show] = [replace(show, level=show.level * amount) for show in shown or ()]
        for child in attributes.element.children:
            if child.namespace not in SPACES or child.name not in ("lexeme", "facs", "faceLexeme", "faceFacs"):
                attributes.tell("", "<lexeme> and <facs>", f"<{child.name[:60]}>")
                continue
            inner = Attributes(child, attributes.where, self._report)
            level = amount * inner.number("amount", USUAL_AMOUNT, 0.0, 1.0)
            found = self._shown(inner, child.name)
            parts += [replace(show, level=show.level * level) for show in found or ()]
            inner.rest()
        if shown is None and not attributes.element.children:
            attributes.tell("", "a lexeme or an au", "neither")
        return self._made(attributes, kind, tuple(parts))

    def _shown(self, attributes: Attributes, name: str) -> tuple[Show, ...] | None:
        """What ``lexeme`` or ``au`` show in full; None where neither is there."""
        lexeme, unit = attributes.text("lexeme"), attributes.text("au")
        if lexeme is None and unit is None:
            if name not in ("face", "faceShift"):
                attributes.tell("lexeme" if "exeme" in name else "au", "this attribute", "nothing")
                return ()
            return None
        found: tuple[Show, ...] = ()
        if lexeme is not None:
            found += self._lexeme(attributes, lexeme)
        if unit is not None:
            found += self._unit(attributes, unit)
        return found

    def _lexeme(self, attributes: Attributes, lexeme: str) -> tuple[Show, ...]:
        known = self._table.lexemes.get(known_as(lexeme))
        if known is not None:
            return known
        try:
            return (Show(canonical(lexeme), 1.0),)
        except UnknownNameError:
            names = (*self._table.lexemes, *(name.upper() for name in (*EMOTIONS, *ALIASES)))
            hint = self._report.near(known_as(lexeme), names)
            attributes.note("lexeme", "a lexeme of bml.yaml, or an emotion", repr(lexeme[:60]), hint)
            return ()

    def _unit(self, attributes: Attributes, unit: str) -> tuple[Show, ...]:
        side = attributes.one_of("side", "BOTH", ("LEFT", "RIGHT", "BOTH"))
        digits = unit.upper().removeprefix("AU").strip()
        if not (digits.isascii() and digits.isdecimal() and len(digits) <= 3):
            attributes.tell("au", "the number of an action unit", repr(unit[:60]))
            return ()
        try:
            number = check_unit(digits)
        except UnknownNameError as error:
            attributes.note("au", "an action unit that the face has", digits, error.hint[:200])
            return ()
        return shows([(number, 1.0)], None if side == "BOTH" else SIDE_NAMES[side.lower()])

    def _aim(self, attributes: Attributes) -> Aim | None:
        target = attributes.text("target")
        if target is None:
            attributes.tell("target", "this attribute", "nothing")
            return None
        known = self._table.targets.get(known_as(target))
        if known is None:
            hint = self._report.near(known_as(target), self._table.targets)
            attributes.note("target", "a target of bml.yaml", repr(target[:60]), hint)
        return known

    def _gaze(self, attributes: Attributes, kind: str) -> Behavior:
        aim = self._aim(attributes)
        influence = attributes.one_of("influence", "EYES", tuple(self._table.influences))
        angle = attributes.number("offsetAngle", 0.0, -180.0, 180.0)
        left, up = _DIRECTIONS[attributes.one_of("offsetDirection", "RIGHT", tuple(_DIRECTIONS))]
        if aim is not None:
            aim = replace(
                aim,
                yaw_deg=min(max(aim.yaw_deg + angle * left, -_FURTHEST_YAW), _FURTHEST_YAW),
                pitch_deg=min(max(aim.pitch_deg + angle * up, -_FURTHEST_PITCH), _FURTHEST_PITCH),
                head_share=self._table.influences[influence],
            )
        return self._made(attributes, kind, aim)

    def _head(self, attributes: Attributes) -> Behavior:
        lexeme = attributes.text("lexeme")
        amount = attributes.number("amount", USUAL_AMOUNT, 0.0, 1.0)
        times = attributes.number("repetition", 1.0, 1.0, MOST_TIMES)
        if times != round(times):
            attributes.tell("repetition", "a whole number", f"{times:g}")
        if lexeme is None:
            attributes.tell("lexeme", "this attribute", "nothing")
            return self._made(attributes, "other", None)
        known = self._table.heads.get(known_as(lexeme))
        if known is None:
            hint = self._report.near(known_as(lexeme), self._table.heads)
            attributes.note("lexeme", "a head's lexeme of bml.yaml", repr(lexeme[:60]), hint)
            return self._made(attributes, "other", None)
        nod, steps = known
        made = self._made(attributes, "head", replace(nod, amount=amount * nod.amount, times=round(times)))
        return replace(made, usual_s=tuple(round(times) * step for step in steps))

    def _head_direction(self, attributes: Attributes) -> Behavior:
        return self._made(attributes, "head_direction_shift", self._aim(attributes))

    def _wait(self, attributes: Attributes) -> Behavior:
        made = self._made(attributes, "wait", None)
        return replace(made, usual_s=(attributes.number("duration", made.usual_s[0], 0.0, LONGEST_S),))

    def _speech(self, attributes: Attributes) -> Behavior | None:
        texts = [child for child in attributes.element.children if child.name == "text" and child.namespace in SPACES]
        for child in attributes.element.children:
            if child not in texts:
                self._report.note(child.line, attributes.where, "<text>", f"<{child.name[:60]}>", "it is left out")
        if len(texts) != 1:
            attributes.tell("", "one <text>", f"{len(texts) or 'none'}")
            attributes.identity()
            return None
        text = self._text(texts[0], attributes.where)
        try:
            unknown = script_of_speech(text).unknown
        except InvalidValueError as error:
            self._report.tell(texts[0].line, attributes.where, error.expected, repr(error.got)[:60], error.hint)
            attributes.identity()
            return None
        for tag in unknown:
            self._report.note(texts[0].line, attributes.where, "the name of an emotion", tag, "it is left out")
        made = self._made(attributes, "speech", text)
        return replace(made, usual_s=(0.0,) * (len(text.syncs) + 1))

    def _text(self, element: Element, where: str) -> Text:
        pieces, syncs = [""], list[str]()
        for part in element.content:
            if isinstance(part, str):
                pieces[-1] += part
            elif part.name == "sync" and part.namespace in SPACES:
                name = Attributes(part, f"{where}.sync", self._report).identity()
                if name in (*syncs, *POINTS["speech"]):
                    self._report.tell(part.line, where, "each sync point once", repr(name))
                elif name:
                    syncs.append(name)
                    pieces.append("")
            else:
                self._report.note(part.line, where, "text and <sync>", f"<{part.name[:60]}>", "it is left out")
        return Text(tuple(pieces), tuple(syncs))
