""":class:`VmcReceiver`: the source by which a tracker drives a face."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import asdict
from types import TracebackType
from typing import Any, Self

from agentface.errors import AgentFaceError
from agentface.face import Face
from agentface.io.datagrams import Listener
from agentface.io.osc.codec import MalformedError, read, split
from agentface.io.vmc.tracker import BONE, BONES, PREFIX, USED, TrackerState
from agentface.motion.performance import HOLD_S
from agentface.requests import SetTracked
from agentface.requests.tracked import tracker_channel

LARGEST_DATAGRAM = 65507
"""Bytes, all that UDP can carry: a whole body and its shapes come in one bundle."""
MOST_MESSAGES = 4096
"""So many messages are taken in a frame; a tracker that has a body and Perfect Sync sends some 120."""
_OURS = tuple(b"\0%s\0" % bone.encode() for bone in BONES)


class VmcReceiver:
    """Receives the protocol for one face from its making until ``close``; as a context manager, until the block ends.

    A source for :func:`agentface.live.loop.run`. Blend values count when ``/VMC/Ext/Blend/Apply`` comes, bones when
    they come; of several frames of the tracker that come between two of the face, the last. Time tags are not waited
    for. ``HOLD_S`` seconds after the last frame the face lets go, and the next tracker begins anew.

    Args:
        face: what is driven; its status has what came.
        host: the address to listen on.
        port: 0 for any free one.
        axes: of the bones, one of ``AXES``.

    Raises ServerError when the address of the machine cannot be had.
    """

    def __init__(self, face: Face, host: str, port: int, *, axes: str = "unity") -> None:
        self._face = face
        tracker_channel(face).warm_up(face.model)
        self._state = TrackerState(axes)
        self._frames = 0
        self._last_s: float | None = None
        self._listener = Listener(host, port, largest=LARGEST_DATAGRAM, what="VMC receiver", option="--vmc-in")
        self.host, self.port = self._listener.host, self._listener.port

    @property
    def status(self) -> dict[str, Any]:
        """Whether a tracker drives the face, what it says of itself, and the counts of what came, JSON-ready."""
        return {
            "from": f"{self.host}:{self.port}",
            "driving": self._last_s is not None,
            "loaded": self._state.loaded,
            "tracker_time_s": self._state.time_s,
            "frames": self._frames,
            **asdict(self._state.counts),
        }

    def take_in(self, time_s: float) -> None:
        """Show what came since the last call; ``time_s`` is the loop's time."""
        self.take((packet for packet, _ in self._listener.take()), time_s)

    def take(self, packets: Iterable[bytes], time_s: float) -> None:
        """Show what these datagrams say."""
        left, new = MOST_MESSAGES, False
        for packet in packets:
            try:
                elements = split(packet, LARGEST_DATAGRAM)
            except MalformedError:
                self._refuse("malformed")
                continue
            taken = elements[:left]
            left -= len(taken)
            self._state.counts.dropped += len(elements) - len(taken)
            for element, _ in taken:
                new |= self._take_one(element)
        if new:
            self._face.apply(SetTracked(self._state.frame()))
            self._frames += 1
            self._last_s = time_s
        elif self._last_s is not None and time_s - self._last_s > HOLD_S:
            self._last_s = None
            self._state.forget()

    def close(self) -> None:
        """Stop listening; may be called twice."""
        self._listener.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def _take_one(self, element: bytes) -> bool:
        """Take in one message; whether the face has to show something new."""
        counts, address = self._state.counts, element.partition(b"\0")[0]
        if not element.startswith(b"/"):
            self._refuse("malformed")
            return False
        if address not in _USED or (address == _BONE and not any(bone in element for bone in _OURS)):
            if address.startswith(_PREFIX):  # most of what comes: not worth reading
                counts.unused += 1
            else:
                self._refuse("unknown")
            return False
        try:
            message = read(element)
            used = counts.used
            new = self._state.take(message.address, message.arguments)
        except MalformedError:
            self._refuse("malformed")
            return False
        except AgentFaceError:
            self._refuse("rejected")
            return False
        self._face.message_counts.messages += counts.used - used
        return new

    def _refuse(self, kind: str) -> None:
        counts = self._state.counts
        setattr(counts, kind, getattr(counts, kind) + 1)
        self._face.message_counts.errors[kind] += 1


_BONE, _PREFIX, _USED = BONE.encode(), PREFIX.encode(), frozenset(address.encode() for address in USED)
