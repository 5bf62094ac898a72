"""Packets that are almost right, wrong or nonsense: none is fatal, none grows anything, no good one is lost."""

from __future__ import annotations

import math

import numpy as np
import pytest
from osc_bytes import bundle, message
from vmc_bytes import BODY, HEAD, JOY, apply, bone, frame, ok, value

from agentface import Face
from agentface.head.arkit import ARKIT_SHAPES
from agentface.io.vmc.receiver import VmcReceiver
from agentface.io.vmc.tracker import BONES, USED
from agentface.parameters import HIGH, LOW
from agentface.vrm.expressions import PRESETS
from tests.heads import head_model

BATCH = 50
ADDRESSES = (*sorted(USED), "/VMC/Ext/Root/Pos", "/VMC/Ext/Cam", "/VMC/", "/", "/avatar/x", "/VMC/Ext/*", "#bundle")
NAMES = (*ARKIT_SHAPES, *PRESETS, "Joy", "A", "Blink_L", "JawOpen", *BONES, *BODY, "", "ä", "x" * 400, "root")
NUMBERS = (0.0, 1.0, -1.0, 0.5, 2.0, 1e-30, 1e30, -1e30, math.nan, math.inf, -math.inf)
WHOLE = (0, 1, -1, 2**31 - 1, -(2**31))


class Fuzzer:
    """Makes datagrams of a seed."""

    def __init__(self, seed):
        self._draw = np.random.default_rng(seed)

    def pick(self, among):
        return among[int(self._draw.integers(len(among)))]

    def number(self):
        return self.pick((*NUMBERS, float(self._draw.uniform(-1.5, 1.5))))

    def good(self):
        turn = self._draw.normal(size=4).tolist()
        makes = (
            lambda: value(self.pick(NAMES), self.number()), lambda: bone(self.pick(NAMES), *turn), apply, ok,
            lambda: JOY, lambda: HEAD, lambda: frame(bone("Head", *turn), Joy=0.5, jawOpen=0.5),
        )  # fmt: skip
        return self.pick(makes)()

    def wrong(self):
        tags = "".join(self.pick("sffffidhTFNI") for _ in range(self._draw.integers(0, 10)))
        values = [
            self.pick(NAMES) if tag == "s" else self.pick(WHOLE) if tag in "ih" else self.number()
            for tag in tags
            if tag in "sfidh"
        ]
        return message(self.pick(ADDRESSES), tags, *values)

    def altered(self):
        packet = bytearray(self.good())
        for _ in range(self._draw.integers(1, 5)):
            packet[self._draw.integers(len(packet))] = self._draw.integers(256)
        return bytes(packet)

    def cut(self):
        packet = self.good()
        return packet[: self._draw.integers(len(packet))]

    def noise(self):
        return self._draw.bytes(int(self._draw.integers(0, 200)))

    def bundled(self, depth=0):
        parts = [self.pick((self.altered, self.wrong, self.good, self.cut))() for _ in range(self._draw.integers(0, 5))]
        if depth < 3 and self._draw.random() < 0.3:
            parts.append(self.bundled(depth + 1))
        return bundle(*parts)

    def packet(self):
        return self.pick((self.good, self.wrong, self.altered, self.altered, self.cut, self.noise, self.bundled))()


def fuzz(packets, seed, receiver):
    """Send so many, and after each batch a good frame, which must be shown."""
    fuzzer, face = Fuzzer(seed), receiver._face
    for batch in range(packets // BATCH):
        weight = 0.25 + 0.5 * (batch % 2)
        receiver.take(
            [*(fuzzer.packet() for _ in range(BATCH)), frame(bone("Head"), bone("Neck"), A=weight)], batch / 60
        )
        assert receiver._state._values["aa"] == weight, f"batch {batch} of seed {seed}"
        assert receiver._state.frame().head == pytest.approx((0.0, 0.0, 0.0))
        face.step(1 / 60)
        pose = face.pose.array
        assert ((pose >= LOW) & (pose <= HIGH)).all(), f"batch {batch} of seed {seed}"
    assert receiver._state._values.keys() <= {*ARKIT_SHAPES, *PRESETS}, "only what a face knows is kept"
    assert receiver._state._bones.keys() <= set(BONES)
    return receiver.status


def test_two_thousand_packets_lose_no_good_one():
    with VmcReceiver(Face(head_model()), "127.0.0.1", 0) as receiver:
        status = fuzz(2000, 0, receiver)
        assert all(status[name] > 50 for name in ("used", "unused", "unknown", "surplus", "rejected", "malformed"))
        assert status["frames"] == 2000 // BATCH


@pytest.mark.soak
@pytest.mark.parametrize("seed", range(1, 11))
def test_many_packets_lose_no_good_one(seed):
    with VmcReceiver(Face(head_model()), "127.0.0.1", 0) as receiver:
        fuzz(30_000, seed, receiver)
