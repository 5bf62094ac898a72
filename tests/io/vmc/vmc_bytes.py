"""Datagrams of trackers, laid out by hand after the VMC specification 3.1."""

from __future__ import annotations

from osc_bytes import bundle, message

STILL = (0.0, 0.0, 0.0, 1.0)


def ok(*more: int) -> bytes:
    return message("/VMC/Ext/OK", "i" * (1 + len(more)), 1, *more)


def value(name: str, weight: float) -> bytes:
    return message("/VMC/Ext/Blend/Val", "sf", name, weight)


def apply() -> bytes:
    return message("/VMC/Ext/Blend/Apply")


def bone(name: str, *turn: float) -> bytes:
    return message("/VMC/Ext/Bone/Pos", "sfffffff", name, 0.0, 0.1, 0.0, *(turn or STILL))


def frame(*elements: bytes, **weights: float) -> bytes:
    """A frame as senders bundle it."""
    return bundle(ok(), *elements, *(value(name, weight) for name, weight in weights.items()), apply())


BODY = ("Hips", "Spine", "Chest", "UpperChest", "LeftUpperArm", "RightHand", "LeftIndexProximal", "Jaw")
# A value and its application, byte for byte: address, tags, arguments, each filled up to four bytes with zeros
JOY = bytes.fromhex(
    "2362756e646c6500" "0000000000000001"
    "00000020" "2f564d432f4578742f426c656e642f56616c0000" "2c736600" "4a6f7900" "3f400000"
    "0000001c" "2f564d432f4578742f426c656e642f4170706c79" "00000000" "2c000000"
)  # fmt: skip
# Turned by 0.2 rad about Unity's +Y, which is to the avatar's right: its axes are left-handed
HEAD = bytes.fromhex(
    "2f564d432f4578742f426f6e652f506f73000000" "2c7366666666666666000000" "48656164" "00000000"
    "00000000" "3dcccccd" "00000000" "00000000" "3dcc7576" "00000000" "3f7eb898"
)  # fmt: skip
