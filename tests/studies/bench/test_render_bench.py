import math

import pytest

from agentface.studies.bench.render import STAGES, run
from agentface.view.gl.quality import QUALITIES

pytestmark = [pytest.mark.gl, pytest.mark.slow]


@pytest.fixture(scope="module")
def report():
    return run(rounds=1, sizes=((32, 24), (64, 48)))


def test_every_stage_is_timed_by_the_clock_and_by_the_processors(report):
    times = {f"{stage}{kind}_ms" for stage in (*STAGES, "frame") for kind in ("", "_cpu")}
    for quality in QUALITIES:
        assert list(report[quality]) == ["32x24", "64x48"]
        for figures in report[quality].values():
            assert figures.keys() == times | {"frames_hz", "frame_to_floor_ratio"}
            assert all(math.isfinite(value) and value > 0 for value in figures.values())
            assert figures["frames_hz"] * figures["frame_ms"] == pytest.approx(1000)


def test_the_floor_is_measured_beside(report):
    assert list(report["floor"]) == ["32x24", "64x48"]
    for size, floor in report["floor"].items():
        assert floor.keys() == {
            f"{stage}{kind}_ms" for stage in ("clear", "readback", "frame") for kind in ("", "_cpu")
        }
        for quality in QUALITIES:
            figures = report[quality][size]
            assert figures["frame_to_floor_ratio"] == pytest.approx(figures["frame_ms"] / floor["frame_ms"])


def test_it_says_what_drew(report):
    assert report["renderer"]
    assert report["processors"] >= 1
    assert report["rounds"] == 1
