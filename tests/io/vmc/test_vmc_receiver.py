"""What a receiver of the VMC protocol has to do, by the specification 3.1, on datagrams made by hand."""

from __future__ import annotations

import json
import math
import socket
import time

import pytest
from osc_bytes import bundle, message
from vmc_bytes import BODY, HEAD, JOY, apply, bone, frame, ok, value

from agentface import Face
from agentface.errors import ServerError
from agentface.io.vmc.receiver import MOST_MESSAGES, VmcReceiver
from agentface.parameters import HIGH, indices_of
from tests.heads import head_model
from tests.waiting import until


@pytest.fixture(scope="module")
def shared():
    with VmcReceiver(Face(head_model()), "127.0.0.1", 0) as receiver:
        yield receiver


@pytest.fixture
def receiver(shared):
    """As a new one: the tracker before is long gone, and the counts are at nought."""
    face = shared._face
    shared.take([], shared_time(shared))
    face.neutral(0.0)
    face.step(1.0)
    for name in ("used", "unused", "unknown", "surplus", "rejected", "malformed", "dropped"):
        setattr(shared._state.counts, name, 0)
    face.message_counts.messages = shared._frames = 0
    face.message_counts.errors = dict.fromkeys(face.message_counts.errors, 0)
    return shared


def shared_time(receiver):
    return (receiver._last_s or 0.0) + 10.0


def show(receiver, *packets, time_s=None):
    """The pose that some datagrams make."""
    receiver.take(packets, shared_time(receiver) if time_s is None else time_s)
    receiver._face.step(0.05)
    return receiver._face.pose


def counts(receiver):
    names = ("used", "unused", "unknown", "surplus", "rejected", "malformed", "dropped")
    return {name: receiver.status[name] for name in names if receiver.status[name]}


def test_captured_bytes_move_the_face(receiver):
    pose = show(receiver, JOY, HEAD)
    assert pose["zygomaticus_major_l"] > 0.7
    assert pose["head_yaw"] == pytest.approx(-0.2, abs=1e-5)
    assert counts(receiver) == {"used": 3}
    assert receiver._face.message_counts.messages == 3


def test_values_count_when_they_are_applied(receiver):
    assert show(receiver, value("A", 1.0))["jaw_open"] == 0.0
    assert show(receiver, value("Joy", 0.5))["jaw_open"] == 0.0
    assert receiver.status["frames"] == 0
    pose = show(receiver, apply())
    assert pose["jaw_open"] > 0.3
    assert pose["zygomaticus_major_l"] > 0.5
    assert receiver.status["frames"] == 1


def test_a_value_stays_until_it_is_sent_again(receiver):
    show(receiver, frame(A=1.0), time_s=1000.0)
    pose = show(receiver, frame(Joy=1.0), time_s=1000.02)
    assert pose["jaw_open"] > 0.3
    assert show(receiver, frame(A=0.0), time_s=1000.04)["jaw_open"] < 0.3


def test_of_several_frames_the_last_is_shown(receiver):
    pose = show(receiver, frame(A=1.0), frame(A=0.2), frame(A=0.0))
    assert pose["jaw_open"] == 0.0
    assert receiver.status["frames"] == 1


@pytest.mark.parametrize(
    ("old", "new"), [("Joy", "happy"), ("Sorrow", "sad"), ("Fun", "relaxed"), ("E", "ee"), ("Blink_R", "blinkRight")]
)
def test_names_of_vrm_0_and_1_are_the_same(receiver, old, new):
    first = show(receiver, frame(**{old: 0.6})).array.copy()
    receiver._face.step(5.0)
    second = show(receiver, frame(**{new: 0.6}))
    assert first.any()
    assert first == pytest.approx(second.array, abs=1e-6)


@pytest.mark.parametrize("name", ["jawOpen", "JawOpen"])
def test_names_of_perfect_sync_are_arkit_s(receiver, name):
    assert 0.3 < show(receiver, frame(**{name: 0.5}))["jaw_open"] < 0.7


@pytest.mark.parametrize("name", ["joy", "JOY", "Happy", "blink_l", "jawopen", "JAWOPEN", "Custom", ""])
def test_names_are_case_sensitive_and_others_ignored(receiver, name):
    assert not show(receiver, frame(**{name: 1.0})).array.any()
    assert counts(receiver) == {"used": 2, "unused": 1}


def test_surplus_arguments_are_ignored(receiver):
    more = message("/VMC/Ext/Blend/Val", "sffs", "A", 1.0, 7.0, "x"), message("/VMC/Ext/Blend/Apply", "i", 1)
    pose = show(receiver, ok(3, 0, 1), message("/VMC/Ext/T", "fff", 12.5, 1.0, 2.0), *more)
    assert pose["jaw_open"] > 0.3
    assert counts(receiver) == {"used": 4, "surplus": 4}
    assert receiver.status["loaded"] is True
    assert receiver.status["tracker_time_s"] == 12.5


