"""Another process that sends datagrams when it is time for each."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from subprocess import Popen

_PROGRAM = """
import json, socket, sys, time
place, due, packets, hurried = json.load(sys.stdin)
times = []
with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
    sender.connect(tuple(place))
    start = time.monotonic()
    for at, packet in zip(due, map(bytes.fromhex, packets)):
        time.sleep(max(0.0, start + at - time.monotonic()))
        times.append(time.monotonic())
        sender.send(packet)
        if not hurried:
            start = max(start, times[-1] - at)
print(json.dumps(times))
"""


@contextmanager
def sending(
    place: tuple[str, int], due_s: Sequence[float], packets: Sequence[bytes], *, hurried: bool
) -> Iterator[list[float]]:
    """Have packets sent to a host and port, each so many seconds after the process began; wait for its end.

    One that is late is followed by the next as if it were not when ``hurried``, else no sooner than was meant.
    Yields a list that has, after the block, when each was sent, by the clock that all processes of the machine share.
    """
    times: list[float] = []
    with Popen([sys.executable, "-c", _PROGRAM], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as sender:  # noqa: S603
        assert sender.stdin is not None and sender.stdout is not None  # noqa: PT018, S101 - for the type checker
        json.dump([place, list(due_s), [packet.hex() for packet in packets], hurried], sender.stdin)
        sender.stdin.close()
        yield times
        times += json.load(sender.stdout)
