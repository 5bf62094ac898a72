"""Several faces behind one receiver: who is meant, who is answered, and what each is told last."""

from __future__ import annotations

import json

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from osc_bytes import bundle, message

from agentface import EmotionState, Face
from agentface.errors import InvalidValueError
from agentface.io.osc.addresses import _READERS
from agentface.io.osc.codec import decode, encode
from agentface.io.osc.receiver import MOST_FACES, Receiver
from tests.clocks import ManualClock
from tests.heads import head_model

ME = ("127.0.0.1", 1)
LARGEST_UDP = 65_507


class Desk:
    """A receiver for two faces on a clock of its own, with what it answered."""

    def __init__(self):
        self.clock = ManualClock()
        self.left, self.right = (Face(head_model(), compiled=False, clock=self.clock) for _ in range(2))
        self.answers = []
        faces = {"left": self.left, "right": self.right}
        self.receiver = Receiver(faces, lambda packet, _: self.answers.append(decode(packet)[0]), self.clock)

    def take(self, *packets):
        self.receiver.take([(packet, ME) for packet in packets])

    def said(self):
        said, self.answers[:] = tuple(self.answers), []
        return said

    @property
    def joy(self):
        return self.left.emotion["happiness"], self.right.emotion["happiness"]

    @property
    def counts(self):
        return self.left.message_counts, self.right.message_counts


@pytest.fixture
def desk():
    return Desk()


@pytest.mark.parametrize(
    ("address", "joy"),
    [
        ("/agentface/emotion", (0.5, 0.5)),
        ("/agentface/*/emotion", (0.5, 0.5)),
        ("/agentface/{left,right}/emotion", (0.5, 0.5)),
        ("/agentface/left/emotion", (0.5, 0.0)),
        ("/agentface/r*/emotion", (0.0, 0.5)),
        ("/agentface/amber/emotion", (0.0, 0.0)),
    ],
)
def test_who_is_meant(desk, address, joy):
    desk.take(message(address, "sf", "joy", 0.5))
    assert desk.joy == joy
    assert tuple(count.messages for count in desk.counts) == tuple(map(bool, joy))
    assert {count.errors["unknown"] for count in desk.counts} == {0 if any(joy) else 1}
    assert not desk.answers


TARGETS = {
    "": ("left", "right"),
    "*/": ("left", "right"),
    "left/": ("left",),
    "right/": ("right",),
}
ORDERS = st.lists(
    st.tuples(
        st.sampled_from(sorted(TARGETS)),
        st.sampled_from(("happiness", "fear", "neutral")),
        st.integers(0, 4),
    ),
    max_size=12,
)


@pytest.mark.untraced
@settings(max_examples=60)
@given(ORDERS)
def test_each_face_is_left_as_by_its_own_messages_one_by_one(orders):
    desk, wanted = DESKS.setdefault("one", Desk()), {"left": {}, "right": {}}
    desk.take(message("/agentface/neutral", "f", 0.0))
    packets = []
    for target, emotion, quarters in orders:
        if emotion == "neutral":
            packets.append(message(f"/agentface/{target}neutral", "f", 0.0))
        else:
            packets.append(message(f"/agentface/{target}emotion", "sff", emotion, quarters / 4, 0.0))
        for name in TARGETS[target]:
            wanted[name] = {} if emotion == "neutral" else wanted[name] | {emotion: quarters / 4}
    desk.take(*packets)
    assert desk.left.emotion == EmotionState.of(wanted["left"])
    assert desk.right.emotion == EmotionState.of(wanted["right"])


DESKS: dict[str, Desk] = {}


def test_a_status_without_an_id_is_one_object_of_all(desk):
    desk.take(message("/agentface/right/emotion", "sff", "joy", 0.5, 0.0), message("/agentface/status"))
    (answer,) = desk.said()
    assert answer.address == "/agentface/status"
    status = json.loads(answer.arguments[0])
    assert list(status) == ["faces"]
    assert list(status["faces"]) == ["left", "right"]
    for name, face in (("left", desk.left), ("right", desk.right)):
        assert status["faces"][name] == json.loads(json.dumps(face.status()))
    assert [status["faces"][name]["emotion"]["happiness"] for name in ("left", "right")] == [0.0, 0.5]
    assert [status["faces"][name]["messages"] for name in ("left", "right")] == [1, 2]


