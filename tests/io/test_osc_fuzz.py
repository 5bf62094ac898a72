"""Packets that are almost right, wrong or nonsense, to every address: none is fatal, and no good one is lost."""

from __future__ import annotations

import math

import numpy as np
import pytest
from osc_bytes import bundle, message

from agentface.io.osc.addresses import _READERS
from agentface.io.osc.codec import decode
from agentface.io.osc.receiver import Receiver
from agentface.parameters import HIGH, LOW
from tests.clocks import ManualClock
from tests.voices import talking_face

BATCH = 50
BLOCK = (
    '<bml xmlns="http://www.bml-initiative.org/bml/bml-1.0" id="b" composition="REPLACE"><head id="h" lexeme="NOD"/>'
    '<speech id="s"><text>Yes, <sync id="x"/>no.</text></speech><faceLexeme id="f" lexeme="SMILE" start="s:x"/></bml>'
)
GOOD = {
    "emotion": ("sf", "joy", 0.5),
    "emotions": ("sfsf", "joy", 0.5, "fear", 0.25),
    "mood": ("sf", "joy", 0.25),
    "neutral": ("f", 0.5),
    "muscle": ("sf", "risorius", 0.5),
    "parameter": ("sf", "head_yaw_deg", 10.0),
    "au": ("ifs", 12, 0.5, "left"),
    "arkit": ("sfsf", "jawOpen", 0.5, "browInnerUp", 0.25),
    "fap": ("if", 3, 100.0),
    "faps": ("i" * 68 + "f", *(int(number == 4) for number in range(68)), 20.0),
    "gaze": ("ff", 10.0, -5.0),
    "look_at": ("fff", 0.1, 0.0, 0.6),
    "head": ("fff", 10.0, 5.0, 2.0),
    "viseme": ("sff", "aa", 0.5, 0.2),
    "visemes": ("sffsff", "aa", 0.0, 0.2, "PP", 0.2, 0.3),
    "hush": ("",),
    "say": ("s", "[joy] Hello. [surprise:0.5] You?"),
    "blink": ("",),
    "gesture": ("sf", "nod", 0.5),
    "liveliness": ("f", 0.5),
    "state": ("s", "listening"),
    "bml": ("s", BLOCK),
}
WORDS = (
    *("joy", "neutral", "risorius", "jaw_open", "head_yaw", "aa", "viseme_PP", "nod", "wink", "speaking", "jawOpen"),
    *("left", "A", "bang", "", "ä", "[joy] Yes. No.", "[face:anger:2] -o /etc/passwd", "Bad.", "x" * 300, "\n"),
)
NUMBERS = (0.0, 1.0, -1.0, 0.5, 2.0, 1e-30, 1e30, -1e30, math.nan, math.inf, -math.inf, 12.0, 60.0, 700.0)
WHOLE = (0, 1, -1, 3, 12, 68, 2**31 - 1, -(2**31))
PLACES = ("", "amber/", "*/", "{amber,onyx}/", "onyx/", "?????/")


class Fuzzer:
    """Makes packets of a seed."""

    def __init__(self, seed):
        self._draw = np.random.default_rng(seed)
        self._names = (*_READERS, "status", "error", "nothing", "", "*", "[!a-d]*")
        self._kinds = (
            self.altered,
            self.altered,
            self.cut,
            self.longer,
            self.wrong,
            self.wrong,
            self.noise,
            self.bundle,
        )

    def pick(self, among):
        return among[int(self._draw.integers(len(among)))]

    def packet(self):
        return self.pick(self._kinds)()

    def good(self):
        name = self.pick(tuple(GOOD))
        return message(f"/agentface/{name}", *GOOD[name])

    def altered(self):
        packet = bytearray(self.good())
        for _ in range(self._draw.integers(1, 5)):
            packet[self._draw.integers(len(packet))] = self._draw.integers(256)
        return bytes(packet)

    def cut(self):
        packet = self.good()
        return packet[: self._draw.integers(len(packet))]

    def longer(self):
        packet = self.good()
        at = int(self._draw.integers(len(packet)))
        return packet[:at] + self._draw.bytes(int(self._draw.integers(1, 40))) + packet[at:]

    def wrong(self):
        tags = "".join(self.pick("sfidhTFNI") for _ in range(self._draw.integers(0, 7)))
        values = [
            self.pick(WORDS) if tag == "s" else self.pick(WHOLE) if tag in "ih" else self.number()
            for tag in tags
            if tag in "sfidh"
        ]
        return message(f"/agentface/{self.pick(PLACES)}{self.pick(self._names)}", tags, *values)

    def number(self):
        return self.pick((*NUMBERS, float(self._draw.uniform(-1.5, 1.5))))

    def noise(self):
        return self._draw.bytes(int(self._draw.integers(0, 200)))

    def bundle(self, depth=0):
        inner = (self.altered, self.wrong, self.good, self.cut)
        parts = [self.pick(inner)() for _ in range(self._draw.integers(0, 4))]
        if depth < 3 and self._draw.random() < 0.3:
            parts.append(self.bundle(depth + 1))
        date = None if self._draw.random() < 0.5 else 1_000_000_000.0 + float(self._draw.uniform(-10, 900))
        return bundle(*parts, date=date)


def fuzz(packets, seed):
    """Send so many, and a good one of each kind in turn among each batch of them; the face's last status."""
    fuzzer, draw, clock = Fuzzer(seed), np.random.default_rng(seed), ManualClock()
    with talking_face(clock=clock) as face:
        answers, noted, numbers = [], [], []
        receiver = Receiver(face, lambda packet, _: answers.append(packet), clock)
        receiver.addresses.add("/check/number", numbers.append)
        face.noted.append(noted.append)
        for batch in range(packets // BATCH):
            name = tuple(GOOD)[batch % len(GOOD)]
            good = message(f"/agentface/{name}", *GOOD[name])
            wanted = receiver.addresses.read(f"/agentface/{name}", decode(good)[0].arguments)
            sent = [fuzzer.packet() for _ in range(BATCH)]
            sent.insert(int(draw.integers(BATCH + 1)), good)
            sent.insert(int(draw.integers(BATCH + 1)), message("/check/number", "i", batch))
            face.hush()
            noted.clear()
            receiver.take([(packet, ("127.0.0.1", 1)) for packet in sent])
            assert wanted.key in [request.key for request in noted], f"{name} in batch {batch} of seed {seed}"
            assert (batch,) in numbers
            clock.sleep(1 / 60)
            face.step(1 / 60)
            pose = face.pose.array
            assert ((pose >= LOW) & (pose <= HIGH)).all(), f"batch {batch} of seed {seed}"
        for packet in answers:
            assert decode(packet)[0].address.split("/")[-1] in ("error", "status", "feedback")
        assert answers
        return face.status()


@pytest.mark.untraced
def test_ten_thousand_packets_lose_no_good_one():
    status = fuzz(10_000, seed=0)
    assert all(count > 100 for count in status["errors"].values()), "each way of being wrong is there"
    assert status["messages"] > 500


@pytest.mark.soak
@pytest.mark.parametrize("seed", range(1, 11))
def test_a_hundred_thousand_packets_lose_no_good_one(seed):
    fuzz(10_000, seed)
