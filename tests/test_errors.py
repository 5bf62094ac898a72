"""Errors hold what they say as data, and come whole out of another process."""

from __future__ import annotations

import copy
import pickle
from pathlib import Path

import numpy as np
import pytest

from agentface.errors import (
    DataError,
    Fault,
    FaultList,
    GraphicsError,
    InvalidValueError,
    Place,
    UnknownNameError,
    shown,
)
from agentface.head.model import load_model
from agentface.resources import face_folder

ERRORS = [
    InvalidValueError("size", "two numbers", (1, 2, 3), "give two"),
    InvalidValueError(Place("lips.yaml", ("rings", 3)), "a ring", []),
    UnknownNameError("face", "ambre", ("amber", "onyx")),
    DataError([Fault(Path("a.yaml"), 3, "a.b", "a number", "'x'"), Fault(Path("b.glb"), None, "", "a file", "none")]),
    GraphicsError("no OpenGL"),
]


@pytest.mark.parametrize("error", ERRORS, ids=lambda error: type(error).__name__)
@pytest.mark.parametrize("through", [lambda error: pickle.loads(pickle.dumps(error)), copy.deepcopy])  # noqa: S301
def test_errors_are_pickled_and_copied_whole(error, through):
    again = through(error)
    assert type(again) is type(error)
    assert str(again) == str(error)
    assert vars(again) == vars(error)


def test_a_place_is_data_and_text():
    error = InvalidValueError(Place("wrinkles.yaml", ("trains", "glabella", "end")), "a point apart", "none")
    assert error.place == ("wrinkles.yaml", ("trains", "glabella", "end"))
    assert error.where == "wrinkles.yaml: trains.glabella.end"
    assert InvalidValueError("fps", "a number", 0).place is None


def test_a_muscle_s_error_has_its_place_in_the_table():
    muscles = load_model(face_folder("amber")).muscles
    zone = muscles.zone.copy()
    zone[muscles.index("risorius_l")] = np.pi
    with pytest.raises(InvalidValueError, match="muscle risorius_l: zone") as caught:
        type(muscles)(**{name: getattr(muscles, name) for name in muscles.__slots__} | {"zone": zone})
    assert caught.value.place == Place("muscles.yaml", ("muscles", "risorius", "zone"))


def test_a_list_of_faults_ends_where_it_is_told_to():
    faults = FaultList("a.csv", most=3)
    faults.check()
    assert not faults
    faults.tell(7, "time", "more than 1", 0.5)
    faults.tell(2, "", "two fields", 3)
    with pytest.raises(DataError) as caught:
        faults.tell(9, "", "a number", "x")
    assert [str(fault) for fault in caught.value.faults] == [
        "a.csv:2: expected two fields, got 3",
        "a.csv:7: time: expected more than 1, got 0.5",
        "a.csv:9: expected a number, got x",
    ]
    with pytest.raises(DataError, match="expected an end"):
        FaultList("b").stop(None, "", "an end", "none")


@pytest.mark.parametrize(
    ("text", "quoted"), [("a\nb", r"'a\nb'"), ("\ud800\0", r"'\ud800\x00'"), ("x" * 99, f"'{'x' * 37}'...")]
)
def test_what_came_is_quoted_printable_and_short(text, quoted):
    assert shown(text) == quoted
