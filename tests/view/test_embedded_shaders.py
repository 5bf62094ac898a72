"""The shaders for WebGL 2: the same text, with another beginning."""

from __future__ import annotations

import re

import pytest

from agentface.errors import GraphicsError
from agentface.view.gl.source import embedded, read_source
from agentface.view.portrait import programs


def test_only_the_beginning_differs():
    for name, defines in (("skin.frag.glsl", ("WRINKLED",)), ("strand.vert.glsl", ()), ("eye.frag.glsl", ())):
        source = read_source(name, defines=defines)
        made = embedded(source)
        assert made.startswith("#version 300 es\nprecision highp float;\n")
        kept = [line for line in source.text.splitlines()[1:] if line and not line.startswith("#line")]
        assert made.splitlines()[-len(kept) :] == kept
        assert "#include" not in made


def test_a_shader_of_another_version_is_refused(tmp_path):
    (tmp_path / "old.glsl").write_text("#version 120\nvoid main() {}\n")
    with pytest.raises(GraphicsError, match=r"old\.glsl:1: expected #version 330 core"):
        embedded(read_source("old.glsl", tmp_path))


def declared(shader: str, way: str) -> set[str]:
    lines = re.findall(rf"^(?:(?:flat|centroid) )?{way} \w+ ([\w, ]+);", shader, re.MULTILINE)
    return {name for line in lines for name in line.split(", ")}


@pytest.mark.parametrize("textured", [False, True])
def test_every_input_of_a_fragment_is_an_output_of_its_vertex(textured):
    made = programs(textured=textured)
    assert {"skin", "skin-wrinkled", "eye", "part", "lining", "cloth", "ribbon", "strand", "sheet", "cap"} <= {*made}
    for name, program in made.items():
        assert declared(program["fragment"], "in") <= declared(program["vertex"], "out"), name
    assert ("#define TEXTURED" in made["skin"]["fragment"]) == textured
    assert "#define WRINKLED" in made["skin-wrinkled"]["vertex"]


def test_no_number_of_another_kind_stands_where_es_wants_a_float():
    """GLSL ES has no implicit conversions: a whole number beside a float does not compile there."""
    beside = re.compile(r"(?<![\w.\[])(?:\d+\.\d+\s*[-+*/]\s*\d+(?![\w.])|\d+\s*[-+*/]\s*\d+\.\d+)")
    for program in programs(textured=True).values():
        for text in program.values():
            assert beside.findall(re.sub(r"//[^\n]*", "", text)) == []
