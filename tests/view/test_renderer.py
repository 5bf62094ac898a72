import numpy as np
import pytest
from scipy.ndimage import label

from agentface.deform.geometry import FaceGeometry
from agentface.errors import DataError, InvalidValueError, UnknownNameError
from agentface.head.look import load_look, read_look
from agentface.mesh.normals import vertex_normals
from agentface.view.camera import Camera, named_view
from agentface.view.renderer import Renderer
from tests.heads import head_model

pytestmark = pytest.mark.gl

SIZE = (160, 120)


def shown(model, **shapes):
    vertices = model.vertices.copy()
    for name, weight in shapes.items():
        vertices += np.float32(weight) * model.shapes[name].dense(len(vertices))
    geometry = FaceGeometry.at_rest(model, normals=vertex_normals(vertices, model.triangles))
    geometry.vertices[:] = vertices
    return geometry


@pytest.fixture(scope="module", params=["amber", "onyx"])
def renderer(request):
    renderer = Renderer(head_model(request.param))
    yield renderer
    renderer.close()


@pytest.fixture(scope="module")
def green(renderer):
    """The same face before green, without hair: that hides holes, and one sees past it beside the face."""
    bright = {"background_inner": [0.0, 1.0, 0.0], "background_outer": [0.0, 1.0, 0.0]}
    bald = renderer.look.hair.model_copy(update={"style": "none"})
    return Renderer(renderer.model, renderer.look.model_copy(update=bright | {"hair": bald}), renderer.context)


@pytest.mark.parametrize("view", ["front", "three-quarter", "profile"])
@pytest.mark.parametrize("quality", ["fast", "portrait"])
def test_pictures_have_the_size_asked_for_and_show_something(renderer, view, quality):
    picture = renderer.render(shown(renderer.model), SIZE, view, quality)
    assert picture.shape == (120, 160, 3)
    assert picture.dtype == np.uint8
    middle, corner = picture[40:80, 60:100].astype(int), picture[:8, :8].astype(int)
    assert middle.std() > 10
    assert middle[..., 0].mean() > corner[..., 0].mean() + 15  # skin is redder than the background
    assert (picture[:, :, 0].astype(int) > 250).mean() < 0.02  # little is burnt out


@pytest.mark.parametrize("quality", ["fast", "portrait"])
def test_pictures_without_a_background_lie_over_any(renderer, quality):
    geometry = shown(renderer.model, jawOpen=0.5)
    whole = renderer.render(geometry, SIZE, quality=quality).astype(int)
    cut = renderer.render(geometry, SIZE, quality=quality, alpha=True).astype(float)
    assert cut.shape == (120, 160, 4)
    cover = cut[..., 3:] / 255
    assert not cut[cut[..., 3] == 0].any()
    assert np.abs(cut[..., :3] - whole)[cut[..., 3] == 255].max() <= 1
    nobody = renderer.render(geometry, SIZE, Camera((0.0, 0.0, 2.0), (0.0, 0.0, 3.0)), quality)
    edges = np.abs(cover * cut[..., :3] + (1 - cover) * nobody - whole)[..., 0][(cover > 0.1)[..., 0]]
    assert edges.max() <= 5  # eight bits, rounded once for each hair over a pixel
    np.testing.assert_array_equal(renderer.render(geometry, SIZE, quality=quality), whole)


def test_two_pictures_are_the_same_to_the_byte(renderer):
    geometry = shown(renderer.model, jawOpen=0.5)
    first = renderer.render(geometry, SIZE)
    renderer.render(shown(renderer.model), (64, 64), "profile", "portrait")
    np.testing.assert_array_equal(renderer.render(geometry, SIZE), first)
    other = Renderer(renderer.model)
    np.testing.assert_array_equal(other.render(geometry, SIZE), first)
    other.close()


def test_the_top_row_comes_first_and_the_left_of_the_person_is_right(renderer):
    front = named_view(renderer.model, "front")
    shown_ = shown(renderer.model)
    centred = renderer.render(shown_, SIZE).astype(int)
    risen = Camera(front.eye, (front.target[0], front.target[1] - 0.05, front.target[2]))
    assert _middle_of_skin(renderer.render(shown_, SIZE, risen))[0] < _middle_of_skin(centred)[0] - 5
    smile = renderer.render(shown(renderer.model, eyeBlinkLeft=1.0), SIZE).astype(int)
    changed = np.abs(smile - centred).sum(2)
    assert changed[:, 80:].sum() > 5 * changed[:, :80].sum()


def _middle_of_skin(picture):
    red = picture[..., 0].astype(int) - picture[..., 2]
    rows, columns = np.nonzero(red > 25)
    return rows.mean(), columns.mean()


def test_expressions_eyes_jaw_and_head_change_the_picture(renderer):
    rest = renderer.render(shown(renderer.model), SIZE).astype(int)
    looking, opened, turned = (shown(renderer.model) for _ in range(3))
    c, s = np.cos(0.4), np.sin(0.4)
    turn = np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]], np.float32)
    looking.eye_rotations[:] = turn
    turned.head[:3, :3] = turn
    opened = shown(renderer.model, jawOpen=0.8)
    jaw_only = shown(renderer.model, jawOpen=0.8)
    jaw_only.jaw[1, 3] = -0.02
    for geometry, share in ((looking, 0.0005), (turned, 0.05), (opened, 0.005)):
        changed = np.abs(renderer.render(geometry, SIZE).astype(int) - rest).max(2) > 12
        assert changed.mean() > share
    teeth = np.abs(renderer.render(jaw_only, SIZE).astype(int) - renderer.render(opened, SIZE)).max(2) > 12
    assert teeth.any()


