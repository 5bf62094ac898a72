"""The tongue: where each parameter takes it, and that neither teeth nor lips nor skin ever get into it."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from numba import njit
from scipy.spatial import cKDTree

from agentface.deform.crowd import Crowd
from agentface.deform.tongue import tables, tongue
from agentface.parameters import COUNT, HIGH, LOW, NEUTRAL, PARAMETERS, FacePose, indices_of
from tests.deform.crossings import crossings, edges_of
from tests.heads import deformer_of, head_model

FACES = ("amber", "onyx")
OWN = np.array([known.kind in ("tongue", "jaw") for known in PARAMETERS])
NEAR = 0.09  # m round the upper lip, where skin is looked at
POSES = 1000
SOME = 40
TIP = 30  # vertices of the tip, left and right


def poses(count, seed):
    """``(count, COUNT)``: tongue and jaw anywhere in their ranges, and some, more or all of the others."""
    draw = np.random.default_rng(seed)
    values = draw.uniform(LOW, HIGH, (count, COUNT))
    kept = OWN | (draw.random((count, COUNT)) < draw.choice([0.0, 0.1, 0.3, 1.0], (count, 1)))
    return np.clip(np.where(kept, values, NEUTRAL), LOW, HIGH).astype(np.float32)


def part(model, name):
    mesh = model.parts[name]
    return mesh.attributes["POSITION"].astype(float), mesh.triangles


def posed(geometry, points):
    return points.astype(float) @ geometry.jaw[:3, :3].T.astype(float) + geometry.jaw[:3, 3]


def around(geometry, model):
    """What may not be where the tongue is: points and triangles by name."""
    near = np.linalg.norm(model.vertices - model.landmarks["upper_lip_middle"], axis=1) < NEAR
    upper, lower = part(model, "teeth_upper"), part(model, "teeth_lower")
    return {
        "upper teeth": upper,
        "lower teeth": (posed(geometry, lower[0]), lower[1]),
        "skin": (geometry.vertices.astype(float), model.triangles[near[model.triangles].all(axis=1)]),
    }


@njit(cache=True)
def bounds_of(corners):
    """The least and the largest coordinates of each triangle, ``(T, 3)`` each."""
    low, high = np.empty((len(corners), 3)), np.empty((len(corners), 3))
    for t in range(len(corners)):
        for axis in range(3):
            low[t, axis], high[t, axis] = corners[t, :, axis].min(), corners[t, :, axis].max()
    return low, high


@njit(cache=True)
def outside(point, low, high):
    inside = True
    for axis in range(3):
        inside = inside and low[axis] <= point[axis] <= high[axis]
    return not inside


@njit(cache=True)
def deepest(points, corners):
    """How far above or below it the surface of a closed mesh ``(T, 3, 3)`` is, of the point most inside; 0 for none."""
    most = 0.0
    low, high = bounds_of(corners)
    lowest, highest = np.empty(3), np.empty(3)
    for axis in range(3):
        lowest[axis], highest[axis] = low[:, axis].min(), high[:, axis].max()
    for point in points:
        if outside(point, lowest, highest):
            continue
        x, y, z = point[0] + 1.3e-8, point[1], point[2] + 1.7e-8  # past the edges of triangles that it lies on
        winding, above, below = 0, 1.0, 1.0
        for t in range(corners.shape[0]):
            if x < low[t, 0] or x > high[t, 0] or z < low[t, 2] or z > high[t, 2]:
                continue
            a, b, c = corners[t, 0], corners[t, 1], corners[t, 2]
            u = (b[0] - x) * (c[2] - z) - (b[2] - z) * (c[0] - x)
            v = (c[0] - x) * (a[2] - z) - (c[2] - z) * (a[0] - x)
            w = (a[0] - x) * (b[2] - z) - (a[2] - z) * (b[0] - x)
            if (u > 0 and v > 0 and w > 0) or (u < 0 and v < 0 and w < 0):
                height = (u * a[1] + v * b[1] + w * c[1]) / (u + v + w) - y
                if height > 0.0:
                    winding += 1 if u < 0 else -1
                    above = min(above, height)
                else:
                    below = min(below, -height)
        if winding != 0:
            most = max(most, min(above, below))
    return most


@pytest.mark.untraced
@pytest.mark.parametrize("face", FACES)
def test_nothing_gets_into_the_tongue(face):
    model = head_model(face)
    corners_of = model.parts["tongue"].triangles
    upper, lower = (part(model, name)[0] for name in ("teeth_upper", "teeth_lower"))
    rows, skin = poses(POSES, 0), np.linalg.norm(model.vertices - model.landmarks["upper_lip_middle"], axis=1) < NEAR
    deep = {"upper teeth": np.zeros(POSES), "lower teeth": np.zeros(POSES), "skin": np.zeros(POSES)}
    out = 0
    with Crowd(model) as crowd:
        for first in range(0, POSES, 100):
            faces = crowd.deform(rows[first : first + 100])
            assert np.isfinite(faces.tongue).all()
            for k in range(len(faces)):
                shown = faces[k]
                corners = posed(shown, shown.tongue)[corners_of]
                out += corners[..., 2].max() > shown.vertices[model.lips.rings[0].upper[12], 2]
                deep["upper teeth"][first + k] = deepest(upper, corners)
                deep["lower teeth"][first + k] = deepest(posed(shown, lower), corners)
                deep["skin"][first + k] = deepest(shown.vertices[skin].astype(float), corners)
    assert out > POSES // 5, "a tongue that never leaves the mouth proves little"
    for name, at in deep.items():
        assert at.max() == 0.0, (name, np.argsort(-at)[:5], np.sort(at)[:-6:-1])


def test_the_oracle_finds_what_is_inside():
    model = head_model()
    points, triangles = part(model, "tongue")
    middle = points.mean(axis=0)
    assert deepest(middle[None], points[triangles]) > 0.0005
    assert deepest(middle[None] + [0, 0.05, 0], points[triangles]) == 0.0
    moved = points + np.array([0, 0, 0.006])
    assert deepest(part(model, "teeth_lower")[0], moved[triangles]) > 0.0005, "through the teeth"


@pytest.mark.parametrize("face", FACES)
def test_no_edge_goes_through_teeth_or_skin(face):
    model, deformer = head_model(face), deformer_of(face)
    triangles = model.parts["tongue"].triangles
    edges, found = edges_of(triangles), {}
    for number, values in enumerate(poses(SOME, 5)):
        shown = deformer.at(FacePose(values))
        points = posed(shown, shown.tongue)
        for name, (others, of_others) in around(shown, model).items():
            if len(crossings(points, edges, others, of_others)):
                found[number] = name
    assert not found


@pytest.mark.parametrize("face", FACES)
def test_at_rest_it_lies_within_the_teeth(face):
    model = head_model(face)
    points, triangles = part(model, "tongue")
    for name in ("teeth_upper", "teeth_lower"):
        others, of_others = part(model, name)
        assert not len(crossings(points, edges_of(triangles), others, of_others)), name
        assert not len(crossings(others, edges_of(of_others), points, triangles)), name


@pytest.mark.parametrize("compiled", [True, False])
def test_without_its_parameters_it_rests(compiled):
    rest = head_model().parts["tongue"].attributes["POSITION"]
    for pose in (FacePose(), FacePose.of(jaw_open=0.7, zygomaticus_major=1.0, gaze_yaw=0.2)):
        np.testing.assert_array_equal(deformer_of(compiled=compiled).at(pose).tongue, rest)


@pytest.mark.parametrize("face", FACES)
def test_both_forms_agree(face):
    model, deformer = head_model(face), deformer_of(face)
    prepared = tables.prepare(model)
    for values in poses(SOME, 9):
        shown = deformer.at(FacePose(values))
        other = np.empty_like(shown.tongue)
        tongue.apply(prepared, values, shown.vertices, shown.jaw, other)
        np.testing.assert_allclose(shown.tongue, other, atol=1e-6, rtol=0)


def tip(**pose):
    """Where the tip is in the head's axes, m, and where at rest."""
    shown = deformer_of().at(FacePose.of(**pose))
    rest = head_model().parts["tongue"].attributes["POSITION"]
    front = np.argsort(-rest[:, 2])[:TIP]
    return posed(shown, shown.tongue)[front].mean(axis=0), posed(shown, rest)[front].mean(axis=0)


