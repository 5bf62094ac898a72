"""A mirrored pose makes the mirrored face."""

import numpy as np
import pytest

from agentface.parameters import NAMES, PARAMETERS, FacePose, indices_of
from tests.deform.conflicts import random_poses
from tests.heads import deformer_of, head_model

TURNED = [known.name for known in PARAMETERS if known.sideways]


def image(pose):
    """The pose with left and right exchanged."""
    values = pose.array.copy()
    for name in NAMES:
        if name.endswith("_l"):
            left, right = indices_of(name[:-2])
            values[[left, right]] = pose.array[[right, left]]
    for name in TURNED:
        values[indices_of(name)[0]] *= -1
    return FacePose(values)


@pytest.mark.slow
@pytest.mark.parametrize("compiled", [True, False])
@pytest.mark.parametrize("face", ["amber", "onyx"])
def test_a_mirrored_pose_makes_the_mirrored_face(face, compiled):
    model = head_model(face)
    deformer = deformer_of(face, compiled=compiled)
    flip = np.array([-1, 1, 1])
    for pose in random_poses(200 if compiled else 6, seed=11):
        one = deformer.at(pose)
        vertices, eyes, jaw, head, heights = (
            array.copy() for array in (one.vertices, one.eye_rotations, one.jaw, one.head, one.wrinkles)
        )
        other = deformer.at(image(pose))
        np.testing.assert_allclose(other.vertices[model.mirror] * flip, vertices, atol=1e-5, rtol=0)
        np.testing.assert_allclose(other.wrinkles[model.mirror], heights, atol=1e-5, rtol=0)
        turned = np.outer(flip, flip)
        np.testing.assert_allclose(other.eye_rotations[::-1] * turned, eyes, atol=1e-5)
        np.testing.assert_allclose(other.jaw[:3, :3] * turned, jaw[:3, :3], atol=1e-6)
        np.testing.assert_allclose(other.jaw[:3, 3] * flip, jaw[:3, 3], atol=1e-6)
        np.testing.assert_allclose(other.head[:3, :3] * turned, head[:3, :3], atol=1e-5)
        np.testing.assert_allclose(other.head[:3, 3] * flip, head[:3, 3], atol=1e-5)


def test_the_mirror_of_the_mirror_is_the_pose():
    for pose in random_poses(20, seed=3):
        np.testing.assert_array_equal(image(image(pose)).array, pose.array)
        assert not np.array_equal(image(pose).array, pose.array)
