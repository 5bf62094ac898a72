import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from agentface.errors import InvalidValueError, UnknownNameError
from agentface.view.camera import VIEWS, Camera, named_view
from tests.heads import head_model

metres = st.floats(-3, 3)
points = st.tuples(metres, metres, metres)


def cameras():
    def make(target, arm):
        return Camera(tuple(np.add(target, arm)), target)

    arms = points.filter(lambda arm: np.hypot(arm[0], arm[2]) > 0.05)
    return st.builds(make, points, arms)


def seen(camera, point, aspect=1.5):
    clip = camera.projection(aspect) @ camera.view() @ [*point, 1.0]
    return clip[:3] / clip[3]


@given(cameras())
def test_the_view_is_rigid_and_looks_at_the_target(camera):
    view = camera.view()
    np.testing.assert_allclose(view[:3, :3] @ view[:3, :3].T, np.eye(3), atol=1e-9)
    assert np.linalg.det(view[:3, :3]) == pytest.approx(1.0)
    np.testing.assert_allclose((view @ [*camera.target, 1])[:3], [0, 0, -camera.distance], atol=1e-9)
    np.testing.assert_allclose(seen(camera, camera.target)[:2], 0, atol=1e-9)


@given(cameras())
def test_up_stays_up_and_right_stays_right(camera):
    above = np.add(camera.target, [0, 0.01, 0])
    assert seen(camera, above)[1] > 0
    assert abs(seen(camera, above)[0]) < 1e-9


@given(cameras(), st.floats(-4, 4), st.floats(-1, 1), st.floats(0.3, 3))
def test_orbiting_keeps_the_distance_and_zooming_the_direction(camera, yaw, pitch, factor):
    orbited = camera.orbited(yaw, pitch)
    assert orbited.distance == pytest.approx(camera.distance)
    assert orbited.target == camera.target
    zoomed = camera.zoomed(factor)
    before, after = (np.subtract(c.eye, c.target) / c.distance for c in (camera, zoomed))
    np.testing.assert_allclose(after, before, atol=1e-9)


def test_orbiting_to_the_left_and_back():
    camera = Camera((0, 0, 1), (0, 0, 0))
    np.testing.assert_allclose(camera.orbited(np.pi / 2, 0).eye, [1, 0, 0], atol=1e-12)
    np.testing.assert_allclose(camera.orbited(0.3, 0.2).orbited(-0.3, -0.2).eye, camera.eye, atol=1e-12)
    assert camera.orbited(0, 10).eye[1] < 1.0


def test_half_the_field_of_view_reaches_the_edge():
    camera = Camera((0, 0, 2), (0, 0, 0), field_of_view=np.radians(40))
    top = 2 * np.tan(np.radians(20))
    assert seen(camera, (0, top, 0))[1] == pytest.approx(1.0)
    assert seen(camera, (1.5 * top, 0, 0))[0] == pytest.approx(1.0)


@pytest.mark.parametrize("face", ["amber", "onyx"])
@pytest.mark.parametrize("view", list(VIEWS))
@pytest.mark.parametrize("aspect", [0.5, 0.8, 1.0, 16 / 9, 3.0])
def test_named_views_hold_the_whole_head(face, view, aspect):
    model = head_model(face)
    camera = named_view(model, view)
    head = model.vertices[model.vertices[:, 1] > model.landmarks["menton"][1]]
    clip = np.c_[head, np.ones(len(head))] @ (camera.projection(aspect) @ camera.view()).T
    place = clip[:, :3] / clip[:, 3:]
    assert np.abs(place).max() < 1.0
    # and it fills a good part of the picture's shorter side
    assert np.ptp(place[:, 1]) > (1.2 if aspect >= 0.8 else 0.7)


def test_wrong_cameras_say_what_is_wrong():
    with pytest.raises(InvalidValueError, match=r"Camera\.eye"):
        Camera((0, 0), (0, 0, 0))
    with pytest.raises(InvalidValueError, match="finite"):
        Camera((0, float("nan"), 1), (0, 0, 0))
    with pytest.raises(InvalidValueError, match="above or below"):
        Camera((0, 1, 0), (0, 0, 0))
    with pytest.raises(InvalidValueError, match="field_of_view"):
        Camera((0, 0, 1), (0, 0, 0), field_of_view=4.0)
    with pytest.raises(UnknownNameError, match="profile"):
        named_view(head_model("amber"), "profil")