def test_each_parameter_takes_it_where_it_says():
    for jaw in (0.4, 0.8):
        now, before = tip(tongue_out=1.0, jaw_open=jaw)
        assert now[2] - before[2] > 0.03
        for inside in (True, False):
            pose = {"jaw_open": jaw, "tongue_out": 0.0 if inside else 1.0}
            before = tip(**pose)[0]
            assert tip(tongue_tip_raise=1.0, **pose)[0][1] - before[1] > 0.005
            if not inside:
                assert tip(tongue_tip_raise=-1.0, **pose)[0][1] - before[1] < -0.001
            left, right = (tip(tongue_tip_shift=side, **pose)[0][0] for side in (1.0, -1.0))
            assert left > 0.003
            assert abs(left + right) < 5e-4


def test_its_back_rises_and_its_edges_roll_up():
    rest = head_model().parts["tongue"].attributes["POSITION"]
    up, down, rolled = (
        deformer_of().at(FacePose.of(jaw_open=0.6, **{name: value})).tongue - rest
        for name, value in (("tongue_raise", 1.0), ("tongue_raise", -1.0), ("tongue_roll", 1.0))
    )
    assert up[:, 1].max() > 0.005
    assert down[:, 1].min() < -0.002
    front = rest[:, 2] > np.quantile(rest[:, 2], 0.5)
    edge = front & (np.abs(rest[:, 0]) > 0.7 * np.abs(rest[front, 0]).max())
    assert rolled[edge, 1].mean() > 0.002
    assert np.abs(rolled[front & (np.abs(rest[:, 0]) < 0.001), 1]).max() < 0.001


