"""Two thousand random poses of the whole face: nothing flips, nothing pokes through, everything is finite."""

import numpy as np
import pytest

from agentface.anatomy.model import load_model
from agentface.deform.pipeline import GeometricDeformer
from agentface.parameters import FacePose
from tests.deform.conflicts import Edges, Poking, fold_vertices, random_poses

COUNT, SEED = 2000, 2003
FACES = ("amber", "onyx")


@pytest.mark.slow
@pytest.mark.parametrize("face", FACES)
def test_random_poses(face):
    model = load_model(face)
    deformer, edges, poking = GeometricDeformer(model), Edges.of(model), Poking(model)
    outside = ~edges.folding()
    flipped, through = {}, {}
    for number, pose in enumerate(random_poses(COUNT, SEED)):
        geometry = deformer.deform(pose)
        for name in ("vertices", "normals", "wrinkles", "eye_rotations", "jaw", "head"):
            assert np.isfinite(getattr(geometry, name)).all(), (number, name)
        over = np.flatnonzero(edges.flipped(geometry.vertices) & outside)
        if len(over):
            middle = model.vertices[edges.ends[over[0]]].mean(axis=0)
            flipped[number] = (len(over), np.round(1e3 * middle, 1).tolist())
        parts = {part: count for part, count in poking.count(geometry).items() if count}
        if parts:
            through[number] = parts
    assert not flipped, f"{len(flipped)} poses with skin turned over, such as (edges, mm): {list(flipped.items())[:5]}"
    assert not through, f"{len(through)} poses with something through the skin: {list(through.items())[:5]}"


@pytest.mark.parametrize("face", FACES)
def test_little_is_left_out_as_a_fold(face):
    """The lips' red, the inside of the mouth and the lids with the crease above them: a sixth of the edges."""
    model = load_model(face)
    edges = Edges.of(model)
    assert 0.14 < edges.folding().mean() < 0.18
    assert fold_vertices(model).mean() < 0.19


@pytest.mark.parametrize("face", FACES)
def test_what_has_flipped_or_come_through_is_found(face):
    """The detectors themselves: a vertex pushed over its neighbours, a lid into the eye, a lip into the teeth."""
    model = load_model(face)
    geometry, edges, poking = GeometricDeformer(model).deform(FacePose()), Edges.of(model), Poking(model)
    assert not edges.flipped(geometry.vertices).any()
    assert not any(poking.count(geometry).values())
    rest = geometry.vertices.copy()
    cheek = int(np.linalg.norm(rest - model.landmarks["cheek_l"], axis=1).argmin())
    geometry.vertices[cheek, 1] += 0.015
    assert (edges.flipped(geometry.vertices) & ~edges.folding()).any()
    geometry.vertices[:] = rest
    lid = np.linalg.norm(rest - rest[model.eyelids.rings["l"][5].upper[7]], axis=1) < 0.004
    geometry.vertices[lid] -= [0, 0, 0.004]
    assert poking.count(geometry)["eye_l"] > 0
    assert poking.count(geometry)["eye_r"] == 0
    geometry.vertices[:] = rest
    lip = np.linalg.norm(rest - model.landmarks["upper_lip_middle"], axis=1) < 0.025
    geometry.vertices[lip] -= [0, 0, 0.025]
    assert poking.count(geometry)["teeth_upper"] > 0
