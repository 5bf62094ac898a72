"""A picture worn as skin: what a look may name, what is made of it, and the template to paint it on."""

from __future__ import annotations

import shutil
import struct
import zlib
from dataclasses import replace

import numpy as np
import pytest
import yaml
from click.testing import CliRunner
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from PIL import Image

from agentface.cli import cli
from agentface.deform.geometry import FaceGeometry
from agentface.errors import DataError
from agentface.head.look import load_look, read_look
from agentface.head.skin_image import bled, skin_image
from agentface.head.texture_file import read_texture
from agentface.resources import face_folder
from agentface.view.renderer import Renderer
from agentface.view.skin.template import skin_template
from tests.heads import head_model

SIZE = 256


def call(*words):
    return CliRunner().invoke(cli, [str(word) for word in words])


def look_with(folder, texture, **more):
    data = yaml.safe_load((face_folder("amber") / "look.yaml").read_text())
    data["skin"] |= {"texture": str(texture), **more}
    folder.mkdir(exist_ok=True)
    file = folder / "look.yaml"
    file.write_text(yaml.safe_dump(data, sort_keys=False, default_flow_style=False))
    return file


def noise(height, width, channels=4):
    return np.random.default_rng(3).integers(0, 256, (height, width, channels), np.uint8)


def png_that_claims(width, height):
    def chunk(kind, content):
        return struct.pack(">I", len(content)) + kind + content + struct.pack(">I", zlib.crc32(kind + content))

    header = chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0))
    return b"\x89PNG\r\n\x1a\n" + header + chunk(b"IDAT", zlib.compress(b"\0" * 64)) + chunk(b"IEND", b"")


def test_a_look_names_its_picture_relative_to_itself_or_in_full(tmp_path):
    Image.fromarray(noise(8, 6)).save(tmp_path / "face.png")
    for name in ("../face.png", tmp_path / "face.png"):
        look = read_look(look_with(tmp_path / "looks", name))
        np.testing.assert_array_equal(skin_image(look)[..., 3], noise(8, 6)[..., 3])
    assert load_look(head_model("amber"), tmp_path / "looks" / "look.yaml") == look
    assert skin_image(load_look(head_model("amber"))) is None


def test_pixels_arrive_as_they_are(tmp_path):
    opaque = noise(5, 7)
    opaque[..., 3] = 255
    Image.fromarray(opaque).save(tmp_path / "a.png")
    Image.fromarray(opaque).save(tmp_path / "a.webp", lossless=True)
    Image.fromarray(opaque[..., :3]).save(tmp_path / "b.png")
    for name in ("a.png", "a.webp", "b.png"):
        np.testing.assert_array_equal(skin_image(read_look(look_with(tmp_path, name))), opaque)


@pytest.mark.parametrize("mode", ["1", "L", "LA", "P", "CMYK"])
def test_every_kind_of_8_bit_picture_is_taken(tmp_path, mode):
    smooth = np.repeat(np.linspace(40, 200, 16, dtype=np.uint8)[:, None, None], 16, axis=1).repeat(3, axis=2)
    name = "a.jpg" if mode == "CMYK" else "a.png"
    picture = Image.fromarray(smooth).convert(mode, dither=Image.Dither.NONE)
    picture.save(tmp_path / name)
    image = read_texture(tmp_path / name)
    assert (image[..., 3] == 255).all()
    assert np.ptp(image[..., 0].astype(int)) > 100
    assert np.abs(image[..., :3].astype(int) - picture.convert("RGB")).max() <= (8 if mode == "CMYK" else 0)


def test_a_photograph_stands_upright(tmp_path):
    smooth = np.zeros((32, 16, 3), np.uint8)
    smooth[:16] = 200
    exif = Image.Exif()
    exif[0x0112] = 6  # the camera lay on its side
    Image.fromarray(smooth).rotate(90, expand=True).save(tmp_path / "a.jpg", exif=exif, quality=95)
    image = read_texture(tmp_path / "a.jpg")
    assert image.shape == (32, 16, 4)
    assert image[:14, :, 0].min() > 190 > 10 > image[18:, :, 0].max()


@pytest.mark.parametrize("strength", [0.25, 0.5, 1.0])
def test_strength_is_in_the_alpha(tmp_path, strength):
    picture = noise(9, 9)
    Image.fromarray(picture).save(tmp_path / "a.png")
    image = skin_image(read_look(look_with(tmp_path, "a.png", texture_strength=strength)))
    np.testing.assert_array_equal(image[..., 3], np.round(strength * picture[..., 3]))


