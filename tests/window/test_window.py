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


def test_a_glfw_that_does_not_load_is_not_called_missing(face, monkeypatch, tmp_path):
    (tmp_path / "glfw.py").write_text('raise ImportError("Failed to load GLFW3 shared library.")')
    monkeypatch.delitem(sys.modules, "glfw", raising=False)
    monkeypatch.syspath_prepend(tmp_path)
    with pytest.raises(GraphicsError, match=r"(?s)glfw to load, got: Failed to load GLFW3.*libglfw3") as caught:
        Window(face)
    assert "pip install" not in str(caught.value)


def test_an_imgui_that_lacks_a_package_is_not_called_missing(monkeypatch, tmp_path):
    (tmp_path / "imgui_bundle.py").write_text("import no_such_module")
    monkeypatch.delitem(sys.modules, "imgui_bundle", raising=False)
    monkeypatch.syspath_prepend(tmp_path)
    assert "lacks the Python package no_such_module" in window_module._missing_panel()
