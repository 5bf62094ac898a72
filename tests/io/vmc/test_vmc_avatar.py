"""What leaves by VMC is seen on a real avatar: three-vrm shows this project's own, over a bridge from UDP to its page.

The bridge reads with python-osc alone, and the page does with the messages what the specification says.
"""

from __future__ import annotations

import socket

import numpy as np
import pytest
from click.testing import CliRunner
from PIL import Image
from pythonosc.osc_bundle import OscBundle

from agentface import Face
from agentface.cli import cli
from agentface.io.vmc.sender import VmcSender
from agentface.live.loop import Frame
from tests.browser import address, places, viewer

pytestmark = [pytest.mark.slow, pytest.mark.gl, pytest.mark.untraced]
BONES = ("head", "leftEye", "rightEye")
CAMERA = [0.0, 1.53, 1.15], [0.0, 1.5, 0.0]


class Bridge:
    """Brings a face's frames to a page with its avatar."""

    def __init__(self, page):
        self.page, self.face = page, Face("amber")
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._socket.bind(("127.0.0.1", 0))
        self._socket.settimeout(60)

    def show(self, names):
        """What the avatar shows of the face as it is now."""
        with VmcSender(self.face, *self._socket.getsockname(), names=names) as sender:
            sender.show(Frame(0.0, 0.0, self.face.pose, self.face.geometry))
        messages = [[message.address, *message.params] for message in OscBundle(self._socket.recv(65536))]
        self.page.evaluate("messages => receive(messages)", messages)
        return self.page.evaluate("bones => avatar(bones)", BONES)

    def picture(self, path):
        self.page.evaluate("([eye, target]) => draw(eye, target)", CAMERA)
        self.page.screenshot(path=path)
        with Image.open(path) as picture:
            return np.asarray(picture.convert("RGB"), np.float64)

    def skin(self):
        """The places of the skin's vertices in mm."""
        return 1e3 * places(self.page, "skin")

    def clear(self):
        self.face.neutral(0.0)
        self.face.step(1.0)

    def close(self):
        self._socket.close()
        self.face.close()


@pytest.fixture(scope="module")
def bridge(tmp_path_factory):
    path = tmp_path_factory.mktemp("avatar") / "amber.vrm"
    result = CliRunner().invoke(cli, ["export", str(path)])
    assert result.exit_code == 0, result.output
    with viewer() as page:
        page.evaluate("url => load(url)", address(path))
        made = Bridge(page)
        yield made
        made.close()
        assert page.said == []


def test_what_a_face_feels_and_says_is_seen_on_an_avatar(bridge, tmp_path):
    bridge.clear()
    bridge.show("vrm0")
    at_rest = bridge.picture(tmp_path / "rest.png")
    bridge.face.set_emotion("happiness", 0.8, fade=0.0)
    bridge.face.show_viseme("aa", 0.5)
    bridge.face.set_head(20.0, 10.0, fade=0.0)
    bridge.face.set_gaze(-10.0, 0.0, fade=0.0)
    bridge.face.step(0.5)
    shown = bridge.show("vrm0")
    assert shown["expressions"] == pytest.approx({"happy": 0.8, "aa": 0.5}, abs=0.02)
    picture = bridge.picture(tmp_path / "happy.png")
    assert np.abs(picture - at_rest).mean() > 1.0


@pytest.mark.parametrize(
    ("head", "gaze"),
    [((20.0, 0.0, 0.0), (0.0, 0.0)), ((0.0, 15.0, 0.0), (10.0, 0.0)), ((-30.0, -10.0, 12.0), (-8.0, 5.0))],
)
def test_heads_and_eyes_turn_as_the_face_s(bridge, head, gaze):
    bridge.clear()
    bridge.face.set_head(*head, fade=0.0)
    bridge.face.set_gaze(*gaze, fade=0.0)
    bridge.face.step(0.1)
    found = bridge.show("arkit")["directions"]
    turn = bridge.face.geometry.head[:3, :3]
    np.testing.assert_allclose(found["head"], turn[:, 2], atol=1e-4)
    for side, name in enumerate(("leftEye", "rightEye")):
        np.testing.assert_allclose(found[name], (turn @ bridge.face.geometry.eye_rotations[side])[:, 2], atol=1e-4)


@pytest.mark.parametrize("names", ["vrm1", "arkit"])
@pytest.mark.parametrize("emotion", ["happiness", "surprise", "anger", "sadness"])
def test_the_avatar_s_skin_comes_near_to_the_face_s(bridge, names, emotion):
    bridge.clear()
    bridge.show(names)
    rest, model = bridge.skin(), 1e3 * bridge.face.geometry.vertices
    bridge.face.set_emotion(emotion, 0.8, fade=0.0)
    bridge.face.step(0.1)
    wanted = 1e3 * bridge.face.geometry.vertices - model
    bridge.show(names)
    moved = bridge.skin() - rest
    whole = np.linalg.norm(wanted)
    assert whole > 0.0
    off = np.linalg.norm(moved - wanted) / whole
    cosine = float((moved * wanted).sum() / (np.linalg.norm(moved) * whole))
    assert cosine > 0.9, f"off by {off:.2f} of the movement"
