"""What the rest of the face is told of speech."""

from __future__ import annotations

import numpy as np
import pytest

from agentface.motion.following import AHEAD_S
from agentface.motion.speech import SpeechChannel
from agentface.speech.phones import Phone
from agentface.studies.harvard import harvard
from tests.motion.living import channels


class Log:
    """A follower that is advanced after the speech, and writes down when it is told what is to happen."""

    def __init__(self):
        self.now, self.told = 0.0, []

    def speaking(self, speaks, in_s=0.0):
        self.told.append(("speaks" if speaks else "is quiet", self.now + in_s))

    def beat(self, stress=1.0, in_s=0.0):
        assert 0.0 < stress <= 1.0
        self.told.append(("beat", self.now + in_s))

    def sentence_ends(self, in_s=0.0):
        self.told.append(("end", self.now + in_s))


def told(hz, *utterances, seconds=8.0, hush_at=None):
    speech, log = SpeechChannel(compiled=False), Log()
    speech.follow(log)
    for phones in utterances:
        speech.speak(phones)
    for frame in range(round(seconds * hz)):
        if hush_at is not None and frame == round(hush_at * hz):
            speech.hush()
        speech.advance(1 / hz)
        log.now += 1 / hz
    return log.told


def test_a_sentence_is_followed_from_its_beginning_to_its_end():
    sentence = harvard()[0]
    log = told(60, sentence.phones)
    assert log[0] == ("speaks", 0.0)
    assert log[-2:] == [("is quiet", pytest.approx(sentence.duration_s)), ("end", pytest.approx(sentence.duration_s))]
    beats = [at for what, at in log if what == "beat"]
    assert len(beats) >= 2
    vowels = {"er", "uw", "ow", "ih", "aa", "ax", "eh", "iy", "ey", "ae", "ah", "ao", "ay", "aw", "oy"}
    for at in beats:
        said = next(phone for phone in sentence.phones if phone.start_s <= at < phone.end_s)
        assert said.symbol in vowels
        assert said.end_s - said.start_s >= 0.09
        assert at > AHEAD_S


@pytest.mark.parametrize("hz", [30, 144])
def test_what_is_told_does_not_depend_on_the_frames(hz):
    sentences = [sentence.phones for sentence in harvard()[:2]]
    one, other = told(60, *sentences), told(hz, *sentences)
    assert [what for what, _ in one] == [what for what, _ in other]
    assert [at for _, at in one] == pytest.approx([at for _, at in other], abs=1e-9)
    assert [what for what, _ in one].count("speaks") == 1, "one utterance after the other is one speech"


def test_a_pause_ends_a_sentence_and_so_does_a_hush():
    spoken = [Phone("aa", 0.0, 0.5), Phone("pau", 0.5, 0.8), Phone("aa", 0.8, 1.4)]
    assert [what for what, _ in told(60, spoken)] == ["speaks", "end", "beat", "is quiet", "end"]
    hushed = told(60, spoken, hush_at=0.25)
    assert hushed[-2:] == [("is quiet", pytest.approx(0.25)), ("end", pytest.approx(0.25))]


def test_a_living_face_follows_and_a_still_one_stays_still():
    for liveliness, moves in ((0.6, True), (0.0, False)):
        mixer = channels(seed=2, liveliness=liveliness)
        mixer.speech.speak(harvard()[1].phones)
        states, nods = set(), []
        for _ in range(120):
            mixer.advance(1 / 60)
            states.add(mixer.life.state)
            nods.append(mixer.pose()["head_pitch"])
        assert states == {"speaking"}
        assert bool(np.ptp(nods) > 0.01) is moves
        assert moves or not any(nods)
