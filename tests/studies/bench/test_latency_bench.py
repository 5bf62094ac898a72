from __future__ import annotations

from types import SimpleNamespace

import pytest

from agentface.studies.bench import latency
from tests.voices import talking_face


@pytest.mark.slow
def test_every_message_of_another_process_is_found_in_its_frame():
    report = latency.run(messages=12)
    assert (report["messages"], report["lost"]) == (12, 0)
    # it cannot be seen before it is sent, and the clocks of both processes are one
    assert 0.0 < report["p50_ms"] <= report["p99_ms"]
    assert 0.0 < report["step_ms"] < report["frame_ms"]


def test_the_figures_are_those_of_the_times():
    sent = [float(number) for number in range(101)]
    watch = SimpleNamespace(
        shown_s={number: number + (number + 1) / 1000.0 for number in range(101) if number != 50},
        times_s=[0.0, 1 / 60, 2 / 60, 5 / 60],
        steps_s=[0.001, 0.002, 0.003],
    )
    report = latency._figures(sent, watch, skipped=1)
    assert report["p50_ms"] == pytest.approx(52.0)
    assert report["p99_ms"] == pytest.approx(101.0)
    assert report["frame_ms"] == pytest.approx(1000.0 / 60)
    assert report["step_ms"] == pytest.approx(2.0)
    assert (report["late_frames"], report["frames"], report["messages"], report["lost"]) == (1, 4, 100, 1)


def test_only_a_frame_that_has_changed_counts():
    with talking_face() as face:
        levels = [0.25, 0.75]
        watch = latency.ChangeWatch(face, levels)

        def frame():
            face.step(0.01)
            watch.show(SimpleNamespace(time_s=0.0, step_s=0.0, pose=face.pose))
            return sorted(watch.shown_s)

        assert frame() == []
        face.set_emotion("joy", 0.25, fade=0.0)
        assert frame() == [0]
        first = watch.shown_s[0]
        assert frame() == [0]
        face.blink()
        assert frame() == [0]
        face.set_emotion("joy", 0.75, fade=0.0)
        assert frame() == [0, 1]
        assert watch.shown_s[0] == first
