from __future__ import annotations

import numpy as np
import pytest

from agentface import Face
from agentface.bml.table import bml_table
from agentface.errors import InvalidValueError
from agentface.io.bml.reader import read_bml
from agentface.live.notes import Replay
from agentface.parameters import NAMES
from agentface.requests import Gesture, Hush, LookAt, PlayBlock, SetActionUnit, SetEmotion, SetGaze, SetHead, Speak
from agentface.speech.synthesizer import Synthesizer
from agentface.talk.block_speech import speak_block, spoken_timetable
from agentface.talk.blocks import MOST_BLOCKS, BlockPlayer
from agentface.talk.talker import LEAD_S
from tests.heads import head_model
from tests.voices import HundredthsVoice


def block(inside, name="b", **attributes):
    extra = "".join(f' {key}="{value}"' for key, value in attributes.items())
    return read_bml(f'<bml xmlns="http://www.bml-initiative.org/bml/bml-1.0" id="{name}"{extra}>\n{inside}\n</bml>')


class Stage:
    """A face, what it was asked and told, and when."""

    def __init__(self):
        self.face = Face(head_model(), compiled=False)
        self.player = BlockPlayer(self.face, Synthesizer(lambda _voice, _language: HundredthsVoice()))
        self.face._agendas.blocks = self.player
        self.face.noted.append(self.player.notice)
        self.now, self.asked, self.told, self.failed = 0.0, [], [], []
        self.face.noted.append(lambda request: self.asked.append((round(self.player._now, 6), request)))
        self.player.told.append(lambda each: self.told.append((round(self.player._now, 6), each.block, each.what)))
        self.player.failed.append(lambda name, error: self.failed.append((name, str(error))))

    def play(self, inside, name="b", **attributes):
        self.face.play_block(block(inside, name, **attributes))
        self.player.wait()

    def run(self, seconds, dt=0.05):
        poses = []
        for _ in range(round(seconds / dt)):
            self.face._agendas.advance(dt, self.face.channels.advance)
            self.face._touch()
            poses.append(self.face.pose.array.copy())
        return np.array(poses)

    def of(self, *kinds):
        return [(time, request) for time, request in self.asked if isinstance(request, kinds)]

    def when(self, what, name="b"):
        return [time for time, of, told in self.told if (of, told) == (name, what)]


@pytest.fixture
def stage():
    made = Stage()
    with made.face:
        yield made


def test_a_face_comes_holds_and_goes_at_its_times(stage):
    stage.play('<faceLexeme id="f" lexeme="SMILE" amount="0.6" start="0.23" attackPeak="0.5" relax="1.111" end="2"/>')
    stage.run(2.5)
    (came, show), (went, let_go) = stage.of(SetEmotion)
    assert (came, went) == pytest.approx((0.23, 1.111))
    assert (show.emotion, show.intensity, show.fade) == ("happiness", 0.6, pytest.approx(0.27))
    assert (let_go.intensity, let_go.fade) == (0.0, pytest.approx(0.889))
    assert stage.face.emotion["happiness"] == 0.0


def test_action_units_are_shown_on_their_side(stage):
    stage.play('<faceFacs id="f" au="2" side="LEFT" amount="1" start="0" attackPeak="0.2" relax="1" end="1.2"/>')
    poses = stage.run(0.5)
    left, right = (NAMES.index(f"frontalis_lateralis_{side}") for side in "lr")
    assert poses[-1, left] == pytest.approx(1.0, abs=1e-3)
    assert poses[-1, right] == 0.0
    stage.run(1.0)
    assert stage.face.channels.action_units.shown == {}


def test_of_two_that_show_the_same_the_stronger_counts_while_it_lasts(stage):
    stage.face.set_emotion("happiness", 0.2, fade=0.0)
    stage.play(
        '<faceLexeme id="f" lexeme="SMILE" amount="0.4" start="0" attackPeak="0.1" relax="2" end="2.1"/>'
        '<faceLexeme id="g" lexeme="SMILE" amount="0.8" start="0.5" attackPeak="0.6" relax="1" end="1.1"/>'
    )
    stage.run(3.0)
    assert [request.intensity for _, request in stage.of(SetEmotion)][1:] == [0.4, 0.8, 0.4, 0.2]


