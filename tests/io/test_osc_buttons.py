"""What a button sends that is pressed, or let go of, in place of arguments."""

from __future__ import annotations

import pytest
from osc_bytes import message

PRESSED = [("f", 1.0), ("i", 1), ("f", -0.5), ("d", 1e-3), ("T",), ("I",), ("N",), ("s", "bang"), ("S", "bang"), ("",)]
RELEASED = [("f", 0.0), ("i", 0), ("h", 0), ("F",), ("f", -0.0)]


@pytest.mark.parametrize("arguments", [*PRESSED, *RELEASED], ids=str)
def test_a_button_blinks_when_it_is_pressed(desk, arguments):
    desk.take(message("/agentface/blink", *arguments))
    desk.face.step(0.09)
    assert desk.face.pose["orbicularis_oculi_palpebralis_l"] == (1.0 if arguments in PRESSED else 0.0)
    assert desk.face.message_counts.messages == 1
    assert not desk.answers


@pytest.mark.parametrize("arguments", [*PRESSED, *RELEASED], ids=str)
def test_a_button_asks_for_the_status_when_it_is_pressed(desk, arguments):
    desk.take(message("/agentface/status", *arguments))
    assert [answer.address for answer in desk.said()] == ["/agentface/status"] * (arguments in PRESSED)


@pytest.mark.parametrize(
    ("arguments", "left", "fade"),
    [(("T",), 0.0, 0.25), (("I",), 0.0, 0.25), (("N",), 0.0, 0.25), (("s", "bang"), 0.0, 0.25), (("F",), 0.5, 0.0),
     (("f", 0.0), 0.0, 0.0), (("i", 1), 0.0, 1.0)],
)  # fmt: skip
def test_a_button_lets_go_of_everything(desk, arguments, left, fade):
    desk.take(message("/agentface/emotion", "sff", "joy", 0.5, 0.0))
    desk.take(message("/agentface/neutral", *arguments))
    assert desk.state["happiness"] == left
    desk.face.step(0.5 * fade)
    shown = desk.face.status()["shown"]["emotion"]["happiness"]
    assert 0.1 < shown < 0.3 if fade else shown == left
    assert not desk.answers
