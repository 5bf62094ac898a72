"""What is asked under which address: patterns, addresses that a program adds, and unknown ones."""

from __future__ import annotations

import pytest
from osc_bytes import bundle, message

from agentface import EmotionState
from agentface.errors import InvalidValueError, UnknownNameError
from agentface.requests import SetMuscle


def test_a_program_adds_an_address_of_its_own(desk):
    def wink(arguments):
        (side,) = arguments
        return SetMuscle(f"orbicularis_oculi_palpebralis_{side}", 1.0, 0.0)

    desk.receiver.addresses.add("/avatar/wink", wink)
    desk.take(message("/avatar/wink", "s", "l"))
    assert desk.face.pose["orbicularis_oculi_palpebralis_l"] == 1.0
    desk.take(bundle(message("/avatar/wink", "s", "r"), date=desk.clock.date() + 1))
    assert desk.face.pose["orbicularis_oculi_palpebralis_r"] == 0.0
    desk.clock.sleep(1.0)
    desk.take()
    assert desk.face.pose["orbicularis_oculi_palpebralis_r"] == 1.0
    desk.take(message("/avatar/wink", "s", "x"), message("/avatar/wink"))
    assert [answer.arguments[0] for answer in desk.said()] == ["/avatar/wink", "/avatar/wink"]
    assert desk.face.message_counts.errors == {"malformed": 0, "unknown": 0, "rejected": 2}
    desk.receiver.addresses.remove("/avatar/wink")
    desk.take(message("/avatar/wink", "s", "l"))
    assert desk.face.message_counts.errors["unknown"] == 1


def test_an_added_address_may_do_its_own_work(desk):
    taken = []
    desk.receiver.addresses.add("/avatar/note", taken.append)
    desk.take(message("/avatar/note", "if", 3, 0.5))
    assert taken == [(3, 0.5)]
    assert desk.face.message_counts.messages == 1


@pytest.mark.parametrize(
    "address", ["", "avatar", "/", "/a//b", "/a/", "/a b", "/a*", "/{a}", "/ä", None, "/agentface/blink",
                "/agentface/amber/blink", "/agentface/status", "/taken"],
)  # fmt: skip
def test_a_wrong_or_taken_address_is_not_added(desk, address):
    desk.receiver.addresses.add("/taken", lambda arguments: None)
    with pytest.raises(InvalidValueError, match="address"):
        desk.receiver.addresses.add(address, lambda arguments: None)


def test_only_what_was_added_is_removed(desk):
    for address in ("/agentface/blink", "/none"):
        with pytest.raises(UnknownNameError):
            desk.receiver.addresses.remove(address)


@pytest.mark.parametrize(
    "address",
    [
        "/other/emotion",
        "/agentface",
        "/agentface/",
        "/agentface/visage",
        "/agentface/onyx/emotion",
        "/*",
        "/*/*/*/*",
        "/agentface/{emotion",
        "/agentface/[e",
        "/agentface/e?",
        "//emotion",
        "/agentface/" + "*" * 300,
    ],
)
def test_unknown_addresses_are_counted_and_not_answered(desk, address):
    desk.take(message(address, "sf", "joy", 0.5))
    assert desk.face.message_counts.errors == {"malformed": 0, "unknown": 1, "rejected": 0}
    assert not desk.answers
    assert desk.state == EmotionState()


@pytest.mark.parametrize(
    "address",
    [
        "/agentface/{emotion,moods}", "/agentface/e*n", "/agentface/emotio?", "/agentface/[!a-df-z]motion",
        "/*/emotion", "/agentface/*/emotion", "/agentface/{amber,onyx}/emotion", "/agentface/a????/[d-f]motion",
    ],
)  # fmt: skip
def test_patterns_are_matched(desk, address):
    desk.take(message(address, "sf", "joy", 0.5))
    assert desk.state == EmotionState.of(happiness=0.5)
    assert desk.face.message_counts.messages == 1
    assert desk.face.message_counts.errors == {"malformed": 0, "unknown": 0, "rejected": 0}


def test_a_pattern_means_each_address_by_itself(desk):
    desk.receiver.addresses.add("/avatar/muscles", lambda arguments: SetMuscle(*arguments, 0.0))
    desk.take(message("/{agentface,avatar}/muscle*", "sf", "risorius", 0.5))
    assert desk.face.message_counts.messages == 2
    desk.take(message("/agentface/{muscle,emotion,status}", "sf", "jaw_open", 0.5))
    assert desk.face.held["jaw_open"] == 0.5
    refused = [answer.arguments[0] for answer in desk.said()]
    assert refused == ["/agentface/emotion", "/agentface/status"]
    desk.take(message("/agentface/stat*"))
    assert desk.said()[0].address == "/agentface/status"


def test_the_face_has_a_name_of_its_own(desk):
    desk.take(message("/agentface/amber/emotion", "sf", "joy", 0.5))
    assert desk.state == EmotionState.of(happiness=0.5)
