from contextlib import suppress
from typing import Annotated, Literal

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import Field

from agentface.config import Document, Table, load
from agentface.errors import DataError


class Row(Table):
    name: str
    weight: float
    parts: list[int] = []


def write(tmp_path, text):
    path = tmp_path / "file.yaml"
    path.write_text(text, encoding="utf-8")
    return path


def faults_of(tmp_path, text):
    with pytest.raises(DataError) as caught:
        load(write(tmp_path, text), Row)
    return caught.value.faults


def test_reads_a_good_file(tmp_path):
    row = load(write(tmp_path, "name: a\nweight: 0.5\nparts: [1, 2]\n"), Row)
    assert (row.name, row.weight, row.parts) == ("a", 0.5, [1, 2])


def test_reports_all_faults_of_a_file_with_their_lines(tmp_path):
    faults = faults_of(tmp_path, "name: 3\nweight: heavy\nparts:\n  - 1\n  - x\ncolour: red\n")
    assert [(fault.line, fault.where) for fault in faults] == [
        (1, "name"),
        (2, "weight"),
        (5, "parts.1"),
        (6, "colour"),
    ]
    assert "expected no such key" in str(faults[3])


def test_a_missing_key_is_named(tmp_path):
    (fault,) = faults_of(tmp_path, "name: a\n")
    assert (fault.where, fault.expected) == ("weight", "this key")


@pytest.mark.parametrize("word", ["yes", "no", "on", "off"])
def test_yes_and_no_are_words_not_booleans(tmp_path, word):
    assert load(write(tmp_path, f"name: {word}\nweight: 1\n"), Row).name == word


@pytest.mark.parametrize(
    ("text", "line", "got"),
    [
        ("name: a\nname: b\nweight: 1\n", 2, "the key a second time"),
        ("name: &x [1]\nweight: 1\nparts: *x\n", 1, "an alias"),
        ("name: a\nweight: .nan\n", 2, "nan"),
        ("name: [a\n", None, ""),
        ("", 1, "an empty file"),
        ("name: !!python/object:os.system x\n", None, ""),
    ],
)
def test_refuses_what_plain_yaml_lets_pass(tmp_path, text, line, got):
    fault = faults_of(tmp_path, text)[0]
    assert got in fault.got
    if line:
        assert fault.line == line


def test_an_unreadable_file_is_one_fault(tmp_path):
    with pytest.raises(DataError, match="readable file"):
        Document(tmp_path / "none.yaml")
    (tmp_path / "binary.yaml").write_bytes(b"\xff\xfe\x00name")
    with pytest.raises(DataError, match="UTF-8"):
        Document(tmp_path / "binary.yaml")


@pytest.mark.slow
@given(st.text(max_size=200))
def test_never_raises_anything_else(tmp_path_factory, text):
    path = tmp_path_factory.mktemp("yaml") / "any.yaml"
    path.write_text(text, encoding="utf-8", errors="surrogatepass")
    with suppress(DataError):
        load(path, Row)


class Round(Table):
    kind: Literal["round"]
    radius: Annotated[float, Field(gt=0)]


class Square(Table):
    kind: Literal["square"]
    sides: list[float]


class Shapes(Table):
    shapes: dict[str, Annotated[Round | Square, Field(discriminator="kind")]]


SHAPES = """\
shapes:
  a:
    kind: round
    radius: -1
  b:
    kind: square
    sides:
      - 1
      - two
  c:
    kind: triangle
  d:
    sides: [1]
  e:
    kind: square
  f: 3
  g:
    kind: round
    radius: 1
    square: 2
"""


def test_what_is_wrong_in_one_of_several_kinds_of_table_is_told_where_it_is(tmp_path):
    with pytest.raises(DataError) as caught:
        load(write(tmp_path, SHAPES), Shapes)
    assert [(fault.line, fault.where, fault.expected, fault.got) for fault in caught.value.faults] == [
        (4, "shapes.a.radius", "greater than 0", "-1"),
        (9, "shapes.b.sides.1", "a valid number", "'two'"),
        (11, "shapes.c.kind", "one of round, square", "'triangle'"),
        (12, "shapes.d.kind", "this key", "nothing"),
        (14, "shapes.e.sides", "this key", "nothing"),
        (16, "shapes.f", "a table of keys and values", "3"),
        (20, "shapes.g.square", "no such key", "2"),
    ]
