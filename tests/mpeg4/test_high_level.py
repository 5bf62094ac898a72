"""FAPs 1 and 2: visemes, expressions, what a stream defines, and low-level FAPs that win over all."""

from __future__ import annotations

import numpy as np
import pytest

from agentface.commands.check import faults_of
from agentface.errors import InvalidValueError
from agentface.mpeg4.expressions import EXPRESSIONS, expression_pose
from agentface.mpeg4.fap_player import FapPlayer
from agentface.mpeg4.faps import fap
from agentface.mpeg4.visemes import viseme_pose
from agentface.parameters import FacePose, parameter
from agentface.resources import face_names, rules_file
from agentface.speech.visemes import VISEME_COUNT, visemes
from tests.mpeg4.solvers import measured, solver_of

NOTHING = np.zeros(68)
SAID, FELT = (0,), (1,)


def frame(mask=(), **low):
    faps, named = np.zeros(68), np.zeros(68, np.bool_)
    named[list(mask)] = True
    for name, value in low.items():
        faps[fap(name).number - 1], named[fap(name).number - 1] = value, True
    return faps, named


def shown(face, pose):
    return measured(face, np.asarray(pose, np.float32)[None])[0]


# the standard's words for each, as signs of FAPs: by number, 1 or -1
SIGNS = {
    "happiness": {3: 1, 4: -1, 6: 1, 7: 1, 12: 1, 13: 1, 53: 1, 54: 1, 59: 1, 60: 1},
    "sadness": {31: 1, 32: 1, 19: 1, 20: 1, 12: -1, 13: -1},
    "anger": {31: -1, 32: -1, 33: -1, 34: -1, 37: 1, 38: 1, 19: -1, 20: -1},
    "fear": {31: 1, 32: 1, 37: 1, 38: 1, 19: -1, 20: -1},
    "disgust": {4: -1, 8: -1, 9: -1, 51: -1, 61: 1, 62: 1},
    "surprise": {31: 1, 32: 1, 33: 1, 34: 1, 35: 1, 36: 1, 19: -1, 20: -1, 3: 1, 5: -1},
}


@pytest.mark.parametrize("face", face_names())
@pytest.mark.parametrize("name", SIGNS)
def test_expressions_measured_back_have_the_signs_of_the_standard(face, name):
    faps = shown(face, expression_pose(EXPRESSIONS.index(name), 63, 0, 0))
    for number, sign in SIGNS[name].items():
        assert sign * faps[number - 1] > 5.0, number
    if name == "happiness":
        assert np.abs(faps[30:36]).max() < 5.0, "relaxed eyebrows"
    if name in ("sadness", "fear"):
        assert min(faps[30], faps[31]) > max(faps[34], faps[35]) + 10.0, "inner brows bent up"
    if name == "surprise":
        assert np.abs(faps[20:22]).max() < 20.0, "lower lids relaxed"


def test_two_expressions_mix_by_the_rules():
    both = expression_pose(1, 30, 6, 30)
    assert both[parameter("zygomaticus_major_l").index] > 0.0
    assert both[parameter("frontalis_lateralis_l").index] > 0.0
    np.testing.assert_array_equal(expression_pose(1, 20, 1, 43), expression_pose(1, 63, 0, 0))
    assert not expression_pose(0, 63, 0, 63).any()


def test_the_fifteen_visemes():
    assert len(visemes()) == VISEME_COUNT
    assert not visemes()[0].values.any()
    assert [visemes()[number].sounds for number in (1, 10, 14)] == [("p", "b", "m"), ("A:",), ("U",)]
    assert len({each.name for each in visemes()}) == VISEME_COUNT
    with pytest.raises(ValueError, match="read-only"):
        visemes()[1].values[0] = 1.0


@pytest.mark.parametrize("face", face_names())
def test_visemes_look_as_they_sound(face):
    faps = {each.name: shown(face, each.values) for each in visemes()}

    def gap(name):
        return -faps[name][3] - faps[name][4]

    assert gap("PP") < 40.0, "lips shut"
    assert faps["aa"][2] == max(row[2] for row in faps.values()), "the jaw's widest"
    assert gap("aa") > gap("E") > gap("ih") > 100.0
    for name in ("ou", "oh", "CH", "RR"):
        assert faps[name][52] + faps[name][53] < -20.0, f"{name} is narrow"
    for name in ("E", "ih", "SS"):
        assert faps[name][52] + faps[name][53] > 20.0, f"{name} is wide"
    assert faps["SS"][2] < 0.1 * faps["aa"][2], "teeth together"


def test_a_blend_goes_from_one_viseme_to_the_other():
    a, b = visemes()[10].values, visemes()[14].values
    np.testing.assert_array_equal(viseme_pose(10, 14, 63), a)
    np.testing.assert_array_equal(viseme_pose(10, 14, 0), b)
    np.testing.assert_allclose(viseme_pose(10, 14, 21), a / 3 + 2 * b / 3, atol=1e-6)