def test_a_shift_stays_and_is_what_others_go_back_to(stage):
    stage.play('<faceShift id="s" lexeme="SMILE" amount="0.5" start="0" end="0.3"/>', "one")
    stage.run(1.0)
    stage.play('<faceLexeme id="f" lexeme="SMILE" amount="1" start="0" attackPeak="0.1" relax="0.5" end="0.6"/>', "two")
    stage.run(1.0)
    assert stage.face.emotion["happiness"] == 0.5
    stage.play('<faceShift id="s" lexeme="SADNESS" amount="0.5"/>', "three")
    stage.run(1.0)
    assert stage.face.emotion.as_dict() == {**dict.fromkeys(stage.face.emotion, 0.0), "sadness": 0.5}


def test_a_mood_is_gone_back_to_and_not_held(stage):
    stage.face.set_mood({"happiness": 0.3})
    stage.run(5.0)
    stage.play('<faceLexeme id="f" lexeme="SMILE" amount="0.9" end="1"/>')
    stage.run(3.0)
    assert stage.face.emotion["happiness"] == 0.3
    stage.face.set_mood({})
    stage.run(8.0)
    assert stage.face.emotion["happiness"] == 0.0


def test_a_gaze_looks_there_and_back(stage):
    stage.face.set_gaze(5, 3, fade=0.0)
    stage.play('<gaze id="g" target="LEFT" start="0.1" ready="0.2" relax="0.6" end="0.7"/>')
    poses = stage.run(1.5, 0.1)
    yaw = np.degrees(poses[:, NAMES.index("gaze_yaw")])
    assert yaw[:5].max() > 15.0
    assert yaw[-1] == pytest.approx(5.0, abs=0.1)
    ((there, look),) = stage.of(LookAt)
    assert there == pytest.approx(0.1)
    assert (look.x > 0, look.fade) == (True, pytest.approx(0.1))
    assert stage.of(SetGaze)[-1] == (pytest.approx(0.6), SetGaze(5, 3, stage.of(SetGaze)[-1][1].fade))


def test_a_gaze_within_another_goes_back_to_that_and_a_shift_stays(stage):
    stage.play(
        '<gazeShift id="s" target="DOWN" start="0" end="0.1"/>'
        '<gaze id="a" target="LEFT" start="0.2" end="2"/><gaze id="b" target="RIGHT" start="0.5" end="1"/>'
    )
    stage.run(3.0)
    looks = [request for _, request in stage.of(LookAt)]
    assert [np.sign(round(look.x, 6)) for look in looks] == [0, 1, -1, 1, 0]
    assert looks[-1].y < looks[1].y


def test_the_head_turns_along_and_back(stage):
    stage.play('<gaze id="g" target="LEFT" influence="WHOLE" start="0" end="1"/>')
    stage.run(3.0)
    heads = [request for _, request in stage.of(SetHead)]
    assert [head.yaw_deg for head in heads] == pytest.approx([0.9 * 30.0, 0.0])
    stage.play('<headDirectionShift id="h" target="RIGHT"/>', "c")
    stage.run(2.0)
    assert stage.face.turned_deg["head_yaw"] == pytest.approx(-30.0)


def test_a_head_nods_in_the_time_it_has(stage):
    stage.play('<head id="n" lexeme="NOD" amount="1" start="0.5" end="2.5"/>')
    poses = stage.run(3.0)
    pitch = np.degrees(poses[:, NAMES.index("head_pitch")])
    assert pitch[:10].max() == pitch[:10].min() == 0.0
    assert pitch[-8:].min() == pytest.approx(0.0, abs=1e-9)
    lowest = 0.05 * (1 + pitch.argmin())
    assert lowest == pytest.approx(0.5 + 2.0 * 0.21, abs=0.06), "as far through its time as when it is not stretched"
    assert pitch.min() == pytest.approx(-9.0, abs=0.1)


