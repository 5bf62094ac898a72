"""Datagrams by hand, not by the codec under test."""

from __future__ import annotations

import struct

UNIX_IN_NTP = 2_208_988_800


def text(value: str | bytes) -> bytes:
    raw = value.encode() if isinstance(value, str) else value
    return raw + b"\0" * (4 - len(raw) % 4)


def message(address: str, tags: str = "", *values: object) -> bytes:
    values_of = [tag for tag in tags if tag not in "TFNI[]"]
    body = b"".join(
        text(value) if tag in "sS" else struct.pack({"f": ">f", "i": ">i", "d": ">d", "h": ">q"}[tag], value)
        for tag, value in zip(values_of, values, strict=True)
    )
    return text(address) + text("," + tags) + body


def bundle(*elements: bytes, date: float | None = None) -> bytes:
    tag = 1 if date is None else round((date + UNIX_IN_NTP) * 2**32)
    head = b"#bundle\0" + struct.pack(">Q", tag)
    return head + b"".join(struct.pack(">I", len(element)) + element for element in elements)


# /agentface/emotion ,sf joy 0.5, byte for byte after the OSC 1.0 specification
EMOTION = bytes.fromhex("2f6167656e74666163652f656d6f74696f6e00002c7366006a6f79003f000000")
