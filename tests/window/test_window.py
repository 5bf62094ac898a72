import sys

import pytest

from agentface import Face
from agentface.errors import GraphicsError
from agentface.window import window as window_module
from agentface.window.window import Window
from tests.heads import head_model


@pytest.fixture
def face():
    return Face(head_model("amber"), compiled=False)


def test_without_glfw_the_error_says_how_to_get_it(face, monkeypatch):
    monkeypatch.setitem(sys.modules, "glfw", None)
    with pytest.raises(GraphicsError, match=r'pip install "agentface\[window\]"'):
        Window(face)


def test_without_a_display_the_error_says_so(face, monkeypatch):
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
        Window(face)