@pytest.mark.parametrize(
    "wrong",
    [
        message("/VMC/Ext/Blend/Val", "s", "A"),
        message("/VMC/Ext/Blend/Val"),
        message("/VMC/Ext/Blend/Val", "fs", 1.0, "A"),
        message("/VMC/Ext/Blend/Val", "ss", "A", "1"),
        message("/VMC/Ext/Blend/Val", "sT", "A"),
        message("/VMC/Ext/Blend/Val", "sf", "A", math.nan),
        message("/VMC/Ext/Blend/Val", "sf", "A", math.inf),
        message("/VMC/Ext/OK"),
        message("/VMC/Ext/OK", "s", "1"),
        message("/VMC/Ext/T", "s", "now"),
        message("/VMC/Ext/Bone/Pos", "sffffff", "Head", *[0.0] * 6),
        bone("Head", 0.0, 0.0, 0.0, 0.0),
        bone("Head", math.nan, 0.0, 0.0, 1.0),
    ],
)
def test_too_few_and_wrong_arguments_are_ignored_and_counted(receiver, wrong):
    pose = show(receiver, wrong, frame(Joy=0.75))
    assert pose["zygomaticus_major_l"] > 0.5, "what comes with it is not lost"
    assert pose["head_yaw"] == 0.0
    assert counts(receiver)["rejected"] == 1
    assert receiver._face.message_counts.errors["rejected"] == 1


def test_unknown_addresses_are_ignored_and_counted(receiver):
    strange = [
        message("/VMC/Ext/Cam", "sffffffff", "Camera", *[0.0] * 8),
        message("/VMC/Ext/Hmd/Pos", "sfffffff", "1", *[0.0] * 7),
        message("/VMC/Thru/x/y", "si", "z", 1),
        message("/VMC/Ext/Set/Eye", "ifff", 1, 0.0, 0.0, 1.0),
    ]
    bones = [bone(name) for name in BODY]
    pose = show(receiver, bundle(*strange, *bones), message("/avatar/x", "f", 1.0), message("/"), frame(A=1.0))
    assert pose["jaw_open"] > 0.3
    assert counts(receiver) == {"used": 3, "unused": len(strange) + len(bones), "unknown": 2}
    assert receiver._face.message_counts.errors == {"malformed": 0, "unknown": 2, "rejected": 0}


@pytest.mark.parametrize(
    "packet",
    [
        b"", b"\0", b"VMC", b"\xff" * 500, b"#bundle\0", JOY[:-4], JOY[:30], b"/VMC/Ext/Blend/Val\0\0,sf\0Joy\0",
        b"/VMC/Ext/Blend/Val", bundle(b"nonsense")[:-1], bundle(b"/VMC/Ext/T\0\0,f\0\0"),
    ],
)  # fmt: skip
def test_malformed_bytes_are_counted_and_lose_nothing(receiver, packet):
    pose = show(receiver, packet, frame(A=1.0))
    assert pose["jaw_open"] > 0.3
    assert counts(receiver)["malformed"] == 1
    assert receiver._face.message_counts.errors["malformed"] == 1


def test_a_wrong_part_of_a_bundle_costs_no_other(receiver):
    wrong = b"/VMC/Ext/T\0\0,q\0\0\0\0\0\0"
    assert show(receiver, bundle(wrong, value("A", 1.0), apply()))["jaw_open"] > 0.3
    assert counts(receiver) == {"used": 2, "malformed": 1}


def test_values_outside_of_their_range_are_the_nearer_limit(receiver):
    at_most = show(receiver, frame(A=1.0)).array.copy()
    assert show(receiver, frame(A=7.5)).array == pytest.approx(at_most, abs=1e-6)
    assert not show(receiver, frame(A=-3.0)).array.any()
    assert "rejected" not in counts(receiver)


def test_dates_are_not_waited_for(receiver):
    assert show(receiver, bundle(value("A", 1.0), apply(), date=2e9))["jaw_open"] > 0.3


def turned(axis, degrees):
    half = math.radians(degrees) / 2.0
    return *(math.sin(half) * part for part in axis), math.cos(half)


@pytest.mark.parametrize(
    ("axis", "name"),
    # Unity's axes are left-handed; the avatar looks along +Z and has its left at -X
    [((0, -1, 0), "head_yaw"), ((-1, 0, 0), "head_pitch"), ((0, 0, 1), "head_roll")],
)
@pytest.mark.parametrize("shares", [{"Head": 30.0}, {"Neck": 30.0}, {"Neck": 10.0, "Head": 20.0}])
def test_neck_and_head_turn_the_head_together(receiver, axis, name, shares):
    pose = show(receiver, *(bone(which, *turned(axis, degrees)) for which, degrees in shares.items()), bone("Hips"))
    assert pose[name] == pytest.approx(math.radians(30.0), abs=1e-5)


