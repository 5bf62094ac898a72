"""What moves the skin by a shape: twins, the artists' shapes, the jaw's turn, shared muscles, mirror images."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from agentface.deform import morphs, morphs_compiled, tables
from agentface.deform.finish import teeth
from agentface.parameters import COUNT, HIGH, LOW, PARAMETERS, FacePose, indices_of
from tests.heads import deformer_of, head_model

FACES = ("amber", "onyx")
MORPHED = [known for known in PARAMETERS if known.morphs]
FRACTIONS = st.lists(st.floats(0, 1), min_size=COUNT, max_size=COUNT)


def posed(**values):
    return FacePose().replace(values).array


def moved(face, values, kernels=morphs):
    """``(V, 3)`` m: what the morphs alone do to the skin at rest."""
    model = head_model(face)
    points = model.vertices.copy()
    kernels.apply(tables.of(model).skin.morphs, values, points)
    return points - model.vertices


@settings(max_examples=20)
@given(FRACTIONS)
def test_the_twins_agree(fractions):
    values = (LOW + (HIGH - LOW) * np.array(fractions)).astype(np.float32)
    for face in FACES:
        np.testing.assert_allclose(moved(face, values), moved(face, values, morphs_compiled), atol=2e-7)


@pytest.mark.parametrize("face", FACES)
@pytest.mark.parametrize("known", MORPHED, ids=lambda known: known.name)
def test_each_moves_skin_at_both_ends_in_proportion(face, known):
    for end in {known.low, known.high} - {0.0}:
        whole = moved(face, posed(**{known.name: end}))
        assert 0.0005 < np.linalg.norm(whole, axis=1).max() < 0.015
        np.testing.assert_allclose(moved(face, posed(**{known.name: 0.5 * end})), 0.5 * whole, atol=1e-6)


@pytest.mark.parametrize("face", FACES)
@pytest.mark.parametrize("known", [known for known in MORPHED if known.partner], ids=lambda known: known.name)
def test_a_side_leaves_the_other_alone(face, known):
    other = np.sign(head_model(face).vertices[:, 0]) == (-1 if known.name.endswith("_l") else 1)
    far = other & (np.abs(head_model(face).vertices[:, 0]) > 0.02)
    assert np.abs(moved(face, posed(**{known.name: known.high}))[far]).max() < 8e-4


@pytest.mark.parametrize("face", FACES)
@pytest.mark.parametrize("known", MORPHED, ids=lambda known: known.name)
def test_the_image_of_a_morph_is_that_of_its_image(face, known):
    model = head_model(face)
    pose = FacePose().replace({known.name: known.high, "jaw_open": 0.3})
    one, other = (deformer_of(face).at(shown).vertices for shown in (pose, pose.mirrored()))
    np.testing.assert_allclose(one[model.mirror] * [-1, 1, 1], other, atol=1e-5)


@pytest.mark.parametrize("face", FACES)
def test_halves_of_the_lips_are_the_artists_whole(face):
    model = head_model(face)
    whole = moved(face, posed(orbicularis_oris_funnel_upper=1.0, orbicularis_oris_funnel_lower=1.0))
    shape = model.shapes["mouthFunnel"].dense(len(model.vertices))
    lips = model.material[:, 0] > 0.5
    part = model.morphs_file.morphs["orbicularis_oris_funnel_upper"].high.shapes["mouthFunnel"]
    np.testing.assert_allclose(whole[lips], part * shape[lips], atol=2e-5)
    lower = moved(face, posed(orbicularis_oris_funnel_lower=1.0))
    middle = [ring.upper[len(ring.upper) // 2] for ring in model.lips.rings]
    assert not lower[middle].any()


@pytest.mark.parametrize("face", FACES)
def test_a_half_of_a_lip_is_one_muscle(face):
    """Press and funnel in full share it, and what the whole muscle puckers it does not have for its halves."""
    press, funnel = "orbicularis_oris_press_upper_l", "orbicularis_oris_funnel_upper_l"
    one, other = moved(face, posed(**{press: 1.0})), moved(face, posed(**{funnel: 1.0}))
    np.testing.assert_allclose(moved(face, posed(**{press: 1.0, funnel: 1.0})), 0.5 * (one + other), atol=2e-7)
    puckered = moved(face, posed(**{press: 1.0, "orbicularis_oris_pucker": 0.7}))
    np.testing.assert_allclose(puckered, 0.3 * one, atol=2e-7)
    assert not moved(face, posed(**{press: 1.0, "orbicularis_oris_pucker": 1.0})).any()
    beside = moved(face, posed(**{press: 0.5, "orbicularis_oris_funnel_lower_r": 1.0}))
    far = head_model(face).vertices[:, 0] > 0.02
    np.testing.assert_allclose(beside[far], 0.5 * one[far], atol=2e-4)


@pytest.mark.parametrize("face", FACES)
@pytest.mark.parametrize(("name", "axis"), [("jaw_thrust", 2), ("jaw_shift", 0)])
@pytest.mark.parametrize("opening", [0.0, 0.4])
def test_the_teeth_go_with_the_chin(face, name, axis, opening):
    """In the jaw's own frame, whatever its turn: what the chin's skin does the bone does."""
    model, deformer = head_model(face), deformer_of(face)
    chin = int(np.linalg.norm(model.vertices - model.landmarks["pogonion"], axis=1).argmin())
    before, after = (deformer.at(FacePose.of(jaw_open=opening).replace({name: value})) for value in (0.0, 1.0))
    unmoved = np.linalg.inv(before.jaw.astype(np.float64)) @ after.jaw
    np.testing.assert_allclose(unmoved[:3, :3], np.eye(3), atol=1e-6)
    skin = before.jaw[:3, :3].T @ (after.vertices[chin] - before.vertices[chin])
    assert unmoved[axis, 3] == pytest.approx(skin[axis], abs=4e-4)
    assert abs(unmoved[axis, 3]) > 0.004


def test_a_jaw_that_slides_back_carries_the_teeth_back():
    model = head_model()
    out = np.zeros((4, 4), np.float32)
    teeth.apply(teeth.prepare(model), posed(jaw_thrust=-1.0), out)
    assert -0.004 < out[2, 3] < -0.001


def test_lids_are_not_drawn_off_the_eye():
    model = head_model()
    margin = model.material[:, 2] > 0.5
    for known in MORPHED:
        assert not moved("amber", posed(**{known.name: known.high}))[margin].any()


def test_indices_are_those_of_the_table():
    kept = tables.of(head_model()).skin.morphs
    assert set(kept.parameters.tolist()) == {known.index for known in MORPHED}
    assert kept.whole.tolist() == [indices_of(f"orbicularis_oris_{name}")[0] for name in ("pucker", "press")]
