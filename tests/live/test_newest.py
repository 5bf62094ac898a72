from __future__ import annotations

import threading
from contextlib import contextmanager

import pytest

from agentface import Face
from agentface.live.loop import Frame, run
from agentface.live.newest import LiveSink, Mailbox
from tests.clocks import ManualClock
from tests.heads import head_model


@pytest.fixture(scope="module")
def face():
    return Face(head_model())


def frames(face, count):
    return [Frame(float(number), 0.0, face.pose, face.step(0.01)) for number in range(count)]


class Slow:
    """A sink that waits for its turn with each frame."""

    def __init__(self):
        self.times, self.threads, self.turn, self.began = [], set(), threading.Semaphore(0), threading.Event()
        self.closed = False

    def show(self, frame):
        self.threads.add(threading.current_thread())
        self.began.set()
        assert self.turn.acquire(timeout=200)
        self.times.append(frame.time_s)

    @contextmanager
    def open(self):
        self.threads.add(threading.current_thread())
        yield self
        self.closed = True
        self.threads.add(threading.current_thread())


def test_a_slow_sink_gets_the_newest_frame_and_the_others_are_counted(face):
    slow = Slow()
    with LiveSink(slow.open) as sink:
        first, *others = frames(face, 10)
        sink.show(first)
        assert slow.began.wait(200)
        for frame in others:
            sink.show(frame)  # comes back at once, though the sink is busy
        assert sink.dropped == 8
        for _ in range(2):
            slow.turn.release()
    assert slow.times == [0.0, 9.0]
    assert (sink.shown, sink.dropped, slow.closed) == (2, 8, True)
    assert len(slow.threads) == 1
    assert threading.current_thread() not in slow.threads


def test_the_face_goes_on_while_its_sink_hangs(face):
    slow = Slow()
    with LiveSink(slow.open) as sink:
        assert run(face, ManualClock(), [], [sink], fps=50, duration=1.99) == 100
        for _ in range(100):
            slow.turn.release()
    assert sink.shown + sink.dropped == 100
    assert slow.times[-1] == pytest.approx(99 / 50)


def test_what_it_keeps_is_its_own(face):
    mail = Mailbox()
    face.set_emotion("fear", 1.0, fade=0.2)
    geometry = face.step(0.01)
    before = geometry.vertices.copy()
    mail.show(Frame(0.0, 0.0, face.pose, geometry))
    face.step(0.1)
    kept = mail.take()
    assert (kept.geometry.vertices == before).all()
    assert (face.geometry.vertices != before).any()


def test_a_mailbox_without_a_letter(face):
    mail = Mailbox()
    assert mail.take(0.0) is None
    mail.show(frames(face, 1)[0])
    mail.close()
    assert mail.take() is not None, "the last one is delivered"
    assert mail.take() is None


def test_errors_of_the_sink_come_out_in_the_loop(face):
    @contextmanager
    def cannot():
        raise OSError("cannot be opened")
        yield

    with pytest.raises(OSError, match="cannot be opened"), LiveSink(cannot):
        raise AssertionError("not reached")

    class Fails:
        def show(self, frame):
            raise OSError("cannot be written")

    @contextmanager
    def fails():
        yield Fails()

    def show_all():
        with LiveSink(fails) as sink:
            run(face, ManualClock(), [], [sink], duration=1e6)

    with pytest.raises(OSError, match="cannot be written"):
        show_all()

    def show_one():
        with LiveSink(fails) as sink:
            sink.show(frames(face, 1)[0])

    with pytest.raises(OSError, match="cannot be written"):
        show_one()
    assert not [thread for thread in threading.enumerate() if thread.name == "agentface-sink"]
