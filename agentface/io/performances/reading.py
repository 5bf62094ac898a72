"""Bytes that may come from anywhere, with a limit to each: a file, a line, the number of frames."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import BinaryIO

import numpy as np

from agentface.conventions import Doubles, Floats
from agentface.errors import DataError, Fault, FaultList

MOST_FRAMES = 500_000
"""Of one performance: more than two hours at 60 frames a second."""
LONGEST_LINE = 256 * 1024
"""Bytes; the widest table that a program is known to write, py-feat's with every landmark, needs a fifth of it."""


def open_file(path: str | Path) -> BinaryIO:
    """The file at ``path``; raises DataError for one that cannot be read."""
    try:
        return Path(path).open("rb")
    except OSError as error:
        raise unreadable(path, error) from error


def unreadable(path: str | Path, error: OSError) -> DataError:
    """What to raise for a file that the system does not give."""
    return DataError([Fault(Path(path), None, "", "a readable file", error.strerror or type(error).__name__)])


def read_bytes(path: str | Path, largest: int) -> bytes:
    """All of a file of at most ``largest`` bytes; no more is ever read. Raises DataError."""
    with open_file(path) as file:
        try:
            data = file.read(largest + 1)
        except OSError as error:
            raise unreadable(path, error) from error
    if len(data) > largest:
        raise DataError([Fault(Path(path), None, "", f"a file of at most {largest:,} bytes", "more")])
    return data


def text_of(data: bytes, path: str | Path) -> str:
    """UTF-8, a byte order mark left out; raises DataError with the line of what is not."""
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        got = f"the byte {data[error.start]:#04x}"
        raise DataError([Fault(Path(path), line, "", "text in UTF-8", got)]) from error


def lines_of(path: str | Path) -> Iterator[str]:
    """The lines of a file one by one, without their ends; no more than one is in memory. Raises DataError."""
    faults = FaultList(path)
    with open_file(path) as file:
        for number in range(1, MOST_FRAMES * 4):
            try:
                line = file.readline(LONGEST_LINE + 1)
            except OSError as error:
                raise unreadable(path, error) from error
            if not line:
                return
            if len(line) > LONGEST_LINE:
                faults.stop(number, "", f"a line of at most {LONGEST_LINE:,} bytes", "a longer one")
            try:
                text = line.decode("utf-8-sig" if number == 1 else "utf-8")
            except UnicodeDecodeError as error:
                faults.stop(number, "", "text in UTF-8", f"the byte {line[error.start]:#04x}")
            yield text.rstrip("\r\n")
    faults.stop(None, "", f"a file of fewer than {MOST_FRAMES * 4:,} lines", "more")


def single(values: Doubles) -> Floats:
    """``values`` as float32; what is beyond its range is brought to its ends."""
    ends = np.finfo(np.float32)
    return np.asarray(values.clip(ends.min, ends.max), np.float32)
