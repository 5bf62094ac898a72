from __future__ import annotations

import socket
from types import SimpleNamespace

import pytest

from agentface.face import MessageCounts
from agentface.studies.bench import flood, latency, sender
from tests.voices import talking_face


@pytest.mark.slow
def test_messages_of_another_process_are_found_in_their_frames():
    report = latency.run(messages=6, flood_s=0.2)
    assert report["messages"] == 6
    assert report["lost"] < 6, "where the machine lets frames come late, one message may hide another"
    # it cannot be seen before it is sent, and the clocks of both processes are one
    assert 0.0 < report["p50_ms"] <= report["p99_ms"]
    assert report["step_ms"] > 0.0
    assert report["frame_ms"] > 0.0
    assert report["flood_messages"] == 200
    assert report["flood_lost"] == 0
    assert report["flood_frames"] > 0
    assert 0.0 < report["flood_step_p50_ms"] <= report["flood_step_p99_ms"]


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


def test_frames_that_were_left_out_of_a_flood_are_counted():
    times = [3.01 / 60, 4.0 / 60, 4.98 / 60, 8.4 / 60]
    report = flood.figures(times, [0.001, 0.002, 0.003, 0.010])
    assert (report["flood_frames"], report["flood_dropped_frames"]) == (4, 2)
    assert (report["flood_step_p50_ms"], report["flood_step_p99_ms"]) == pytest.approx((3.0, 10.0))


def test_frames_before_the_first_message_are_none_of_the_flood():
    counts = MessageCounts()
    watch = flood.FloodWatch(counts)
    watch.show(SimpleNamespace(time_s=0.0, step_s=0.5))
    counts.messages = 1
    watch.show(SimpleNamespace(time_s=1.0, step_s=0.25))
    assert (watch.times_s, watch.steps_s) == ([1.0], [0.25])


def test_a_sender_that_is_late_keeps_the_distances_unless_it_is_hurried():
    def sent(due_s, *, hurried):
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as there:
            there.bind(("127.0.0.1", 0))
            packets = [bytes([number]) for number in range(len(due_s))]
            with sender.sending(there.getsockname(), due_s, packets, hurried=hurried) as times:
                assert [there.recv(9) for _ in packets] == packets
            return times

    # what is due before the process began is late from the beginning
    first, second = sent([-100.0, -99.75], hurried=False)
    assert second - first >= 0.25
    first, second = sent([-1000.0, 0.0], hurried=True)
    assert second - first < 1000.0
