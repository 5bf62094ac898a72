"""Streams of FAPs to performances: what the solver is asked, and what of its answer is played."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from agentface.io.performances.fap_performance import performance_of_faps
from agentface.mpeg4.fap_stream import FapStream
from agentface.mpeg4.fap_table import FAP_COUNT
from agentface.parameters import COUNT, NEUTRAL, FacePose, parameter

JAW, SMILE, LIP = (
    parameter(name).index for name in ("jaw_open", "zygomaticus_major_l", "depressor_labii_inferioris_l")
)


class Player:
    """Opens the jaw by FAP 3 in thousands, and pulls the corner by FAP 12, of which more than 500 is out of reach.

    A viseme lowers the lip, unless it is the fourth.
    """

    def __init__(self):
        self.asked = []

    def play(self, faps, mask, viseme, expression, previous):
        self.asked.append((viseme, expression, previous))
        values, moves = NEUTRAL.copy(), np.zeros(COUNT, bool)
        if mask[0] and viseme[0] != 4:
            values[LIP] = 0.25
        for number, place in ((3, JAW), (12, SMILE)):
            if mask[number - 1]:
                values[place] = min(faps[number - 1] / 1000, 1.0)
                moves[place] = True
        beyond = (12,) if mask[11] and faps[11] > 500 else ()
        return SimpleNamespace(pose=FacePose(values), moves=moves, out_of_reach=beyond)


def stream(rows):
    """Of ``{number: value}`` for each frame; values of FAP 1 and 2 are rows of fields."""
    values, mask = np.zeros((len(rows), FAP_COUNT), int), np.zeros((len(rows), FAP_COUNT), bool)
    fields = {1: np.zeros((len(rows), 4), int), 2: np.zeros((len(rows), 6), int)}
    for frame, row in enumerate(rows):
        for number, value in row.items():
            mask[frame, number - 1] = True
            if number in fields:
                fields[number][frame] = value
            else:
                values[frame, number - 1] = value
    return FapStream("2.1", "a", 25.0, values, mask, fields[1], fields[2])


def test_each_frame_is_sought_from_the_one_before_and_moves_what_it_names():
    player, done = Player(), []
    played, beyond = performance_of_faps(stream([{3: 500}, {3: 700, 12: 200}, {}, {12: 900}]), player, told=done.append)
    assert [asked[2] is None for asked in player.asked] == [True, False, False, False]
    assert played.rate_hz == 25.0
    assert played.poses[:, JAW] == pytest.approx([0.5, 0.7, 0, 0])
    assert played.weights[:, JAW].tolist() == [1, 1, 0, 0]
    assert played.weights[:, SMILE].tolist() == [0, 1, 0, 1]
    assert beyond == {12: 1}
    assert done == [1, 2, 3, 4]


def test_a_stream_whose_mask_never_changes_has_one_row_of_weights():
    played, _ = performance_of_faps(stream([{3: 1}, {3: 2}]), Player())
    assert played.weights.shape == (1, COUNT)
    assert played.moved == ("jaw_open",)


def test_visemes_determine_what_they_move_in_every_frame_that_has_one():
    player = Player()
    rows = [{1: [3, 0, 63, 0]}, {1: [4, 0, 63, 0], 2: [1, 60, 0, 0, 0, 0], 3: 800}, {3: 800}]
    played, _ = performance_of_faps(stream(rows), player)
    assert [asked[:2] for asked in player.asked] == [
        ((3, 0, 63, 0), (0, 0, 0, 0, 0, 0)),
        ((4, 0, 63, 0), (1, 60, 0, 0, 0, 0)),
        ((0, 0, 0, 0), (0, 0, 0, 0, 0, 0)),
    ]
    assert played.poses[:, LIP].tolist() == [0.25, 0, 0]
    assert played.weights[:, LIP].tolist() == [1, 1, 0]
    assert played.poses[:, JAW] == pytest.approx([0, 0.8, 0.8])
    assert played.weights[:, JAW].tolist() == [1, 1, 1]
