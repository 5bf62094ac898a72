"""Frames: what a page makes of them, beside what the engine made."""

from __future__ import annotations

import struct
from contextlib import contextmanager

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from agentface import Face, FacePose
from agentface.deform.crowd import Crowd
from agentface.errors import InvalidValueError
from agentface.head.model import load_model
from agentface.io.web import stage
from agentface.io.web.basis import SKIN_MODES, TONGUE_MODES, Basis
from agentface.io.web.frames import FRAME, FrameReader, FrameWriter, basis_layout, matrix_of, quaternions
from agentface.io.web.modes import ModeSet
from agentface.io.web.poses import natural_poses, random_mixtures
from agentface.io.web.unfinished import Unfinished, turn_of
from agentface.parameters import HIGH, LOW, parameter

MM = 1000.0


@pytest.fixture(scope="module")
def crowd(model):
    with Crowd(model) as crowd:
        yield crowd


@pytest.fixture(scope="module")
def poses(model):
    """Of every kind, the head turned."""
    rng = np.random.default_rng(5)
    mixed = random_mixtures(24, rng)
    for name in ("head_yaw", "head_pitch", "head_roll"):
        index = parameter(name).index
        mixed[:, index] = rng.uniform(LOW[index], HIGH[index], len(mixed))
    return np.concatenate([mixed, natural_poses(model, 24, rng, head=True)])


@pytest.fixture(scope="module")
def writer(model, basis):
    return FrameWriter(model, basis)


def off(decoded, geometry):
    """How far the vertices of skin and tongue are from the engine's, in mm."""
    _, skin, tongue = decoded
    errors = np.linalg.norm(skin - geometry.vertices, axis=1), np.linalg.norm(tongue - geometry.tongue, axis=1)
    return MM * np.concatenate(errors)


def test_the_last_stages_are_undone(model, crowd, poses):
    unfinished = Unfinished(model)
    straight = poses.copy()
    straight[:, [parameter(name).index for name in ("head_yaw", "head_pitch", "head_roll")]] = 0.0
    for pose, same in zip(poses, straight, strict=True):
        geometry = crowd.deform(pose[None])[0].copy()
        skin = unfinished.skin(geometry)
        back = unfinished.finished(skin, geometry.wrinkle_levels, geometry.head)
        np.testing.assert_allclose(back, geometry.vertices, atol=2e-6)
        np.testing.assert_allclose(skin, unfinished.skin(crowd.deform(same[None])[0]), atol=2e-6)


def test_many_faces_are_undone_at_once(model, crowd):
    poses = random_mixtures(5, np.random.default_rng(8))
    faces = crowd.deform(poses).copy()
    unfinished = Unfinished(model)
    for index, skin in enumerate(unfinished.skin(faces)):
        np.testing.assert_array_equal(skin, unfinished.skin(faces[index]))


def test_exact_frames_are_exact(model, basis, writer, crowd, poses):
    reader = FrameReader(model, basis, writer.layouts["exact"])
    for pose in poses:
        geometry = crowd.deform(pose[None])[0]
        assert off(reader.read(writer.write("exact", 1, 0.5, geometry)), geometry).max() <= 0.01


def test_a_frame_says_what_moves_as_a_whole(model, basis, writer, crowd, poses):
    for mode, turned in (("basis", 1e-4), ("exact", 1e-6)):
        reader = FrameReader(model, basis, writer.layouts[mode])
        for number, pose in enumerate(poses):
            geometry = crowd.deform(pose[None])[0]
            values, _, _ = reader.read(writer.write(mode, number, 0.25 * number, geometry))
            assert (values["frame"], values["time_s"]) == (number, 0.25 * number)
            for side in range(2):
                eye = matrix_of([*values["eyes"][4 * side :][:4], 0.0, 0.0, 0.0])[:3, :3]
                np.testing.assert_allclose(eye, geometry.eye_rotations[side], atol=turned)
            np.testing.assert_allclose(matrix_of(values["jaw"]), geometry.jaw, atol=turned)
            np.testing.assert_allclose(matrix_of(values["head"]), geometry.head, atol=turned)
            np.testing.assert_allclose(values["pupils"], geometry.pupils, atol=1e-4)
            np.testing.assert_allclose(values["eye_thrust"], geometry.eye_thrust, atol=1e-7)
            np.testing.assert_allclose(values["breath"], pose[parameter("breath").index], atol=0.5 / 255 + 1e-6)
            np.testing.assert_allclose(values["wrinkle_levels"], geometry.wrinkle_levels, atol=0.5 / 255 + 1e-6)


