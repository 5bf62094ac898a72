"""VRM avatars: three-vrm loads and poses them, and shows what the engine does."""

from __future__ import annotations

import json
import math
import struct
from typing import Any

import numpy as np
import pytest

from agentface.deform.protocol import make_deformer
from agentface.head.arkit import ARKIT_SHAPES
from agentface.head.look import load_look
from agentface.head.model import load_model
from agentface.head.provenance import Origin, Provenance, read_provenance
from agentface.io.gltf.face_parts import face_parts
from agentface.io.vrm.avatar import encode_avatar
from agentface.io.vrm.expressions import ExpressionBaker
from agentface.io.vrm.licence import meta_of
from agentface.io.vrm.skeleton import bones_of
from agentface.parameters import FacePose
from tests.browser import address, places, viewer
from tests.gltf_validator import issues

REQUIRED = {
    *("hips", "spine", "head"), *(f"{side}{bone}" for side in ("left", "right") for bone in
    ("UpperLeg", "LowerLeg", "Foot", "UpperArm", "LowerArm", "Hand")),
}  # fmt: skip
PRESETS = {
    "happy", "angry", "sad", "relaxed", "surprised", "neutral", "aa", "ih", "ou", "ee", "oh", "blink", "blinkLeft",
    "blinkRight", "lookUp", "lookDown", "lookLeft", "lookRight",
}  # fmt: skip
NEAR_MM = 0.01


@pytest.fixture(scope="module")
def model():
    return load_model("amber")


@pytest.fixture(scope="module")
def deformer(model):
    return make_deformer("geometric", model)


@pytest.fixture(scope="module")
def pose_of(model, deformer):
    return ExpressionBaker(model, deformer, face_parts(model, load_look(model))).pose


@pytest.fixture(scope="module")
def made(model, deformer):
    return encode_avatar(model, load_look(model), deformer)


@pytest.fixture(scope="module")
def file(made, tmp_path_factory):
    path = tmp_path_factory.mktemp("vrm") / "amber.vrm"
    path.write_bytes(made.content)
    return path


@pytest.fixture(scope="module")
def document(made) -> dict[str, Any]:
    return json.loads(made.content[20 : 20 + struct.unpack_from("<I", made.content, 12)[0]])


@pytest.fixture(scope="module")
def page(file):
    with viewer() as shown:
        shown.found = shown.evaluate("url => load(url)", address(file))
        yield shown


@pytest.fixture(scope="module")
def origin(model):
    """Where the model's origin stands in an avatar: bones are over the ground."""
    return bones_of(model)["leftEye"][1] - model.eye_centre("l")


def off_mm(first: np.ndarray, second: np.ndarray) -> float:
    return float(1e3 * np.linalg.norm(first - second, axis=1).max())


@pytest.mark.gl
@pytest.mark.slow
def test_the_validator_finds_no_error_and_no_warning(file):
    (found,) = issues(file).values()
    assert {issue.split()[0] for issue in found} <= {"information"}
    # bones without a mesh, an extension that is not Khronos', and the thumbnail, which that has
    assert {issue.split()[1] for issue in found} == {"UNSUPPORTED_EXTENSION", "NODE_EMPTY", "UNUSED_OBJECT"}


@pytest.mark.gl
@pytest.mark.slow
def test_three_vrm_knows_bones_expressions_and_licence(page):
    assert REQUIRED | {"chest", "neck", "leftEye", "rightEye"} == set(page.found["joints"])
    assert PRESETS | set(ARKIT_SHAPES) == set(page.found["expressions"])
    meta = page.found["meta"]
    assert meta["thumbnailImage"] is True
    assert meta["avatarPermission"] == "everyone"
    assert meta["commercialUsage"] == "corporation"
    assert page.said == []


@pytest.mark.gl
@pytest.mark.slow
@pytest.mark.parametrize("name", ["happy", "surprised", "aa", "blinkLeft"])
def test_an_expression_is_the_engine_s(page, model, deformer, pose_of, origin, name):
    shown = deformer.at(pose_of(name))
    page.evaluate("name => pose({expressions: {[name]: 1}})", name)
    assert off_mm(places(page, "skin") - origin, shown.vertices) < NEAR_MM
    rows = model.parts["teeth_lower"].attributes["POSITION"]
    teeth = rows @ shown.jaw[:3, :3].T + shown.jaw[:3, 3]
    assert off_mm(places(page, "teeth_lower") - origin, teeth) < NEAR_MM


