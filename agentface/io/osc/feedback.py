"""What the senders of BML blocks are told of them: that they begin, how far they are, that they end."""

from __future__ import annotations

from collections import defaultdict, deque
from collections.abc import Callable
from functools import partial

from agentface.bml.block import ENDS, Block
from agentface.clock import Clock
from agentface.errors import AgentFaceError
from agentface.face import Face
from agentface.io.datagrams import Sender
from agentface.io.osc.codec import encode
from agentface.io.osc.rate_limit import RateLimit
from agentface.talk.blocks import STOPPED, Progress

AT_ONCE, A_SECOND = 2000.0, 500.0
"""So many messages go out, over all blocks and senders."""
MOST_NOTES = 10
FAILED = "failed"


class Feedback:
    """Tells senders of their blocks: the id, what has happened, and the seconds since the block began.

    What happens is ``start``, ``end``, ``stopped``, ``failed: `` and why, ``note: `` and what is not shown, or a sync
    point as ``behavior:sync``.
    """

    def __init__(self, reply: Callable[[bytes, Sender], None], clock: Clock) -> None:
        self._reply = reply
        self._limit = RateLimit(clock, AT_ONCE, A_SECOND)
        self._senders: dict[str, dict[str, deque[Sender]]] = {}

    def expect(self, face: Face, address: str, block: Block, sender: Sender) -> None:
        """Tell ``sender`` at ``address`` of a block that ``face`` has just been asked to play."""
        if address not in self._senders:
            self._senders[address] = defaultdict(deque)
            face.blocks.told.append(partial(self._progress, address))
            face.blocks.failed.append(partial(self._failed, address))
        self._senders[address][block.id].append(sender)
        for note in block.notes[:MOST_NOTES]:
            self._send(address, sender, block.id, f"note: {note}"[:300], 0.0)

    def _progress(self, address: str, progress: Progress) -> None:
        senders = self._senders[address].get(progress.block)
        if senders:
            self._send(address, senders[0], progress.block, progress.what, progress.time_s)
        if progress.what in (ENDS, STOPPED):
            self._over(address, progress.block)

    def _failed(self, address: str, block: str, error: AgentFaceError) -> None:
        senders = self._senders[address].get(block)
        if senders:
            self._send(address, senders[0], block, f"{FAILED}: {error}"[:300], 0.0)
        self._over(address, block)

    def _over(self, address: str, block: str) -> None:
        senders = self._senders[address].get(block)
        if senders:
            senders.popleft()
        if not senders:
            self._senders[address].pop(block, None)

    def _send(self, address: str, sender: Sender, block: str, what: str, time_s: float) -> None:
        if self._limit.take():
            self._reply(encode(address, block, what, time_s), sender)