def test_a_head_repeats(stage):
    stage.play('<head id="n" lexeme="SHAKE" repetition="3" start="0" end="3"/>')
    stage.run(3.5)
    assert [time for time, _ in stage.of(Gesture)] == pytest.approx([0.0, 1.0, 2.0])


SPEECH = (
    '<speech id="s" start="0.5"><text>Well hello <sync id="there"/>there. Now <sync id="go"/>go.</text></speech>'
    '<head id="n" lexeme="NOD" stroke="s:go"/>'
    '<faceFacs id="f" au="1" start="s:there" end="s:end + 0.2"/>'
)


def test_others_wait_for_the_words_of_a_speech(stage):
    stage.play(SPEECH)
    stage.run(2.0)
    (spoke, speak), *_ = stage.of(Speak)
    first, second = 0.01 * len("Well hello there."), 0.01 * len("Now go.")
    assert (spoke, speak.start) == pytest.approx((0.5 - LEAD_S, LEAD_S)), "the mouth rounds early"
    assert stage.when("s:there") == pytest.approx([0.5 + 0.11])
    assert stage.when("s:go") == pytest.approx([0.5 + first + 0.04])
    assert stage.when("s:end") == pytest.approx([0.5 + first + second])
    assert stage.when("n:stroke") == stage.when("s:go")
    assert stage.when("f:start") == stage.when("s:there")
    assert stage.when("f:end") == pytest.approx([0.7 + first + second])
    assert stage.face.talker.texts == ()


def test_others_wait_for_a_loudspeaker_that_is_late(stage):
    stage.face.talker.latency_s = 0.06
    stage.play(SPEECH)
    stage.run(2.0)
    (spoke, speak), *_ = stage.of(Speak)
    assert spoke + speak.start == pytest.approx(0.56), "what is heard begins 0.06 s before"
    assert stage.when("s:start") == pytest.approx([0.56])
    assert stage.when("s:there") == stage.when("f:start") == pytest.approx([0.56 + 0.11])


def test_a_speech_is_told_early_only_where_nothing_else_is_said_until_then(stage):
    stage.face.speak([("aa", 0.0, 2.0)])
    stage.play(SPEECH)
    stage.run(2.0)
    (spoke, speak), *_ = [each for each in stage.of(Speak) if each[1].live]
    assert (spoke, speak.start, speak.interrupt) == (pytest.approx(0.5), 0.0, True)
    assert stage.when("s:start") == pytest.approx([0.5])


def test_a_speech_that_is_told_early_and_replaced_before_it_begins_is_never_heard(stage):
    heard, hushed = [], []
    stage.face.talker.heard.append(lambda sound, in_s: heard.append(in_s))
    stage.face.talker.hushed.append(lambda: hushed.append(stage.player._now))
    stage.play(SPEECH)
    stage.run(0.4)
    assert heard == pytest.approx([LEAD_S])
    stage.play('<wait id="w"/>', "r", composition="REPLACE")
    stage.run(1.0)
    assert hushed == pytest.approx([0.4])
    assert stage.face.channels.speech.status is None
    assert stage.when("s:start") == []


def test_what_is_spoken_before_is_the_same(stage):
    voiced = speak_block(HundredthsVoice(), block(SPEECH))
    times = spoken_timetable(voiced).times
    stage.play(SPEECH)
    stage.run(2.0)
    for point, time in times.items():
        assert stage.when(f"{point.behavior}:{point.name}") == pytest.approx([time])


def test_the_feedback_begins_with_the_start_and_is_in_order(stage):
    stage.play('<wait id="w" duration="0.5"/><gesture id="g"/><gaze id="z" target="USER" start="w:end"/>')
    stage.run(4.0)
    times, _, told = zip(*stage.told, strict=True)
    assert list(times) == sorted(times)
    assert (told[0], told[1], told[-1]) == ("start", "w:start", "end")
    assert [each for each in told if each[0] == "z"] == ["z:start", "z:ready", "z:relax", "z:end"]
    assert not any(each.startswith("g:") for each in told)


