"""Clients: the newest frame wins, words keep their order, and nobody waits for another."""

from __future__ import annotations

import asyncio
import contextlib

from agentface.io.web.hub import _AHEAD, _MOST_BYTES, Client, Hub
from tests.clocks import ManualClock


class Line:
    """A way to a client that is open, or blocked."""

    def __init__(self):
        self.came, self.open = [], asyncio.Event()
        self.open.set()

    async def send(self, message):
        await self.open.wait()
        self.came.append(message)


async def settle():
    for _ in range(20):
        await asyncio.sleep(0)


def meet(play, mode="basis"):
    """Let ``play`` have a client that is being served."""

    async def main():
        line, clock = Line(), ManualClock()
        client = Client(line.send, "amber", mode, clock)
        work = asyncio.ensure_future(client.run())
        await play(client, line, clock)
        work.cancel()
        with contextlib.suppress(asyncio.CancelledError):
            await work

    asyncio.run(main())


def test_the_newest_frame_wins():
    async def play(client, line, _):
        line.open.clear()
        client.show(1, b"1")
        await settle()
        for number in range(2, 50):
            client.show(number, str(number).encode())
            await settle()
        line.open.set()
        await settle()
        assert line.came == [b"1", b"49"]
        assert (client.sent, client.dropped) == (2, 47)

    meet(play)


def test_words_keep_their_order_and_are_not_lost():
    async def play(client, line, _):
        line.open.clear()
        client.tell("hello")
        client.show(1, b"1")
        client.tell("again")
        client.show(2, b"2")
        await settle()
        line.open.set()
        await settle()
        assert line.came == ["hello", "again", b"2"]

    meet(play)


def test_who_leaves_all_words_lying_fails():
    async def play(client, line, _):
        line.open.clear()
        for _ in range(_MOST_BYTES // 100_000 + 2):
            client.tell(b"x" * 100_000)
        assert client.failed
        line.open.set()
        await settle()
        assert sum(map(len, line.came)) <= _MOST_BYTES

    meet(play)


def test_what_is_under_way_is_never_old():
    async def play(client, line, clock):
        for number in range(1, 200):
            client.show(number, str(number).encode())
            await settle()
        assert len(line.came) == 199, "a client that confirms nothing gets all that it takes"
        client.confirm(199)
        for number in range(200, 400):
            clock.sleep(0.001)
            client.show(number, str(number).encode())
            await settle()
        assert len(line.came) == 199 + _AHEAD
        client.confirm(199 + _AHEAD)
        await settle()
        assert line.came[-1] == b"399"
        client.confirm(399)
        assert client.latency_s is not None

    meet(play)


def test_latency_is_measured_by_confirmation():
    async def play(client, _, clock):
        client.show(1, b"1")
        await settle()
        clock.sleep(0.05)
        client.confirm(7)
        assert client.latency_s is None
        client.confirm(1)
        assert abs(client.latency_s - 0.05) < 1e-9
        client.confirm(1)

    meet(play)


def test_a_frame_reaches_those_who_look_at_it():
    async def main():
        lines = [Line() for _ in range(3)]
        clients = [
            Client(line.send, face, mode, ManualClock())
            for line, face, mode in zip(lines, ("a", "a", "b"), ("basis", "exact", "basis"), strict=True)
        ]
        hub = Hub()
        for client in clients:
            hub.join(client)
        assert hub.wanted == {"a": {"basis", "exact"}, "b": {"basis"}}
        work = [asyncio.ensure_future(client.run()) for client in clients]
        hub.show("a", "basis", 1, b"1")
        hub.tell("a", "word")
        await settle()
        assert [line.came for line in lines] == [["word", b"1"], ["word"], []]
        hub.leave(clients[0])
        assert hub.wanted == {"a": {"exact"}, "b": {"basis"}}
        for task in work:
            task.cancel()

    asyncio.run(main())