@pytest.mark.gl
@pytest.mark.slow
def test_the_eyes_look_where_they_are_told(page, model, deformer, pose_of, origin):
    """By the bones, which have no torsion, the pupils go where the engine's do; by the expressions all of the eye."""
    shown = deformer.at(FacePose.of(gaze_yaw=math.radians(20), gaze_pitch=math.radians(8)))
    middle = origin + 0.5 * (model.eye_centre("l") + model.eye_centre("r"))
    page.evaluate("point => pose({gaze: point})", (middle + 50.0 * shown.eye_rotations[0][:, 2]).tolist())
    for number, side in enumerate("lr"):
        centre = model.eye_centre(side)
        rows = model.parts[f"eye_{side}"].attributes["POSITION"] - centre
        pupil = int(rows[:, 2].argmax())
        there = places(page, f"eye_{side}") - origin - centre
        turned = rows @ shown.eye_rotations[number].T
        assert off_mm(there[pupil : pupil + 1], turned[pupil : pupil + 1]) < 0.05
    page.evaluate("pose({expressions: {lookLeft: 1}})")
    shown = deformer.at(pose_of("lookLeft"))
    rows = model.parts["eye_l"].attributes["POSITION"] - model.eye_centre("l")
    turned = rows @ shown.eye_rotations[0].T + model.eye_centre("l")
    assert off_mm(places(page, "eye_l") - origin, turned) < NEAR_MM
    assert shown.eye_rotations[0][0, 2] > 0.4  # +X is the person's left


@pytest.mark.gl
@pytest.mark.slow
def test_a_wide_mouth_holds_the_visemes_back(page, made):
    assert "mouth" in made.figures["overrides"]["surprised"]
    page.evaluate("pose({expressions: {surprised: 1}})")
    alone = places(page, "skin")
    page.evaluate("pose({expressions: {surprised: 1, aa: 1}})")
    assert off_mm(places(page, "skin"), alone) < NEAR_MM
    page.evaluate("pose({expressions: {relaxed: 1}})")
    alone = places(page, "skin")
    page.evaluate("pose({expressions: {relaxed: 1, aa: 1}})")
    assert off_mm(places(page, "skin"), alone) > 3.0


@pytest.mark.gl
@pytest.mark.slow
def test_the_head_turns_and_the_shoulders_do_not(page, model, origin):
    page.evaluate("pose({bones: {head: [0, 0.6, 0]}})")
    skin, stands = places(page, "skin") - origin, model.vertices
    nose, collar = int(stands[:, 2].argmax()), int(stands[:, 1].argmin())
    assert skin[nose, 0] > stands[nose, 0] + 0.04  # to the person's left
    assert np.linalg.norm(skin[collar] - stands[collar]) < 1e-5


@pytest.mark.gl
@pytest.mark.slow
def test_the_document_has_what_the_specification_asks_for(document, made):
    vrm = document["extensions"]["VRMC_vrm"]
    assert sorted(document["extensionsUsed"]) == ["KHR_materials_ior", "VRMC_vrm"]
    assert vrm["specVersion"] == "1.0"
    assert vrm["meta"]["licenseUrl"] == "https://vrm.dev/licenses/1.0/"
    assert set(vrm["expressions"]["preset"]) == PRESETS
    assert vrm["lookAt"]["type"] == "bone"
    for row in (*vrm["expressions"]["preset"].values(), *vrm["expressions"]["custom"].values()):
        for bind in row.get("morphTargetBinds", []):
            mesh = document["meshes"][document["nodes"][bind["node"]]["mesh"]]
            assert bind["index"] < len(mesh["extras"]["targetNames"])
    image = document["images"][vrm["meta"]["thumbnailImage"]]
    assert image["mimeType"] == "image/jpeg"
    assert made.figures["licences"] == ["CC0 1.0", "MIT"]


def test_bones_stand_as_a_person_does(model):
    bones = bones_of(model)
    assert bones.keys() >= REQUIRED
    assert bones["leftHand"][1][0] > bones["leftUpperArm"][1][0] > 0.0 > bones["rightUpperArm"][1][0]
    assert bones["head"][1][1] > bones["neck"][1][1] > bones["chest"][1][1] > bones["hips"][1][1] > 0.5
    for name, (parent, _) in bones.items():
        assert parent is None or list(bones).index(parent) < list(bones).index(name)


def test_a_face_of_unknown_origin_is_its_author_s_alone(tmp_path):
    meta = meta_of("mine", "1", read_provenance(tmp_path), 0)
    assert meta["avatarPermission"] == "onlyAuthor"
    assert meta["commercialUsage"] == "personalNonProfit"
    assert meta["modification"] == "prohibited"
    assert meta["allowRedistribution"] is False
    assert meta["creditNotation"] == "required"
    assert meta["authors"] == ["not stated"]


@pytest.mark.parametrize(
    ("licences", "permission", "credit"),
    [
        (("CC0 1.0",), "everyone", "unnecessary"),
        (("CC0 1.0", "MIT"), "everyone", "required"),
        (("CC0 1.0", "CC BY-NC 4.0"), "onlyAuthor", "required"),
    ],
)
def test_no_more_is_allowed_than_the_strictest_licence_allows(licences, permission, credit):
    provenance = Provenance(tuple(Origin("a mesh", "somebody", licence) for licence in licences))
    meta = meta_of("one", "1", provenance, 0)
    assert (meta["avatarPermission"], meta["creditNotation"]) == (permission, credit)