def test_a_head_turns_as_far_as_it_can(receiver):
    pose = show(receiver, bone("Head", *turned((0, -1, 0), 170.0)))
    assert pose["head_yaw"] == float(HIGH[indices_of("head_yaw")[0]])


def test_an_unturned_head_is_held_straight(receiver):
    receiver._face.set_head(30.0, 0.0, fade=0.0)
    assert show(receiver, bone("Head"))["head_yaw"] == pytest.approx(0.0, abs=1e-6)


def test_eyes_turn_by_their_bones_else_by_weights(receiver):
    left = turned((0, -1, 0), 10.0)
    pose = show(receiver, bone("LeftEye", *left), bone("RightEye", *left))
    assert pose["gaze_yaw"] == pytest.approx(math.radians(10.0), abs=1e-5)
    pose = show(receiver, bone("LeftEye", *turned((0, 1, 0), 5.0)), bone("RightEye", *turned((0, -1, 0), 5.0)))
    assert pose["gaze_vergence"] == pytest.approx(math.radians(5.0), abs=1e-5), "both inward"
    looks = {"eyeLookOutLeft": 0.5, "eyeLookInRight": 0.5}
    pose = show(receiver, frame(bone("LeftEye"), bone("RightEye"), **looks), time_s=5000.0)
    by_weights = pose["gaze_yaw"]
    assert by_weights > 0.1
    pose = show(receiver, frame(bone("LeftEye", *left), **looks), time_s=5000.02)
    assert pose["gaze_yaw"] == pytest.approx(math.radians(5.0), abs=1e-5), "the mean of both eyes"


def test_right_handed_axes_by_option():
    with VmcReceiver(Face(head_model()), "127.0.0.1", 0, axes="gltf") as receiver:
        assert show(receiver, HEAD)["head_yaw"] == pytest.approx(0.2, abs=1e-5)


def test_a_tracker_that_stops_lets_go_and_the_next_begins_anew(receiver):
    face = receiver._face
    show(receiver, frame(bone("Head", *turned((0, -1, 0), 20.0)), A=1.0), time_s=9000.0)
    assert receiver.status["driving"]
    face.step(0.4)
    assert face.pose["jaw_open"] > 0.3, "it is held for half a second"
    face.step(0.2)
    face.step(0.5)
    assert not face.pose.array.any()
    receiver.take([], 9001.1)
    assert not receiver.status["driving"]
    pose = show(receiver, frame(Joy=0.5), time_s=9002.0)
    assert pose["head_yaw"] == 0.0
    assert pose["jaw_open"] < 0.1, "nothing of the tracker before"


def test_a_flood_is_bounded(receiver):
    flood = bundle(*[value("A", 0.5)] * 1500)
    show(receiver, *[flood] * 4, frame(A=1.0))
    assert counts(receiver)["used"] == MOST_MESSAGES
    assert counts(receiver)["dropped"] == 4 * 1500 + 3 - MOST_MESSAGES
    assert len(receiver._state._waiting) == 1
    assert show(receiver, frame(A=1.0))["jaw_open"] > 0.3


def test_over_a_socket_and_in_the_status():
    face = Face(head_model())
    with (
        VmcReceiver(face, "127.0.0.1", 0) as receiver,
        socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as tracker,
    ):
        face.reports["vmc_in"] = lambda: receiver.status
        whole = frame(
            *[bone(name) for name in BODY * 8], *[value(f"Shape{number}", 0.5) for number in range(300)], A=1.0
        )
        assert len(whole) > 8192

        def send():
            tracker.sendto(whole, ("127.0.0.1", receiver.port))
            time.sleep(0.01)
            receiver.take_in(0.0)

        until(lambda: receiver.status["frames"], send)
        face.step(0.05)
        told = json.loads(json.dumps(face.status()))
    assert told["vmc_in"]["driving"] is True
    assert told["vmc_in"]["from"] == f"127.0.0.1:{receiver.port}"
    assert told["drivers"]["tracker"]
    assert told["errors"] == {"malformed": 0, "unknown": 0, "rejected": 0}


def test_a_taken_port_is_one_clear_error():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as taken:
        taken.bind(("127.0.0.1", 0))
        port = taken.getsockname()[1]
        with pytest.raises(ServerError, match=f"VMC receiver: expected port {port} .* with --vmc-in HOST:PORT"):
            VmcReceiver(Face(head_model()), "127.0.0.1", port)


def test_it_needs_no_quaternion_of_length_one(receiver):
    assert show(receiver, bone("Head", *(3.0 * part for part in turned((0, -1, 0), 20.0))))[
        "head_yaw"
    ] == pytest.approx(math.radians(20.0), abs=1e-5)
