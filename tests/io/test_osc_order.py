"""What many messages at once do: the newest wins, bundles wait for their time, answers are limited."""

from __future__ import annotations

import json

from osc_bytes import bundle, message

from agentface import EmotionState
from agentface.io.osc.receiver import ANSWERS_A_SECOND, ANSWERS_AT_ONCE
from agentface.io.osc.schedule import MOST


def test_status_is_answered_after_what_came_before_it(desk):
    desk.take(
        message("/agentface/status"), message("/agentface/emotion", "sf", "joy", 0.5), message("/agentface/status")
    )
    (answer,) = desk.said()
    status = json.loads(answer.arguments[0])
    assert answer.address == "/agentface/status"
    assert status["emotion"]["happiness"] == 0.5
    assert list(status) == list(desk.face.status())
    assert status["messages"] == 3


def test_every_sender_gets_its_status(desk):
    for port in range(3):
        desk.receiver.take([(message("/agentface/status"), ("127.0.0.1", port))] * 5)
    assert [sender for _, sender in desk.answers] == [("127.0.0.1", port) for port in range(3)]


def test_the_newest_wins_and_order_is_kept(desk):
    many = [message("/agentface/emotion", "sf", "joy", number / 1000) for number in range(1000)]
    desk.take(*many, message("/agentface/neutral"), message("/agentface/emotion", "sf", "fear", 0.25))
    assert desk.state == EmotionState.of(fear=0.25)
    desk.take(message("/agentface/emotions", "sf", "anger", 0.5), message("/agentface/emotion", "sf", "joy", 0.125))
    assert desk.state == EmotionState.of(anger=0.5, happiness=0.125)


def test_a_bundle_with_one_malformed_part_does_nothing(desk):
    desk.take(
        bundle(message("/agentface/emotion", "sf", "joy", 0.5), message("/agentface/emotion", "sf", "fear", 0.5)[:-4])
    )
    assert desk.state == EmotionState()
    assert desk.face.message_counts.errors["malformed"] == 1


def test_bundles_play_at_their_time_in_their_order(desk):
    now = desk.clock.date()
    desk.take(
        bundle(message("/agentface/emotion", "sf", "joy", 0.75), date=now + 2),
        bundle(message("/agentface/emotion", "sf", "joy", 0.25), date=now + 1),
        bundle(message("/agentface/emotion", "sf", "joy", 0.125), date=now - 3600),
    )
    assert desk.state["happiness"] == 0.125
    seen = []
    for _ in range(5):
        desk.clock.sleep(0.5)
        desk.take()
        seen.append(desk.state["happiness"])
    assert seen == [0.125, 0.25, 0.25, 0.75, 0.75]


def test_a_wrong_message_in_a_later_bundle_is_answered_now(desk):
    desk.take(bundle(message("/agentface/emotion", "sf", "joi", 0.75), date=desk.clock.date() + 2))
    assert desk.said()[0].arguments[0] == "/agentface/emotion"


def test_the_schedule_is_bounded(desk):
    packet = bundle(*[message("/agentface/blink")] * 200, date=desk.clock.date() + 5)
    desk.take(*[packet] * (MOST // 200 + 2))
    assert desk.face.message_counts.errors["rejected"] == (MOST // 200 + 2) * 200 - MOST
    assert desk.face.message_counts.messages == MOST


def test_answers_are_limited_in_time(desk):
    wrong = [message("/agentface/emotion", "sf", "joi", 0.5)] * 1000
    desk.take(*wrong)
    assert len(desk.said()) == ANSWERS_AT_ONCE
    desk.clock.sleep(0.5)
    desk.take(*wrong)
    assert len(desk.said()) == ANSWERS_A_SECOND / 2
    assert desk.face.message_counts.errors["rejected"] == 2000


def test_the_status_is_limited_over_all_senders(desk):
    desk.receiver.take([(message("/agentface/status"), ("10.0.0.1", port)) for port in range(1000)])
    assert len(desk.said()) == ANSWERS_AT_ONCE
    assert desk.face.message_counts.messages == 1000
