"""Tiny EmotionML documents for tests, and what is read of them."""

from __future__ import annotations

from xml.sax.saxutils import quoteattr

import pytest

from agentface.errors import DataError
from agentface.io.emotion_vocabularies import BIG6
from agentface.io.emotionml import read_emotionml
from agentface.io.emotionml_grammar import NAMESPACE

PUBLISHED = "http://www.w3.org/TR/emotion-voc/xml#"
FEAR = '<category name="fear"/>'


def document(*emotions, attributes=f'category-set="{BIG6}"'):
    body = "\n".join(emotions)
    return f'<emotionml version="1.0" xmlns="{NAMESPACE}" {attributes}>\n{body}\n</emotionml>'.encode()


def emotion(content=FEAR, **attributes):
    said = "".join(f" {name.replace('_', '-')}={quoteattr(str(value))}" for name, value in attributes.items())
    return f"<emotion{said}>{content}</emotion>"


def cues(*emotions):
    return read_emotionml(document(*emotions)).cues


def times(*emotions):
    return [(cue.start_s, cue.end_s) for cue in cues(*emotions)]


def faults(data):
    with pytest.raises(DataError) as error:
        read_emotionml(data, "moods.xml")
    assert [fault.line or 0 for fault in error.value.faults] == sorted(fault.line or 0 for fault in error.value.faults)
    return [str(fault) for fault in error.value.faults]


def the_fault(*emotions):
    (fault,) = faults(document(*emotions))
    return fault


def notes(*emotions):
    return [str(note) for note in read_emotionml(document(*emotions), "moods.xml").notes]
