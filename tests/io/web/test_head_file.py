"""The head as a page takes it, read back by another method, and by Khronos' validator."""

from __future__ import annotations

import json
import os
import struct
import subprocess

import numpy as np
import pytest

from agentface.head.look import load_look, look_names
from agentface.io.web.basis import Basis
from agentface.io.web.head_file import EXTENSION, encode_head
from agentface.io.web.modes import Modes
from agentface.view.portrait import portrait
from tests import tools
from tests.npm import node_modules

_TYPES = {"f32": "<f4", "i32": "<i4", "u32": "<u4", "i16": "<i2", "u16": "<u2", "i8": "<i1", "u8": "<u1"}
CHECK = """
const { validateBytes } = require('gltf-validator');
const content = new Uint8Array(require('fs').readFileSync(0));
validateBytes(content).then(({ issues }) => console.log(JSON.stringify(issues)));
"""


@pytest.fixture(scope="module")
def small_basis(model):
    rng = np.random.default_rng(3)
    skin, tongue = (
        Modes(rng.integers(-32767, 32767, (2, count, 3)).astype(np.int16), np.array([1e-6, 2e-7], np.float32))
        for count in (len(model.vertices), len(model.parts["tongue"].attributes["POSITION"]))
    )
    return Basis(skin, tongue)


@pytest.fixture(scope="module")
def content(model, small_basis):
    return encode_head(model, load_look(model), small_basis)


def read(content):
    """The document, and a function that gives what one of the extension's ``{"array": n}`` stands for."""
    magic, version, length, size, kind = struct.unpack_from("<4sIII4s", content)
    assert (magic, version, length, kind) == (b"glTF", 2, len(content), b"JSON")
    document = json.loads(content[20 : 20 + size])
    arrays = document["extensions"][EXTENSION]["arrays"]

    def array(named):
        row = arrays[named["array"]]
        view, shape = document["bufferViews"][row["view"]], row["shape"]
        stored = np.frombuffer(content, _TYPES[row["type"]], int(np.prod(shape)), 28 + size + view["byteOffset"])
        return stored.reshape(shape) * row.get("scale", 1)

    return document, array


def compared(stored, made, array, place=""):
    """Everything that was made is stored under its name, to what a rounded number may lose."""
    if isinstance(made, np.ndarray):
        found = array(stored)
        assert found.shape == made.shape, place
        np.testing.assert_allclose(found, made, rtol=1e-6, atol=2e-5 if made.dtype.kind == "f" else 0, err_msg=place)
    elif isinstance(made, dict):
        for name, part in made.items():
            compared(stored[name], part, array, f"{place}/{name}")
    elif isinstance(made, (list, tuple)):
        assert len(stored) == len(made), place
        for number, part in enumerate(made):
            compared(stored[number], part, array, f"{place}/{number}")
    else:
        assert stored == made, place


def test_all_of_a_portrait_is_in_the_file(model, content, small_basis):
    document, array = read(content)
    stored = document["extensions"][EXTENSION]
    compared(stored, portrait(model, load_look(model)), array)
    compared(stored["basis"], {"skin": small_basis.skin._asdict(), "tongue": small_basis.tongue._asdict()}, array)
    assert (array(stored["rest"]["vertices"]) == model.vertices).all()
    assert (array(stored["rest"]["triangles"]) == model.triangles).all()


def test_a_picture_worn_as_skin_goes_along(model, small_basis):
    worn = [load_look(model, name) for name in look_names(model)]
    look = next((look for look in worn if look.skin.texture is not None), None)
    if look is None:
        plain = load_look(model)
        assert read(encode_head(model, plain, small_basis))[0]["extensions"][EXTENSION]["picture"] is None
        return
    document, array = read(encode_head(model, look, small_basis))
    assert array(document["extensions"][EXTENSION]["picture"]).astype(np.uint8).tobytes().startswith(b"\x89PNG")


def test_khronos_validator_finds_no_fault(content):
    tools.require("node")
    environment = os.environ | {"NODE_PATH": str(node_modules("gltf-validator", "2.0.0-dev.3.10"))}
    run = subprocess.run(
        ["node", "-e", CHECK], input=content, capture_output=True, env=environment, check=True, timeout=120
    )
    issues = json.loads(run.stdout)
    assert (issues["numErrors"], issues["numWarnings"]) == (0, 0), issues["messages"][:5]
