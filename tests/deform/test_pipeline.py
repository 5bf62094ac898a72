"""The whole geometric face: what lips, lids, jaw, eyes and head do, and what no pose may do."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from agentface.deform.finish import neck
from agentface.parameters import COUNT, PARAMETERS, FacePose, parameter
from tests.heads import deformer_of, head_model

FACES = {face: head_model(face) for face in ("amber", "onyx")}
FRACTIONS = st.lists(st.floats(0, 1, width=32), min_size=COUNT, max_size=COUNT)


@pytest.fixture(params=FACES)
def face(request):
    return request.param


def vertices(face, **contractions):
    return deformer_of(face).at(FacePose.of(**contractions)).vertices.copy()


def spread(fractions):
    """A pose from fractions 0..1 of every parameter's range."""
    low = np.array([known.low for known in PARAMETERS])
    high = np.array([known.high for known in PARAMETERS])
    return FacePose((low + (high - low) * np.array(fractions)).astype(np.float32))


def test_the_neutral_pose_is_the_face_at_rest(face):
    geometry = deformer_of(face).at(FacePose())
    np.testing.assert_array_equal(geometry.vertices, FACES[face].vertices)
    np.testing.assert_array_equal(geometry.jaw, np.eye(4))
    np.testing.assert_array_equal(geometry.head, np.eye(4))


@settings(max_examples=25)
@given(FRACTIONS)
def test_no_pose_tears_the_face(fractions):
    for face, model in FACES.items():
        geometry = deformer_of(face).at(spread(fractions))
        assert np.isfinite(geometry.vertices).all()
        assert np.abs(np.linalg.norm(geometry.normals, axis=1) - 1).max() < 1e-3
        above = neck.shares(model) == 1.0  # where the head's turn moves nothing in the head's own axes
        assert np.linalg.norm(geometry.vertices - model.vertices, axis=1)[above].max() < 0.08
        for turn in geometry.eye_rotations:
            np.testing.assert_allclose(turn @ turn.T, np.eye(3), atol=1e-5)


@settings(max_examples=15)
@given(FRACTIONS)
def test_a_mirrored_pose_is_the_mirrored_face(fractions):
    pose = spread(fractions)
    for face, model in FACES.items():
        one = deformer_of(face).at(pose).vertices.copy()
        other = deformer_of(face).at(pose.mirrored()).vertices
        np.testing.assert_allclose(one[model.mirror] * [-1, 1, 1], other, atol=1e-5)


def lid_gap(face, side, points):
    """The opening of an eye in metres, in its middle."""
    ring = FACES[face].eyelids.rings[side][3]
    middle = FACES[face].eye_centre(side)[0]
    upper, lower = (min(half, key=lambda vertex: abs(points[vertex, 0] - middle)) for half in (ring.upper, ring.lower))
    return float(points[upper, 1] - points[lower, 1])


def test_lids_close_and_open(face):
    neutral = lid_gap(face, "l", vertices(face))
    assert 0.006 < neutral < 0.014
    assert abs(lid_gap(face, "l", vertices(face, orbicularis_oculi_palpebralis=1))) < 0.0012
    assert lid_gap(face, "l", vertices(face, levator_palpebrae=1)) > 1.2 * neutral
    assert lid_gap(face, "l", vertices(face, orbicularis_oculi_orbitalis=1)) < 0.75 * neutral


def test_one_lid_closes_alone(face):
    points = vertices(face, orbicularis_oculi_palpebralis_l=1)
    assert abs(lid_gap(face, "l", points)) < 0.0012
    assert lid_gap(face, "r", points) == pytest.approx(lid_gap(face, "r", FACES[face].vertices), abs=1e-6)


def test_closed_lids_lie_outside_the_eyeball(face):
    model, points = FACES[face], vertices(face, orbicularis_oculi_palpebralis=1)
    for side in "lr":
        ring = model.eyelids.rings[side][4]
        distance = np.linalg.norm(points[ring.upper + ring.lower] - model.eye_centre(side), axis=1)
        assert distance.min() > 0.98 * model.eyes.radius


