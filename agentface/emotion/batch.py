"""The fuzzy inference for many states at once in numpy: what runs where nothing is compiled, and the kernel's twin."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from agentface.conventions import Doubles, Indices
from agentface.emotion.mamdani import rule_strengths
from agentface.emotion.selector import mode_weights
from agentface.emotion.sets import Sets
from agentface.emotion.state import EMOTIONS


def weigh_in_numpy(states: Doubles, gap: float, out: Doubles) -> None:
    """As ``weigh_all`` of ``inference_compiled``, with the same arguments."""
    out[:] = 0.0
    for state, weights in zip(states, out, strict=True):
        for emotions, weight in mode_weights(state, gap).items():
            weights[EMOTIONS.index(emotions[0]), EMOTIONS.index(emotions[-1])] = weight


def infer_in_numpy(
    states: Doubles,
    weights: Doubles,
    modes: Indices,
    first_row: Indices,
    muscle_of_row: Indices,
    rules: npt.NDArray[np.int8],
    sets: Sets,
    out: Doubles,
) -> None:
    """As ``infer_all`` of ``inference_compiled``, with the same arguments."""
    out[:] = 0.0
    numbers, firsts, seconds = np.nonzero(weights)
    called = modes[firsts, seconds]
    counts = first_row[called + 1] - first_row[called]
    rows = np.array([row for mode in called for row in range(first_row[mode], first_row[mode + 1])], np.intp)
    fired = np.zeros((len(called), *rules.shape[1:]))
    for strengths, number, first, second in zip(fired, numbers, firsts, seconds, strict=True):
        alone = first == second
        found = rule_strengths(states[number, [first] if alone else [first, second]])
        strengths[:, : 1 if alone else None] = found.reshape(len(found), -1)
    asked = _contractions(_cuts(np.repeat(fired, counts, axis=0), rules[rows]), sets)
    asked *= np.repeat(weights[numbers, firsts, seconds], counts)
    np.add.at(out, (np.repeat(numbers, counts), muscle_of_row[rows]), asked)
    np.minimum(out, 1.0, out=out)


def _cuts(strengths: Doubles, rules: npt.NDArray[np.int8]) -> Doubles:
    """The height at which each contraction set is cut, ``(R, 5)``, by rules, ``(R, 5, 5)``, that fire so strongly."""
    sets = np.arange(rules.shape[-1])[:, None, None]
    cuts: Doubles = np.where(rules[:, None] == sets, strengths[:, None], 0.0).max(axis=(2, 3))
    return cuts


def _contractions(cuts: Doubles, sets: Sets) -> Doubles:
    """The contractions ``(R,)`` in 0..1: centroids of the joined, clipped sets, stretched to the whole range."""
    centres, half_width = sets.contraction_centres, sets.contraction_half_width
    reach = half_width * (1.0 - cuts)
    ends = [np.where(cuts > 0.0, centres + side * reach, centres[0]) for side in (-1.0, 1.0)]
    points = np.sort(np.concatenate([np.broadcast_to(sets.universe, (len(cuts), len(sets.universe))), *ends], axis=1))
    memberships = 1.0 - np.abs(points[:, None, :] - centres[:, None]) / half_width
    heights = np.minimum(cuts[:, :, None], memberships).clip(0.0).max(axis=1)
    left, right, low, high = points[:, :-1], points[:, 1:], heights[:, :-1], heights[:, 1:]
    width = right - left
    area = (width * (low + high) / 2.0).sum(axis=1)
    moment = (width * (low * (2.0 * left + right) + high * (left + 2.0 * right)) / 6.0).sum(axis=1)
    alone = (cuts > 0.0).sum(axis=1) == 1
    centroid = np.where(alone, centres[cuts.argmax(axis=1)], moment / area)  # exact: rounding must not move a rest
    contractions: Doubles = ((centroid - centres[0]) / (centres[-1] - centres[0])).clip(0.0, 1.0)
    return contractions
