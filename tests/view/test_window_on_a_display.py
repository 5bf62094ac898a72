"""The window on a virtual display, where the machine has one."""

import os
import shutil
import subprocess
import sys

import pytest

SHOWN = """
import numpy as np
from agentface import Face
from agentface.view.window import Window

window, frames = Window(Face(compiled=False), size=(240, 180)), []

def drawn(renderer, screen, geometry, draw=window._draw):
    draw(renderer, screen, geometry)
    frames.append(np.frombuffer(screen.read(components=3), np.uint8))
    window.controls.key("6")
    window.controls.closing = len(frames) == 3

window._draw = drawn
window.run()
print(len(frames), frames[0].size, int(np.ptp(frames[-1])), bool((frames[0] != frames[-1]).any()))
"""


@pytest.mark.gl
@pytest.mark.skipif(not shutil.which("xvfb-run"), reason="no virtual display on this machine (Debian: xvfb, xauth)")
def test_the_window_shows_a_face_that_changes():
    pytest.importorskip("glfw")
    command = ["xvfb-run", "--auto-servernum", sys.executable, "-c", SHOWN]
    hidden = os.environ | {"DISPLAY": ""}
    done = subprocess.run(command, check=False, capture_output=True, text=True, timeout=120, env=hidden)
    assert done.returncode == 0, done.stderr
    frames, size, contrast, changed = done.stdout.split()[-4:]
    assert (frames, size, changed) == ("3", str(240 * 180 * 3), "True")
    assert int(contrast) > 100
