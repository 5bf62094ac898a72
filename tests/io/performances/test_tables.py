"""The tables of OpenFace, py-feat and Live Link Face."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from agentface.arkit.stream import ANGLES, ArkitStream
from agentface.deform.eyes import eyeballs
from agentface.deform.finish import head_turn
from agentface.errors import DataError, InvalidValueError
from agentface.head.arkit import ARKIT_SHAPES
from agentface.io.performances import camera
from agentface.io.performances.live_link import read_live_link, write_live_link
from agentface.io.performances.openface import read_openface, write_openface
from agentface.io.performances.py_feat import read_py_feat
from agentface.io.performances.unit_stream import ActionUnitStream
from agentface.parameters import FacePose
from tests.heads import head_model
from tests.io.performances.conftest import PY_FEAT, some_stream, some_weights

# As OpenFace 2 writes it: a blank after each comma of the first line, none in the others.
OPENFACE = """frame, face_id, timestamp, confidence, success, gaze_angle_x, gaze_angle_y, \
pose_Tx, pose_Rx, pose_Ry, pose_Rz, AU01_r, AU12_r, AU45_r, AU12_c
1,0,0.0,0.98,1,0.000,0.000,3.1,0.0,0.0,0.0,0.00,0.00,0.00,0.00
2,0,0.033,0.98,1,0.1,-0.2,3.1,0.1,-0.3,0.2,5.00,2.50,1.00,1.00
3,0,0.067,0.98,0,0.1,-0.2,3.1,0.1,-0.3,0.2,5.00,2.50,1.00,1.00
4,0,0.1,0.2,1,0.1,-0.2,3.1,0.1,-0.3,0.2,5.00,2.50,1.00,1.00
5,1,0.11,0.98,1,0.1,-0.2,3.1,0.1,-0.3,0.2,5.00,2.50,1.00,1.00
6,0,0.133,0.98,1,0.0,0.0,3.1,0.0,0.0,0.0,6.00,1.25,0.00,1.00
"""


def lines(text):
    return text.splitlines()


def test_openface_intensities_are_of_five_and_rows_without_a_face_are_left_out():
    stream = read_openface(lines(OPENFACE), "a/talk.csv")
    assert stream.units == (1, 12, 45)
    assert stream.times_s.tolist() == [0.0, 0.033, 0.133]
    assert stream.intensities.tolist() == [[0, 0, 0], [1, 0.5, np.float32(0.2)], [1, 0.25, 0]]
    assert stream.name == "talk"
    assert [str(note) for note in stream.notes] == [
        "a/talk.csv:4: expected a face that was found (success), got none, left out, in 1 row",
        "a/talk.csv:5: expected a confidence of at least 0.5, got less, left out, in 1 row",
        "a/talk.csv:6: expected the face '0', the first of the file, got another, left out, in 1 row",
        "a/talk.csv:7: expected intensities in 0..5, got others, brought into it, in 1 row",
    ]


def turned_as_seen(x=0.0, y=0.0, z=0.0):
    return camera.head_angles(camera.head_rotation(np.array([[x, y, z]])))[0]


def test_what_a_camera_sees_is_turned_as_the_person_does():
    """In the picture a person's left is right; a head that turns, looks or tilts goes there as its nose does."""
    assert turned_as_seen(y=-0.3) == pytest.approx([0.3, 0, 0]), "the nose goes right in the picture: to its left"
    assert turned_as_seen(x=0.3) == pytest.approx([0, -0.3, 0]), "the nose goes down"
    assert turned_as_seen(z=0.3) == pytest.approx([0, 0, 0.3]), "the top goes right in the picture: to its left"
    straight = np.eye(3)[None]
    assert camera.gaze_angles(np.array([[0.3, 0, -1.0]]), straight)[0] == pytest.approx([math.atan(0.3), 0])
    assert camera.gaze_angles(np.array([[0, -0.3, -1.0]]), straight)[0] == pytest.approx([0, math.atan(0.3)])


ANGLE = st.floats(-0.9, 0.9)