@pytest.mark.parametrize(
    "shapes",
    [{}, {"jawOpen": 0.9}, {"eyeWideLeft": 1.0, "eyeWideRight": 1.0}, {"eyeBlinkLeft": 0.5, "mouthSmileLeft": 1.0}],
)
@pytest.mark.parametrize("view", ["front", "three-quarter"])
def test_nothing_shows_through_eyes_and_mouth(renderer, green, shapes, view):
    geometry = shown(renderer.model, **shapes)
    picture = green.render(geometry, (400, 400), view).astype(int)
    backdrop = (picture[..., 1] > picture[..., 0] + 40) & (picture[..., 1] > picture[..., 2] + 40)
    patches, count = label(backdrop)
    outside = np.unique(np.concatenate([patches[0], patches[-1], patches[:, 0], patches[:, -1]]))
    camera = named_view(renderer.model, view)
    lids = [eye[3] for eye in renderer.model.eyelids.rings.values()]
    for ring in (renderer.model.lips.rings[0], *lids):
        at = geometry.vertices[[*ring.upper, *ring.lower]]
        clip = np.c_[at, np.ones(len(at))] @ (camera.projection(1.0) @ camera.view()).T
        x, y = ((0.5 + 0.5 * clip[:, :2] / clip[:, 3:]) * 400).T
        box = patches[int(400 - y.max()) : int(400 - y.min()) + 1, int(x.min()) : int(x.max()) + 1]
        assert box.size
        assert not set(np.unique(box)) - {0} - set(outside), f"{count} patches"


@pytest.mark.parametrize(
    "size", [(0, 10), (10, 0), (-1, 10), (20000, 10), (10, 20000), (10.5, 10), (True, 10), (10,), 10, None, ("a", "b")]
)
def test_wrong_sizes_are_refused(renderer, size):
    with pytest.raises(InvalidValueError, match="size"):
        renderer.render(shown(renderer.model), size)


def test_wrong_names_and_meshes_are_refused(renderer):
    with pytest.raises(UnknownNameError, match="three-quarter"):
        renderer.render(shown(renderer.model), SIZE, "back")
    with pytest.raises(UnknownNameError, match="portrait"):
        renderer.render(shown(renderer.model), SIZE, quality="best")
    for name in ("vertices", "smooth_normals", "wrinkles", "wrinkle_levels", "eye_rotations", "jaw", "head"):
        geometry = shown(renderer.model)
        array = getattr(geometry, name)
        for wrong in (array[:-1], array[None], array[:0]):
            setattr(geometry, name, wrong)
            with pytest.raises(InvalidValueError, match=rf"geometry\.{name}: expected an array of shape"):
                renderer.render(geometry, SIZE)


def test_odd_and_small_sizes(renderer):
    for size in ((1, 1), (3, 5), (161, 7), (7, 161)):
        assert renderer.render(shown(renderer.model), size).shape == (size[1], size[0], 3)


def test_many_sizes_do_not_pile_up(renderer):
    for side in range(20, 40):
        renderer.render(shown(renderer.model), (side, side))
    assert len(renderer._targets) >= 20, "small ones are kept"
    renderer.render(shown(renderer.model), (640, 640))
    for side in range(600, 603):
        renderer.render(shown(renderer.model), (side, side))
    kept = [size[0] * size[1] * max(samples, 1) for size, samples in list(renderer._targets)[:-1]]
    assert sum(kept) <= 400_000
    assert (602, 602) in [size for size, _ in renderer._targets]


def test_looks_are_checked(tmp_path, renderer):
    text = (renderer.model.folder / "look.yaml").read_text()
    path = tmp_path / "look.yaml"
    path.write_text(text.replace("style: ", "style: long-").replace("grey: 0.", "grey: 7."))
    with pytest.raises(DataError) as caught:
        read_look(path)
    assert {fault.where for fault in caught.value.faults} == {"hair.style", "hair.grey"}
    assert all(fault.line for fault in caught.value.faults)
    assert load_look(renderer.model) == renderer.look


def test_pupils_eyeballs_and_tongue_change_the_picture(renderer):
    model, size = renderer.model, (400, 400)
    rest = renderer.render(shown(model), size).astype(int)
    wide, small, out = (shown(model) for _ in range(3))
    wide.pupils[:], small.pupils[:], out.eye_thrust[:] = 2.0, 0.5, 0.01
    eyes = [renderer.render(geometry, size).astype(int) for geometry in (wide, small, out)]
    assert (np.abs(eyes[0] - rest).max(2) > 12).sum() > 20
    dark = [int((picture.sum(2) < 60)[120:220].sum()) for picture in (eyes[0], rest, eyes[1])]
    assert dark[0] > dark[1] >= dark[2]
    assert (np.abs(eyes[2] - rest).max(2) > 12).any()
    licked = shown(model, jawOpen=0.8)
    before = renderer.render(licked, size).astype(int)
    licked.tongue[:, 2] += 0.03
    after = renderer.render(licked, size).astype(int)
    assert (np.abs(after - before).max(2) > 12).sum() > 50
    np.testing.assert_array_equal(renderer.render(shown(model), size), rest)
