"""Gestures: key poses that are met, and how several share the face."""

from __future__ import annotations

import math

import numpy as np
import pytest
from click.testing import CliRunner
from hypothesis import given
from hypothesis import strategies as st

from agentface import Face
from agentface.cli import cli
from agentface.errors import DataError, UnknownNameError
from agentface.motion.gestures.channel import LET_GO_S, MOST
from agentface.motion.gestures.gesture import Track
from agentface.motion.gestures.table import all_gestures, load_gestures
from agentface.parameters import FacePose, parameter
from agentface.resources import rules_file
from tests.heads import head_model
from tests.motion.living import channels, trace

GESTURES = load_gestures(rules_file("gestures.yaml"))
ASKED_FOR = {"nod", "shake", "tilt", "brow_flash", "wink", "frown", "mouth_shrug", "glance", "listening_nod", "beat"}
VALUES = st.floats(-1, 1).map(lambda value: round(value, 6))
KEYS = st.lists(st.tuples(st.floats(0.02, 1), VALUES), min_size=1, max_size=6)


def track_of(keys):
    times = np.cumsum([0.0, *(step for step, _ in keys), 0.3])
    return Track.of("jaw_shift", times, np.array([0.0, *(value for _, value in keys), 0.0]))


@given(KEYS)
def test_a_track_meets_its_keys_between_which_it_never_runs_past_them(keys):
    track = track_of(keys)
    for time, value in zip(track.times_s, track.values, strict=True):
        assert track.at(time) == pytest.approx(value, abs=1e-9)
    for place, (before, after) in enumerate(zip(track.times_s, track.times_s[1:], strict=False)):
        low, high = sorted(track.values[place : place + 2])
        shown = [track.at(time) for time in np.linspace(before, after, 15)[1:-1]]
        assert low - 1e-9 <= min(shown)
        assert max(shown) <= high + 1e-9
    assert track.at(-1.0) == track.at(track.times_s[-1] + 1.0) == 0.0


@given(KEYS)
def test_a_track_is_the_cubic_that_scipy_makes_of_it(keys):
    from scipy.interpolate import PchipInterpolator

    track = track_of(keys)
    # at its ends it rests, where scipy's goes on: between the inner keys both are the same
    theirs = PchipInterpolator(track.times_s, track.values)
    for time in np.linspace(track.times_s[1], track.times_s[-2], 9):
        assert track.at(float(time)) == pytest.approx(float(theirs(time)), abs=1e-9)


@given(KEYS)
def test_a_track_has_no_kink(keys):
    track = track_of(keys)
    for time in track.times_s:
        near = 1e-6
        before, at, after = (track.at(time + step) for step in (-near, 0.0, near))
        assert abs((after - at) - (at - before)) / near < 0.05


def test_those_that_come_along_are_all_there_and_end_at_nothing():
    assert set(GESTURES) >= ASKED_FOR
    for name, gesture in GESTURES.items():
        mixer = channels(liveliness=0.0)
        mixer.gestures.play(name)
        poses = trace(mixer, gesture.length_s + 0.05, 100)
        assert np.abs(poses).max() > 0.03, name
        assert not poses[-1].any(), name
        assert mixer.gestures.playing == ()


def test_a_nod_goes_down_a_shake_aside_and_a_wink_shuts_one_eye():
    def extremes(name, *parameters):
        mixer = channels(liveliness=0.0)
        mixer.gestures.play(name)
        poses = trace(mixer, 1.5, 200)
        return [extreme(poses[:, parameter(of).index]) for of in parameters for extreme in (np.min, np.max)]

    low, high = np.degrees(extremes("nod", "head_pitch"))
    assert low == pytest.approx(-9.0, abs=0.1)
    assert high == pytest.approx(2.0, abs=0.1)
    left, right = np.degrees(extremes("shake", "head_yaw"))
    assert left == pytest.approx(-right, abs=0.1)
    closer = [f"orbicularis_oculi_palpebralis_{side}" for side in "lr"]
    assert extremes("wink", *closer) == pytest.approx([0.0, 1.0, 0.0, 0.0], abs=1e-3)


@pytest.mark.untraced
@given(st.floats(0, 1))
def test_half_as_strong_goes_half_as_far(strength):
    mixer = channels(liveliness=0.0)
    mixer.gestures.play("tilt", strength)
    mixer.advance(1.0)
    assert math.degrees(mixer.pose()["head_roll"]) == pytest.approx(8.0 * strength, abs=1e-4)


