from __future__ import annotations

import copy
import json
from io import BytesIO

import numpy as np
import pytest
from PIL import Image

from agentface.errors import DataError
from agentface.studies.figures import tissue_charts
from agentface.studies.figures.bar_chart import Chart, tick, written

FPS = {"happiness": 36.1, "anger": 25.3, "sadness": 20.8, "disgust": 23.2, "surprise": 29.5}
"""The last column of the paper's Table 1."""
ROW = {
    "largest_mm": 8.0,
    "nodes": {"dynamic": 1, "quasi_static": 2, "static": 3},
    "semi_implicit": {"iteration_ms": 0.5, "precompute_s": 2.0, "frame_ms": 40.0},
    "adaptive": {
        "dynamic_ms": 0.3,
        "quasi_static_ms": 0.1,
        "iteration_ms": 0.4,
        "precompute_s": 6.0,
        "saved_ratio": 0.2,
        "saved_with_drawing_ratio": 0.02,
        "error_max_mm": 0.4,
        "error_mean_mm": 0.1,
    },
    "default": {"frame_ms": 2.0, "worst_error_ratio": 0.01, "error_max_mm": 0.05},
}
REPORT = {"draw_ms": 5.0, "expressions": dict.fromkeys(tissue_charts.PAPER, ROW)}


@pytest.mark.parametrize(
    ("highest", "step"), [(0.0, 2e-10), (4.0, 1.0), (5.0, 1.0), (5.1, 2.0), (0.48, 0.1), (122.0, 50.0)]
)
def test_ticks_are_round_and_few(highest, step):
    assert tick(highest) == pytest.approx(step)


@pytest.mark.parametrize(
    ("value", "text"), [(0.0442, "0.044"), (1.32, "1.3"), (9.96, "10"), (122.4, "122"), (0.0, "0")]
)
def test_values_are_written_short(value, text):
    assert written(value) == text


def test_a_bar_is_as_high_as_its_value_and_its_parts_lie_on_each_other():
    red, blue, green = (220, 20, 20), (20, 20, 220), (20, 160, 20)
    chart = Chart("mm", [{"one": red, "two": blue}, {"three": green}], {"a": [(2.0, 1.0), (1.5,)]}, (200, 200))
    pixels = np.asarray(chart.picture(), int)
    assert chart.top == 3.0
    high = {colour: (np.abs(pixels[50:] - colour).max(axis=2) < 9).any(axis=1).sum() for colour in (red, blue, green)}
    assert high[red] == pytest.approx(2 * high[blue], abs=2)
    assert high[green] == pytest.approx(0.75 * high[red], abs=2)
    rows = [np.flatnonzero((np.abs(pixels[50:] - colour).max(axis=2) < 9).any(axis=1)) for colour in (red, blue)]
    assert rows[1].max() <= rows[0].min()


def test_what_is_not_given_has_no_bar():
    colour = (20, 20, 220)
    drawn = [
        np.asarray(Chart("s", [{"one": colour}], {"a": [(value,)], "b": [(1.0,)]}, (200, 200)).picture(), int)[
            40:, :120
        ]
        for value in (None, 0.5)
    ]
    there = [(np.abs(part - colour).max(axis=2) < 9).sum() for part in drawn]
    assert there[0] == 0
    assert there[1] > 100


def test_the_papers_numbers_agree_with_each_other():
    """Table 1's frame rate follows from its times, and the savings named in its text from whole frames."""
    for name, row in tissue_charts.PAPER.items():
        whole = row.dynamic_ms + row.quasi_static_ms + tissue_charts.PAPER_DRAW_MS
        assert 1e3 / whole == pytest.approx(FPS[name], abs=0.1)
    for name in ("happiness", "sadness"):
        row = tissue_charts._PAPER_ROWS[name]
        adaptive, whole = (row[part]["iteration_ms"] + 5.0 for part in ("adaptive", "semi_implicit"))
        assert 1.0 - adaptive / whole == pytest.approx(tissue_charts.PAPER[name].saved_ratio)


def test_charts_are_drawn_of_any_report_and_say_what_it_says():
    for draw in (tissue_charts.errors, tissue_charts.times):
        one = draw(REPORT)
        worse = copy.deepcopy(REPORT)
        worse["expressions"]["anger"]["adaptive"] |= {"error_max_mm": 0.8, "iteration_ms": 0.9, "dynamic_ms": 0.8}
        assert one.tobytes() == draw(REPORT).tobytes()
        assert one.size == draw(worse).size
        assert one.tobytes() != draw(worse).tobytes()


def test_without_opengl_there_is_no_drawing_time():
    assert tissue_charts.times(REPORT | {"draw_ms": None}).size == tissue_charts.times(REPORT).size


def test_the_kept_report_has_the_papers_expressions_and_gives_the_same_pictures_each_time():
    report = tissue_charts.read_report(tissue_charts.REPORT)
    assert set(report["expressions"]) == set(tissue_charts.PAPER)
    drawn = tissue_charts.figures("amber")
    assert list(drawn) == ["tissue-errors.png", "tissue-times.png"]
    assert drawn == tissue_charts.figures("onyx")
    for content in drawn.values():
        with Image.open(BytesIO(content)) as image:
            assert image.convert("RGB").getpixel((0, 0)) == (255, 255, 255)


@pytest.mark.parametrize("content", [None, "{", "[]", '{"expressions": 3}'])
def test_a_report_that_is_none_is_told_with_what_makes_one(tmp_path, content):
    path = tmp_path / "report.json"
    if content is not None:
        path.write_text(content, encoding="utf-8")
    with pytest.raises(DataError, match="agentface bench tissue --json"):
        tissue_charts.read_report(path)
    path.write_text(json.dumps(REPORT), encoding="utf-8")
    assert tissue_charts.read_report(path) == REPORT
