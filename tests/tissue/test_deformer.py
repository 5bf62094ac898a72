"""The tissue as a deformer: behind the same protocol as the geometric face, with memory, at any frame rate."""

from __future__ import annotations

import numpy as np
import pytest

from agentface.conventions import Floats
from agentface.deform.crowd import Crowd
from agentface.deform.pipeline import GeometricDeformer
from agentface.emotion.inference import default_inference
from agentface.errors import InvalidValueError
from agentface.face import Face
from agentface.head.model import HeadModel
from agentface.parameters import FacePose
from agentface.tissue import skin, skin_compiled
from agentface.tissue.deformer import TissueDeformer
from agentface.tissue.tables import TissueTables


@pytest.fixture(scope="module")
def deformer(model: HeadModel, tissue: TissueTables) -> TissueDeformer:
    return TissueDeformer(model)


@pytest.fixture(scope="module")
def smile() -> FacePose:
    return default_inference().pose({"happiness": 1.0})


def test_the_neutral_pose_is_the_geometric_face_s(model: HeadModel, deformer: TissueDeformer) -> None:
    told = GeometricDeformer(model).at(FacePose())
    found = deformer.at(FacePose())
    for one, other in zip(told.arrays(), found.arrays(), strict=True):
        assert np.allclose(one, other, atol=1e-6)


@pytest.mark.parametrize("pose", [FacePose.of(jaw_open=0.8), FacePose.of(orbicularis_oculi_palpebralis=1.0)])
def test_jaw_and_lids_are_the_geometric_face_s(model: HeadModel, deformer: TissueDeformer, pose: FacePose) -> None:
    told = GeometricDeformer(model).at(pose).vertices
    assert np.abs(told - deformer.at(pose).vertices).max() < 2e-4


def test_still_pictures_do_not_depend_on_what_came_before(deformer: TissueDeformer, smile: FacePose) -> None:
    first = deformer.at(smile)
    deformer.reset(FacePose())
    for _ in range(7):
        deformer.step(default_inference().pose({"anger": 1.0}), 1 / 30)
    assert deformer.at(smile) == first


def test_reset_stands_still_in_the_equilibrium(deformer: TissueDeformer, smile: FacePose) -> None:
    deformer.reset(smile)
    stepped = deformer.step(smile, 1 / 60).vertices
    assert np.abs(stepped - deformer.at(smile).vertices).max() < 2e-5


def test_frame_rates_agree_at_common_times(deformer: TissueDeformer, smile: FacePose) -> None:
    def journey(rate: int) -> list[Floats]:
        deformer.reset(FacePose())
        shown = []
        for frame in range(1, rate + 1):
            time = frame / rate
            target = FacePose(
                smile.array * np.float32(np.clip(time / 0.3, 0.0, 1.0) - np.clip((time - 0.6) / 0.2, 0, 1))
            )
            vertices = deformer.step(target, 1 / rate).vertices
            if frame % (rate // 6) == 0:
                shown.append(vertices.copy())
        return shown

    slow, usual, fast = (journey(rate) for rate in (30, 60, 144))
    for other in (slow, fast):
        for one, two in zip(usual, other, strict=True):
            assert np.linalg.norm(one - two, axis=1).max() < 3e-4


def test_what_is_asked_in_between_is_not_lost(deformer: TissueDeformer, smile: FacePose) -> None:
    deformer.reset(FacePose())
    deformer.step(smile, 0.0)
    assert np.abs(deformer.step(FacePose(), 0.0).vertices - deformer.at(FacePose()).vertices).max() < 1e-6


def test_a_parameter_out_of_range_is_refused(deformer: TissueDeformer) -> None:
    wrong = np.array(FacePose().array)
    wrong[0] = 2.0
    with pytest.raises(InvalidValueError, match="frontalis_medialis"):
        deformer.step(FacePose(wrong), 1 / 60)


def test_the_carried_skin_is_compiled_as_it_is_written(tissue: TissueTables) -> None:
    rng = np.random.default_rng(2)
    positions = tissue.columns.rest.copy()
    moving = len(tissue.columns.first) - 1
    positions[:moving] += rng.standard_normal(positions[:moving].shape).astype(np.float32)
    one, other = (np.empty_like(tissue.epidermis.rest) for _ in range(2))
    skin.put(tissue.epidermis, positions, one)
    skin_compiled.put(tissue.epidermis, positions, other)
    assert np.abs(one - other).max() < 1e-6


def test_a_crowd_is_each_face_s_equilibrium(model: HeadModel, deformer: TissueDeformer, smile: FacePose) -> None:
    poses = [smile, FacePose(), FacePose.of(mentalis=0.5)]
    with Crowd(model, threads=2, deformer="tissue") as crowd:
        faces = crowd.deform(poses)
        for index, pose in enumerate(poses):
            assert faces[index] == deformer.at(pose)


def test_a_face_of_tissue_takes_the_same_messages(model: HeadModel) -> None:
    with Face(model, deformer="tissue") as face:
        face.set_emotion("happiness", 1.0, fade=0.1)
        before = face.step(0.0).vertices.copy()
        for _ in range(40):
            shown = face.step(1 / 60).vertices
        assert 5e-3 < np.linalg.norm(shown - before, axis=1).max() < 4e-2