@pytest.mark.parametrize("face", FACES)
def test_it_goes_out_as_far_as_teeth_and_lips_let_it(face):
    deformer, rest = deformer_of(face), head_model(face).parts["tongue"].attributes["POSITION"]

    def ahead(**pose):
        shown = deformer.at(FacePose.of(tongue_out=1.0, **pose))
        return float(shown.tongue[:, 2].max() - rest[:, 2].max())

    opening = [ahead(jaw_open=float(jaw)) for jaw in np.linspace(0.0, 1.0, 101)]
    assert opening[0] < 0.003, "the teeth meet"
    assert opening[60] > 0.025
    assert np.abs(np.diff(opening)).max() < 0.004, "no jump"
    assert min(np.diff(opening[:40])) > -0.0005, "the wider the mouth, the farther"
    assert ahead(jaw_open=0.12, orbicularis_oris_press=1.0) < 0.006, "the lips meet"


@pytest.mark.parametrize("jaw", [0.0, 0.2, 0.3, 0.6])
@pytest.mark.parametrize("name", ["tongue_out", "tongue_raise", "tongue_tip_raise", "tongue_tip_shift", "tongue_roll"])
def test_it_moves_without_a_jump(name, jaw):
    known = PARAMETERS[indices_of(name)[0]]
    steps = np.linspace(known.low, known.high, 201)
    pose = {"jaw_open": jaw, "tongue_out": 0.8} | {name: 0.0}
    shapes = [deformer_of().at(FacePose.of(**pose | {name: float(value)})).tongue for value in steps]
    assert max(np.abs(one - other).max() for one, other in pairwise(shapes)) < 0.0025


@pytest.mark.parametrize("face", FACES)
def test_a_mirrored_pose_makes_the_mirrored_tongue(face):
    model, deformer = head_model(face), deformer_of(face)
    rest = model.parts["tongue"].attributes["POSITION"]
    flip = np.array([-1.0, 1.0, 1.0])
    middle = 2.0 * 0.5 * (rest[:, 0].min() + rest[:, 0].max()) * np.array([1.0, 0.0, 0.0])
    away, other = cKDTree(rest).query(rest * flip + middle)
    assert away.max() < 1e-6, "the mesh is its own image"
    for values in poses(SOME, 3):
        sideless = {
            known.name: float(values[known.index])
            for known in PARAMETERS
            if known.kind == "tongue" or known.name == "jaw_open"
        }
        one = deformer.at(FacePose.of(**sideless)).tongue
        image = deformer.at(FacePose.of(**sideless | {"tongue_tip_shift": -sideless["tongue_tip_shift"]})).tongue
        np.testing.assert_allclose(image[other], one * flip + middle, atol=2e-4)


@pytest.mark.parametrize("face", FACES)
def test_it_goes_out_as_the_artists_have_it(face):
    model = head_model(face)
    rest = model.parts["tongue"]
    points = rest.attributes["POSITION"]
    theirs = rest.shapes["tongueOut"].dense(len(points)).ravel()
    ours = (deformer_of(face).at(FacePose.of(tongue_out=1.0, jaw_open=0.7)).tongue - points).ravel()
    assert theirs @ ours / np.linalg.norm(theirs) / np.linalg.norm(ours) > 0.8
