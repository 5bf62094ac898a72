"""What datagrams do to a face: decode, check, keep the newest, answer. No sockets here."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable
from typing import Any, TypeAlias

from agentface.clock import Clock
from agentface.errors import AgentFaceError, InvalidValueError
from agentface.face import Face
from agentface.io.osc.codec import MalformedError, Message, address_of, decode, encode
from agentface.io.osc.commands import (
    PREFIX,
    STATUS,
    Command,
    UnknownAddressError,
    name_of,
    read_command,
    reason_and_hint,
)
from agentface.io.osc.rate_limit import Allowance
from agentface.io.osc.schedule import FURTHEST_S, MOST, Agenda

Sender: TypeAlias = tuple[Any, ...]
"""The address of a socket."""
ANSWERS_AT_ONCE, ANSWERS_A_SECOND = 200.0, 100.0


class Receiver:
    """Applies datagrams to a face, a whole frame's worth at a time.

    Of commands of the same kind (the same address and name) only the newest is applied: a flood costs decoding,
    never a queue. Answers go through ``reply``. Over all senders, at most 200 errors at once and then 100 a second
    are answered, and as many requests for the status, of each sender one a frame: forged senders cannot turn the
    server into a flood of its own, and errors do not keep the status from those who ask for it.
    """

    def __init__(self, face: Face, reply: Callable[[bytes, Sender], None], clock: Clock) -> None:
        self._face, self._reply, self._clock = face, reply, clock
        self._agenda = Agenda()
        self._errors = Allowance(clock, ANSWERS_AT_ONCE, ANSWERS_A_SECOND)
        self._statuses = Allowance(clock, ANSWERS_AT_ONCE, ANSWERS_A_SECOND)

    def take(self, datagrams: Iterable[tuple[bytes, Sender]]) -> None:
        """Take in datagrams and what has come due; then answer those who asked for the status."""
        newest: dict[tuple[str, ...], Command] = {}
        askers: dict[Sender, None] = {}
        for command in self._agenda.due(self._clock.date()):
            _put(newest, command)
        for packet, sender in datagrams:
            try:
                messages = decode(packet)
            except MalformedError as error:
                self._refuse("malformed", sender, address_of(packet), str(error), "send OSC 1.0")
                continue
            for message in messages:
                self._take_one(message, sender, newest, askers)
        for command in newest.values():
            command.apply(self._face)
        for sender in askers:
            if self._statuses.take():
                self._reply(encode(f"{PREFIX}{STATUS}", json.dumps(self._face.status(), allow_nan=False)), sender)

    def _take_one(
        self,
        message: Message,
        sender: Sender,
        newest: dict[tuple[str, ...], Command],
        askers: dict[Sender, None],
    ) -> None:
        traffic = self._face.traffic
        try:
            name = name_of(message.address, self._face.model.name)
            if name == STATUS:
                askers[sender] = None
            else:
                self._plan(read_command(name, message), message.date, newest)
        except UnknownAddressError:
            traffic.errors["unknown"] += 1
        except AgentFaceError as error:
            self._refuse("rejected", sender, message.address, *reason_and_hint(error))
        else:
            traffic.messages += 1

    def _plan(self, command: Command, date: float | None, newest: dict[tuple[str, ...], Command]) -> None:
        now = self._clock.date()
        if date is None or date <= now:
            _put(newest, command)
            return
        if date > now + FURTHEST_S:
            raise InvalidValueError(
                "time tag", f"at most {FURTHEST_S:g} s ahead", f"{date - now:.0f} s", "check the clock"
            )
        if self._agenda.full:
            raise InvalidValueError("bundle", f"at most {MOST} messages waiting", "one more", "send it later")
        self._agenda.add(date, command)

    def _refuse(self, kind: str, sender: Sender, address: str, reason: str, hint: str) -> None:
        self._face.traffic.errors[kind] += 1
        if self._errors.take():
            self._reply(encode(f"{PREFIX}error", address[:200], reason, hint[:400]), sender)


def _put(newest: dict[tuple[str, ...], Command], command: Command) -> None:
    # Taken out first: commands are applied in the order of their newest message.
    newest.pop(command.key, None)
    newest[command.key] = command
