"""Records: fields, bytes, and back."""

from __future__ import annotations

import struct
from contextlib import suppress

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from agentface.errors import InvalidValueError
from agentface.io.web.layout import Field, Layout

FORMATS = {"u8": "B", "i8": "b", "u16": "H", "i16": "h", "u32": "I", "i32": "i", "f32": "f", "f64": "d"}


def test_bytes_as_struct_has_them():
    fields = [Field(f"of_{kind}", kind, 2) for kind in FORMATS]
    values = {f"of_{kind}": (3.0, 7.0) for kind in FORMATS}
    record = Layout(fields).encode(values)
    assert record == struct.pack("<" + "".join(form * 2 for form in FORMATS.values()), *(3, 7) * len(FORMATS))


def test_a_name_that_stands_twice_goes_on():
    layout = Layout([Field("a", "i16", 2, 0.5), Field("b", "u8"), Field("a", "i8", 3, 0.25)])
    record = layout.encode({"a": [1.0, -2.0, 1.0, -1.0, 0.25], "b": 9})
    assert record == struct.pack("<hhBbbb", 2, -4, 9, 4, -4, 1)
    assert layout.decode(record)["a"].tolist() == [1.0, -2.0, 1.0, -1.0, 0.25]


def test_a_scale_for_each():
    layout = Layout([Field("a", "i16", 2, (0.5, 2.0))])
    assert layout.encode({"a": (3.0, 8.0)}) == struct.pack("<hh", 6, 4)


@given(st.lists(st.floats(-1.5, 1.5), min_size=5, max_size=5))
def test_what_is_read_is_what_was_written_but_for_rounding(numbers):
    layout = Layout([Field("a", "i16", 2, 1 / 32767), Field("a", "i8", 3, 1 / 127)])
    back = layout.decode(layout.encode({"a": numbers}))["a"]
    steps = np.array([1 / 32767] * 2 + [1 / 127] * 3)
    ends = [(np.iinfo(kind).min * step, np.iinfo(kind).max * step) for kind, step in zip("hhbbb", steps, strict=True)]
    expected = np.array([min(max(x, low), high) for x, (low, high) in zip(numbers, ends, strict=True)])
    assert (np.abs(back - expected) <= 0.5 * steps + 1e-12).all()


def test_a_reader_knows_what_it_is_told():
    layout = Layout([Field("a", "i16", 2, (0.5, 2.0)), Field("b", "f64")])
    again = Layout.from_json(layout.as_json())
    assert again.fields == layout.fields
    assert again.size == layout.size == 12


@pytest.mark.parametrize(
    "values", [{}, {"a": [1.0]}, {"a": [1.0, float("nan")]}, {"a": [1.0, float("inf")]}, {"b": [1.0, 2.0]}]
)
def test_values_that_are_none(values):
    with pytest.raises(InvalidValueError):
        Layout([Field("a", "i16", 2)]).encode(values)


@given(st.binary(max_size=12))
def test_a_record_of_another_length(record):
    layout = Layout([Field("a", "i16", 2), Field("b", "f32")])
    if len(record) == layout.size:
        layout.decode(record)
    else:
        with pytest.raises(InvalidValueError):
            layout.decode(record)


@pytest.mark.parametrize(
    "field",
    [("", "u8"), ("a", "u9"), ("a", "u8", 0), ("a", "u8", True), ("a", "u8", 1 << 40), ("a", "u8", 2, (1.0,)),
     ("a", "u8", 1, 0.0), ("a", "u8", 1, float("nan")), ("a", "u8", 1, "x"), (3, "u8"), ("a", "u8", 1, (1.0, (2.0,)))],
)  # fmt: skip
def test_fields_that_cannot_be(field):
    with pytest.raises(InvalidValueError):
        Layout([Field(*field)])


json_values = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=5),
    lambda inner: (
        st.lists(inner, max_size=4) | st.dictionaries(st.sampled_from(["name", "type", "count", "scale"]), inner)
    ),
    max_leaves=8,
)


@given(json_values)
def test_no_list_of_fields_disturbs_a_reader(told):
    with suppress(InvalidValueError):
        Layout.from_json(told)
