"""A voice that says nothing, and faces that have it and cost little a step."""

from __future__ import annotations

import threading

import numpy as np

from agentface import Face
from agentface.errors import SpeechError
from agentface.speech.phones import Phone
from agentface.speech.sound import Sound
from agentface.speech.synthesizer import Synthesizer
from agentface.speech.voices.voice import Voiced
from agentface.talk.talker import Talker
from tests.heads import head_model

RATE = 8000


class FakeVoice:
    """A second for each sentence: a phone for its first letter; a word begins so many hundredths after the start.

    Of a sentence that begins with a 9 the mouth does not know the phone.
    """

    name = "fake"

    def __init__(self):
        self.said, self.closed, self.go = [], False, threading.Event()
        self.go.set()

    def speak(self, sentence, rate=1.0, marks=()):
        assert self.go.wait(200)
        if sentence.startswith("Bad"):
            raise SpeechError("no")
        if sentence.startswith("Worse"):
            raise ZeroDivisionError("a bug")
        self.said.append(sentence)
        length = 1.0 / rate
        sound = Sound(np.full(round(RATE * length), ord(sentence[0]), np.int16), RATE)
        symbol = sentence[0].lower().replace("9", "%%")
        return Voiced(sound, (Phone(symbol, 0.0, length),), tuple(0.01 * mark for mark in marks))

    def close(self):
        self.closed = True


class HundredthsVoice:
    """A hundredth of a second for each character, all of it one open vowel: so a word is heard when it begins."""

    name = "fake"

    def speak(self, sentence, rate=1.0, marks=()):
        if sentence.startswith("Bad"):
            raise SpeechError("no voice for that")
        length = 0.01 * len(sentence)
        sound = Sound(np.full(round(RATE * length), 1000, np.int16), RATE)
        return Voiced(sound, (Phone("aa", 0.0, length),), tuple(0.01 * mark for mark in marks))

    def close(self):
        pass


class Still:
    """A deformer whose skin never moves."""

    def __init__(self, deformer, pose):
        self._geometry = deformer.at(pose).copy()

    def step(self, pose, dt):
        return self._geometry

    def at(self, pose):
        return self._geometry


def talking_face(voice=None, model=None, **options):
    """A face with such a voice, whose skin stays as it is."""
    face, voice = Face(model or head_model(), compiled=False, **options), voice or FakeVoice()
    face.take_deformer(Still(face.deformer, face.pose))
    face._agendas.talker = Talker(face, Synthesizer(lambda *_: voice))
    face.noted.append(face._agendas.talker.notice)
    return face
