from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from agentface.deform.finish import wrinkles
from agentface.deform.finish import wrinkles_compiled as compiled
from agentface.errors import DataError
from agentface.head.trains import DrawnTrain, ZoneTrain, heights, inner_feet, parabolas, relief
from agentface.head.wrinkles import read_wrinkles
from agentface.mesh.normals import corner_normals, vertex_normals
from agentface.parameters import COUNT, MUSCLES, NAMES, PARAMETERS, indices_of
from tests.heads import head_model

ZONE = ZoneTrain(np.array([0.0, 0.03, 0.0]), np.array([0.0, -1.0, 0.0]), math.radians(35), 0.05, 4, 0.001)
FAN = {"along": np.array([0.0, 1.0, 0.0]), "across": np.array([1.0, 0.0, 0.0]), "bow": -40.0, "fan": True}
WRINKLING = (
    "frontalis_medialis", "corrugator_supercilii", "zygomaticus_major", "levator_labii_superioris_alaeque_nasi",
    "orbicularis_oculi_orbitalis", "mentalis",
)  # fmt: skip
CONTRACTIONS = [parameter.index for parameter in PARAMETERS if parameter.low == 0.0]


@pytest.fixture(scope="module", params=["amber", "onyx"])
def face(request):
    model = head_model(request.param)
    return model, wrinkles.prepare(model)


def contracted(seed, share=0.4):
    rng = np.random.default_rng(seed)
    values = np.zeros(COUNT, np.float32)
    values[CONTRACTIONS] = rng.uniform(0, 1, len(CONTRACTIONS)) * (rng.uniform(0, 1, len(CONTRACTIONS)) < share)
    return values


def raised(tables, values, count, module=wrinkles):
    out = np.full(count, np.nan, np.float32)
    module.heights(tables, values, out)
    return out


def drawn(**changes):
    sides = {"start": np.zeros(3), "along": np.array([0.0, 1.0, 0.0]), "across": np.array([1.0, 0.0, 0.0])}
    numbers = {"length": 0.03, "count": 3, "height": 0.001, "bow": 0.0, "fan": False, "aside": 0.0, "half_width": 0.02}
    soft = {"flat": 0.3, "taper": (0.0, 0.0), "waver": 0.0, "uneven": 0.0, "shade": 1.0}
    return DrawnTrain(**{**sides, **numbers, **soft, **changes})


def paper(distance, length, count, height):
    b = length / (2 * count)
    u = distance - math.floor(distance * count / length) * length / count
    return height * (1 - (u - b) ** 2 / b**2)


@given(st.floats(0, 1), st.floats(0.001, 0.1), st.integers(1, 12), st.floats(0, 0.01))
def test_a_wrinkle_is_the_papers_parabola(part, length, count, height):
    distance = part * length
    got = parabolas(np.array([distance]), length, count, height)[0]
    assert got == pytest.approx(max(paper(distance, length, count, height), 0.0), abs=1e-9)
    assert 0.0 <= got <= height


@pytest.mark.parametrize("count", [1, 2, 5])
def test_feet_are_at_the_skin_and_crests_at_the_height(count):
    length, b = 0.03, 0.03 / (2 * count)
    feet = np.arange(count + 1) * 2 * b
    crests = (2 * np.arange(count) + 1) * b
    np.testing.assert_allclose(parabolas(feet, length, count, 0.002), 0.0, atol=1e-12)
    np.testing.assert_allclose(parabolas(crests, length, count, 0.002), 0.002)
    np.testing.assert_array_equal(parabolas(np.array([-1e-6, length + 1e-6]), length, count, 0.002), 0.0)


def test_the_papers_train_lies_in_the_outer_three_quarters_of_the_zone():
    assert ZONE.length == pytest.approx(0.75 * 0.05 * math.cos(math.radians(35)))
    down = np.linspace(0, 0.06, 601)
    axis = ZONE.origin + down[:, None] * ZONE.axis
    expected = [
        paper(distance, ZONE.length, 4, 0.001) if 0 <= distance <= ZONE.length else 0.0
        for distance in 0.05 * math.cos(math.radians(35)) - down
    ]
    np.testing.assert_allclose(heights(ZONE, axis.astype(np.float32)), expected, atol=2e-8)