def test_a_status_with_an_id_is_that_face_s(desk):
    desk.take(message("/agentface/left/emotion", "sff", "joy", 0.5, 0.0), message("/agentface/left/status"))
    (answer,) = desk.said()
    assert answer.address == "/agentface/left/status"
    assert json.loads(answer.arguments[0]) == json.loads(json.dumps(desk.left.status()))
    desk.take(message("/agentface/*/status"), message("/agentface/left/status"))
    assert [answer.address for answer in desk.said()] == ["/agentface/left/status", "/agentface/right/status"]


def test_a_wrong_message_is_answered_once_and_counted_for_those_it_meant(desk):
    desk.take(message("/agentface/emotion", "sf", "joi", 0.5), message("/agentface/left/emotion", "sf", "joi", 0.5))
    assert [answer.arguments[0] for answer in desk.said()] == ["/agentface/emotion", "/agentface/left/emotion"]
    assert [count.errors["rejected"] for count in desk.counts] == [2, 1]
    assert [count.messages for count in desk.counts] == [0, 0]
    desk.take(b"garbage")
    assert len(desk.said()) == 1
    assert [count.errors["malformed"] for count in desk.counts] == [1, 1]


def test_what_a_face_refuses_names_that_face(desk):
    desk.take(message("/agentface/look_at", "fff", 0.0, 0.0, -1.0))
    refused = desk.said()
    assert [answer.arguments[0] for answer in refused] == ["/agentface/left/look_at", "/agentface/right/look_at"]
    assert [count.errors["rejected"] for count in desk.counts] == [1, 1]
    assert [count.messages for count in desk.counts] == [0, 0]


def test_a_later_bundle_finds_its_faces(desk):
    now = desk.clock.date()
    desk.take(
        bundle(
            message("/agentface/emotion", "sff", "joy", 0.5, 0.0),
            message("/agentface/right/emotion", "sff", "joy", 1.0, 0.0),
            date=now + 1,
        )
    )
    assert desk.joy == (0.0, 0.0)
    desk.clock.sleep(1.0)
    desk.take()
    assert desk.joy == (0.5, 1.0)


def test_an_added_address_is_for_all(desk):
    from agentface.requests import SetEmotion

    desk.receiver.addresses.add("/avatar/smile", lambda arguments: SetEmotion("joy", *arguments))
    desk.take(message("/avatar/smile", "f", 0.25))
    assert desk.joy == (0.25, 0.25)
    desk.take(message("/avatar/smile", "f", 2.0))
    assert [answer.arguments[0] for answer in desk.said()] == ["/avatar/smile"]


@pytest.mark.parametrize(
    "name", [*_READERS, "status", "error", "", "a b", "a/b", "a*", "#1", "{a}", "ä", "x" * 65, 3, None], ids=str
)
def test_what_is_no_id(name):
    with pytest.raises(InvalidValueError, match="id"):
        Receiver({"left": None, name: None}, lambda *_: None, ManualClock())


@pytest.mark.parametrize("count", [0, MOST_FACES + 1])
def test_there_is_at_least_one_face_and_there_are_not_too_many(count):
    with pytest.raises(InvalidValueError, match="faces"):
        Receiver({f"face{number}": None for number in range(count)}, lambda *_: None, ManualClock())


def test_the_status_of_as_many_as_there_may_be_fits_into_a_datagram(desk):
    busy = desk.left
    busy.set_emotion(dict.fromkeys(busy.emotion, 1 / 3))
    for unit in range(1, 29):
        if unit not in (3, 8, 19, 21):
            busy.set_action_unit(unit, 1 / 3)
    busy.speak([("aa", 0.0, 1.0)])
    busy.step(0.1)
    length = len(json.dumps(busy.status()))
    assert MOST_FACES * (length + 80) < LARGEST_UDP
    answers = []
    receiver = Receiver(
        {f"face{number}": busy for number in range(MOST_FACES)}, lambda packet, _: answers.append(packet), desk.clock
    )
    receiver.take([(encode("/agentface/status"), ME)])
    assert len(answers[0]) > MOST_FACES * length
    assert len(answers[0]) < LARGEST_UDP


def test_one_face_with_an_id_answers_as_one(desk):
    answers = []
    receiver = Receiver({"host": desk.left}, lambda packet, _: answers.append(decode(packet)[0]), desk.clock)
    receiver.take([(message("/agentface/host/emotion", "sf", "joy", 0.5), ME), (message("/agentface/status"), ME)])
    assert desk.joy == (0.5, 0.0)
    assert json.loads(answers[0].arguments[0])["face"] == "amber"