def test_the_upper_lid_follows_the_eye(face):
    level, down = (lid_gap(face, "l", vertices(face, gaze_pitch=pitch)) for pitch in (0.0, -0.3))
    assert down < level


@pytest.mark.parametrize("opening", [0.25, 0.5, 1.0])
def test_the_jaw_takes_chin_and_lower_lip_along_and_leaves_the_upper_lip(face, opening):
    model = FACES[face]
    moved = vertices(face, jaw_open=opening) - model.vertices
    lower = model.lips.rings[4].lower[len(model.lips.rings[4].lower) // 2]
    upper = model.lips.rings[4].upper[len(model.lips.rings[4].upper) // 2]
    corner = model.lips.rings[4].upper[0]
    assert moved[lower, 1] < -0.03 * opening
    assert abs(moved[upper, 1]) < 0.006 * opening
    assert moved[lower, 1] < moved[corner, 1] < moved[upper, 1]
    jaw = deformer_of(face).at(FacePose.of(jaw_open=opening)).jaw
    angle = math.atan2(jaw[2, 1], jaw[1, 1])
    assert angle == pytest.approx(math.radians(model.jaw.widest_deg) * opening, rel=1e-3)


def test_pressing_flattens_the_lips_and_puckering_narrows_the_mouth(face):
    model = FACES[face]
    rest, press, pucker = (
        vertices(face),
        vertices(face, orbicularis_oris_press=1),
        vertices(face, orbicularis_oris_pucker=1),
    )
    ring = model.lips.rings[5]
    red = ring.upper[len(ring.upper) // 2], ring.lower[len(ring.lower) // 2]

    def height(points):
        return points[red[0], 1] - points[red[1], 1]

    def width(points):
        return points[ring.upper[0], 0] - points[ring.upper[-1], 0]

    assert height(press) < 0.7 * height(rest)
    assert width(rest) <= width(press) < 1.12 * width(rest)
    assert width(pucker) < 0.85 * width(rest)
    assert pucker[red[0], 2] > rest[red[0], 2] + 0.002


def test_gaze_stays_in_the_ellipse_of_the_eye_hole(face):
    limits = parameter("gaze_yaw").high, parameter("gaze_pitch").high
    for turn in np.linspace(0, 2 * math.pi, 24):
        pose = FacePose().replace({"gaze_yaw": limits[0] * math.cos(turn), "gaze_pitch": limits[1] * math.sin(turn)})
        x, y, z = deformer_of(face).at(pose).eye_rotations[0] @ [0, 0, 1]
        yaw, pitch = math.degrees(math.atan2(x, z)), math.degrees(math.asin(y))
        eyes = FACES[face].eyes
        assert (yaw / eyes.yaw_limit_deg) ** 2 + (pitch / eyes.pitch_limit_deg) ** 2 < 1.03


def test_gaze_and_head_turn_to_the_persons_left_and_up(face):
    geometry = deformer_of(face).at(FacePose.of(gaze_yaw=0.2, gaze_pitch=0.1, head_yaw=0.3, head_pitch=0.2))
    for turn in (*geometry.eye_rotations, geometry.head[:3, :3]):
        x, y, _ = turn @ [0, 0, 1]
        assert x > 0
        assert y > 0


def test_muscles_of_the_upper_lip_leave_the_lower_lip(face):
    model = FACES[face]
    moved = np.linalg.norm(vertices(face, levator_labii_superioris=1) - model.vertices, axis=1)
    for side in "lr":
        # the lips are one surface round the mouth: a little goes round the corners
        assert moved[model.regions.members(f"lower_lip_{side}")].max() < 0.0006
        assert moved[model.regions.members(f"upper_lip_{side}")].max() > 0.002


def test_frontalis_leaves_the_eyelids(face):
    model = FACES[face]
    pose = {f"frontalis_{part}": 1.0 for part in ("medialis", "intermedius", "lateralis")}
    moved = np.linalg.norm(vertices(face, **pose) - model.vertices, axis=1)
    for lid in ("upper_eyelid", "lower_eyelid"):
        for side in "lr":
            assert moved[model.regions.members(f"{lid}_{side}")].max() == 0.0
