"""The steps taken one by one, in numpy: the deformer's own are these, and the numbers of the documents are theirs."""

from __future__ import annotations

import re
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from agentface.parameters import COUNT, FacePose
from agentface.studies.parallel_steps import CASES, WAYS, SteppedFace, combined_units, compare, table
from tests.deform.conflicts import Edges, ranges
from tests.heads import deformer_of, head_model

FACES = ("amber", "onyx")
DOCUMENT = Path(__file__).parents[2] / "docs" / "lips.md"
OF_LIPS = [case for case in CASES if "squeeze" not in case.name and "lids" not in case.name]


@pytest.fixture(params=FACES)
def face(request):
    return request.param


@cache
def stepped(face, way):
    return SteppedFace(head_model(face), way)


def poses(count, seed):
    low, high = ranges()
    draw = np.random.default_rng(seed)
    for number in range(count):
        values = low + (high - low) * draw.random(COUNT) * (draw.random(COUNT) < (0.3 if number % 2 else 1.0))
        yield FacePose(values.astype(np.float32))


@pytest.mark.parametrize("compiled", [True, False])
def test_the_deformer_takes_these_steps(face, compiled):
    """Which compute the ways of the lips' parts at their mean place, and not one after the other."""
    for pose in [*(case.pose for case in CASES), *poses(4, seed=1)]:
        gap = deformer_of(face, compiled=compiled).at(pose).vertices - stepped(face, "steps").at(pose).vertices
        assert np.abs(gap).max() < 1e-6, repr(pose)


@pytest.mark.parametrize(
    "muscle",
    [
        "zygomaticus_major",
        "orbicularis_oris_pucker",
        "orbicularis_oris_press",
        "orbicularis_oculi_palpebralis",
        "orbicularis_oculi_preseptalis",
        "orbicularis_oculi_orbitalis",
    ],
)
def test_each_muscle_alone_does_the_same_in_every_way(face, muscle):
    pose = FacePose.of(**{muscle: 0.9})
    once, steps, mutual = (stepped(face, way).at(pose).vertices for way in WAYS)
    np.testing.assert_allclose(steps, once, atol=1e-6)
    np.testing.assert_allclose(mutual, once, atol=1e-6)


def test_nothing_turns_over_in_any_way(face):
    edges = Edges.of(head_model(face))
    for case in CASES:
        for way in WAYS:
            over = edges.flipped(stepped(face, way).at(case.pose).vertices) & ~edges.folding()
            assert not over.any(), (case.name, way)


def test_lips_in_the_steps_come_nearer_to_the_artists_than_once(face):
    """But for a lower lip that is drawn down, where it makes no difference."""
    for case in (*OF_LIPS, *combined_units()):
        ways = compare(head_model(face), case)
        assert ways["steps"].error_mm < ways["once"].error_mm + (0.02 if "lowered" in case.name else 0.0), case.name
        assert ways["steps"].cosine > ways["once"].cosine - 0.002, case.name


def test_a_contraction_over_a_border_of_steps_moves_the_face_without_a_jump(face):
    """Nor does its speed change there by more than three times what it does where a muscle of the smile is alone."""
    smile, pucker = "zygomaticus_major", "orbicularis_oris_pucker"
    sweeps = {
        "alone": lambda level: {smile: level},
        "smile": lambda level: {smile: level, pucker: 1.0},
        "pucker": lambda level: {smile: 1.0, pucker: level},
    }
    kinks = {}
    for name, at in sweeps.items():
        before, border, after = (
            deformer_of(face).at(FacePose.of(**at(level))).vertices.astype(np.float64) for level in (0.59, 0.6, 0.61)
        )
        assert np.linalg.norm(after - before, axis=1).max() < 5e-4, name
        kinks[name] = np.linalg.norm(after - 2 * border + before, axis=1).max()
    assert 0.0 < max(kinks["smile"], kinks["pucker"]) < 3.0 * kinks["alone"]


def test_the_table_of_the_documents_is_this_one():
    """Its words to the letter, its numbers but for rounding."""
    made = table({name: head_model(name) for name in FACES})
    begin = made.partition("\n")[0]
    text = DOCUMENT.read_text(encoding="utf-8")
    there = text[text.index(begin) :].partition("\n\n")[0]
    number = re.compile(r"\d+\.\d+")
    assert number.sub("#", there) == number.sub("#", made), made
    gaps = [abs(float(a) - float(b)) for a, b in zip(number.findall(there), number.findall(made), strict=True)]
    assert max(gaps) < 0.015, made