def test_a_contraction_comes_on_top_of_what_is_there():
    mixer, name = channels(liveliness=0.0), "frontalis_intermedius_l"
    mixer.action_units.set(2, 0.5, None, 0.0)
    below = mixer.pose()[name]
    assert 0.1 < below < 0.9
    mixer.gestures.play("brow_flash")
    mixer.advance(0.2)
    assert mixer.pose()[name] == pytest.approx(below + 0.8 * (1.0 - below), abs=1e-5)


def test_the_same_again_replaces_it_and_others_go_on():
    mixer = channels(liveliness=0.0)
    mixer.gestures.play("tilt")
    mixer.gestures.play("frown")
    trace(mixer, 0.5, 60)
    mixer.gestures.play("tilt")
    assert mixer.gestures.playing == ("tilt", "frown", "tilt")
    trace(mixer, LET_GO_S + 0.05, 60)
    assert mixer.gestures.playing == ("frown", "tilt")
    mixer.release(0.2)
    assert trace(mixer, 0.25, 60)[-1].any() == False  # noqa: E712  # numpy's
    assert mixer.gestures.playing == ()


def test_a_flood_of_gestures_is_bounded():
    mixer = channels(liveliness=0.0)
    for name in [*GESTURES] * 3:
        mixer.gestures.play(name)
        mixer.advance(0.3)
        mixer.pose()
        assert len(mixer.gestures.playing) <= MOST + 1
    for _ in range(1000):
        mixer.gestures.play("nod")
    poses = trace(mixer, 0.3, 100)
    assert np.degrees(np.abs(poses[:, parameter("head_pitch").index])).max() < 25


def test_one_that_is_told_ahead_begins_then():
    mixer = channels(liveliness=0.0)
    mixer.gestures.play("nod", 1.0, 0.5)
    assert not trace(mixer, 0.5, 60).any()
    assert trace(mixer, 0.3, 60).any()


MINE = """
gestures:
  nod:
    description: "mine"
    keys:
      - {at_s: 0.5, pose: {jaw_open: 0.5}}
      - {at_s: 1.0, pose: {}}
  pout:
    description: "new"
    keys:
      - {at_s: 0.5, pose: {orbicularis_oris_pucker: 0.5, cheek_puff: 0.2}}
      - {at_s: 1.0, pose: {}}
"""


def test_a_user_adds_gestures_in_a_file_or_in_the_data_folder(tmp_path, monkeypatch):
    file = tmp_path / "rules" / "gestures.yaml"
    file.parent.mkdir()
    file.write_text(MINE)
    face = Face(head_model(), compiled=False, gestures=file)
    with pytest.raises(UnknownNameError, match="pout"):
        face.gesture("poute")
    face.gesture("pout")
    face.channels.advance(0.5)
    assert face.channels.pose() == FacePose.of(orbicularis_oris_pucker=0.5, cheek_puff=0.2)
    assert all_gestures()["nod"].description != "mine"
    monkeypatch.setenv("AGENTFACE_DATA", str(tmp_path))
    assert all_gestures()["nod"].description == "mine"
    assert set(all_gestures()) == {*GESTURES, "pout"}


def test_a_file_that_is_named_has_to_be_there(tmp_path):
    with pytest.raises(DataError):
        all_gestures(tmp_path / "none.yaml")


def test_every_fault_of_a_file_is_told_at_once(tmp_path):
    path = tmp_path / "gestures.yaml"
    path.write_text(
        """
gestures:
  nod:
    description: "x"
    keys:
      - {at_s: 0.5, pose: {head_pitch: 0.1, head_yaw_deg: 81}}
      - {at_s: 0.4, pose: {risorious: 0.5, jaw_open: 1.5}}
      - {at_s: 0.9, pose: {jaw_open: 0.1}}
"""
    )
    with pytest.raises(DataError) as caught:
        load_gestures(path)
    assert {(fault.where.removeprefix("gestures.nod.keys."), fault.line) for fault in caught.value.faults} == {
        ("0.pose.head_pitch", 6), ("0.pose.head_yaw_deg", 6), ("1.at_s", 7), ("1.pose.risorious", 7),
        ("1.pose.jaw_open", 7), ("2.pose", 8),
    }  # fmt: skip
    assert CliRunner().invoke(cli, ["check", str(path)]).exit_code == 1
    path.write_text("gestures:\n  Nod Off:\n    description: x\n    keys: []\n    pose: 1\n")
    with pytest.raises(DataError) as caught:
        load_gestures(path)
    assert len(caught.value.faults) >= 3