def test_the_zones_sides_fade_without_a_step():
    b = ZONE.length / 8
    down = 0.05 * math.cos(ZONE.zone) - b  # along the first crest
    across = np.linspace(-1.1, 1.1, 2001) * down * math.tan(ZONE.zone)
    points = ZONE.origin + down * ZONE.axis + across[:, None] * [1.0, 0.0, 0.0]
    height = heights(ZONE, points.astype(np.float32))
    assert height[1000] == pytest.approx(0.001, rel=1e-4)
    assert (height[np.abs(across) > down * math.tan(ZONE.zone)] == 0.0).all()
    assert np.abs(np.diff(height)).max() < 1e-5
    assert (np.diff(height[1000:]) <= 1e-12).all()


@given(st.floats(-0.01, 0.04), st.floats(-0.03, 0.03), st.floats(-30, 30))
def test_a_bowed_train_measures_from_its_arc(along, aside, bow):
    train = drawn(bow=bow)
    distance, weight = train.place(np.array([[aside, along, 0.02]]))
    assert 0.0 <= weight[0] <= 1.0
    if abs(bow) < 1e-6:
        assert distance[0] == pytest.approx(along, abs=1e-6)
    else:
        to_centre = math.hypot(aside, 1 / bow - along)
        expected = math.copysign(1.0, bow) * (abs(1 / bow) - to_centre)
        assert distance[0] == pytest.approx(expected, abs=1e-6)


def test_a_fans_wrinkles_are_spokes():
    fan = drawn(**FAN)
    centre = np.array([-1 / 40.0, 0.0, 0.0])
    for angle in np.linspace(-0.5, 1.0, 7):
        spoke = centre + np.array([0.022, 0.025, 0.03])[:, None] * [math.cos(angle), math.sin(angle), 0.0]
        np.testing.assert_allclose(fan.place(spoke)[0], angle / 40.0, atol=1e-9)


@given(st.floats(0, 1), st.floats(-1, 1), st.floats(0, 0.5), st.floats(0, 0.003), st.floats(0, 1))
def test_no_train_is_higher_than_it_says(part, aside, taper, waver, uneven):
    train = drawn(taper=(taper, taper), waver=waver, uneven=uneven)
    height, crease = relief(train, np.array([[0.02 * aside, part * train.length, 0.0]]))
    assert 0.0 <= height[0] <= 0.001 + 1e-12
    assert 0.0 <= crease[0] <= 1.0


def test_inner_feet_are_the_feet_between_wrinkles():
    train = drawn()
    along = np.array([0.0, 0.005, 0.01, 0.0149, 0.02, 0.03, 0.04])
    points = np.stack([np.zeros(7), along, np.zeros(7)], axis=1)
    np.testing.assert_array_equal(inner_feet(train, points, 1e-6), [False, False, True, False, True, False, False])
    points[:, 0] = 0.021  # beside the train
    assert not inner_feet(train, points, 1e-6).any()


def sheet(train, across=9, along=31):
    x, y = np.meshgrid(np.linspace(-0.01, 0.01, across), np.linspace(0, train.length, along))
    points = np.stack([x, y, np.zeros_like(x)], axis=-1).reshape(-1, 3)
    corner = (np.arange(along - 1)[:, None] * across + np.arange(across - 1)).ravel()
    quads = np.stack([corner, corner + 1, corner + across + 1, corner + across], axis=1)
    triangles = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    points[:, 2] = heights(train, points)
    return points, triangles


def test_corners_on_inner_feet_have_the_normals_of_their_triangles():
    train = drawn()
    points, triangles = sheet(train)
    feet = inner_feet(train, points * [1, 1, 0], 1e-6)
    assert feet.sum() == 2 * 9
    got = corner_normals(points, triangles, feet)
    smooth = vertex_normals(points, triangles)
    for t, corners in enumerate(triangles):
        flat = np.cross(points[corners[1]] - points[corners[0]], points[corners[2]] - points[corners[0]])
        flat /= np.linalg.norm(flat)
        for i, vertex in enumerate(corners):
            np.testing.assert_allclose(got[t, i], flat if feet[vertex] else smooth[vertex], atol=1e-12)
    # what the paper calls unrepresentative: the mean normal at a foot hides the valley, the triangles' do not
    inner = np.flatnonzero(feet & (np.abs(points[:, 0]) < 0.005))
    assert smooth[inner, 2].min() > 0.99
    assert got[np.isin(triangles, inner)][:, 2].max() < 0.96


def test_a_face_at_rest_has_no_wrinkles(face):
    model, tables = face
    assert (raised(tables, np.zeros(COUNT, np.float32), len(model.vertices)) == 0.0).all()