def test_what_does_not_show_is_no_picture(tmp_path):
    Image.fromarray(noise(9, 9)).save(tmp_path / "a.png")
    assert skin_image(read_look(look_with(tmp_path, "a.png", texture_strength=0))) is None
    Image.new("RGBA", (4, 4), (255, 0, 0, 0)).save(tmp_path / "a.png")
    assert skin_image(read_look(look_with(tmp_path, "a.png"))) is None


def test_a_large_picture_is_made_smaller_without_dark_rims(tmp_path):
    picture = np.zeros((120, 300, 4), np.uint8)  # black where nothing shows
    picture[:, 101:203] = (250, 120, 80, 255)
    Image.fromarray(picture).save(tmp_path / "a.png")
    image = skin_image(read_look(look_with(tmp_path, "a.png")), largest=100)
    assert image.shape == (40, 100, 4)
    assert np.abs(image[..., :3].astype(int) - (250, 120, 80)).max() <= 3
    assert image[..., 3].astype(float).mean() == pytest.approx(255 * 102 / 300, rel=0.01)
    assert skin_image(read_look(look_with(tmp_path, "a.png"))).shape == (120, 300, 4)


def test_a_picture_that_was_painted_over_is_read_anew(tmp_path):
    for colour in ((200, 10, 10), (10, 200, 10)):
        Image.new("RGB", (30, 30), colour).save(tmp_path / "a.png")
        (tmp_path / "a.png").chmod(0o644)
        image = read_texture(tmp_path / "a.png")
        with pytest.raises(ValueError, match="read-only"):
            image[0, 0, 0] = 1
    assert tuple(image[0, 0, :3]) == (10, 200, 10)


@given(
    arrays(np.uint8, st.tuples(st.integers(1, 9), st.integers(1, 9), st.just(4)), elements=st.sampled_from([0, 7, 255]))
)
def test_colours_bleed_only_into_what_is_transparent(image):
    result = bled(image)
    shown = image[..., 3] > 0
    np.testing.assert_array_equal(result[..., 3], image[..., 3])
    np.testing.assert_array_equal(result[shown], image[shown])
    if shown.any():
        low, high = image[shown][:, :3].min(axis=0), image[shown][:, :3].max(axis=0)
        assert ((result[..., :3] >= low) & (result[..., :3] <= high)).all()


def test_colours_bleed_from_near():
    image = np.zeros((64, 64, 4), np.uint8)
    image[20:40, :10] = (255, 0, 0, 255)
    image[20:40, -10:] = (0, 0, 255, 255)
    result = bled(image)
    assert tuple(result[30, 12, :3]) == (255, 0, 0)
    assert tuple(result[30, 51, :3]) == (0, 0, 255)


def damaged(name, keep):
    def write(path):
        Image.fromarray(noise(64, 64, 3)).save(path.with_name(name))
        content = path.with_name(name).read_bytes()
        path.write_bytes(content[: int(keep * len(content))])

    return write


FAULTS = [
    (lambda path: None, "a picture file", "No such file"),
    (lambda path: path.mkdir(), "a picture file", "a folder"),
    (lambda path: path.write_text("not a picture"), "PNG, JPEG, WEBP", "something else"),
    (lambda path: path.write_bytes(b""), "PNG, JPEG, WEBP", "something else"),
    (lambda path: Image.new("L", (4, 4)).save(path, "GIF"), "PNG, JPEG, WEBP", "something else"),
    (damaged("a.png", 0.5), "an undamaged picture", "truncated"),
    (damaged("a.jpg", 0.5), "an undamaged picture", "truncated"),
    (lambda path: path.write_bytes(png_that_claims(64, 64)), "an undamaged picture", ""),
    (lambda path: path.write_bytes(png_that_claims(8193, 2)), "at most 8192 x 8192 pixels", "8193 x 2"),
    (lambda path: path.write_bytes(png_that_claims(10_000, 10_000)), "at most 8192", "10000 x 10000"),
    (lambda path: path.write_bytes(png_that_claims(60_000, 60_000)), "at most 8192", "far more"),
    (lambda path: Image.new("I;16", (4, 4)).save(path, "PNG"), "8 bits a channel", "the kind I"),
]