WAIT = '<wait id="w" duration="1"/>'


BLOCKS = {"a": WAIT, "b": '<wait id="w" duration="9"/>', "c": '<speech id="s"><text>Bad word.</text></speech>'}


def test_merge_plays_beside_append_after_all(stage):
    stage.play(WAIT, "a")
    stage.run(0.5)
    stage.play(WAIT, "b")
    stage.play(WAIT, "c", composition="APPEND")
    stage.play(WAIT, "d", composition="APPEND")
    assert stage.player.blocks == ("a", "b", "c", "d")
    stage.run(4.0)
    assert [stage.when("start", name) for name in "abcd"] == [[0.0], [0.5], [1.5], [2.5]]
    assert stage.when("end", "d") == [3.5]
    assert stage.player.blocks == ()


def test_replace_ends_what_plays_smoothly(stage):
    stage.play('<faceLexeme id="f" lexeme="SMILE" amount="1" end="5"/><gaze id="z" target="LEFT" end="5"/>', "a")
    stage.play('<speech id="s"><text>A long text that is not said to its very end.</text></speech>', "t")
    stage.play(WAIT, "x", composition="APPEND")
    first = stage.run(0.4, 0.01)
    stage.play('<faceLexeme id="f" lexeme="SADNESS" amount="0.5"/>', "b", composition="REPLACE")
    second = stage.run(1.0, 0.01)
    assert stage.when("stopped", "a") == stage.when("stopped", "t") == stage.when("start", "b") == [0.4]
    assert [what for _, name, what in stage.told if name == "x"] == ["stopped"]
    assert len(stage.of(Hush)) == 1
    assert stage.face.emotion["happiness"] == 0.0
    gaze = NAMES.index("gaze_yaw")
    assert second[-1, gaze] == pytest.approx(0.0, abs=1e-6)
    jumps = np.abs(np.diff(np.concatenate([first, second])[:, gaze])).max()
    assert jumps < np.radians(6.0), "no faster than a saccade"


def test_another_block_s_sync_points(stage):
    stage.play('<wait id="w" duration="2"/>', "a")
    stage.run(0.5)
    stage.play('<wait id="v" start="a:w:end + 0.25"/>', "b")
    stage.play('<wait id="v" start="a:bml:end + 0.5"/>', "c")
    stage.play('<wait id="v" start="nobody:w:end"/>', "d")
    stage.run(4.0)
    assert stage.when("v:start", "b") == [2.25]
    assert stage.when("v:start", "c") == [2.5]
    ((name, why),) = stage.failed
    assert name == "d"
    assert "nobody:w:end" in why


def test_a_voice_that_fails_fails_its_block_alone(stage):
    stage.play('<speech id="s"><text>Bad word.</text></speech><wait id="w"/>', "a")
    stage.play(WAIT, "b", composition="APPEND")
    stage.run(1.5)
    assert stage.failed == [("a", "no voice for that")]
    assert stage.when("end", "b") == [1.0]
    assert stage.when("start", "a") == []


def test_an_id_is_for_one_block_and_not_too_many_wait(stage):
    stage.play(WAIT, "a")
    with pytest.raises(InvalidValueError, match="block id"):
        stage.play(WAIT, "a")
    stage.play(WAIT, "a", composition="REPLACE")
    for number in range(MOST_BLOCKS - 2):
        stage.play(WAIT, f"w{number}")
    with pytest.raises(InvalidValueError, match=f"at most {MOST_BLOCKS}"):
        stage.play(WAIT, "more")


def test_what_is_taken_back_while_it_waits_is_not_played(stage):
    stage.play(WAIT, "a")
    doing = stage.face.apply(PlayBlock(block(WAIT, "b", composition="APPEND")))
    stage.run(0.5)
    doing.end(whole=False)
    stage.run(2.0)
    assert stage.when("start", "b") == []
    assert stage.when("stopped", "b") == [0.5]


