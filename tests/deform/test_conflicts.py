"""Two thousand random poses of the whole face: nothing flips, everything is finite; a tenth: nothing pokes through.

The rays that look for what pokes through take nine tenths of the time; ``make soak`` looks at a third of many more.
"""

from itertools import combinations

import numpy as np
import pytest

from agentface.deform.pipeline import GeometricDeformer
from agentface.emotion.inference import default_inference
from agentface.emotion.state import EMOTIONS, EmotionState
from agentface.head.ring_names import LidRing
from agentface.parameters import FacePose
from tests.deform.conflicts import Edges, Poking, fold_vertices, random_poses, ranges
from tests.heads import deformer_of, head_model

pytestmark = pytest.mark.untraced

COUNT, SEED = 2000, 2003
FACES = ("amber", "onyx")


@pytest.mark.slow
@pytest.mark.parametrize("face", FACES)
def test_random_poses(face):
    check_poses(face, SEED, poke_every=10)


@pytest.mark.soak
@pytest.mark.parametrize("seed", [SEED, *range(5)])
@pytest.mark.parametrize("face", FACES)
def test_twelve_thousand_random_poses(face, seed):
    check_poses(face, seed, poke_every=3)


def check_poses(face, seed, poke_every):
    model = head_model(face)
    deformer, edges, poking = deformer_of(face), Edges.of(model), Poking(model)
    outside = ~edges.folding()
    flipped, through = {}, {}
    for number, pose in enumerate(random_poses(COUNT, seed)):
        geometry = deformer.at(pose)
        for name in (
            "vertices",
            "normals",
            "wrinkles",
            "eye_rotations",
            "jaw",
            "head",
            "tongue",
            "pupils",
            "eye_thrust",
            "shoulders",
        ):
            assert np.isfinite(getattr(geometry, name)).all(), (number, name)
        over = np.flatnonzero(edges.flipped(geometry.vertices) & outside)
        if len(over):
            middle = model.vertices[edges.ends[over[0]]].mean(axis=0)
            flipped[number] = (len(over), np.round(1e3 * middle, 1).tolist())
        if number % poke_every == 0 and (parts := {part: n for part, n in poking.count(geometry).items() if n}):
            through[number] = parts
    assert not flipped, f"{len(flipped)} poses with skin turned over, such as (edges, mm): {list(flipped.items())[:5]}"
    assert not through, f"{len(through)} poses with something through the skin: {list(through.items())[:5]}"


def feelings():
    """Six emotions at four intensities, and two at a time in full."""
    infer = default_inference().pose
    for name in EMOTIONS:
        for intensity in (0.25, 0.5, 0.75, 1.0):
            yield f"{name} {intensity}", infer(EmotionState.of({name: intensity}))
    for one, other in combinations(EMOTIONS, 2):
        yield f"{one} and {other}", infer(EmotionState.of({one: 1.0, other: 1.0}))


def sparse(count, seed):
    """Poses of few parameters, each at its highest with a probability of 0.15, the others at nothing."""
    low, high = ranges()
    draw = np.random.default_rng(seed)
    for number in range(count):
        yield number, FacePose(np.where(draw.random(len(low)) < 0.15, high, np.maximum(low, 0.0)).astype(np.float32))


@pytest.mark.slow
@pytest.mark.parametrize("face", FACES)
def test_no_emotion_turns_skin_over(face):
    assert turned_over(face, feelings()) == {}


@pytest.mark.slow
@pytest.mark.parametrize("face", FACES)
def test_few_muscles_in_full_turn_skin_over_round_the_mouth_alone(face):
    """There press, funnel and roll meet zygomaticus and mentalis, which none of them knows; one in a hundred."""
    found = turned_over(face, sparse(400, 82))
    marks = head_model(face).landmarks
    near = [marks[name] for name in ("mouth_corner_l", "subnasale", "lower_lip_middle", "alare_l")]
    assert len(found) <= 4, found
    for places in found.values():
        away = np.abs(places)[:, None] - np.abs(near)
        assert (np.linalg.norm(away, axis=2).min(axis=1) < 0.02).all(), found


@pytest.mark.parametrize("face", FACES)
def test_the_brow_comes_down_on_an_eye_that_opens(face):
    brows = {"corrugator_supercilii": 1.0, "depressor_supercilii": 1.0}
    poses = {
        "AU 4": FacePose.of(**brows),
        "AU 4, one side": FacePose.of(corrugator_supercilii_l=1.0, depressor_supercilii_l=1.0),
        "AU 4 + 5": FacePose.of(corrugator_supercilii=1.0, levator_palpebrae=1.0),
        "AU 4 + 2": FacePose.of(corrugator_supercilii=1.0, frontalis_intermedius=1.0),
        "AU 12 + 24": FacePose.of(orbicularis_oris_press=1.0, zygomaticus_major=1.0),
    }
    assert turned_over(face, poses.items()) == {}


def turned_over(face, poses):
    """Where skin turns over outside the folds, metres at rest, by the names of those of ``poses`` in which it does."""
    model = head_model(face)
    deformer, edges = deformer_of(face), Edges.of(model)
    outside, found = ~edges.folding(), {}
    for name, pose in poses:
        over = edges.flipped(deformer.at(pose).vertices) & outside
        if over.any():
            found[name] = model.vertices[edges.ends[over]].mean(axis=1)
    return found


@pytest.mark.parametrize("face", FACES)
def test_little_is_left_out_as_a_fold(face):
    """The lips' red, the inside of the mouth and the lids with the crease above them, where the mesh is finest."""
    model = head_model(face)
    edges = Edges.of(model)
    assert 0.16 < edges.folding().mean() < 0.20
    assert fold_vertices(model).mean() < 0.21


@pytest.mark.slow
@pytest.mark.parametrize("face", FACES)
def test_what_has_flipped_or_come_through_is_found(face):
    """The detectors themselves: a vertex pushed over its neighbours, a lid into the eye, a lip into the teeth."""
    model = head_model(face)
    geometry, edges, poking = GeometricDeformer(model).at(FacePose()), Edges.of(model), Poking(model)
    assert not edges.flipped(geometry.vertices).any()
    assert not any(poking.count(geometry).values())
    rest = geometry.vertices.copy()
    cheek = int(np.linalg.norm(rest - model.landmarks["cheek_l"], axis=1).argmin())
    geometry.vertices[cheek, 1] += 0.015
    assert (edges.flipped(geometry.vertices) & ~edges.folding()).any()
    geometry.vertices[:] = rest
    lid = np.linalg.norm(rest - rest[model.eyelids.rings["l"][LidRing.EDGE].upper[7]], axis=1) < 0.006
    geometry.vertices[lid] -= [0, 0, 0.004]
    assert poking.count(geometry)["eye_l"] > 0
    assert poking.count(geometry)["eye_r"] == 0
    geometry.vertices[:] = rest
    lip = np.linalg.norm(rest - model.landmarks["upper_lip_middle"], axis=1) < 0.025
    geometry.vertices[lip] -= [0, 0, 0.025]
    assert poking.count(geometry)["teeth_upper"] > 0
