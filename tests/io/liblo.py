"""The programs of liblo, another implementation of OSC."""

from __future__ import annotations

import socket
import subprocess
import time
from pathlib import Path


def oscsend(port: int, address: str, tags: str = "", *values: object) -> None:
    command = ["oscsend", "127.0.0.1", str(port), address, *([tags] if tags else []), *map(str, values)]
    subprocess.run(command, check=True, timeout=200)


def oscdump(packet: bytes, folder: Path, messages: int = 1) -> list[str]:
    """What liblo prints of the messages of a datagram.

    It does not say when it begins to listen: the datagram is sent until it does.
    """
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
        sender.bind(("127.0.0.1", 0))
        place = sender.getsockname()
    said = folder / "said.txt"
    with said.open("w") as output, subprocess.Popen(["oscdump", "-L", str(place[1])], stdout=output) as dump:
        try:
            with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
                while said.read_text().count("\n") < messages:
                    sender.sendto(packet, place)
                    time.sleep(0.02)
        finally:
            dump.terminate()
    lines = [line.partition(" ") for line in said.read_text().splitlines()[:messages]]
    assert all("." in date for date, _, _ in lines)
    return [line for _, _, line in lines]
