"""Bytes to OSC messages and back: pure functions, safe on any bytes.

python-osc reads the messages. Bundles are taken apart here, because python-osc never returns from an element of
size -4 and runs out of stack on deep nesting; and a message must be exactly as long as what was read from it, because
python-osc reads a number that was cut off as 0.
"""

from __future__ import annotations

import struct
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

LARGEST_DATAGRAM = 8192
"""Bytes; a longer one is malformed. The longest real message, 68 FAPs, has 624."""
_DEEPEST = 8
_MOST_ARGUMENTS = 256
_BUNDLE = b"#bundle\0"
_UNIX_EPOCH_IN_NTP = 2_208_988_800
_FIXED = {"i": 4, "f": 4, "r": 4, "m": 4, "h": 8, "d": 8, "t": 8, "T": 0, "F": 0, "N": 0}
_ALIKE = str.maketrans({"S": "s", "I": "T", "[": None, "]": None})
"""A symbol is read as a string, an impulse as true, an array as what is in it."""
_KNOWN = frozenset(_FIXED) | frozenset("sb")


class MalformedError(Exception):
    """Bytes that are no OSC packet; the text says why."""


@dataclass(frozen=True, slots=True)
class Message:
    """One message: its address, its arguments, and its date (seconds since 1970), None for at once.

    Of an array, what is in it stands among the arguments.
    """

    address: str
    arguments: tuple[Any, ...]
    date: float | None = None


def decode(packet: bytes) -> list[Message]:
    """All messages of a packet in their order, bundles opened; raises MalformedError if any part is malformed."""
    return [read(element, date) for element, date in split(packet)]


def split(packet: bytes, largest: int = LARGEST_DATAGRAM) -> list[tuple[bytes, float | None]]:
    """The bytes of each message of a packet with its date, bundles opened.

    Raises MalformedError for a packet of more than ``largest`` bytes and for bundles that are not as they should be.
    """
    if len(packet) > largest:
        raise MalformedError(f"more than {largest} bytes")
    return list(_open(packet, None, 0))


def encode(address: str, *arguments: str | float) -> bytes:
    """A message of strings and floats."""
    tags = "".join("s" if isinstance(argument, str) else "f" for argument in arguments)
    parts = [_text(address), _text(f",{tags}")]
    parts += [_text(value) if isinstance(value, str) else struct.pack(">f", value) for value in arguments]
    return b"".join(parts)


def address_of(packet: bytes) -> str:
    """What stands where the address should be, as far as it can be printed: for the answer to malformed bytes."""
    start = packet[:64].partition(b"\0")[0]
    return "".join(char for char in start.decode("ascii", "ignore") if char.isprintable())


def _open(packet: bytes, date: float | None, depth: int) -> Iterator[tuple[bytes, float | None]]:
    if not packet.startswith(_BUNDLE):
        yield packet, date
        return
    if depth >= _DEEPEST:
        raise MalformedError(f"bundles nested more than {_DEEPEST} deep")
    if len(packet) < 16:
        raise MalformedError("a bundle without its time tag")
    date = _later(date, int.from_bytes(packet[8:16], "big"))
    place = 16
    while place < len(packet):
        size = int.from_bytes(packet[place : place + 4], "big")
        element = packet[place + 4 : place + 4 + size]
        if len(packet) < place + 4 or size == 0 or size % 4 or len(element) != size:
            raise MalformedError(f"a bundle's element of {size} bytes, which is not what follows")
        yield from _open(element, date, depth + 1)
        place += 4 + size


def _later(outer: float | None, time_tag: int) -> float | None:
    if time_tag == 1:
        return outer
    date = time_tag / 2**32 - _UNIX_EPOCH_IN_NTP
    return date if outer is None else max(outer, date)


def read(packet: bytes, date: float | None = None) -> Message:
    """One message of its bytes; raises MalformedError."""
    from pythonosc.osc_message import OscMessage
    from pythonosc.parsing import osc_types

    if not packet.startswith(b"/") or len(packet) % 4:
        raise MalformedError("expected an address that begins with / in a multiple of 4 bytes")
    try:
        address, place = osc_types.get_string(packet, 0)
        tags = osc_types.get_string(packet, place)[0] if place < len(packet) else ","
        start = place + _padded(tags) if place < len(packet) else place
        plain = tags.translate(_ALIKE)
        if tags[:1] != "," or not set(plain[1:]) <= _KNOWN or len(tags) > _MOST_ARGUMENTS or not _nested(tags):
            raise MalformedError(
                f"type tags {tags[:24]!r}: expected a comma and up to {_MOST_ARGUMENTS - 1} of isfdhTFNIbrmtS[]"
            )
        arguments = tuple(OscMessage(packet[:place] + _text(plain) + packet[start:]).params)
    except MalformedError:
        raise
    except Exception as error:  # a codec's own errors, UnicodeDecodeError, and whatever else foreign bytes provoke
        raise MalformedError(f"no OSC message: {type(error).__name__}") from error
    due = start + sum(_length(tag, value) for tag, value in zip(plain[1:], arguments, strict=True))
    if due != len(packet):
        raise MalformedError(f"{len(packet)} bytes, where the type tags {tags[:24]!r} need {due}")
    return Message(address, arguments, date)


def _nested(tags: str) -> bool:
    """Whether each array that begins also ends."""
    depth = 0
    for tag in tags:
        depth += (tag == "[") - (tag == "]")
        if depth < 0:
            return False
    return depth == 0


def _length(tag: str, value: Any) -> int:
    if tag == "s":
        return _padded(value)
    if tag == "b":
        return 4 + (len(value) + 3) // 4 * 4
    return _FIXED[tag]


def _padded(text: str) -> int:
    return len(text.encode()) // 4 * 4 + 4


def _text(text: str) -> bytes:
    raw = text.replace("\0", "").encode("utf-8", "replace")
    return raw + bytes(4 - len(raw) % 4)
