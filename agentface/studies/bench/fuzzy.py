"""The fuzzy inference beside scikit-fuzzy's control systems of the same rules, interleaved in one run."""

from __future__ import annotations

from statistics import median
from time import perf_counter
from typing import Any

import numpy as np

from agentface.conventions import Doubles
from agentface.emotion.inference import default_inference
from agentface.emotion.rules import Mode
from agentface.emotion.selector import mode_weights
from agentface.emotion.sets import (
    CONTRACTION_CENTRES,
    CONTRACTION_HALF_WIDTH,
    CONTRACTION_SETS,
    INTENSITY_CENTRES,
    INTENSITY_SETS,
    UNIVERSE,
    rescale,
)
from agentface.emotion.state import EmotionState
from agentface.parameters import MUSCLES

_PAIRS = (("anger", "disgust"), ("happiness", "surprise"), ("sadness", "fear"))
_REPEATS = 50


def control_simulation(mode: Mode) -> Any:
    """The rules of ``mode`` as a simulation of ``skfuzzy.control``: an input an emotion, an output a muscle."""
    from skfuzzy import control, trimf

    inputs = [control.Antecedent(INTENSITY_CENTRES, emotion) for emotion in mode.emotions]
    for antecedent in inputs:
        for name, membership in zip(INTENSITY_SETS, np.eye(len(INTENSITY_SETS)), strict=True):
            antecedent[name] = membership
    outputs = {muscle: control.Consequent(UNIVERSE, muscle) for muscle in mode.consequents}
    for consequent in outputs.values():
        for name, centre in zip(CONTRACTION_SETS, CONTRACTION_CENTRES, strict=True):
            consequent[name] = trimf(
                UNIVERSE, [centre - CONTRACTION_HALF_WIDTH, centre, centre + CONTRACTION_HALF_WIDTH]
            )
    rules = []
    for place in np.ndindex((len(INTENSITY_SETS),) * len(inputs)):
        premise = inputs[0][INTENSITY_SETS[place[0]]]
        for antecedent, column in zip(inputs[1:], place[1:], strict=True):
            premise = premise & antecedent[INTENSITY_SETS[column]]
        concluded = {muscle: CONTRACTION_SETS[table[place]] for muscle, table in mode.consequents.items()}
        rules.append(control.Rule(premise, [outputs[muscle][name] for muscle, name in concluded.items()]))
    # With its cache on, cuts of earlier inputs leak into later results.
    return control.ControlSystemSimulation(control.ControlSystem(rules), cache=False)


def control_centroids(simulation: Any, mode: Mode, state: EmotionState) -> dict[str, float]:
    """What scikit-fuzzy computes for ``state``: the centroid of each muscle of ``mode``."""
    for emotion in mode.emotions:
        simulation.input[emotion] = state[emotion]
    simulation.compute()
    return {muscle: float(simulation.output[muscle]) for muscle in mode.consequents}


def run(states: int = 24, seed: int = 0) -> dict[str, Any]:
    """Median times of one inference by both, microseconds, on the same random states of one or two emotions.

    scikit-fuzzy is charged with its control systems alone: the selector is ours, outside its clock.
    """
    inference = default_inference()
    rules = inference.rulebase
    pairs = _PAIRS[:states]
    wanted = {*pairs, *((emotion,) for pair in pairs for emotion in pair)}
    simulations = {emotions: control_simulation(rules.mode(emotions)) for emotions in sorted(wanted)}
    rng = np.random.default_rng(seed)
    inference.contractions({"fear": 0.5})
    ours, theirs, differences = [], [], []
    for number in range(states):
        pair = pairs[number % len(pairs)]
        state = EmotionState.of(dict(zip(pair, rng.uniform(0.05, 1.0, 2).tolist(), strict=True)))
        start = perf_counter()
        for _ in range(_REPEATS):
            contractions = inference.contractions(state)
        ours.append((perf_counter() - start) / _REPEATS)
        weights = mode_weights(state.array, rules.gap)
        start = perf_counter()
        centroids = {mode: control_centroids(simulations[mode], rules.mode(mode), state) for mode in weights}
        theirs.append(perf_counter() - start)
        differences.append(float(np.abs(contractions - _combined(weights, centroids)).max()))
    return {
        "ours_us": median(ours) * 1e6,
        "skfuzzy_us": median(theirs) * 1e6,
        "speedup_ratio": median(slow / fast for slow, fast in zip(theirs, ours, strict=True)),
        "states": states,
        "max_abs_difference": max(differences),
    }


def _combined(weights: dict[tuple[str, ...], float], centroids: dict[tuple[str, ...], dict[str, float]]) -> Doubles:
    total = np.zeros(len(MUSCLES))
    for mode, weight in weights.items():
        for muscle, centroid in centroids[mode].items():
            total[MUSCLES.index(muscle)] += weight * rescale(centroid)
    return total
