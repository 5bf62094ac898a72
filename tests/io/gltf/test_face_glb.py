"""GLB files of a face: Khronos' validator finds nothing, and three.js shows what the engine does."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from agentface.arkit.shape_solver import ShapeSolver
from agentface.deform.geometry import FaceGeometry
from agentface.head.arkit import ARKIT_SHAPES
from agentface.io.gltf.face_parts import face_parts, released
from agentface.parameters import FacePose
from agentface.view.parts.shirt import shirt
from tests.browser import address, places, viewer
from tests.gltf_validator import issues

pytestmark = [pytest.mark.gl, pytest.mark.slow]
NEAR_MM = 0.01


@pytest.fixture(scope="module")
def page():
    with viewer() as shown:
        yield shown


def in_the_room(geometry: FaceGeometry, rows: np.ndarray) -> np.ndarray:
    return rows.astype(np.float64) @ geometry.head[:3, :3].T.astype(np.float64) + geometry.head[:3, 3]


def off_mm(first: np.ndarray, second: np.ndarray) -> float:
    return float(1e3 * np.linalg.norm(first - second, axis=1).max())


def lower_teeth(model: Any, geometry: FaceGeometry) -> np.ndarray:
    rows = model.parts["teeth_lower"].attributes["POSITION"]
    return in_the_room(geometry, rows @ geometry.jaw[:3, :3].T + geometry.jaw[:3, 3])


def test_the_validator_finds_nothing(arkit_file, played_file):
    assert issues(arkit_file.path, played_file.path) == {str(arkit_file.path): [], str(played_file.path): []}


def test_three_shows_arkit_s_shapes_as_the_engine_does(page, arkit_file, model, deformer):
    solver = ShapeSolver(model)
    found = page.evaluate("url => load(url)", address(arkit_file.path))
    assert set(found["meshes"]["skin"]["shapes"]) == set(ARKIT_SHAPES)
    assert {"jawOpen", "tongueOut", "jawLeft"} <= set(found["meshes"]["tongue"]["shapes"])
    assert off_mm(places(page, "skin"), model.vertices) < NEAR_MM
    for name in ("jawOpen", "mouthSmileLeft", "eyeLookUpRight", "cheekPuff"):
        page.evaluate("name => shape({[name]: 1})", name)
        shown = deformer.at(solver.solve_named({name: 1.0}).pose)
        assert off_mm(places(page, "skin"), shown.vertices) < NEAR_MM, name
        if name == "jawOpen":
            assert off_mm(places(page, "teeth_lower"), lower_teeth(model, shown)) < NEAR_MM
    # what is seen only with an open jaw goes on top of that
    page.evaluate("shape({jawOpen: 1, mouthClose: 1})")
    shown = deformer.at(solver.solve_named({"jawOpen": 1.0, "mouthClose": 1.0}).pose)
    assert off_mm(places(page, "skin"), shown.vertices) < NEAR_MM
    assert page.said == []


@pytest.mark.parametrize("angles", [(0.9, 0.0, 0.0), (0.3, -0.4, 0.25)])
def test_the_head_turns_on_its_neck(page, arkit_file, deformer, angles):
    yaw, pitch, roll = angles
    turned = deformer.at(FacePose.of(head_yaw=yaw, head_pitch=pitch, head_roll=roll))
    page.evaluate("url => load(url)", address(arkit_file.path))
    # R = Y(yaw) X(-pitch) Z(-roll), which three calls YXZ
    page.evaluate("([x, y, z]) => { scene_of('head').rotation.set(x, y, z, 'YXZ') }", [-pitch, yaw, -roll])
    assert off_mm(places(page, "skin"), in_the_room(turned, turned.vertices)) < NEAR_MM


def test_three_plays_a_performance_as_the_engine_does(page, played_file, model, deformer):
    error = played_file.made.figures["error_max_mm"]
    assert error <= 0.1
    page.evaluate("url => load(url)", address(played_file.path))
    worn = shirt(model)[0]
    for pose, time in zip(played_file.poses, played_file.times_s, strict=True):
        page.evaluate("time => seek(time)", time)
        shown = deformer.at(pose)
        tongue = shown.tongue @ shown.jaw[:3, :3].T + shown.jaw[:3, 3]
        for name, rows in (
            ("skin", in_the_room(shown, shown.vertices)),
            ("teeth_lower", lower_teeth(model, shown)),
            ("tongue", in_the_room(shown, tongue)),
        ):
            assert off_mm(places(page, name), rows) < error + NEAR_MM, (name, time)
        for number, side in enumerate("lr"):
            centre = model.eye_centre(side)
            rows = model.parts[f"eye_{side}"].attributes["POSITION"] - centre
            eye = rows @ shown.eye_rotations[number].T + centre + [0.0, 0.0, shown.eye_thrust[number]]
            assert off_mm(places(page, f"eye_{side}"), in_the_room(shown, eye)) < NEAR_MM
        breathing = worn @ shown.shoulders[:3, :3].T + shown.shoulders[:3, 3]
        assert off_mm(places(page, "shirt"), breathing) < NEAR_MM
    assert page.said == []


def test_what_rides_on_the_skin_follows_it(page, played_file, face_glb, model, deformer):
    """The eyes' linings hang on no mode of their own, and yet lie on the skin; brows and lashes turn with it."""
    parts = {part.name: part for part in face_parts(model, face_glb.look)}
    page.evaluate("url => load(url)", address(played_file.path))
    for pose, time in list(zip(played_file.poses, played_file.times_s, strict=True))[1:]:
        page.evaluate("time => seek(time)", time)
        shown = deformer.at(pose)
        for name in ("brows", "lashes", "lining_l"):
            rows = in_the_room(shown, parts[name].at(released(model, shown))[0])
            assert off_mm(places(page, name), rows) < played_file.made.figures["error_max_mm"] + NEAR_MM, name


def test_everything_that_has_a_picture_shows_one(page, arkit_file):
    page.evaluate("url => load(url)", address(arkit_file.path))
    pictures = page.evaluate("pictures()")
    assert pictures["skin"] == [1024, 1024]
    assert pictures["eye_l"] == pictures["eye_r"] == [512, 512]
    assert pictures["hair_sheet_0"] == [1024, 1024]
    assert pictures["teeth_upper"] is None
    assert {"skin", "teeth_upper", "teeth_lower", "tongue", "eye_l", "eye_r", "brows", "lashes", "hair", "scalp",
            "shirt"} <= pictures.keys()  # fmt: skip


def test_the_figures_are_those_of_the_file(arkit_file, played_file):
    figures = arkit_file.made.figures
    assert figures["bytes"] == arkit_file.path.stat().st_size
    assert figures["shapes"] == list(ARKIT_SHAPES)
    assert "error_max_mm" not in figures
    figures = played_file.made.figures
    assert figures["frames"] == len(played_file.poses)
    assert figures["duration_s"] == pytest.approx(played_file.times_s[-1])
    assert 0.0 <= figures["error_rms_mm"] <= figures["error_max_mm"] <= 0.1


def test_the_same_face_gives_the_same_bytes(arkit_file, face_glb):
    assert face_glb.with_arkit().content == arkit_file.made.content
