from __future__ import annotations

import gc
import weakref

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from agentface import EmotionState, Face
from agentface.live.notes import Replay
from agentface.parameters import NAMES
from agentface.requests import Hush, Say, SetEmotion, Speak
from agentface.speech.phones import Phone
from agentface.speech.sound import Sound
from agentface.speech.synthesizer import Synthesizer
from agentface.speech.voices.flite import Flite
from agentface.speech.voices.voice import Voiced
from agentface.talk.talker import Talker
from tests.heads import head_model
from tests.tools import require

TEXT = "[joy] Papa saw. [surprise:0.5] A big map!"


@pytest.fixture
def face():
    require("flite")
    with Face(head_model(), compiled=False) as made:
        yield made


def motion(face, seconds, dt):
    """The pose every so often, without a deformed skin."""
    poses = []
    for _ in range(round(seconds / dt)):
        face._agendas.advance(dt, face.channels.advance)
        face._touch()
        poses.append(face.pose.array.copy())
    return np.array(poses)


def test_what_it_says_moves_its_mouth_at_once_and_for_as_long(face):
    face.say("Papa saw a map.", wait=True)
    spoken = Flite().speak("Papa saw a map.")
    jaw = motion(face, spoken.sound.duration_s + 1.0, 0.01)[:, NAMES.index("jaw_open")]
    open_ = [p for p in spoken.phones if p.symbol in ("aa", "ao", "ae")]
    for phone in open_:
        assert jaw[round(100 * phone.start_s) : round(100 * phone.end_s)].max() > 0.1
    assert jaw[: round(100 * spoken.phones[0].end_s) - 10].max() < 0.3 * jaw.max()
    assert jaw[-20:].max() < 0.01
    assert face.channels.speech.status is None


def test_the_same_text_gives_the_same_frames_at_any_rate(face):
    twin = Face(head_model(), compiled=False)
    again = Face(head_model(), compiled=False)
    for one in (face, twin, again):
        one.say(TEXT, wait=True)
    first, second, fine = motion(face, 3.0, 1 / 30), motion(twin, 3.0, 1 / 30), motion(again, 3.0, 1 / 120)
    assert (first == second).all()
    assert np.abs(first - fine[3::4]).max() < 1e-3
    for one in (twin, again):
        one.close()


def test_what_came_of_a_text_is_noted_and_gives_the_same_again(face):
    noted, fps = [], 30.0
    face.noted.append(noted.append)
    face.say(TEXT, wait=True)
    motion(face, 3.0, 1 / fps)
    kinds = [type(request) for request in noted]
    assert kinds[0] is Say
    assert kinds.count(Speak) == 2
    assert [(r.emotion, r.intensity) for r in noted if isinstance(r, SetEmotion)] == [
        ("happiness", 0.7),
        ("happiness", 0.0),
        ("surprise", 0.5),
        ("surprise", 0.0),
    ]
    other = Face(head_model(), compiled=False)
    replay = Replay(other, [(0.0, request) for request in noted[:2]], fps)
    replay.take_in(0.0)
    assert other._agendas.talker is None, "nothing is spoken twice"
    assert other.channels.speech.status is not None


def test_hush_closes_the_mouth_and_drops_the_rest(face):
    face.say("Father saw a large car. Father saw a large car.", wait=True)
    motion(face, 0.6, 0.02)
    face.hush()
    jaw = motion(face, 4.0, 0.01)[:, NAMES.index("jaw_open")]
    assert jaw[15:].max() < 0.01
    assert face.talker.texts == ()


def test_say_waits_for_speak_and_interrupts_it(face):
    face.speak([("aa", 0.0, 1.0)])
    face.say("Yes.", wait=True)
    noted = []
    face.noted.append(noted.append)
    motion(face, 0.9, 0.1)
    assert not noted
    motion(face, 0.5, 0.1)
    assert [type(request) for request in noted] == [Speak]
    face.speak([("aa", 0.0, 5.0)], interrupt=True)
    assert face.talker.texts == ()
    face.say("No.", interrupt=True, wait=True)
    motion(face, 0.1, 0.05)
    assert face.channels.speech.status["ends_in_s"] < 2.0


class Quick:
    """A voice of a tenth of a second a letter."""

    name = "quick"

    def speak(self, sentence, rate=1.0, marks=()):
        letters = [letter.lower() for letter in sentence if letter.isalpha()]
        phones = tuple(
            Phone("aa" if letter in "aeiou" else "m", 0.1 * n, 0.1 * n + 0.1) for n, letter in enumerate(letters)
        )
        sound = Sound(np.zeros(800 * len(letters), np.int16), 8000)
        return Voiced(sound, phones, tuple(0.1 * min(mark, len(letters)) for mark in marks))

    def close(self):
        pass


ASKED = st.one_of(
    st.tuples(
        st.just("say"), st.sampled_from(["Ma.", "[joy] Aha! [sad] Mama.", "[neutral] Oh [fear:0.3]"]), st.booleans()
    ),
    st.tuples(st.just("speak"), st.booleans(), st.booleans()),
    st.tuples(st.sampled_from(["hush", "neutral"])),
    st.tuples(st.just("step"), st.floats(0.0, 0.7)),
)


@pytest.mark.untraced
@settings(deadline=None, max_examples=40)
@given(plan=st.lists(ASKED, max_size=12))
def test_whatever_it_is_told_in_the_end_it_is_silent_and_as_before(plan):
    face = Face(head_model(), compiled=False)
    face._talker = Talker(face, Synthesizer(lambda *_: Quick()))
    face.noted.append(face._talker.notice)
    failed = []
    face.talker.failed.append(failed.append)
    for word, *rest in plan:
        if word == "say":
            face.say(rest[0], interrupt=rest[1], wait=True)
        elif word == "speak":
            face.speak([("aa", 0.0, 0.3)], interrupt=rest[0], live=rest[1])
        elif word == "step":
            face._agendas.advance(rest[0], face.channels.advance)
        else:
            getattr(face, word)()
    for _ in range(400):
        if not (face.talker.texts or face.channels.speech.status):
            break
        face._agendas.advance(0.25, face.channels.advance)
    face._agendas.advance(3.0, face.channels.advance)
    assert not failed
    assert face.talker.texts == ()
    assert face.channels.speech.status is None
    assert face.emotion == EmotionState()
    assert face.talker.due_s == np.inf
    face.close()


def test_a_face_that_is_dropped_or_closed_leaves_no_thread():
    require("flite")
    made = Face(head_model(), compiled=False)
    made.say("Yes.", wait=True)
    made.step(0.01)
    watched = weakref.ref(made)
    thread = made.talker._synthesizer._thread
    assert thread.is_alive()
    made.close()
    made.close()
    thread.join()
    del made
    gc.collect()
    assert watched() is None


def test_a_hush_before_anything_was_said_is_no_fault(face):
    face.apply(Hush())
    face.say("Yes.")
    face.hush()
    motion(face, 0.3, 0.05)
    assert face.talker.texts == ()