@given(ANGLE, ANGLE, ANGLE)
def test_angles_of_the_head_are_those_by_which_the_face_turns(yaw, pitch, roll):
    tables = head_turn.prepare(head_model())
    transform = np.zeros((4, 4), np.float32)
    head_turn.apply(tables, FacePose.of(head_yaw=yaw, head_pitch=pitch, head_roll=0.9 * roll).array, transform)
    angles = np.array([[yaw, pitch, 0.9 * roll]])
    np.testing.assert_allclose(camera.turned_head(angles)[0], transform[:3, :3], atol=1e-5)
    np.testing.assert_allclose(camera.head_angles(transform[None, :3, :3].astype(float)), angles, atol=1e-5)
    seen = camera.camera_rotations(camera.turned_head(angles))
    np.testing.assert_allclose(camera.head_rotation(seen), camera.turned_head(angles), atol=1e-9)


@given(st.floats(-0.3, 0.3), st.floats(-0.2, 0.2), ANGLE, ANGLE)
def test_angles_of_the_eyes_are_those_by_which_the_face_looks(yaw, pitch, head_yaw, head_pitch):
    rotations = np.zeros((2, 3, 3), np.float32)
    eyeballs.apply(eyeballs.prepare(head_model()), FacePose.of(gaze_yaw=yaw, gaze_pitch=pitch).array, rotations)
    head = camera.turned_head(np.array([[head_yaw, head_pitch, 0.1]]))
    seen = camera.seen_directions(np.array([[yaw, pitch]]), head)
    np.testing.assert_allclose(seen[0] * [1, -1, -1], head[0] @ rotations[0] @ [0, 0, 1], atol=1e-5)
    np.testing.assert_allclose(camera.gaze_angles(seen, head), [[yaw, pitch]], atol=1e-6)


def test_gaze_is_that_of_the_eyes_in_the_head():
    """Who turns the head and still looks into the camera, turns the eyes back."""
    text = OPENFACE.splitlines()[0] + "\n1,0,0,1,1,0,0,0,0,-0.3,0,0,0,0,0\n"
    stream = read_openface(lines(text))
    assert stream.head[0] == pytest.approx([0.3, 0, 0])
    assert stream.gaze[0] == pytest.approx([-0.3, 0])


def test_directions_of_both_eyes_do_for_angles():
    text = (
        "timestamp,gaze_0_x,gaze_0_y,gaze_0_z,gaze_1_x,gaze_1_y,gaze_1_z,AU12_r\n"
        "0,0.2,0,-1,0.0,0,-1,0\n"
    )  # fmt: skip
    assert read_openface(lines(text)).gaze[0] == pytest.approx([math.atan(0.1), 0], abs=1e-6)


def test_openface_tables_come_back():
    stream = some_stream(7)
    again = read_openface(lines(write_openface(stream)))
    assert again.units == stream.units
    for name in ("times_s", "intensities", "head", "gaze"):
        np.testing.assert_allclose(getattr(again, name), getattr(stream, name), atol=2e-6)


def test_a_table_plays_with_head_and_gaze():
    played = read_openface(lines(OPENFACE)).performance()
    assert {"head_yaw", "gaze_pitch", "zygomaticus_major_l", "orbicularis_oculi_palpebralis_r"} <= {*played.moved}
    assert "jaw_open" not in played.moved


