"""The rules, run by scikit-fuzzy's own control systems, give the same contractions on a thousand random states."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from skfuzzy.control import ControlSystem

from agentface.emotion.inference import Inference
from agentface.emotion.rules import Mode, RuleBase
from agentface.emotion.selector import MODES, mode_weights
from agentface.emotion.sets import rescale
from agentface.emotion.state import EMOTIONS, EmotionState
from agentface.parameters import MUSCLES
from agentface.studies.bench.fuzzy import control_centroids, control_simulation

pytestmark = pytest.mark.untraced

TOLERANCE = 1e-9
SINGLE_STATES, BLEND_STATES = 130, 15


def only(rulebase: RuleBase, mode: Mode) -> Inference:
    """An inference in which nothing but ``mode`` has rules: its contractions are the mode's, by its weight."""
    modes = (kept if kept is mode else Mode(kept.emotions, "", "", {}) for kept in rulebase.modes)
    return Inference(RuleBase(tuple(modes), rulebase.gap))


def distinct(mode: Mode) -> tuple[Mode, dict[str, str]]:
    """The mode with one muscle of those whose rules are the same, and that muscle for each.

    scikit-fuzzy's time grows with the square of the muscles.
    """
    first: dict[bytes, str] = {}
    alike = {muscle: first.setdefault(rules.tobytes(), muscle) for muscle, rules in mode.consequents.items()}
    return replace(mode, consequents={muscle: mode.consequents[muscle] for muscle in first.values()}), alike


def largest_difference(rulebase: RuleBase, mode: Mode, states: list[EmotionState]) -> float:
    inference = only(rulebase, mode)
    reduced, alike = distinct(mode)
    largest = 0.0
    # scikit-fuzzy would work out the order of the rules for every rule that it adds and for every state
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(ControlSystem, "rules", ())
        simulation = control_simulation(reduced)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(ControlSystem, "rules", ordered := list(simulation.ctrl.rules))
        assert len(ordered) == 5 ** len(mode.emotions)
        for state in states:
            weight = mode_weights(state.array, rulebase.gap)[mode.emotions]
            centroids = control_centroids(simulation, reduced, state)
            for muscle, contraction in zip(MUSCLES, inference.contractions(state), strict=True):
                expected = weight * rescale(centroids[alike[muscle]]) if muscle in alike else 0.0
                largest = max(largest, abs(contraction - expected) / weight)
    return largest


@pytest.mark.parametrize("emotion", EMOTIONS)
def test_single_expressions_equal_scikit_fuzzy(rulebase: RuleBase, rng: np.random.Generator, emotion: str):
    states = [EmotionState.of({emotion: level}) for level in (0.0, 1.0, *rng.random(SINGLE_STATES).tolist()) if level]
    assert largest_difference(rulebase, rulebase.mode((emotion,)), states) < TOLERANCE


@pytest.mark.slow
@pytest.mark.parametrize("pair", MODES[len(EMOTIONS) :], ids="+".join)
def test_blends_equal_scikit_fuzzy(rulebase: RuleBase, rng: np.random.Generator, pair: tuple[str, str]):
    states = []
    while len(states) < BLEND_STATES:
        state = EmotionState.of(dict(zip(pair, rng.random(2).tolist(), strict=True)))
        if mode_weights(state.array, rulebase.gap).get(pair, 0.0) > 1e-3:
            states.append(state)
    assert largest_difference(rulebase, rulebase.mode(pair), states) < TOLERANCE
