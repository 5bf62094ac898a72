"""A face's own asymmetry: of its bones when it is loaded, of its muscles before the deformer; both can be off."""

import shutil

import numpy as np
import pytest

from agentface import Face
from agentface.errors import InvalidValueError
from agentface.head.asymmetry import gains_of, read_asymmetry
from agentface.head.model import load_model
from agentface.head.ring_names import LidRing
from agentface.head.volumes import read_volumes
from agentface.parameters import COUNT, indices_of
from agentface.resources import face_folder

FACES = ("amber", "onyx")


@pytest.fixture(scope="module", params=FACES)
def pair(request):
    return load_model(request.param, asymmetry=0.0), load_model(request.param)


def off_the_mirror(model):
    return np.linalg.norm(model.vertices[model.mirror] * [-1, 1, 1] - model.vertices, axis=1)


def test_without_it_a_face_is_its_own_mirror_image(pair):
    assert off_the_mirror(pair[0]).max() < 1e-6


def test_with_it_a_face_is_uneven_by_a_few_per_cent(pair):
    even, uneven = pair
    unit = even.landmarks.eye_separation
    apart = off_the_mirror(uneven)
    assert 0.01 * unit < apart.max() < 0.08 * unit
    assert np.linalg.norm(uneven.vertices - even.vertices, axis=1).max() < 0.06 * unit


def test_half_of_it_is_half_the_way():
    none, half, whole = (load_model("amber", asymmetry=part).vertices.astype(np.float64) for part in (0.0, 0.5, 1.0))
    np.testing.assert_allclose(half, 0.5 * (none + whole), atol=1e-7)


def test_it_is_smooth_and_no_expression_of_the_artists(pair):
    even, uneven = pair
    way = uneven.vertices.astype(np.float64) - even.vertices
    ends = np.concatenate([even.triangles[:, [i, (i + 1) % 3]] for i in range(3)])
    steps = np.linalg.norm(way[ends[:, 0]] - way[ends[:, 1]], axis=1)
    lengths = np.linalg.norm(even.vertices[ends[:, 0]] - even.vertices[ends[:, 1]], axis=1)
    assert (steps < 0.35 * lengths + 2e-5).all()
    assert "asymmetry" not in uneven.shapes


def test_eyes_teeth_and_tongue_go_along(pair):
    even, uneven = pair
    way = uneven.vertices - even.vertices
    for side in "lr":
        ring = even.eyelids.rings[side][LidRing.INNER_MARGIN]
        margin = way[ring.upper + ring.lower[1:-1]]
        eye = uneven.eye_centre(side) - even.eye_centre(side)
        np.testing.assert_allclose(margin, np.tile(eye, (len(margin), 1)), atol=5e-5)
    for name in ("teeth_upper", "teeth_lower", "tongue"):
        moves = uneven.parts[name].attributes["POSITION"] - even.parts[name].attributes["POSITION"]
        np.testing.assert_allclose(moves, np.tile(moves[0], (len(moves), 1)), atol=1e-7)


def test_each_face_is_uneven_in_its_own_way():
    amber, onyx = (read_asymmetry(face_folder(face) / "asymmetry.yaml").gains for face in FACES)
    assert amber != onyx
    assert all(0.8 <= gain < 1.0 for gains in (amber, onyx) for gain in gains.values())


def test_gains_fade_to_1_with_the_strength():
    file = read_asymmetry(face_folder("amber") / "asymmetry.yaml")
    assert (gains_of(file, 0.0) == 1.0).all()
    whole, half = gains_of(file, 1.0), gains_of(file, 0.5)
    assert whole.shape == (COUNT,)
    np.testing.assert_allclose(half, 0.5 + 0.5 * whole, rtol=1e-6)
    name, gain = next(iter(file.gains.items()))
    assert whole[indices_of(name)[0]] == pytest.approx(gain)


def test_an_emotion_is_lopsided_by_the_gains_and_a_pose_of_muscles_is_not():
    smiling, level = (Face("amber", asymmetry=part) for part in (1.0, 0.0))
    for face in (smiling, level):
        face.set_emotion({"happiness": 1.0})
        for _ in range(50):
            face.step(0.1)
    left, right = indices_of("zygomaticus_major")
    assert level.pose.array[left] == level.pose.array[right]
    ratio = smiling.pose.array[right] / smiling.pose.array[left]
    gains = smiling.model.gains
    assert ratio == pytest.approx(gains[right] / gains[left], rel=1e-3)
    assert ratio < 1.0


@pytest.mark.parametrize("strength", [-0.1, 1.1, float("nan"), "much"])
def test_a_strength_that_is_none_is_told(strength):
    with pytest.raises(InvalidValueError, match="asymmetry"):
        load_model("amber", asymmetry=strength)


def test_a_copy_of_a_face_keeps_its_own(tmp_path):
    copy = shutil.copytree(face_folder("onyx"), tmp_path / "mine")
    (copy / "asymmetry.yaml").write_text("gains: {}\n")
    assert (load_model(copy).gains == 1.0).all()
    assert read_volumes(copy / "volumes.yaml").volumes
