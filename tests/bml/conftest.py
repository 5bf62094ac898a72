from __future__ import annotations

import numpy as np
import pytest

from agentface.io.bml.reader import read_bml
from agentface.speech.phones import Phone
from agentface.speech.sound import Sound
from agentface.speech.voices.voice import Voiced

RATE = 8000
NAMESPACE = "http://www.bml-initiative.org/bml/bml-1.0"


class HundredthsVoice:
    """A hundredth of a second a character: so a word is heard when its first one is."""

    name = "fake"

    def speak(self, sentence, rate=1.0, marks=()):
        length = 0.01 * len(sentence)
        sound = Sound(np.full(round(RATE * length), 1000, np.int16), RATE)
        return Voiced(sound, (Phone("aa", 0.0, length),), tuple(0.01 * mark for mark in marks))

    def close(self):
        pass


@pytest.fixture
def voice():
    return HundredthsVoice()


@pytest.fixture
def block():
    """Makes a block of the elements in it."""

    def made(inside, name="b", **attributes):
        extra = "".join(f' {key}="{value}"' for key, value in attributes.items())
        return read_bml(f'<bml xmlns="{NAMESPACE}" id="{name}"{extra}>\n{inside}\n</bml>')

    return made
