"""Wherever a path is taken, a ``str`` is one."""

from __future__ import annotations

import ast
import shutil
from pathlib import Path

import numpy as np
import pytest

import agentface
from agentface.config import Document
from agentface.emotion.tables import load_blends, load_emotions
from agentface.errors import AgentFaceError
from agentface.facs.action_units import load_action_units
from agentface.head.look import load_look, read_look
from agentface.head.model import load_model
from agentface.io.emotionml import load_emotionml
from agentface.io.files import check_writable, write_file
from agentface.io.picture import write_picture
from agentface.io.sequence import SequenceWriter
from agentface.io.video import VideoWriter
from agentface.mesh.glb import read_glb, write_glb
from agentface.resources import face_folder, rules_file
from agentface.tissue.reading import anatomy_file, read_tissue, tissue_of
from agentface.view.gl.source import read_source
from tests.heads import head_model

PACKAGE = Path(agentface.__file__).parent
PICTURE = np.zeros((48, 64, 3), np.uint8)
INSIDE = {"cannot_write", "keep_newest", "tell_no_cache", "read_xml"}
"""What only agentface itself calls, with paths that it made."""


def public_functions(tree: ast.Module | ast.ClassDef):
    for node in tree.body:
        if isinstance(node, ast.ClassDef) and not node.name.startswith("_"):
            yield from public_functions(node)
        if isinstance(node, ast.FunctionDef) and (node.name == "__init__" or not node.name.startswith("_")):
            yield node


def test_no_public_function_takes_a_path_alone():
    wrong = [
        f"{path}:{node.lineno}: {node.name}({argument.arg})"
        for path in PACKAGE.rglob("*.py")
        for node in public_functions(ast.parse(path.read_text()))
        if node.name not in INSIDE and not any("click" in ast.unparse(mark) for mark in node.decorator_list)
        for argument in [*node.args.args, *node.args.kwonlyargs]
        if argument.annotation is not None and ast.unparse(argument.annotation) in ("Path", "Path | None")
    ]
    assert wrong == []


READERS = [
    (load_emotions, rules_file("emotions.yaml")),
    (load_blends, rules_file("blends.yaml")),
    (load_action_units, rules_file("action_units.yaml")),
    (Document, rules_file("emotions.yaml")),
    (read_tissue, anatomy_file()),
    (tissue_of, face_folder("amber")),
    (read_look, face_folder("amber") / "look.yaml"),
    (read_glb, face_folder("amber") / "head.glb"),
    (load_model, face_folder("onyx")),
    (lambda path: load_look(head_model("amber"), path), face_folder("amber") / "look.yaml"),
    (lambda path: read_source("skin.vert.glsl", path), PACKAGE.parent / "shaders"),
]


@pytest.mark.parametrize(("read", "path"), READERS)
def test_readers_take_text(read, path):
    assert read(str(path)) is not None


@pytest.mark.parametrize(("read", "path"), READERS)
def test_readers_tell_in_our_words_what_is_not_there(read, path, tmp_path):
    with pytest.raises(AgentFaceError):
        read(str(tmp_path / "nothing" / path.name))


def test_emotionml_is_read(tmp_path):
    (tmp_path / "one.xml").write_text(
        '<emotion xmlns="http://www.w3.org/2009/10/emotionml" category-set='
        '"http://www.w3.org/TR/emotion-voc/xml#big6" duration="500"><category name="anger"/></emotion>'
    )
    assert load_emotionml(str(tmp_path / "one.xml")).length_s == 0.75  # with its fade


def test_writers_take_text(tmp_path):
    folder = str(tmp_path)
    check_writable(folder + "/a.bin")
    write_file(folder + "/a.bin", b"a")
    write_picture(folder + "/a.png", PICTURE)
    write_glb(folder + "/a.glb", read_glb(str(shutil.copy(face_folder("amber") / "head.glb", tmp_path))), "")
    with VideoWriter(folder + "/a.mp4", (64, 48), fps=30) as film:
        film.add(PICTURE, 0.0)
    with SequenceWriter(folder + "/a-%03d.png", (64, 48), fps=30) as pictures:
        pictures.add(PICTURE, 0.0)
    assert {path.name for path in tmp_path.iterdir()} >= {"a.bin", "a.png", "a.glb", "a.mp4", "a-000.png"}