@pytest.mark.parametrize(("make", "expected", "got"), FAULTS)
def test_a_picture_that_cannot_be_worn_is_a_fault_of_the_look(tmp_path, make, expected, got):
    picture = tmp_path / "skin.png"
    make(picture)
    file = look_with(tmp_path, "skin.png")
    (line,) = [i for i, row in enumerate(file.read_text().splitlines(), 1) if "texture: skin.png" in row]
    with pytest.raises(DataError) as caught:
        read_look(file)
    (fault,) = caught.value.faults
    assert (fault.file, fault.line, fault.where) == (file, line, "skin.texture")
    assert expected in fault.expected
    assert str(picture) in fault.expected
    assert got in fault.got
    checked = call("check", file)
    assert checked.exit_code == 1
    assert f"{file}:{line}: skin.texture: expected" in checked.output
    drawn = call("render", "--look", file, "-o", tmp_path / "out.png")
    assert drawn.exit_code == 1
    assert f"{file}:{line}: skin.texture" in drawn.output
    assert not (tmp_path / "out.png").exists()


@pytest.mark.parametrize(
    ("values", "where"),
    [
        ({"texture": 3}, "skin.texture"),
        ({"texture": ["a.png"]}, "skin.texture"),
        ({"texture_strength": 1.5}, "skin.texture_strength"),
        ({"texture_strength": "much"}, "skin.texture_strength"),
        ({"textures": "a.png"}, "skin.textures"),
    ],
)
def test_other_faults_of_the_keys_are_told(tmp_path, values, where):
    file = look_with(tmp_path, "a.png")
    data = yaml.safe_load(file.read_text())
    data["skin"] = {**data["skin"], **values}
    file.write_text(yaml.safe_dump(data))
    with pytest.raises(DataError) as caught:
        read_look(file)
    assert where in [fault.where for fault in caught.value.faults]


def test_a_picture_that_went_since_is_a_fault(tmp_path):
    Image.fromarray(noise(4, 4)).save(tmp_path / "a.png")
    look = read_look(look_with(tmp_path, "a.png"))
    (tmp_path / "a.png").unlink()
    with pytest.raises(DataError, match=r"a\.png: expected a picture file, got No such file"):
        skin_image(look)


def test_check_reads_the_looks_of_a_face(tmp_path):
    face = shutil.copytree(face_folder("amber"), tmp_path / "mine")
    assert call("check", face).exit_code == 0
    (face / "looks" / "painted.yaml").write_text((look_with(tmp_path / "other", "none.png")).read_text())
    checked = call("check", face)
    assert checked.exit_code == 1
    assert "painted.yaml" in checked.output
    assert "none.png" in checked.output


@pytest.fixture(scope="module", params=["amber", "onyx"])
def template(request):
    model = head_model(request.param)
    look = load_look(model)
    return model, look, skin_template(model, look, SIZE)


def linear(image):
    c = image[..., :3] / 255.0
    return np.where(c <= 0.04045, c / 12.92, ((c + 0.055) / 1.055) ** 2.4)


def at_vertices(model, image):
    column, row = np.clip(model.uv * SIZE, 0, SIZE - 1).astype(int).T
    return image[row, column]


@pytest.mark.gl
def test_the_template_is_opaque_where_the_face_is_and_nowhere_else(template):
    model, _, image = template
    assert image.shape == (SIZE, SIZE, 4)
    assert image.dtype == np.uint8
    assert set(np.unique(image[..., 3])) == {0, 255}
    assert not image[:20, :20, 3].any()
    assert not image[-20:, -20:, 3].any()
    outer = (model.material[:, 1] < 0.5) & (model.uv_cover == 1.0) & (model.vertices[:, 1] > -0.12)
    assert (at_vertices(model, image)[outer, 3] == 255).mean() > 0.99
    eye = model.uv[model.material[:, 2] > 0.5]
    left = eye[eye[:, 0] > 0.5] * SIZE
    (low_x, low_y), (high_x, high_y) = np.floor(left.min(axis=0)).astype(int), np.ceil(left.max(axis=0)).astype(int)
    assert (image[low_y:high_y, low_x:high_x, 3] == 0).any(), "the eyes are holes"


@pytest.mark.gl
def test_the_template_has_the_colours_of_the_look(template):
    model, look, image = template
    seen = at_vertices(model, linear(image))
    at = model.landmarks
    forehead = np.linalg.norm(model.vertices - 0.5 * (at["hairline_middle"] + at["glabella"]), axis=1) < 0.012
    np.testing.assert_allclose(seen[forehead], np.broadcast_to(look.skin.tone, (forehead.sum(), 3)), rtol=0.12)
    # outer faces of the lips: light reaches them
    lips = (model.material[:, 0] > 0.95) & (model.shade[:, 0] > 0.3)
    redness = seen[:, 0] / seen[:, 1]
    assert redness[lips].min() > 1.2 * np.median(redness[forehead])
    red = at_vertices(model, image)[lips].astype(int)
    assert np.ptp(red, axis=0).max() < 18, "from the browner upper lip to the lower one, nothing of the mouth's inside"