def test_one_block_is_taken_back_while_others_go_on(stage):
    stage.play('<faceLexeme id="f" lexeme="SMILE" end="3"/>', "a")
    inside = (
        '<faceLexeme id="f" lexeme="SMILE" amount="1" end="9"/><gaze id="g" target="LEFT" end="9"/>'
        '<head id="n" lexeme="NOD" end="9"/><speech id="s"><text>A text of many words that is hushed.</text></speech>'
    )
    doing = stage.face.apply(PlayBlock(block(inside, "b")))
    stage.player.wait()
    stage.run(0.2)
    doing.end(whole=False)
    poses = stage.run(1.0)
    assert stage.when("stopped", "b") == [0.2]
    assert stage.when("stopped", "a") == []
    assert stage.face.emotion["happiness"] == 0.5
    assert len(stage.of(Hush)) == 1
    left = {name: abs(poses[-1, NAMES.index(name)]) for name in ("gaze_yaw", "head_pitch")}
    assert max(left.values()) < 1e-6
    stage.run(3.0)
    assert stage.face.emotion["happiness"] == 0.0


def test_what_goes_on_says_how_it_ended(stage):
    whole, half, bad = (stage.face.apply(PlayBlock(block(text, name))) for name, text in BLOCKS.items())
    stage.player.wait()
    stage.run(1.5)
    stage.player.stop()
    assert (whole.outcome, half.outcome, bad.outcome) == (True, False, False)
    assert (half.error, str(bad.error)) == (None, "no voice for that")


def test_neutral_ends_all_and_what_is_felt_meanwhile_stays(stage):
    stage.play('<faceLexeme id="f" lexeme="SMILE" amount="1" end="3"/>', "a")
    stage.run(0.5)
    stage.face.set_emotion("happiness", 0.4)
    stage.run(4.0)
    assert stage.face.emotion["happiness"] == 0.4
    stage.play('<faceLexeme id="f" lexeme="SMILE" amount="1" end="3"/>', "b")
    stage.run(0.5)
    stage.face.neutral()
    assert stage.when("stopped", "b")
    stage.run(4.0)
    assert stage.face.emotion["happiness"] == 0.0


def test_any_frame_rate_shows_the_same():
    whole = (
        f'{SPEECH}<gaze id="z" target="LEFT" influence="HEAD" start="0.31" end="1.3"/>'
        '<faceLexeme id="j" lexeme="SMILE" start="0.123" end="1.4"/>'
    )
    shown = []
    for fps in (20, 100):
        stage = Stage()
        stage.play(whole)
        shown.append(stage.run(2.0, 1 / fps)[fps // 20 - 1 :: fps // 20])
        stage.face.close()
    assert np.abs(shown[0] - shown[1]).max() < 1e-3


def test_what_came_of_a_block_is_noted_and_gives_the_same_again(stage):
    noted, dt = [], 0.05
    stage.face.noted.append(lambda request: noted.append((round(stage.player._now, 6), request)))
    stage.play(
        '<faceFacs id="f" au="1" start="0.2" attackPeak="0.4" relax="0.8" end="1"/>'
        '<head id="n" lexeme="NOD" start="0.5"/>'
    )
    shown = stage.run(2.0, dt)
    assert isinstance(noted[0][1], PlayBlock)
    assert [type(request) for _, request in noted[1:]] == [SetActionUnit] * 2 + [Gesture] + [SetActionUnit] * 2
    again = Stage()
    replay = Replay(again.face, noted, 1 / dt)
    poses = []
    for step in range(40):
        replay.take_in(step * dt)
        poses.append(again.run(dt, dt)[0])
    assert np.abs(np.array(poses) - shown).max() < 1e-9
    again.face.close()


def test_the_table_s_lexemes_show_something():
    for name, shows in bml_table().lexemes.items():
        assert shows, name
