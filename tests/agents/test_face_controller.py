"""The adapter, called as an agent kit calls it."""

from __future__ import annotations

import asyncio
import threading
from abc import ABC, abstractmethod

import pytest

from agentface.agents.face_controller import FaceController
from agentface.agents.faces import default_faces, load_faces
from agentface.emotion.state import EmotionState
from agentface.errors import DataError, InvalidValueError, UnknownNameError
from tests.voices import talking_face


@pytest.fixture
def face():
    with talking_face() as made:
        yield made


@pytest.fixture
def controller(face):
    return FaceController(face)


def shows(controller, name, duration=0.0):
    asyncio.run(controller.set_face(name, duration))


def shown(face):
    """The emotions that are drawn."""
    return {name: value for name, value in face.status()["shown"]["emotion"].items() if value}


@pytest.mark.parametrize(
    ("name", "emotion"),
    [("joy", "happiness"), ("angry", "anger"), ("sorrow", "sadness"), ("fun", "happiness"), ("surprised", "surprise"),
     ("happy", "happiness"), ("sad", "sadness"), ("relaxed", "happiness")],
)  # fmt: skip
def test_a_kit_s_names_show_their_emotion(face, controller, name, emotion):
    face.set_emotion("disgust", 1.0, fade=0.0)
    shows(controller, name)
    face.step(0.01)
    face.step(30.0)
    drawn = shown(face)
    assert max(drawn, key=drawn.get) == emotion
    assert "disgust" not in drawn
    assert controller.current_face == name


def test_it_goes_back_after_its_duration(face, controller):
    face.set_mood({"happiness": 0.25}, fade=0.0)
    shows(controller, "angry", 2.0)
    assert controller.current_face == "angry", "also before the step that begins it"
    face.step(0.01)
    face.step(1.9)
    assert controller.current_face == "angry"
    for _ in range(100):
        face.step(0.1)
    assert controller.current_face == "neutral"
    assert shown(face) == {"happiness": 0.25}


@pytest.mark.parametrize("duration", [0, 0.0, -1])
def test_no_duration_is_for_good(face, controller, duration):
    shows(controller, "joy", duration)
    face.step(0.01)
    face.step(1000.0)
    assert controller.current_face == "joy"


def test_reset_and_neutral_let_go(face, controller):
    for let_go in (controller.reset, lambda: shows(controller, "neutral", 3.0)):
        shows(controller, "sorrow", 60.0)
        face.step(0.01)
        let_go()
        assert controller.current_face == "neutral"
        face.step(0.01)
        face.step(30.0)
        assert shown(face) == {}


def test_another_hand_ends_it(face, controller):
    shows(controller, "joy", 60.0)
    face.step(0.01)
    face.set_emotion({"fear": 0.5})
    assert controller.current_face == "neutral"


def test_wrong_names_and_durations_are_told_at_once(face, controller):
    with pytest.raises(UnknownNameError, match=r"'jolly'.*joy"):
        shows(controller, "jolly", 1.0)
    for duration in (float("nan"), "long", None):
        with pytest.raises(InvalidValueError, match="duration"):
            shows(controller, "joy", duration)
    face.step(0.01)
    assert controller.current_face == "neutral"
    assert face.emotion == EmotionState()


def test_a_kit_may_call_from_its_own_thread(face, controller):
    over = threading.Event()

    def steps():
        while not over.wait(0.001):
            face.step(0.02)

    thread = threading.Thread(target=steps)
    thread.start()
    try:
        for number in range(50):
            shows(controller, ("joy", "angry")[number % 2], 1.0)
        shows(controller, "fun", 100.0)
    finally:
        over.set()
        thread.join()
    face.step(0.01)
    assert face.emotion == default_faces()["fun"]


def test_it_fits_where_a_kit_demands_its_own_class(face):
    class Kits(ABC):
        @property
        @abstractmethod
        def current_face(self): ...

        @abstractmethod
        async def set_face(self, name: str, duration: float): ...

        @abstractmethod
        def reset(self): ...

    class Ours(FaceController, Kits):
        """As a program would write it."""

    ours = Ours(face)
    assert isinstance(ours, Kits)
    asyncio.run(ours.set_face("joy", 1.0))
    face.step(0.01)
    assert ours.current_face == "joy"


@pytest.mark.parametrize(
    ("text", "faults"),
    [
        ("faces: {}\n", ["faces"]),
        ("faces:\n  joy: {happiness: 1}\n", ["faces.neutral"]),
        ("faces:\n  neutral: {fear: 0.1}\n", ["faces.neutral"]),
        ("faces:\n  neutral: {}\n  a: {joy: 1}\n  b: {fear: 2}\n", ["faces.a.joy", "faces.b.fear"]),
        ("faces:\n  neutral: {}\n  c: {fear: 0}\n", ["faces.c.fear"]),
        ("faces:\n  neutral: {}\nface: 1\n", ["face"]),
    ],
)  # fmt: skip
def test_faults_of_the_table(tmp_path, text, faults):
    path = tmp_path / "agents.yaml"
    path.write_text(text)
    with pytest.raises(DataError) as caught:
        load_faces(path)
    assert [fault.where for fault in caught.value.faults] == faults