def test_gaze_head_and_lids_raise_nothing(face):
    model, tables = face
    values = np.zeros(COUNT, np.float32)
    quiet = ["gaze_yaw", "gaze_pitch", "head_yaw", "head_pitch", "head_roll", "jaw_open", "levator_palpebrae_l"]
    values[[NAMES.index(name) for name in quiet]] = 0.5
    assert (raised(tables, values, len(model.vertices)) == 0.0).all()


def test_one_muscle_raises_its_trains_in_proportion(face):
    model, tables = face
    for muscle in MUSCLES:
        values = np.zeros(COUNT, np.float32)
        values[list(indices_of(muscle))] = 1.0
        full = raised(tables, values, len(model.vertices))
        assert full.max() < 0.04 * model.landmarks.eye_separation
        np.testing.assert_allclose(raised(tables, 0.25 * values, len(full)), 0.25 * full, atol=1e-9)


def test_where_trains_meet_the_highest_one_stands(face):
    model, tables = face
    values = contracted(3)
    expected = np.zeros(len(model.vertices))
    for placed in model.trains:
        level = max(values[i] for i in placed.parameters)
        expected = np.maximum(expected, level * placed.reach * heights(placed.train, model.vertices))
    np.testing.assert_allclose(raised(tables, values, len(expected)), expected, atol=2e-6)


@pytest.mark.parametrize("muscle", WRINKLING)
def test_muscles_that_wrinkle_the_skin_do(face, muscle):
    model, tables = face
    values = np.zeros(COUNT, np.float32)
    values[list(indices_of(muscle))] = 1.0
    assert raised(tables, values, len(model.vertices)).max() > 0.2e-3


def test_nothing_rises_on_lips_wet_lid_margins_or_in_the_mouth(face):
    model, tables = face
    height = raised(tables, np.ones(COUNT, np.float32), len(model.vertices))
    assert (height[(model.material[:, :3] >= 0.5).any(axis=1)] == 0.0).all()


@given(st.integers(0, 10_000))
def test_the_other_side_is_the_mirror_image(face, seed):
    model, tables = face
    values = contracted(seed)
    other = values.copy()
    for i, name in enumerate(NAMES):
        if name.endswith(("_l", "_r")):
            other[NAMES.index(name[:-2] + ("_r" if name.endswith("_l") else "_l"))] = values[i]
    here, there = (raised(tables, pose, len(model.vertices)) for pose in (values, other))
    np.testing.assert_allclose(there[model.mirror], here, atol=1e-5)


@given(st.integers(0, 10_000))
def test_compiled_is_numpy(face, seed):
    model, tables = face
    values, count = contracted(seed), len(model.vertices)
    height = raised(tables, values, count)
    np.testing.assert_allclose(raised(tables, values, count, compiled), height, atol=1e-9)
    levels = [np.zeros(len(model.trains), np.float32) for _ in range(2)]
    wrinkles.levels(tables, values, levels[0])
    compiled.levels(tables, values, levels[1])
    np.testing.assert_array_equal(*levels)
    normals = vertex_normals(model.vertices, model.triangles).astype(np.float32)
    placed = [model.vertices.copy() for _ in range(2)]
    wrinkles.raise_vertices(tables, height, normals, placed[0])
    compiled.raise_vertices(tables, height, normals, placed[1])
    np.testing.assert_allclose(*placed, atol=1e-7)


def test_vertices_rise_along_their_normals(face):
    model, tables = face
    height = raised(tables, np.ones(COUNT, np.float32), len(model.vertices))
    normals = vertex_normals(model.vertices, model.triangles).astype(np.float32)
    moved = model.vertices.copy()
    wrinkles.raise_vertices(tables, height, normals, moved)
    np.testing.assert_allclose(((moved - model.vertices) * normals).sum(axis=1), height, atol=1e-7)


def test_a_bad_table_names_every_fault(tmp_path):
    path = tmp_path / "wrinkles.yaml"
    path.write_text(
        """trains:
  cheek:
    muscles: [zygomaticus_mayor]
    start: {at: cheeck}
    end: {at: cheek}
    facing: [0.0, 0.0, 0.0]
    count: 0
    height: 0.01
    half_width: 0.3
    regions: [middle_faze]
"""
    )
    with pytest.raises(DataError) as error:
        read_wrinkles(path)
    message = str(error.value)
    for part in ("zygomaticus_major", "cheek", "facing", "count", "middle_face"):
        assert part in message
    assert f"{path}:3" in message
