from __future__ import annotations

import json

import pytest

from agentface.resources import face_names
from agentface.studies.bench import PARTS, run, speech
from agentface.studies.speech_laws import LAWS, STATES


class Kept:
    """A mouth whose figures lie within every law, but for one of them when it is loud and surprised."""

    def __init__(self, model, deformer):
        self.said = []

    def figures(self, manner):
        self.said.append(manner)
        figures = {name: 0.5 * sum(max(min(end, 1e3), -1e3) for end in law) for name, law in LAWS.items()}
        if manner.loudness > 1.0 and manner.rate > 1.0 and manner.state == {"surprise": 1.0}:
            figures["lip_speed_mm_s"] = 460.0
        return figures


def test_what_breaks_a_law_is_told_with_its_manner(monkeypatch):
    monkeypatch.setattr(speech, "SpeakingMouth", Kept)
    monkeypatch.setattr(speech, "load_model", lambda name: name)
    figures = json.loads(json.dumps(run("speech")))
    assert figures["manners"] == len(STATES) * len(speech.SETTINGS)
    assert figures["frame_us"] > 0.0
    for face in face_names():
        assert figures[face]["broken"] == ["surprise, rate 1.6, loudness 1.8: lip_speed_mm_s: 460 is not in 0..450"]
        assert figures[face]["most"]["lip_speed_mm_s"] == 460.0
        assert figures[face]["least"]["lip_speed_mm_s"] == pytest.approx(225.0)


def test_it_is_run_when_it_is_asked_for_alone():
    assert "speech" in PARTS
