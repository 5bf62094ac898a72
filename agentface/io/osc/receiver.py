"""What datagrams do to faces: decode, check, keep the newest, answer. No sockets here."""

from __future__ import annotations

import json
from collections import deque
from collections.abc import Callable, Hashable, Iterable, Mapping
from typing import Any, TypeAlias

from agentface.clock import Clock
from agentface.errors import AgentFaceError, InvalidValueError
from agentface.face import Face
from agentface.io.datagrams import Sender
from agentface.io.osc.addresses import ERROR, FEEDBACK, PREFIX, STATUS, Addresses, check_id, pressed, reason_and_hint
from agentface.io.osc.codec import MalformedError, Message, address_of, decode, encode
from agentface.io.osc.feedback import Feedback
from agentface.io.osc.rate_limit import RateLimit
from agentface.io.osc.schedule import FURTHEST_S, MOST, Schedule, Waiting
from agentface.motion.doing import Doing
from agentface.requests import PlayBlock

ANSWERS_AT_ONCE, ANSWERS_A_SECOND = 200.0, 100.0
MOST_FACES = 8
"""So many faces share a server; their status together fits into one datagram."""
_Newest: TypeAlias = dict[tuple[Hashable, ...], tuple[str, list[Waiting]]]
"""By face and key, the face's id and what is asked of it, the newest last."""


