"""A desk at which datagrams are taken in for a face, without sockets."""

from __future__ import annotations

from agentface import Face
from agentface.io.osc.codec import decode
from agentface.io.osc.receiver import Receiver
from tests.clocks import ManualClock

ME = ("127.0.0.1", 1)


class Desk:
    """A receiver on a clock of its own, with what it answered."""

    def __init__(self, model):
        self.clock = ManualClock()
        self.face = Face(model, clock=self.clock)
        self.answers = []
        self.receiver = Receiver(self.face, lambda packet, sender: self.answers.append((packet, sender)), self.clock)

    def take(self, *packets, sender=ME):
        self.receiver.take([(packet, sender) for packet in packets])

    def said(self):
        """The answers since the last call, decoded."""
        said = [decode(packet)[0] for packet, _ in self.answers]
        self.answers.clear()
        return said

    @property
    def state(self):
        return self.face.emotion