def test_what_selects_nothing_is_refused():
    for wrong in ((15, 0, 63), (0, -1, 63), (0, 0, 64), (0.5, 0, 3)):
        with pytest.raises(InvalidValueError, match="viseme"):
            viseme_pose(*wrong)
    for wrong in ((7, 0, 0, 0), (0, 64, 0, 0), (0, 0, 0, -1)):
        with pytest.raises(InvalidValueError, match="expression"):
            expression_pose(*wrong)
    player = FapPlayer(solver_of("amber"))
    with pytest.raises(InvalidValueError, match="FAP 1"):
        player.play(*frame(SAID), viseme=(1, 2, 3))
    with pytest.raises(InvalidValueError, match="init_face"):
        player.play(*frame(FELT), expression=(1, 2, 1, 3, 2, 0))
    with pytest.raises(InvalidValueError, match="mask"):
        player.play(NOTHING, np.zeros(3, np.bool_))


def test_a_frame_of_high_level_faps_is_its_base():
    player = FapPlayer(solver_of("amber"))
    found = player.play(*frame(SAID), viseme=(10, 0, 63, 0))
    np.testing.assert_allclose(found.pose.array, visemes()[10].values, atol=1e-6)
    found = player.play(*frame((*SAID, *FELT)), viseme=(10, 0, 63, 0), expression=(6, 63, 0, 0, 0, 0))
    assert found.pose["jaw_open"] >= visemes()[10].values[parameter("jaw_open").index]
    assert found.pose["frontalis_lateralis_l"] > 0.5
    unmasked = player.play(*frame(), viseme=(10, 0, 63, 0), expression=(6, 63, 0, 0, 0, 0))
    assert unmasked.pose == FacePose()


def test_low_level_faps_win_over_both():
    face = "amber"
    player = FapPlayer(solver_of(face))
    felt = (1, 63, 0, 0, 0, 0)
    found = player.play(*frame(FELT, open_jaw=0), expression=felt)
    seen = shown(face, found.pose.array)
    assert abs(seen[2]) < 20.0, "a closed jaw, though joy opens it"
    assert seen[11] > 150.0, "and still a smile"
    found = player.play(*frame(FELT, raise_l_i_eyebrow=60, raise_r_i_eyebrow=60), expression=(3, 63, 0, 0, 0, 0))
    assert shown(face, found.pose.array)[30] == pytest.approx(60.0, abs=12.0), "raised in anger"


def test_init_face_counts_from_the_expression():
    face = "amber"
    player = FapPlayer(solver_of(face))
    sad = expression_pose(2, 63, 0, 0)
    base = shown(face, sad)[2]
    found = player.play(*frame(FELT, open_jaw=300), expression=(2, 63, 0, 0, 1, 0))
    assert shown(face, found.pose.array)[2] == pytest.approx(base + 300.0, abs=25.0)
    jaw = shown(face, expression_pose(1, 63, 0, 0))[2]
    assert jaw > 200.0
    for init, expected in ((0, 300.0), (1, 300.0 + jaw)):
        found = player.play(*frame(FELT, open_jaw=300), expression=(1, 63, 0, 0, init, 0))
        assert shown(face, found.pose.array)[2] == pytest.approx(expected, abs=30.0)


def test_a_stream_defines_its_own_viseme_and_expression():
    face = "amber"
    player = FapPlayer(solver_of(face))
    player.play(*frame(SAID, open_jaw=800), viseme=(1, 0, 63, 1))
    found = player.play(*frame(SAID), viseme=(1, 0, 63, 0))
    assert shown(face, found.pose.array)[2] == pytest.approx(800.0, abs=40.0), "not p any more"
    found = player.play(*frame(SAID), viseme=(1, 0, 32, 0))
    assert shown(face, found.pose.array)[2] == pytest.approx(800.0 * 32 / 63, abs=40.0)
    player.play(*frame(FELT, raise_l_o_eyebrow=80, raise_r_o_eyebrow=80), expression=(4, 63, 0, 0, 0, 1))
    found = player.play(*frame(FELT), expression=(4, 63, 0, 0, 0, 0))
    assert shown(face, found.pose.array)[34] == pytest.approx(80.0, abs=15.0)
    usual = FapPlayer(solver_of(face)).play(*frame(SAID), viseme=(1, 0, 63, 0)).pose["jaw_open"]
    assert usual == visemes()[1].values[parameter("jaw_open").index]


def test_every_fault_of_the_visemes_is_told(tmp_path):
    text = rules_file("visemes.yaml").read_text()
    for old, new in (
        ("jaw_open: 0.4,", "jaw_opens: 0.4,"),
        ("risorius: 0.55", "risorius: -0.55"),
        ("  14:", "  15:"),
    ):
        assert old in text
        text = text.replace(old, new, 1)
    path = tmp_path / "visemes.yaml"
    path.write_text(text)
    assert [fault.where for fault in faults_of(path)] == ["visemes.15"]
    path.write_text(text[: text.index("  15:")] + text[text.index("\n# Visemes that are") :])
    told = {fault.where: fault for fault in reversed(faults_of(path))}
    assert set(told) == {"visemes", "visemes.10.parameters.jaw_opens", "visemes.11.parameters.risorius"}
    assert "jaw_open" in told["visemes.10.parameters.jaw_opens"].hint