def test_a_basis_of_few_samples_is_near_already(model, basis, writer, crowd):
    reader = FrameReader(model, basis, writer.layouts["basis"])
    rest = crowd.deform(np.zeros((1, len(LOW))))[0]
    assert off(reader.read(writer.write("basis", 1, 0.0, rest)), rest).max() < 1e-3, (
        "at rest there is nothing to be off"
    )
    errors = []
    for pose in natural_poses(model, 12, np.random.default_rng(6), head=True):
        geometry = crowd.deform(pose[None])[0]
        errors.append(off(reader.read(writer.write("basis", 1, 0.0, geometry)), geometry))
    assert np.sqrt((np.array(errors) ** 2).mean()) < 0.3


def test_a_basis_of_fewer_samples_is_not_taken_for_a_full_one(monkeypatch):
    monkeypatch.setattr(stage, "make_basis", lambda model, deformer, samples, done: (deformer, samples))
    face = Face("onyx")
    for samples in ((1, 2), (3, 4)):
        monkeypatch.setattr(stage, "SAMPLES", samples)
        assert stage.basis_of(face, "geometric") == ("geometric", samples)


def test_who_waits_for_a_basis_is_told_how_much_of_it_is_done(monkeypatch):
    monkeypatch.setattr("agentface.head.model.prepared", lambda stamp, name, make: make())
    monkeypatch.setattr(stage, "SAMPLES", (71, 5))
    face, said, watched = Face("onyx"), [], []

    @contextmanager
    def watch(name):
        watched.append(name)
        yield watched.append
        watched.append("over")

    stage.basis_of(face, "geometric", said.append, watch)
    assert [line.partition(" ")[0] for line in said] == ["measuring", "measured"]
    assert (watched[0], watched[-2:]) == ("how onyx moves", [1.0, "over"])
    assert watched[1:-1] == sorted(watched[1:-1])


@pytest.mark.soak
@pytest.mark.parametrize(("name", "deformer", "count"), [("amber", "geometric", 300), ("onyx", "geometric", 150)])
def test_a_basis_is_true(name, deformer, count):
    face = Face(name, deformer=deformer)
    basis = stage.basis_of(face, deformer)
    writer = FrameWriter(face.model, basis)
    reader = FrameReader(face.model, basis, writer.layouts["basis"])
    rng = np.random.default_rng(77)
    with Crowd(face.model, deformer=deformer) as crowd:
        for poses in (random_mixtures(count, rng), natural_poses(face.model, count, rng, head=True)):
            errors = np.array([off(reader.read(writer.write("basis", 1, 0.0, one)), one) for one in each(crowd, poses)])
            assert np.sqrt((errors**2).mean()) <= 0.1
            assert np.quantile(errors, 0.999) <= 0.5


def each(crowd, poses):
    for pose in poses:
        yield crowd.deform(pose[None])[0]


@pytest.mark.parametrize("name", ["amber", "onyx"])
def test_a_second_is_at_most_twenty_kilobytes(name):
    few = Basis(
        *(
            ModeSet(np.zeros((count, 1, 3), np.int16), np.ones(count, np.float32))
            for count in (SKIN_MODES, TONGUE_MODES)
        )
    )
    header = 1 + 4  # the kind, and what a WebSocket puts before such a message
    assert 60 * (header + basis_layout(few, len(load_model(name).trains)).size) <= 20_000


@given(st.lists(st.floats(-1.0, 1.0), min_size=3, max_size=3), st.floats(-2.9, 2.9))
def test_turns_there_and_back(axis, angle):
    from scipy.spatial.transform import Rotation

    length = np.linalg.norm(axis)
    if length < 1e-3:
        return
    turn = Rotation.from_rotvec(np.array(axis) / length * angle)
    expected = turn.as_quat(canonical=True)
    np.testing.assert_allclose(quaternions(turn.as_matrix()[None])[0], expected, atol=1e-6)
    np.testing.assert_allclose(matrix_of([*expected, 1.0, 2.0, 3.0])[:3, :3], turn.as_matrix(), atol=1e-6)
    found, by = turn_of(turn.as_matrix().astype(np.float64))
    np.testing.assert_allclose(found * by, turn.as_rotvec(), atol=1e-6)


def test_a_frame_begins_with_its_kind_and_number(writer, crowd):
    message = writer.write("basis", 0x1_0000_0002, 1.5, crowd.deform([FacePose()])[0])
    assert struct.unpack_from("<BId", message) == (FRAME, 2, 1.5)


@given(st.binary(max_size=400))
def test_no_bytes_disturb_a_reader(model, basis, writer, message):
    reader = FrameReader(model, basis, writer.layouts["basis"])
    if len(message) != writer.layouts["basis"].size + 1 or message[0] != FRAME:
        with pytest.raises(InvalidValueError):
            reader.read(message)
