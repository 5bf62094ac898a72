"""The window on a virtual display, where the machine has one."""

import os
import subprocess
import sys

import pytest

from tests.display import on_a_virtual_display
from tests.tools import require

pytestmark = [pytest.mark.gl, pytest.mark.slow]

WITHOUT_PANEL = """
import sys
sys.modules["imgui_bundle"] = None
import numpy as np
from agentface import Face
from agentface.window.window import Window

said, frames = [], []
window = Window(Face(compiled=False), size=(240, 180), say=said.append)

def drawn(renderer, screen, frame, now, draw=window._draw):
    draw(renderer, screen, frame, now)
    frames.append(np.frombuffer(screen.read(components=3), np.uint8))
    window.controls.key("6")
    window.controls.closing = len(frames) == 3

window._draw = drawn
window.run()
print(len(frames), frames[0].size, int(np.ptp(frames[-1])), bool((frames[0] != frames[-1]).any()))
print(len(said), said[0])
"""


def test_without_imgui_the_window_shows_a_face_that_changes_and_says_how_to_get_the_panel():
    require("xvfb-run", "xauth")
    pytest.importorskip("glfw")
    command = [*on_a_virtual_display(), sys.executable, "-c", WITHOUT_PANEL]
    hidden = os.environ | {"DISPLAY": ""}
    done = subprocess.run(command, check=False, capture_output=True, text=True, timeout=240, env=hidden)
    assert done.returncode == 0, done.stderr
    drawn, said = done.stdout.split("\n", 1)
    frames, size, contrast, changed = drawn.split()
    assert (frames, size, changed) == ("3", str(240 * 180 * 3), "True")
    assert int(contrast) > 100
    assert said.startswith("1 ")
    assert 'pip install "agentface[window]"' in said


def test_keys_mouse_and_size(on_a_display):
    seen = on_a_display("""
        def play():
            yield from frames(3)
            controls = window.controls
            face = pictures[0].copy()
            for name in ("6", "6", "KP_6", "KP_6"):
                yield from key(name)
            seen["raised"] = dict(controls.face.emotion)
            yield from until(lambda: controls.face.pose["jaw_open"] > 0.5)
            yield from frames(2)
            seen["changed"] = float(np.abs(face[:, :200].astype(int) - pictures[0][:, :200]).mean())
            yield from key("ctrl+z")
            seen["undone"] = dict(controls.face.emotion)
            yield from key("ctrl+shift+z")
            seen["redone"] = dict(controls.face.emotion)

            front = controls.camera
            yield from drag((60, 200), (160, 200))
            seen["orbited"] = controls.camera.eye != front.eye and controls.camera.target == front.target
            yield from key("f")
            yield from drag((60, 200), (100, 230), button=3)
            seen["panned"] = controls.camera.target != front.target
            yield from key("f")
            yield from point(100, 200)
            xdo("click", 4)
            yield from until(lambda: controls.camera.distance < front.distance)
            yield from key("p")
            seen["profile"] = controls.camera.eye[0] > 0.3

            xdo("windowsize", *handles(), 900, 500)
            yield from until(lambda: pictures[0].shape == (500, 900, 3))
            yield from frames(2)
            panel = round(window._panel_width())
            seen["panel"] = panel
            seen["beside"] = window._targets.size
            edge = pictures[0][:, 900 - panel + 1 : 900 - panel + 4].reshape(-1, 3)
            seen["edge"] = edge.min(axis=0).tolist(), edge.max(axis=0).tolist()
            xdo("windowsize", *handles(), 300, 240)
            yield from until(lambda: window._targets.size == (300, 240))  # too small for both
            seen["closing"] = controls.closing
            xdo("key", "Escape")
            yield from until(lambda: False)

        def handles():
            found = subprocess.run(["xdotool", "search", "--name", "for help"], capture_output=True, text=True)
            return found.stdout.split()[:1]

        show(Face(), size=(560, 420))
    """)
    assert seen["raised"] == dict.fromkeys(seen["raised"], 0.0) | {"surprise": 1.0}
    assert seen["changed"] > 1.0
    assert seen["undone"]["surprise"] == 0.75
    assert seen["redone"]["surprise"] == 1.0
    assert seen["orbited"]
    assert seen["panned"]
    assert seen["profile"]
    assert 300 < seen["panel"] < 360
    assert seen["beside"] == [900 - seen["panel"], 500]
    assert seen["edge"] == [[27, 28, 31], [27, 28, 31]], "the panel's ground, from top to bottom"
    assert seen["closing"] is False


def test_a_still_face_is_not_drawn_again(on_a_display):
    seen = on_a_display("""
        def play():
            yield from frames(2)
            window._awake_until = 0.0
            while window._awake_until or len(counted) < 30:
                counted.append(drawn())
                window._awake_until = 0.0
                yield
            seen["at rest"] = counted[-1] - counted[5]
            window.controls.face.blink()
            before = drawn()
            while drawn() < before + 3:
                yield
            seen["blinking"] = True

        def drawn():
            return int((window.times.totals_ms > 0).sum())

        counted = []
        show(size=(300, 240))
    """)
    assert seen == {"at rest": 0, "blinking": True}


def test_a_dense_display_has_a_larger_panel(on_a_display):
    seen = on_a_display(
        """
        def play():
            yield from frames(3)
            seen["pixels"] = pictures[0].shape
            seen["panel"] = window._panel_width()
            seen["slider"] = places["happiness"]

        show(size=(560, 420))
        """,
        first='xprop -root -f RESOURCE_MANAGER 8s -set RESOURCE_MANAGER "Xft.dpi:\t192\n"',
    )
    assert seen["pixels"] == [840, 1120, 3]
    assert 600 < seen["panel"] < 720
    left, top, right, bottom = seen["slider"]
    assert 35 < bottom - top < 60
    assert 1120 - seen["panel"] < left < right < 1120


def test_a_deformer_with_memory(on_a_display):
    seen = on_a_display("""
        from tests.deform import jelly

        with jelly.registered() as name:
            face = Face(deformer=name)

        def lag():
            return float(np.abs(face._deformer.at(face.pose).vertices - face.geometry.vertices).max())

        def play():
            yield from frames(3)
            seen["at rest"] = lag()
            before = pictures[0].copy()
            window.controls.change({"jaw_open": 1.0})
            late = []
            for _ in range(12):
                yield from frames(1)
                late.append(lag())
            seen["late"] = max(late)
            yield from until(lambda: face.pose["jaw_open"] == 1.0 and lag() < 1e-6)
            yield from frames(2)
            seen["changed"] = bool((pictures[0] != before).any())

        show(face, size=(300, 240))
    """)
    assert seen["at rest"] < 1e-6
    assert seen["late"] > 1e-3
    assert seen["changed"]
