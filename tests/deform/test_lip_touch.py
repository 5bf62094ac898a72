"""What speech has the lips touch: each other and the upper teeth, whatever else moves them."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from agentface.deform.mouth import contact
from agentface.deform.mouth import contact_compiled as compiled
from agentface.deform.mouth.dental_arch import fit_arch, fit_crowns
from agentface.emotion.inference import default_inference
from agentface.emotion.state import EMOTIONS, EmotionState
from agentface.parameters import HIGH, LOW, PARAMETERS, FacePose, indices_of
from agentface.studies.mouth_ruler import MouthRuler
from tests.deform.test_contact import Mouth
from tests.heads import deformer_of, head_model

FACES = ("amber", "onyx")
FEELINGS = ("neutral", *EMOTIONS)
RULERS = {face: MouthRuler(head_model(face)) for face in FACES}
JAW, SEAL, BITE = (indices_of(name)[0] for name in ("jaw_open", "lip_seal", "lip_bite"))


@pytest.fixture(params=FACES)
def face(request):
    return request.param


def felt(feeling, **more):
    state = EmotionState() if feeling == "neutral" else EmotionState.of({feeling: 1.0})
    return default_inference().pose(state).replace(more)


def measured(face, pose):
    return RULERS[face].measure(deformer_of(face).at(pose), bite=True)


@pytest.mark.parametrize("feeling", FEELINGS)
def test_sealed_lips_are_shut_whatever_is_felt(face, feeling):
    for jaw in (0.0, 0.05, 0.1):
        open_mouth = felt(feeling, jaw_open=jaw)
        assert measured(face, open_mouth.replace({"lip_seal": 1.0})).gap <= (0.25 if feeling == "disgust" else 0.15)
    assert measured(face, felt("anger", jaw_open=0.1)).gap > 5.0, "there is something to close"


@pytest.mark.parametrize("feeling", FEELINGS)
def test_a_bitten_lip_touches_the_upper_teeth_whatever_is_felt(face, feeling):
    for jaw in (0.0, 0.05, 0.1):
        pose = felt(feeling, jaw_open=jaw, orbicularis_oris_roll_lower=0.6)
        assert measured(face, pose.replace({"lip_bite": 1.0})).bite <= 0.5
    assert measured(face, felt("neutral", orbicularis_oris_roll_lower=0.6)).bite > 1.5, "there is a way to go"


@pytest.mark.parametrize("feeling", ["neutral", "happiness", "fear"])
@pytest.mark.parametrize(("name", "read"), [("lip_seal", "gap"), ("lip_bite", "bite")])
def test_more_of_it_is_nearer(face, feeling, name, read):
    poses = [felt(feeling, jaw_open=0.1, **{name: level}) for level in np.linspace(0.0, 1.0, 11)]
    distances = np.array([getattr(measured(face, pose), read) for pose in poses])
    assert (np.diff(distances) < 0.02).all(), distances
    assert distances[-1] < 0.4 * distances[0]


@pytest.mark.parametrize("feeling", ["neutral", "anger", "disgust"])
def test_a_seal_takes_its_share_of_the_gap(face, feeling):
    whole = measured(face, felt(feeling, jaw_open=0.1)).gap
    for level in (0.25, 0.5, 0.75):
        left = measured(face, felt(feeling, jaw_open=0.1, lip_seal=level)).gap
        assert left == pytest.approx((1.0 - level) * whole, abs=0.06 * whole)


def test_the_lower_lip_goes_more_of_the_way(face):
    wide = deformer_of(face).at(FacePose.of(jaw_open=0.2)).vertices
    shut = deformer_of(face).at(FacePose.of(jaw_open=0.2, lip_seal=1.0)).vertices
    table, up = RULERS[face]._contact, (shut - wide)[..., 1]
    sunk, raised = (up[table.grid[table.seam, columns[5:-5]]].mean() for columns in (table.upper, table.lower))
    assert sunk < -1e-3
    assert raised > -1.05 * sunk


def test_nothing_else_than_lips_moves(face):
    model = head_model(face)
    touched = {int(vertex) for vertex in RULERS[face]._contact.grid.ravel()}
    plain = deformer_of(face, compiled=False)
    for name in ("lip_seal", "lip_bite"):
        pose = FacePose.of(jaw_open=0.1)
        moved = plain.at(pose.replace({name: 1.0})).vertices - plain.at(pose).vertices
        far = np.linalg.norm(model.vertices - model.landmarks["lower_lip_middle"], axis=1) > 0.05
        assert not moved[far].any()
        assert len(touched & set(np.flatnonzero(np.abs(moved).max(axis=1) > 1e-3).tolist())) > 50


@settings(max_examples=20)
@given(st.floats(0, 1), st.floats(0, 1), st.floats(0, 1), st.floats(0, 5), st.integers(0, 10**6))
def test_compiled_and_numpy_agree(seal, bite, opening, size, seed):
    values = FacePose.of(jaw_open=opening, lip_seal=seal, lip_bite=bite).array
    for face in FACES:
        model, table = head_model(face), RULERS[face]._contact
        noise = np.random.default_rng(seed).standard_normal(model.vertices.shape)
        one = (model.vertices + 1e-3 * size * noise).astype(np.float32)
        other = one.copy()
        contact.apply(table, values, one)
        compiled.apply(table, values, other)
        np.testing.assert_allclose(one, other, atol=2e-7)


@pytest.mark.parametrize("feeling", ["neutral", "happiness", "disgust"])
def test_the_image_of_a_face_that_touches_is_the_same_on_the_other_side(face, feeling):
    model = head_model(face)
    for name in ("lip_seal", "lip_bite"):
        pose = felt(feeling, jaw_open=0.1, zygomaticus_major_l=0.8, zygomaticus_major_r=0.3, **{name: 0.8})
        one, other = (deformer_of(face).at(shown).vertices for shown in (pose, pose.mirrored()))
        np.testing.assert_allclose(other, one[model.mirror] * [-1, 1, 1], atol=2e-5)


@pytest.mark.slow
def test_lips_that_touch_pass_through_nothing(face):
    """Poses anywhere in their ranges: sealed, nowhere; bitten, an edge or two of a lip drawn wide cut into a crown."""
    mouth, deformer, rng = Mouth(head_model(face)), deformer_of(face), np.random.default_rng(11)
    cut = []
    for number in range(60):
        values = LOW + rng.random(len(LOW)) * (HIGH - LOW)
        values[[known.index for known in PARAMETERS if known.kind in ("head", "gaze")]] = 0.0
        bitten = number % 3 > 0
        values[[SEAL, BITE]] = [(1, 0), (0, 1), (1, 1)][number % 3]
        values[JAW] *= number % 2
        geometry = deformer.at(FacePose(values.astype(np.float32)))
        lips, above, below = mouth.crossings(geometry.vertices, geometry.jaw)
        assert (lips, below) == (0, 0), number
        assert bitten or above == 0, number
        cut.append(above)
    assert max(cut) <= 4
    assert np.count_nonzero(cut) <= 4


def test_crowns_lie_behind_the_arch_of_their_gum(face):
    model = head_model(face)
    for name in ("teeth_upper", "teeth_lower"):
        gum, crowns = fit_arch(model, name), fit_crowns(model, name)
        assert 1e-3 < gum.front - crowns.front < 5e-3
        places = model.parts[name].attributes["POSITION"].astype(np.float64)
        near = (np.abs(places[:, 1] - crowns.edge) < 1.5e-3) & (np.abs(places[:, 0]) < 13e-3)
        assert crowns.distance(places[near]).max() < 1e-5
        assert crowns.distance(places[near]).max() > -3e-4
