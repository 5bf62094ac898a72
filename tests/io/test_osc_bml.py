from __future__ import annotations

import socket
import time

import pytest
from osc_bytes import message
from pythonosc.osc_message import OscMessage
from pythonosc.osc_message_builder import OscMessageBuilder

from agentface import Face
from agentface.io.osc.codec import decode
from agentface.io.osc.receiver import Receiver
from agentface.io.osc.server import OscServer
from tests.clocks import ManualClock
from tests.heads import head_model

ME, YOU = ("127.0.0.1", 1), ("127.0.0.1", 2)
BLOCK = '<bml id="{0}" composition="{1}"><wait id="w" duration="0.5"/><gesture id="g"/></bml>'


class Desk:
    """A receiver on a clock of its own, with what it answered to whom."""

    def __init__(self, *ids):
        self.clock, self.answers = ManualClock(), []
        made = [Face(head_model(), clock=self.clock, compiled=False) for _ in ids or "x"]
        self.faces = made if not ids else dict(zip(ids, made, strict=True))
        self.receiver = Receiver(self.faces if ids else made[0], self.reply, self.clock)
        self.made = made

    def reply(self, packet, sender):
        self.answers.append((sender, decode(packet)[0]))

    def send(self, text, sender=ME, address="/agentface/bml"):
        self.receiver.take([(message(address, "s", text), sender)])

    def run(self, seconds):
        for face in self.made:
            face._agendas.advance(seconds, face.channels.advance)

    def told(self, sender=ME):
        return [(each.address, *each.arguments) for to, each in self.answers if to == sender]


FEEDBACK = "/agentface/bml/feedback"


def test_the_sender_is_told_how_far_its_block_is():
    desk = Desk()
    desk.send(BLOCK.format("one", "MERGE"))
    desk.send(BLOCK.format("two", "APPEND"), YOU)
    note, *_ = desk.told()
    assert note[:2] == (FEEDBACK, "one")
    assert note[2].startswith("note: bml:1: g: expected what a face does, got <gesture>")
    desk.answers.clear()
    desk.run(1.45)
    assert desk.told() == [
        (FEEDBACK, "one", "start", 0.0),
        (FEEDBACK, "one", "w:start", 0.0),
        (FEEDBACK, "one", "w:end", 0.5),
        (FEEDBACK, "one", "end", pytest.approx(1.4)),
    ]
    assert desk.told(YOU)[0] == (FEEDBACK, "two", "start", 0.0)


def test_what_replaces_is_told_apart_from_what_it_replaces():
    desk = Desk()
    desk.send(BLOCK.format("one", "MERGE"))
    desk.run(0.2)
    desk.send(BLOCK.format("one", "REPLACE"), YOU)
    desk.run(2.0)
    assert desk.told()[-1][2] == "stopped"
    assert [each[2] for each in desk.told(YOU)][1:] == ["start", "w:start", "w:end", "end"]


def test_a_block_that_cannot_be_played_is_told():
    desk = Desk()
    desk.send('<bml id="a"><wait id="w" start="nobody:w:end"/></bml>')
    desk.run(0.1)
    assert desk.told()[-1][2].startswith("failed: bml:1: nobody:w:end: expected a sync point of a block")


BAD = ("", "<bml/>", "no XML", '<bml id="a"><smile/></bml>', "<!DOCTYPE a [<!ENTITY b 'c'>]><bml/>")


@pytest.mark.parametrize("bad", BAD)
def test_what_is_no_block_is_an_error_and_nothing_of_it_happens(bad):
    desk = Desk()
    desk.send(bad)
    ((address, about, reason, _),) = desk.told()
    assert (address, about) == ("/agentface/error", "/agentface/bml")
    assert "expected" in reason
    assert desk.made[0].blocks.blocks == ()
    assert desk.made[0].message_counts.errors["rejected"] == 1
    desk.receiver.take([(message("/agentface/bml", "i", 3), ME)])
    assert "as text" in desk.told()[-1][2]


def test_of_several_faces_each_tells_of_its_own():
    desk = Desk("left", "right")
    desk.send(BLOCK.format("one", "MERGE"), address="/agentface/*/bml")
    desk.send(BLOCK.format("two", "MERGE"), YOU, "/agentface/right/bml")
    desk.answers.clear()
    desk.run(1.45)
    assert {each[0] for each in desk.told()} == {"/agentface/left/bml/feedback", "/agentface/right/bml/feedback"}
    assert {each[0] for each in desk.told(YOU)} == {"/agentface/right/bml/feedback"}


def test_a_real_client_hears_of_its_block():
    builder = OscMessageBuilder("/agentface/bml")
    builder.add_arg(BLOCK.format("one", "MERGE"))
    heard = []
    with (
        Face(head_model(), compiled=False) as face,
        OscServer(face, port=0) as server,
        socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as client,
    ):
        client.settimeout(200)
        client.sendto(builder.build().dgram, ("127.0.0.1", server.port))
        while not face.blocks.blocks:
            server.take_in()
            time.sleep(0.001)
        face._agendas.advance(2.0, face.channels.advance)
        while not heard or heard[-1][1] != "end":
            heard.append(OscMessage(client.recv(4096)).params)
    assert [what for _, what, _ in heard[1:]] == ["start", "w:start", "w:end", "end"]
    assert heard[-1][2] == pytest.approx(1.4)


def test_of_several_faces_the_character_of_a_block_plays_it():
    desk = Desk("left", "right")
    for name, character in (("a", "left"), ("b", "right"), ("c", ""), ("d", "Ann")):
        desk.send(f'<bml id="{name}" characterId="{character}"><wait id="w"/></bml>')
        desk.run(0.1)
    starts = [(address, block) for address, block, what, _ in desk.told() if what == "start"]
    assert starts == [
        ("/agentface/left/bml/feedback", "a"),
        ("/agentface/right/bml/feedback", "b"),
        ("/agentface/left/bml/feedback", "c"),
        ("/agentface/right/bml/feedback", "c"),
        ("/agentface/left/bml/feedback", "d"),
        ("/agentface/right/bml/feedback", "d"),
    ]


def test_a_block_for_another_face_than_its_address_is_refused():
    desk = Desk("left", "right")
    desk.send('<bml id="a" characterId="right"><wait id="w"/></bml>', address="/agentface/left/bml")
    desk.run(0.1)
    ((address, *answer),) = desk.told()
    assert (address, answer[0]) == ("/agentface/error", "/agentface/left/bml")
    assert "characterId" in answer[1]
    assert [face.message_counts.errors["rejected"] for face in desk.made] == [1, 0]


def test_one_face_plays_the_blocks_of_any_character():
    desk = Desk()
    desk.send('<bml id="a" characterId="Ann"><wait id="w"/></bml>')
    desk.run(0.1)
    assert (FEEDBACK, "a", "start", 0.0) in desk.told()
