import sys

import numpy as np
import pytest

from agentface import Face
from agentface.errors import GraphicsError
from agentface.resources import data_folder
from agentface.view.gl.context import compile_program, open_context
from agentface.view.gl.source import read_source

NOTHING = "#version 330 core\nvoid main() { gl_Position = vec4(0.0); }\n"


@pytest.fixture(scope="module")
def context():
    context = open_context()
    yield context
    context.release()


def test_includes_are_put_in_once_and_lines_are_kept(tmp_path):
    (tmp_path / "a.glsl").write_text('#include "b.glsl"\nfloat a;\n')
    (tmp_path / "b.glsl").write_text("float b;\n")
    (tmp_path / "main.glsl").write_text('#version 330 core\n#include "a.glsl"\n#include "b.glsl"\nfloat c;\n')
    source = read_source("main.glsl", tmp_path)
    lines = source.text.split("\n")
    assert [line for line in lines if line.startswith("float")] == ["float b;", "float a;", "float c;"]
    assert lines.index("#line 3 0") < lines.index("float c;")
    assert [path.name for path in source.files] == ["main.glsl", "a.glsl", "b.glsl"]


def test_defines_come_behind_the_version_and_lines_are_kept(tmp_path):
    (tmp_path / "main.glsl").write_text("// why\n#version 330 core\n#ifdef TWICE\nfloat a;\n#endif\n")
    lines = read_source("main.glsl", tmp_path, ("TWICE", "FAST")).text.split("\n")
    assert lines[1:5] == ["#version 330 core", "#define TWICE", "#define FAST", "#line 3 0"]
    assert lines[5] == "#ifdef TWICE"
    assert "#define" not in read_source("main.glsl", tmp_path).text


@pytest.mark.gl
def test_a_define_chooses_and_errors_keep_their_lines(context, tmp_path):
    (tmp_path / "pass.glsl").write_text(NOTHING)
    (tmp_path / "main.glsl").write_text(
        "#version 330 core\nout vec4 c;\nvoid main() {\n#ifdef WRONG\n    c = nothing;\n#endif\n}\n"
    )
    compile_program(context, "pass.glsl", "main.glsl", tmp_path, ("RIGHT",)).release()
    with pytest.raises(GraphicsError, match=r"main\.glsl:5"):
        compile_program(context, "pass.glsl", "main.glsl", tmp_path, ("RIGHT", "WRONG"))


def test_a_missing_include_names_the_line_that_wants_it(tmp_path):
    (tmp_path / "main.glsl").write_text('#version 330 core\n\n#include "nowhere.glsl"\n')
    with pytest.raises(GraphicsError, match=r"main\.glsl:3: .*nowhere\.glsl"):
        read_source("main.glsl", tmp_path)


@pytest.mark.gl
@pytest.mark.parametrize(
    ("main", "included", "where"),
    [
        (
            '#version 330 core\n#include "part.glsl"\nout vec4 c;\nvoid main() { c = nothing; }\n',
            "float x;\n",
            "main.frag.glsl:4",
        ),
        (
            '#version 330 core\n#include "part.glsl"\nout vec4 c;\nvoid main() { c = f(); }\n',
            "\n\nvec4 f() { return 1 }\n",
            "part.glsl:3",
        ),
    ],
)
def test_a_compiler_error_is_mapped_to_its_file_and_line(context, tmp_path, main, included, where):
    (tmp_path / "pass.glsl").write_text(NOTHING)
    (tmp_path / "main.frag.glsl").write_text(main)
    (tmp_path / "part.glsl").write_text(included)
    with pytest.raises(GraphicsError) as caught:
        compile_program(context, "pass.glsl", "main.frag.glsl", tmp_path)
    assert where in str(caught.value)


@pytest.mark.gl
def test_every_shader_compiles(context):
    fragments = {
        "ribbon": ["ribbon"],
        "strand": ["strand"],
        "skin": ["skin"],
        "skin_fast": ["skin_fast"],
        "part": ["part"],
        "cloth": ["cloth"],
        "unwrap": ["unwrap"],
        "eye": ["eye"],
        "anchored": ["part"],
        "cap": ["cap"],
        "cap_flat": ["cap"],
        "sheet": ["sheet"],
        "sheet_flat": ["sheet"],
        "screen": ["background", "copy", "eye_flat"],
        "bone": ["bone"],
        "film": ["film"],
    }
    folder = data_folder("shaders")
    assert {path.name.split(".")[0] for path in folder.glob("*.vert.glsl")} == {*fragments, "depth"}
    for vertex, used in fragments.items():
        for fragment in used:
            for defines in (
                ((), ("WRINKLED",), ("TEXTURED",), ("TEXTURED", "WRINKLED")) if vertex.startswith("skin") else ((),)
            ):
                compile_program(context, f"{vertex}.vert.glsl", f"{fragment}.frag.glsl", defines=defines).release()
    compile_program(context, "depth.vert.glsl", None).release()


def test_without_opengl_the_error_names_the_packages(monkeypatch):
    import moderngl

    def refuse(**_):
        raise Exception("libEGL.so not loaded")

    monkeypatch.setattr(moderngl, "create_context", refuse)
    with pytest.raises(GraphicsError, match=r"(?s)libEGL\.so not loaded.*apt-get install .*libegl1 libgl1"):
        open_context()


@pytest.mark.slow
@pytest.mark.parametrize("package", ["moderngl", "glcontext.egl"])
def test_a_missing_package_is_not_blamed_on_the_system(monkeypatch, package):
    monkeypatch.setitem(sys.modules, package, None)
    with pytest.raises(GraphicsError, match=rf"Python packages moderngl and glcontext.*{package}") as caught:
        open_context()
    assert "pip install" in str(caught.value)
    assert "apt-get" not in str(caught.value)


@pytest.mark.gl
def test_faces_in_turn_each_draw_in_their_own_context():
    faces = [Face(name, compiled=False) for name in ("amber", "onyx")]
    first = [face.render((64, 48)) for face in faces]
    assert np.abs(first[0].astype(int) - first[1]).max() > 50
    for _ in range(2):
        for face, picture in zip(faces, first, strict=True):
            np.testing.assert_array_equal(face.render((64, 48)), picture)
