from __future__ import annotations

import json
import os
import subprocess
import sys
import textwrap
from typing import Any

import pytest

from tests.display import on_a_virtual_display
from tests.tools import require

BEFORE = """
import json, subprocess, sys
import numpy as np
from imgui_bundle import imgui
from agentface import Face
from agentface.window.capture import Capture
from agentface.window.window import Window

seen, places, pictures = {}, {}, []

def noted(name):
    inner = getattr(imgui, name)
    def call(label, *args):
        result = inner(label, *args)
        low, high = imgui.get_item_rect_min(), imgui.get_item_rect_max()
        places[label.partition("###")[2] or label] = (low.x, low.y, high.x, high.y)
        return result
    setattr(imgui, name, call)

for name in (
    "slider_float", "button", "small_button", "collapsing_header", "tree_node_ex", "invisible_button", "checkbox",
):
    noted(name)

def xdo(*words):
    subprocess.run(["xdotool", *map(str, words)], check=True, timeout=30)

def at(label, part=0.5):
    x0, y0, x1, y1 = places[label]
    if label in window.controls.values() or " " in label:  # a slider's label stands at its right
        x1 = x0 + 0.62 * (x1 - x0)
    return round(x0 + part * (x1 - x0)), round(0.5 * (y0 + y1))

def frames(count=2):
    for _ in range(count):
        window._awake_until = window.clock.now() + 1.0  # so that every frame is drawn
        yield

def until(condition, most=200):
    for _ in range(most):
        if condition():
            return
        yield from frames(1)
    raise AssertionError("it did not come to pass")

def arrives(*words, most=200):
    window._awake_until = 0.0  # every event moves it
    xdo(*words)
    for _ in range(most):
        yield
        if window._awake_until:
            break

def point(x, y):
    yield from arrives("mousemove", x, y, most=10)  # none comes where the mouse is already
    yield from frames()

def click(label, part=0.5, button=1):
    yield from point(*at(label, part))
    yield from arrives("click", button)
    yield from frames(4)

def drag(start, stop, button=1):
    yield from point(*start)
    yield from arrives("mousedown", button)
    yield from frames()
    for part in (0.5, 1.0):
        yield from point(*(round(a + part * (b - a)) for a, b in zip(start, stop)))
    yield from arrives("mouseup", button)
    yield from frames()

def key(name):
    yield from arrives("key", name)
    yield from frames()

def show(face=None, **options):
    global window
    window = Window(face or Face(compiled=False), **options)
    draw = window._draw

    def drawn(renderer, screen, *rest):
        draw(renderer, screen, *rest)
        size = window.glfw.get_framebuffer_size(window.handle)
        raw = screen.read(viewport=(0, 0, *size), components=3, alignment=1)
        pictures[:] = [np.frombuffer(raw, np.uint8).reshape(size[1], size[0], 3)[::-1]]

    window._draw = drawn
    acting = play()

    def next_scene():
        try:
            next(acting)
        except StopIteration:
            window.controls.closing = True

    window.run(each_frame=next_scene)
    print("SEEN" + json.dumps(seen))
"""


@pytest.fixture
def on_a_display():
    """Plays a scene in a real window on a virtual display, with real keys and a real mouse; returns what it saw.

    A scene is a program that opens ``window`` with ``show(...)``. Its generator ``play()`` goes on between frames, and
    what it puts into ``seen`` comes back. ``first`` is a shell command run on the display before.
    """
    require("xvfb-run", "xauth", "xdotool", "xprop")
    pytest.importorskip("imgui_bundle")
    return _play


def _play(scene: str, first: str = "true") -> dict[str, Any]:
    # a display without -noreset forgets everything when its first program ends
    command = on_a_virtual_display("-screen 0 1300x1000x24", "-noreset")
    command += ["sh", "-c", f'{first} && exec "$0" -W error -c "$1"', sys.executable, BEFORE + textwrap.dedent(scene)]
    hidden = os.environ | {"DISPLAY": ""}
    done = subprocess.run(command, check=False, capture_output=True, text=True, timeout=240, env=hidden)
    assert done.returncode == 0, done.stderr + done.stdout
    seen: dict[str, Any] = json.loads(done.stdout.rpartition("SEEN")[2])
    return seen
