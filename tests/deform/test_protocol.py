from __future__ import annotations

import numpy as np
import pytest

from agentface import Face
from agentface.deform.crowd import Crowd
from agentface.deform.pipeline import GeometricDeformer
from agentface.deform.protocol import deformer_names, make_deformer, register
from agentface.errors import InvalidValueError, UnknownNameError
from agentface.parameters import FacePose
from tests.deform import jelly
from tests.heads import head_model

SMILE = FacePose.of(zygomaticus_major=1.0)


def test_the_geometric_face_is_found_by_name():
    assert deformer_names()[0] == "geometric"
    assert isinstance(make_deformer("geometric", head_model(), compiled=False), GeometricDeformer)
    with pytest.raises(UnknownNameError, match="known: geometric"):
        make_deformer("jelly", head_model())


def test_a_name_is_taken_once_and_given_back():
    before = deformer_names()
    with jelly.registered() as name:
        assert deformer_names() == (*before, name)
        with pytest.raises(InvalidValueError, match=r"taken: geometric, .*jelly"):
            register(name, jelly.Jelly)
    assert deformer_names() == before
    with pytest.raises(InvalidValueError):
        register("geometric", jelly.Jelly)


def test_a_face_steps_a_deformer_with_memory_once_a_step():
    with jelly.registered() as name:
        face = Face(head_model(), deformer=name)
    rest = face.geometry.vertices.copy()
    face.set_muscle("zygomaticus_major", 1.0, fade=0.0)
    still = face.geometry.vertices.copy()
    ways = []
    for _ in range(4):
        geometry = face.step(jelly.LATE_S)
        assert face.geometry is geometry
        ways.append(float(np.linalg.norm(geometry.vertices - rest) / np.linalg.norm(still - rest)))
    np.testing.assert_allclose(ways, 1.0 - np.exp(-np.arange(1.0, 5.0)), rtol=1e-3)


@pytest.mark.gl
def test_pictures_do_not_step_it():
    with jelly.registered() as name:
        face = Face(head_model(), deformer=name)
    face.set_muscle("jaw_open", 1.0, fade=0.0)
    before = face.step(0.02).copy()
    pictures = [face.render((64, 48)) for _ in range(2)]
    np.testing.assert_array_equal(*pictures)
    face.render((64, 48), pose=SMILE)
    assert face.geometry == before


def test_a_crowd_of_any_deformer_is_what_each_makes_of_its_pose():
    poses = [FacePose(), SMILE, FacePose.of(jaw_open=0.5)]
    with jelly.registered() as name:
        crowd = Crowd(head_model(), threads=2, deformer=name)
    geometry, expected = crowd.deform(poses), make_deformer("geometric", head_model())
    for index, pose in enumerate(poses):
        assert geometry[index] == expected.at(pose)


def test_a_crowd_without_compiled_kernels_is_the_same():
    poses = [SMILE, FacePose.of(jaw_open=0.5)]
    with Crowd(head_model(), compiled=False) as crowd:
        plain = crowd.deform(poses)
        fast = Crowd(head_model()).deform(poses)
    np.testing.assert_allclose(plain.vertices, fast.vertices, atol=1e-6)
