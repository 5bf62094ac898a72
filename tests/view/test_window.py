import sys

import numpy as np
import pytest

from agentface.anatomy.model import load_model
from agentface.errors import GraphicsError
from agentface.view import window as window_module
from agentface.view.window import HELP, Controls, Window


class Face:
    def __init__(self):
        self.model = load_model("amber")
        self.emotion = dict.fromkeys(("happiness", "sadness", "anger", "fear", "disgust", "surprise"), 0.0)
        self.blinks = 0

    def set_emotion(self, emotion, value=None, *, fade=None):
        assert fade is not None
        self.emotion = dict(emotion)

    def blink(self):
        self.blinks += 1

    def step(self, dt):
        raise AssertionError("not drawn here")


@pytest.fixture
def controls():
    return Controls(Face())


def test_each_digit_raises_its_emotion_by_a_quarter_up_to_one(controls):
    for digit, name in enumerate(controls.face.emotion, start=1):
        for expected in (0.25, 0.5, 0.75, 1.0, 1.0):
            controls.key(str(digit))
            assert controls.face.emotion[name] == expected
    controls.key("1", shift=True)
    assert controls.face.emotion["happiness"] == 0.75
    assert controls.face.emotion["surprise"] == 1.0
    assert "happiness 0.75" in controls.title()


@pytest.mark.parametrize("key", ["0", "Backspace"])
def test_neutral(controls, key):
    controls.key("3")
    controls.key(key)
    assert not any(controls.face.emotion.values())
    assert "neutral" in controls.title()


def test_lowering_stops_at_zero(controls):
    controls.key("2", shift=True)
    assert controls.face.emotion["sadness"] == 0.0


def test_other_keys(controls):
    controls.key("Space")
    assert controls.face.blinks == 1
    front = controls.camera
    controls.key("P")
    assert controls.camera.eye[0] > 0.3
    controls.key("F")
    assert controls.camera == front
    for unknown in ("7", "9", "Z", "", "£"):
        controls.key(unknown)
    assert controls.camera == front
    controls.key("Q")
    assert controls.quality == "portrait"
    controls.key("Escape")
    assert controls.closing


def test_the_mouse_turns_the_head_with_it_and_the_wheel_comes_nearer(controls):
    before = controls.camera
    controls.drag(50, 0)
    assert controls.camera.eye[0] < before.eye[0]  # the camera goes left: the head turns right with the mouse
    controls.drag(0, 50)
    assert controls.camera.eye[1] > before.eye[1]
    controls.wheel(2)
    assert controls.camera.distance < before.distance
    controls.wheel(-1000)
    controls.wheel(1000)
    assert np.isfinite(controls.camera.eye).all()


def test_the_help_names_every_key():
    for name in ("1..6", "Shift", "Backspace", "Space", "F T P", "Esc", "wheel"):
        assert name in HELP


def test_without_glfw_the_error_says_how_to_get_it(monkeypatch):
    monkeypatch.setitem(sys.modules, "glfw", None)
    with pytest.raises(GraphicsError, match=r'pip install "agentface\[window\]"'):
        Window(Face())


def test_without_a_display_the_error_says_so(monkeypatch):
    class NoDisplay:
        ERROR_REPORTING = "raise"

        def set_error_callback(self, callback):
            self.callback = callback

        def init(self):
            self.callback(65544, b"X11: The DISPLAY environment variable is missing")
            return False

        def terminate(self):
            pass

    monkeypatch.setattr(window_module, "_glfw", NoDisplay)
    with pytest.raises(GraphicsError, match=r"(?s)DISPLAY environment variable is missing.*xvfb-run"):
        Window(Face())