BAD = [
    ("", None, "an empty file"),
    ("frame,AU12_r\n1,0\n", 1, "timestamp: expected a column of this name, got none"),
    ("timestamp,AU12_c\n0,1\n", 1, "a column of an action unit"),
    ("timestamp,AU99_r\n0,1\n", 1, "a column of an action unit"),
    ("timestamp,AU12_r\n", None, "at least one frame, got none"),
    ("timestamp,success,AU12_r\n0,0,1\n", None, "at least one frame, got none"),
    ("timestamp,AU12_r\n0,1\n0,1\n", 3, "a time after that of the row before, 0 s, got 0 s"),
    ("timestamp,AU12_r\n1,1\n0.5,1\n", 3, "a time after that of the row before, 1 s, got 0.5 s"),
    ("timestamp,AU12_r\n-1,1\n", 2, "a time in 0.."),
    ("timestamp,AU12_r\n0,nan\n", 2, "AU12_r: expected a finite number, got 'nan'"),
    ("timestamp,AU12_r\n0,1e999\n", 2, "AU12_r: expected a finite number"),
    ("timestamp,AU12_r\n0,1_0\n", 2, "AU12_r: expected a finite number"),
    ("timestamp,AU12_r\n0,\n", 2, "AU12_r: expected a finite number, got ''"),
    ("timestamp,AU12_r\n0\n", 2, "2 fields, as the first line names, got 1"),
    ("timestamp,AU12_r\n0,1,2\n", 2, "2 fields, as the first line names, got 3"),
    ("timestamp,AU12_r\n0,1\n0.1,", 3, "AU12_r: expected a finite number"),
    ('timestamp,AU12_r\n0,"1\n', 2, None),
]  # fmt: skip


@pytest.mark.parametrize(("text", "line", "message"), BAD)
def test_every_fault_of_a_table_is_told_with_its_line(text, line, message):
    if message is None:  # a quote that is never closed ends with the line
        assert len(read_openface(lines(text))) == 1
        return
    with pytest.raises(DataError) as caught:
        read_openface(lines(text), "a.csv")
    fault = caught.value.faults[0]
    assert message in str(fault)
    assert fault.line == line


def test_faults_are_told_together_but_not_without_end():
    text = "timestamp,AU12_r\n" + "".join(f"{row},x\n" for row in range(1000))
    with pytest.raises(DataError) as caught:
        read_openface(lines(text))
    assert [fault.line for fault in caught.value.faults] == [*range(2, 22)]


def test_py_feat_has_degrees_and_fractions_and_a_rate_from_outside():
    stream = read_py_feat(lines(PY_FEAT), "a/news.csv", rate_hz=25.0)
    assert stream.units == (1, 12, 43)
    assert stream.times_s.tolist() == [0.0, 0.04]
    assert stream.intensities.tolist() == [[0.25, 0.5, 0], [0.5, 0.75, 0]]
    assert np.rad2deg(stream.head[0]) == pytest.approx([-10.0, -3.5, 2.0])
    assert stream.gaze is None


def test_newer_py_feat_has_radians_and_the_place_of_the_head():
    text = "FaceScore,Pitch,Roll,Yaw,X,Y,Z,AU12,frame\n0.99,0.1,0.2,-0.3,0,0,5,0.5,7\n"
    assert read_py_feat(lines(text)).head[0] == pytest.approx([0.3, 0.1, 0.2])


def test_py_feat_rows_without_a_face_or_with_a_second_one_are_left_out():
    head, first, second = PY_FEAT.splitlines()
    unsure = second.replace("0.99", "0.3")[:-1] + "2"
    text = [head, first, first, second, unsure, "," * 10 + "2"]
    stream = read_py_feat(text)
    assert len(stream) == 2
    assert [note.line for note in stream.notes] == [3, 5, 6]


def rows_of(*codes, values=None):
    text = write_live_link(some_weights(len(codes))).splitlines()
    for place, code in enumerate(codes, start=1):
        fields = text[place].split(",")
        text[place] = ",".join([code, *(values or fields[1:])])
    return text


def test_live_link_tables_come_back():
    stream = some_weights(200)
    again = read_live_link(lines(write_live_link(stream)))
    np.testing.assert_allclose(again.times_s, stream.times_s, atol=1e-4)
    np.testing.assert_array_equal(again.weights, stream.weights)
    np.testing.assert_array_equal(again.angles, stream.angles)
    assert again.rate_hz == 60.0
    assert len(lines(write_live_link(stream))[0].split(",")) == 63


