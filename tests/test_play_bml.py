from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

from agentface import Face
from agentface.cli import cli
from agentface.clock import FrameClock
from agentface.commands.recordings import opened, player_of
from agentface.io.bml.reader import load_bml
from agentface.live.blocks import SETTLES_S, BlockSource
from agentface.live.loop import run
from agentface.parameters import NAMES
from agentface.speech.voices.voice import SILENCE
from agentface.talk.block_speech import block_sound, speak_block, spoken_timetable
from tests.heads import head_model
from tests.tools import require
from tests.voices import RATE, HundredthsVoice

GREETING = Path(__file__).parent.parent / "examples" / "greeting.bml"
FPS = 30.0
SPEAKS = (
    '<bml id="b"><speech id="s" start="0.5"><text>Mama saw a map.</text></speech>'
    '<faceLexeme id="f" lexeme="SMILE" end="s:end"/></bml>'
)


class Poses:
    """Keeps every pose with its time."""

    def __init__(self):
        self.times, self.poses = [], []

    def show(self, frame):
        self.times.append(frame.time_s)
        self.poses.append(frame.pose)

    def of(self, name):
        return np.array([pose.array[NAMES.index(name)] for pose in self.poses])


def call(*arguments):
    return CliRunner().invoke(cli, [*map(str, arguments)], prog_name="agentface")


def test_an_agent_s_document_is_played_in_a_simulated_clock():
    block = speak_block(HundredthsVoice(), load_bml(GREETING))
    times, shown, told = spoken_timetable(block), Poses(), []
    with Face(head_model(), compiled=False) as face:
        face.blocks.told.append(told.append)
        end = times.end_s + SETTLES_S
        run(face, FrameClock(FPS), [BlockSource(face, block)], [shown], fps=FPS, duration=end)
    at = np.array(shown.times)
    moment = {f"{point.behavior}:{point.name}": time for point, time in times.times.items()}
    assert {each.what: each.time_s for each in told if ":" in each.what} == pytest.approx(
        {what: time for what, time in moment.items() if not what.startswith("wave")}
    )
    pitch, smile = shown.of("head_pitch"), shown.of("zygomaticus_major_l")
    assert at[pitch.argmin()] == pytest.approx(moment["hello:welcome"], abs=0.05), "it nods at the word"
    full = (at > moment["smile:attackPeak"] + 0.2) & (at < moment["smile:relax"])
    assert smile[full].min() > 0.1
    jaw = shown.of("jaw_open")
    assert jaw[at < moment["hello:start"] - 0.3].max() < 0.1 * jaw.max()
    gaze = shown.of("gaze_yaw")
    aside = (at > moment["aside:ready"]) & (at < moment["aside:relax"])
    assert gaze[aside].min() > np.radians(5)
    left = {name for name in NAMES if abs(shown.poses[-1][name]) > 1e-5}
    assert left == {"gaze_vergence"}, "all is as it was, but that it looks at the user"


def test_a_block_is_played_again_when_it_is_over():
    block, told = load_bml(GREETING).voiced({}), []
    short = type(block)("b", tuple(each for each in block.behaviors if each.id == "wave"))
    with Face(head_model(), compiled=False) as face:
        face.blocks.told.append(told.append)
        run(face, FrameClock(20), [BlockSource(face, short, again=True)], fps=20, duration=4.5)
    assert [each.what for each in told] == ["start", "end", "start", "end", "start"]


def test_what_is_heard_begins_with_the_speech():
    block = speak_block(HundredthsVoice(), load_bml(GREETING))
    sound = block_sound(block, RATE)
    start = round(RATE * spoken_timetable(block).times[block.speeches[0].anchors[0][1].point])
    start += round(RATE * 0.2)
    assert not sound.samples[:start].any()
    assert sound.samples[start : start + 100].all()


def test_check_tells_every_fault_of_a_block(tmp_path):
    path = tmp_path / "bad.bml"
    path.write_text('<bml id="b">\n<gaze id="g"/>\n<head id="h" lexeme="NOD" start="x:end"/>\n</bml>')
    result = call("check", path)
    assert result.exit_code == 1
    assert f"{path}:2: g.target" in result.output
    assert f"{path}:3: h.start: expected the id of a behavior, got 'x'" in result.output
    good = call("check", "--strict", GREETING)
    assert good.exit_code == 1
    assert "got <gesture>" in good.output


def test_what_hangs_on_another_block_is_told_before_anything_is_shown(tmp_path):
    path = tmp_path / "after.bml"
    path.write_text('<bml id="b">\n<wait id="w" start="other:w:end"/>\n</bml>')
    assert call("check", path).exit_code == 0
    result = call("play", path, "-o", tmp_path / "film.mp4")
    assert result.exit_code == 1
    assert f"{path}:2: other:w:end: expected a sync point of a block that plays or has played" in result.stderr
    assert not (tmp_path / "film.mp4").exists()


@pytest.mark.slow
@pytest.mark.gl
def test_a_block_is_filmed_with_what_it_says(tmp_path):
    import av

    require("flite")
    path, film = tmp_path / "says.bml", tmp_path / "says.mp4"
    path.write_text(SPEAKS)
    result = call("play", path, "-o", film, "--size", "64x64", "--fps", "10")
    assert result.exit_code == 0, result.output
    found = opened(path, None)
    with Face(head_model(), compiled=False) as face:
        _, length_s = player_of(found, face)
    with av.open(str(film)) as container:
        frames = sum(1 for _ in container.decode(video=0))
    with av.open(str(film)) as container:
        heard = np.concatenate([frame.to_ndarray().ravel() for frame in container.decode(audio=0)]).astype(float)
        rate = container.streams.audio[0].rate
    assert frames == int(np.ceil(10 * length_s - 1e-6))
    loud = np.flatnonzero(np.abs(heard) > 0.02 * np.abs(heard).max())
    first = next(phone for phone in found.voiced.spoken[0][1].phones if phone.symbol != SILENCE)
    assert loud[0] / rate == pytest.approx(0.5 + first.start_s, abs=0.1)


@pytest.mark.slow
def test_a_block_is_measured_in_faps_and_not_made_into_poses(tmp_path):
    path = tmp_path / "smile.bml"
    path.write_text('<bml id="b"><faceFacs id="f" au="12" amount="1" end="1"/></bml>')
    result = call("play", path, "--fap-out", tmp_path / "smile.fap")
    assert result.exit_code == 0, result.output
    assert (tmp_path / "smile.fap").read_text().count("\n") > 80
    result = call("convert", path, tmp_path / "smile.npz")
    assert result.exit_code == 1
    assert "expected a file that has frames, or emotions in time, got BML" in result.stderr
