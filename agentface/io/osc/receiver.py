"""What datagrams do to a face: decode, check, keep the newest, answer. No sockets here."""

from __future__ import annotations

import json
from collections.abc import Callable, Hashable, Iterable

from agentface.clock import Clock
from agentface.errors import AgentFaceError, InvalidValueError
from agentface.face import Face
from agentface.io.osc.addresses import PREFIX, STATUS, Addresses, pressed, reason_and_hint
from agentface.io.osc.codec import MalformedError, Message, address_of, decode, encode
from agentface.io.osc.rate_limit import RateLimit
from agentface.io.osc.schedule import FURTHEST_S, MOST, Schedule, Sender, Waiting

ANSWERS_AT_ONCE, ANSWERS_A_SECOND = 200.0, 100.0


class Receiver:
    """Applies datagrams to a face, a whole frame's worth at a time.

    Of requests of the same kind (the same key) only the newest is applied: a flood costs decoding,
    never a queue. Answers go through ``reply``. Over all senders, at most 200 errors at once and then 100 a second
    are answered, and as many requests for the status, of each sender one a frame: forged senders cannot turn the
    server into a flood of its own, and errors do not keep the status from those who ask for it.
    """

    def __init__(self, face: Face, reply: Callable[[bytes, Sender], None], clock: Clock) -> None:
        self.addresses = Addresses(face.model.name)
        self._face, self._reply, self._clock = face, reply, clock
        self._schedule = Schedule()
        self._errors = RateLimit(clock, ANSWERS_AT_ONCE, ANSWERS_A_SECOND)
        self._statuses = RateLimit(clock, ANSWERS_AT_ONCE, ANSWERS_A_SECOND)

    def take(self, datagrams: Iterable[tuple[bytes, Sender]]) -> None:
        """Take in datagrams and what has come due; then answer those who asked for the status."""
        newest: dict[tuple[Hashable, ...], Waiting] = {}
        askers: dict[Sender, None] = {}
        for waiting in self._schedule.due(self._clock.date()):
            _put(newest, waiting)
        for packet, sender in datagrams:
            try:
                messages = decode(packet)
            except MalformedError as error:
                self._refuse("malformed", sender, address_of(packet), str(error), "send OSC 1.0")
                continue
            for message in messages:
                self._take_one(message, sender, newest, askers)
        for waiting in newest.values():
            self._apply(waiting)
        for sender in askers:
            if self._statuses.take():
                self._reply(encode(f"{PREFIX}{STATUS}", json.dumps(self._face.status(), allow_nan=False)), sender)

    def _take_one(
        self,
        message: Message,
        sender: Sender,
        newest: dict[tuple[Hashable, ...], Waiting],
        askers: dict[Sender, None],
    ) -> None:
        counts, meant = self._face.message_counts, self.addresses.meant(message.address)
        if not meant:
            counts.errors["unknown"] += 1
        for address in meant:
            try:
                if not self.addresses.is_status(address):
                    request = self.addresses.read(address, message.arguments)
                    if request is not None:
                        self._plan(Waiting(request, sender, address), message.date, newest)
                elif pressed(message.arguments):
                    askers[sender] = None
            except AgentFaceError as error:
                self._refuse("rejected", sender, address, *reason_and_hint(error))
            else:
                counts.messages += 1

    def _plan(self, waiting: Waiting, date: float | None, newest: dict[tuple[Hashable, ...], Waiting]) -> None:
        now = self._clock.date()
        if date is None or date <= now:
            _put(newest, waiting)
            return
        if date > now + FURTHEST_S:
            raise InvalidValueError(
                "time tag", f"at most {FURTHEST_S:g} s ahead", f"{date - now:.0f} s", "check the clock"
            )
        if self._schedule.full:
            raise InvalidValueError("bundle", f"at most {MOST} messages waiting", "one more", "send it later")
        self._schedule.add(date, waiting)

    def _apply(self, waiting: Waiting) -> None:
        try:
            self._face.apply(waiting.request)
        except AgentFaceError as error:  # what only this face can tell, such as a point behind its eyes
            self._face.message_counts.messages -= 1
            self._refuse("rejected", waiting.sender, waiting.address, *reason_and_hint(error))

    def _refuse(self, kind: str, sender: Sender, address: str, reason: str, hint: str) -> None:
        self._face.message_counts.errors[kind] += 1
        if self._errors.take():
            self._reply(encode(f"{PREFIX}error", address[:200], reason, hint[:400]), sender)


def _put(newest: dict[tuple[Hashable, ...], Waiting], waiting: Waiting) -> None:
    # Taken out first: requests are applied in the order of their newest message.
    newest.pop(waiting.request.key, None)
    newest[waiting.request.key] = waiting