@pytest.mark.parametrize(
    ("codes", "rate", "times"),
    [
        (["10:00:00:00.000", "10:00:00:30.500", "10:00:01:59.000"], 60, [0, 30.5 / 60, 1 + 59 / 60]),
        (["10:00:00:00.0", "10:00:00:29", "10:00:01:00"], 30, [0, 29 / 30, 1]),
        (["10:00:00:00", "10:00:00:23", "10:00:01:01"], 24, [0, 23 / 24, 1 + 1 / 24]),
        (["10:00:00:03", "10:00:00:12"], 60, [0, 9 / 60]),
        (["23:59:59:58.5", "00:00:00:01.5"], 60, [0, 3 / 60]),
        (["1:2:3:110", "1:2:4:0"], 120, [0, 10 / 120]),
    ],
)
def test_the_timecode_counts_frames_of_a_second(codes, rate, times):
    stream = read_live_link(rows_of(*codes))
    assert stream.rate_hz == rate
    assert stream.times_s == pytest.approx(times, abs=1e-9)


def test_a_rate_that_is_given_counts():
    stream = read_live_link(rows_of("0:0:0:3", "0:0:0:12"), rate_hz=30.0)
    assert stream.times_s.tolist() == pytest.approx([0, 9 / 30])


def test_dropped_frames_are_left_out_and_told():
    text = rows_of("0:0:0:0", "0:0:0:1", "0:0:0:2", "0:0:0:2")
    text[2] = "0:0:0:1,0" + "," * 61
    stream = read_live_link(text)
    assert stream.times_s.tolist() == pytest.approx([0, 2 / 60])
    assert [(note.line, note.expected) for note in stream.notes] == [
        (3, "a frame with values"),
        (5, "each timecode once"),
    ]


def test_columns_may_stand_in_any_order_in_any_letters_and_without_angles():
    text = [line.split(",")[:54] for line in write_live_link(some_weights()).splitlines()]
    mixed = [",".join(reversed(fields)) for fields in text]
    mixed[0] = mixed[0].lower()
    stream = read_live_link(mixed)
    np.testing.assert_array_equal(stream.weights, some_weights().weights)
    assert not stream.angles.any()


@pytest.mark.parametrize(
    ("text", "line", "message"),
    [
        (rows_of("0:0:0"), 2, "Timecode: expected HH:MM:SS:FF.fff, got '0:0:0'"),
        (rows_of("0:99:0:0"), 2, "Timecode: expected HH:MM:SS:FF.fff"),
        (rows_of("0:0:0:5", "0:0:0:4"), 3, "a time after that of the row before"),
        (rows_of("0:0:0:5", values=["61", *["nan"] * 61]), None, "at least one frame"),
        (rows_of("0:0:0:5", values=["61", *["x"] * 61]), 2, "eyeBlinkLeft: expected a finite number"),
        ([line.replace("TongueOut", "Tongue") for line in rows_of("0:0:0:5")], 1, "tongueOut: expected a column"),
    ],
)
def test_every_fault_of_a_live_link_table_is_told(text, line, message):
    with pytest.raises(DataError) as caught:
        read_live_link(text, "take.csv")
    fault = caught.value.faults[0]
    assert message.lower() in str(fault).lower()
    assert fault.line == line


def test_what_is_no_stream_of_weights_is_refused():
    good = {"times_s": [0, 1], "weights": np.zeros((2, len(ARKIT_SHAPES))), "angles": np.zeros((2, len(ANGLES)))}
    assert len(ArkitStream(**good)) == 2
    for wrong in (
        {"times_s": []},
        {"times_s": [1, 1]},
        {"times_s": [-1, 1]},
        {"weights": np.ones((2, 51))},
        {"weights": np.full((2, 52), 1.5)},
        {"angles": np.full((2, 9), np.nan)},
    ):
        with pytest.raises(InvalidValueError):
            ArkitStream(**(good | wrong))


def test_a_stream_without_head_and_eyes_is_written_without_them():
    stream = ActionUnitStream(np.array([0.0]), (12,), np.ones((1, 1), np.float32))
    text = write_openface(stream)
    assert "pose" not in text
    assert "gaze" not in text
    assert read_openface(lines(text)).head is None