class Receiver:
    """Applies datagrams to faces, a whole frame's worth at a time.

    Of requests of the same kind (the same key) to the same face only the newest is applied: a flood costs decoding,
    never a queue. Answers go through ``reply``. Over all senders, at most 200 errors at once and then 100 a second
    are answered, and as many requests for the status, of each sender and address one a frame: forged senders cannot
    turn the server into a flood of its own, and errors do not keep the status from those who ask for it.

    Args:
        faces: one face, or several by their ids; raises InvalidValueError for an id that cannot be one.
        reply: sends bytes to a sender.
        clock: dates bundles and limits the rate of answers.
    """

    def __init__(self, faces: Face | Mapping[str, Face], reply: Callable[[bytes, Sender], None], clock: Clock) -> None:
        self._faces = _by_id(faces)
        self.addresses = Addresses(*self._faces)
        self._reply, self._clock = reply, clock
        self._schedule = Schedule()
        self._begun: deque[tuple[str, Waiting, Doing]] = deque(maxlen=MOST)
        self._errors = RateLimit(clock, ANSWERS_AT_ONCE, ANSWERS_A_SECOND)
        self._statuses = RateLimit(clock, ANSWERS_AT_ONCE, ANSWERS_A_SECOND)
        self._feedback = Feedback(reply, clock)

    def take(self, datagrams: Iterable[tuple[bytes, Sender]]) -> None:
        """Take in datagrams and what has come due; then answer those who asked for the status."""
        if self._begun:
            self._follow()
        newest: _Newest = {}
        askers: dict[tuple[Sender, str], None] = {}
        for waiting in self._schedule.due(self._clock.date()):
            self._put(newest, waiting)
        for packet, sender in datagrams:
            try:
                messages = decode(packet)
            except MalformedError as error:
                self._refuse("malformed", self._faces, sender, address_of(packet), str(error), "send OSC 1.0")
                continue
            for message in messages:
                self._take_one(message, sender, newest, askers)
        for face, asked in newest.values():
            while asked and not self._apply(face, asked.pop()):
                pass  # what a face refuses takes the place of nothing
        for sender, address in askers:
            if self._statuses.take():
                self._reply(encode(address, json.dumps(self._status(address), allow_nan=False)), sender)

    def _take_one(
        self, message: Message, sender: Sender, newest: _Newest, askers: dict[tuple[Sender, str], None]
    ) -> None:
        meant = self.addresses.meant(message.address)
        if not meant:
            self._count("unknown", self._faces)
        for address in meant:
            faces = self.addresses.ids(address)
            try:
                if not self.addresses.is_status(address):
                    request = self.addresses.read(address, message.arguments)
                    if request is not None:
                        self._plan(Waiting(request, sender, address), message.date, newest)
                elif pressed(message.arguments):
                    askers[sender, address if self._several else f"{PREFIX}{STATUS}"] = None
            except AgentFaceError as error:
                self._refuse("rejected", faces, sender, address, *reason_and_hint(error))
            else:
                for face in faces:
                    self._faces[face].message_counts.messages += 1

    def _plan(self, waiting: Waiting, date: float | None, newest: _Newest) -> None:
        self._performers(waiting)
        now = self._clock.date()
        if date is None or date <= now:
            self._put(newest, waiting)
            return
        if date > now + FURTHEST_S:
            raise InvalidValueError(
                "time tag", f"at most {FURTHEST_S:g} s ahead", f"{date - now:.0f} s", "check the clock"
            )
        if self._schedule.full:
            raise InvalidValueError("bundle", f"at most {MOST} messages waiting", "one more", "send it later")
        self._schedule.add(date, waiting)

    def _put(self, newest: _Newest, waiting: Waiting) -> None:
        # Taken out first: requests are applied in the order of their newest message.
        for face in self._performers(waiting):
            key = face, *waiting.request.key
            asked = newest.pop(key, (face, []))[1]
            asked.append(waiting)
            newest[key] = face, asked

    def _performers(self, waiting: Waiting) -> Iterable[str]:
        """The faces that a message is for: of a BML block, that whose id is its character, where one has it.

        Raises InvalidValueError where the address means others.
        """
        faces = self.addresses.ids(waiting.address)
        character = waiting.request.block.character if isinstance(waiting.request, PlayBlock) else ""
        if not self._several or character not in self._faces:
            return faces
        if character not in faces:
            raise InvalidValueError("characterId", f"a face that the address means: {', '.join(faces)}", character)
        return (character,)

    def _apply(self, face: str, waiting: Waiting) -> bool:
        try:
            doing = self._faces[face].apply(waiting.request)
            if isinstance(waiting.request, PlayBlock):
                address = f"{PREFIX}{face}/{FEEDBACK}" if self._several else f"{PREFIX}{FEEDBACK}"
                self._feedback.expect(self._faces[face], address, waiting.request.block, waiting.sender)
        except AgentFaceError as error:  # what only this face can tell, such as a point behind its eyes
            self._refuse_one(face, waiting, error)
            return False
        if isinstance(doing, Doing):
            self._begun.append((face, waiting, doing))
        return True

    def _follow(self) -> None:
        """Tell the senders of what takes its time what went wrong with it meanwhile, such as a missing voice."""
        begun, self._begun = self._begun, deque(maxlen=MOST)
        for face, waiting, doing in begun:
            if doing.error is not None:
                self._refuse_one(face, waiting, doing.error)
            elif doing.outcome is None:
                self._begun.append((face, waiting, doing))

    def _refuse_one(self, face: str, waiting: Waiting, error: AgentFaceError) -> None:
        self._faces[face].message_counts.messages -= 1
        address = self.addresses.for_one(waiting.address, face) if self._several else waiting.address
        self._refuse("rejected", (face,), waiting.sender, address, *reason_and_hint(error))

    def _refuse(self, kind: str, faces: Iterable[str], sender: Sender, address: str, reason: str, hint: str) -> None:
        self._count(kind, faces)
        if self._errors.take():
            self._reply(encode(f"{PREFIX}{ERROR}", address[:200], reason, hint[:400]), sender)

    def _count(self, kind: str, faces: Iterable[str]) -> None:
        for face in faces:
            self._faces[face].message_counts.errors[kind] += 1

    def _status(self, address: str) -> dict[str, Any]:
        faces = {name: self._faces[name].status() for name in self.addresses.ids(address)}
        return next(iter(faces.values())) if len(faces) == 1 else {"faces": faces}

    @property
    def _several(self) -> bool:
        return len(self._faces) > 1


def _by_id(faces: Face | Mapping[str, Face]) -> dict[str, Face]:
    if not isinstance(faces, Mapping):
        return {faces.model.name: faces}
    if not 1 <= len(faces) <= MOST_FACES:
        raise InvalidValueError("faces", f"1 to {MOST_FACES}", len(faces))
    return {check_id(name): face for name, face in faces.items()}