@pytest.mark.gl
def test_the_template_is_its_own_mirror_image(template):
    _, _, image = template
    apart = np.abs(image.astype(int) - image[:, ::-1]).max(axis=2)
    assert (apart > 6).mean() < 0.01


@pytest.mark.gl
def test_the_template_of_a_face_with_coordinates_of_its_own_follows_them():
    model = head_model("amber")
    model = replace(model, triangles=model.triangles[(model.uv_cover[model.triangles] > 0.0).all(axis=1)])
    turned = replace(model, own_uv=np.ascontiguousarray(model.uv[:, ::-1]))
    look = load_look(model)
    straight, swapped = skin_template(model, look, SIZE), skin_template(turned, look, SIZE)
    both = (straight[..., 3] > 0) & (swapped[..., 3] > 0).T
    apart = np.abs(straight.astype(int) - swapped.swapaxes(0, 1)).max(axis=2)
    assert both.mean() > 0.6
    assert (apart[both] > 6).mean() < 0.01


@pytest.mark.gl
def test_the_command_writes_the_template_and_the_guide(tmp_path):
    plain, guide = tmp_path / "skin.png", tmp_path / "guide.webp"
    assert call("unwrap", "--face", "onyx", "--size", SIZE, "-o", plain).exit_code == 0
    assert call("unwrap", "--face", "onyx", "--size", SIZE, "--lines", "-o", guide).exit_code == 0
    model = head_model("onyx", asymmetry=1.0)
    np.testing.assert_array_equal(read_texture(plain), skin_template(model, load_look(model), SIZE))
    drawn = np.asarray(Image.open(guide).convert("RGBA"))
    assert drawn.shape == (SIZE, SIZE, 4)
    changed = np.abs(drawn.astype(int) - read_texture(plain)).max(axis=2) > 20
    assert 0.1 < changed.mean() < 0.9
    lighter = tmp_path / "umber.png"
    assert call("unwrap", "--look", "umber", "--size", SIZE, "-o", lighter).exit_code == 0
    assert (read_texture(lighter) != read_texture(plain)).any()
    worn = read_look(look_with(tmp_path, "skin.png"))
    np.testing.assert_array_equal(skin_image(worn)[..., 3], read_texture(plain)[..., 3])


@pytest.mark.parametrize(
    ("words", "code", "told"),
    [
        (["-o", "a.jpg"], 1, "transparent"),
        (["-o", "no/folder/a.png"], 1, "no folder"),
        (["-o", "a.png", "--face", "ambre"], 1, "did you mean amber"),
        (["-o", "a.png", "--look", "nobody"], 1, "known"),
        (["-o", "a.png", "--deformer", "jelly"], 1, "geometric"),
        (["-o", "a.png", "--size", "20000"], 2, "4096"),
        (["--size", "256"], 2, "--output"),
    ],
)
def test_the_command_says_what_is_wrong_and_writes_nothing(tmp_path, monkeypatch, words, code, told):
    monkeypatch.chdir(tmp_path)
    result = call("unwrap", *words)
    assert result.exit_code == code
    assert told in result.output
    assert not list(tmp_path.iterdir())


@pytest.mark.slow
@pytest.mark.gl
@pytest.mark.parametrize("quality", ["fast", "portrait"])
def test_a_worn_picture_shows_where_its_coordinates_say(tmp_path, quality):
    model = head_model("amber")
    half = np.zeros((64, 64, 4), np.uint8)
    half[:, :32] = (20, 40, 200, 255)  # the person's right
    Image.fromarray(half).save(tmp_path / "half.png")
    geometry = FaceGeometry.at_rest(model)
    pictures = []
    for look in (load_look(model), read_look(look_with(tmp_path / "worn", tmp_path / "half.png"))):
        renderer = Renderer(model, look)
        pictures.append(renderer.render(geometry, (160, 120), "front", quality).astype(int))
        renderer.close()
    plain, painted = pictures
    right, left = np.s_[62:70, 60:68], np.s_[62:70, 92:100]  # cheeks
    assert (painted[right][..., 2] > painted[right][..., 0] + 40).all()
    assert (plain[right][..., 2] < plain[right][..., 0]).all()
    assert np.abs(painted[left] - plain[left]).max() <= 6
    np.testing.assert_array_equal(painted[:8], plain[:8])
