"""The fuzzy inference compiled: the selector of ``selector`` and the Mamdani step of ``mamdani``, for a whole state."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from agentface.conventions import Doubles, Indices
from agentface.emotion.sets import Sets
from agentface.kernel import kernel


@kernel()
def infer_all(
    states: Doubles,
    weights: Doubles,
    modes: Indices,
    first_row: Indices,
    muscle_of_row: Indices,
    rules: npt.NDArray[np.int8],
    sets: Sets,
    out: Doubles,
) -> None:
    """Write the contraction of every muscle in every state into ``out``.

    Args:
        states: (N, 6) float64 in 0..1.
        weights: (N, 6, 6), the weight of the mode of two emotions, the first of them before the second; on the
            diagonal that of one alone.
        modes: (6, 6) int32: likewise the mode.
        first_row: (modes + 1,) int32: where the rows of each mode begin.
        muscle_of_row: (rows,) int32.
        rules: (rows, 5, 5) int8: the contraction set for each intensity set of the mode's first and second emotion.
        sets: the fuzzy sets.
        out: (N, muscles) float64, overwritten.
    """
    for number in range(len(states)):
        _infer(states[number], weights[number], modes, first_row, muscle_of_row, rules, sets, out[number])


@kernel()
def weigh_all(states: Doubles, gap: float, out: Doubles) -> None:
    """Write the weights of the modes of ``states (N, 6)`` into ``out (N, 6, 6)``; ``gap`` is the selector's."""
    out[:] = 0.0
    for number in range(len(states)):
        _weigh(states[number], gap, out[number])


@kernel()
def _infer(
    intensities: Doubles,
    weights: Doubles,
    modes: Indices,
    first_row: Indices,
    muscle_of_row: Indices,
    rules: npt.NDArray[np.int8],
    sets: Sets,
    out: Doubles,
) -> None:
    out[:] = 0.0
    count = len(intensities)
    known_cuts, known = np.empty((len(out), len(sets.contraction_centres))), np.empty(len(out))
    cuts = np.empty(len(sets.contraction_centres))
    for first in range(count):
        for second in range(first, count):
            weight = weights[first, second]
            if weight > 0.0:
                strengths = _strengths(intensities[first], intensities[second], first == second, sets)
                mode = modes[first, second]
                count_known = 0
                for row in range(first_row[mode], first_row[mode + 1]):
                    _cut(strengths, rules[row], cuts)
                    place = _find(known_cuts, count_known, cuts)
                    if place == count_known:
                        known_cuts[place], known[place] = cuts, _contract(cuts, sets)
                        count_known += 1
                    out[muscle_of_row[row]] += weight * known[place]
    for muscle in range(len(out)):
        out[muscle] = min(1.0, out[muscle])


@kernel()
def _weigh(intensities: Doubles, gap: float, weights: Doubles) -> None:
    top = intensities.max()
    if top <= 0.0:
        return
    count = len(intensities)
    degrees = np.empty(count)
    order = np.empty(count, np.int64)
    for emotion in range(count):
        degrees[emotion] = max(0.0, 1.0 - (top - intensities[emotion]) / min(2.0 * gap, top))
        place = emotion
        while place > 0 and degrees[order[place - 1]] < degrees[emotion]:
            order[place] = order[place - 1]
            place -= 1
        order[place] = emotion
    for size in range(1, count + 1):
        share = degrees[order[size - 1]] - (degrees[order[size]] if size < count else 0.0)
        if size == 1:
            weights[order[0], order[0]] += share
            continue
        for i in range(size):
            for j in range(i):
                low, high = min(order[i], order[j]), max(order[i], order[j])
                weights[low, high] += share / (size * (size - 1) / 2)


@kernel()
def _strengths(first: float, second: float, alone: bool, sets: Sets) -> Doubles:
    count = len(sets.intensity_centres)
    strengths = np.zeros((count, count))
    for i in range(count):
        one = max(0.0, 1.0 - abs(first - sets.intensity_centres[i]) / sets.intensity_half_width)
        for j in range(count):
            two = max(0.0, 1.0 - abs(second - sets.intensity_centres[j]) / sets.intensity_half_width)
            strengths[i, j] = min(one, two)
        if alone:
            strengths[i, :] = 0.0
            strengths[i, 0] = one
    return strengths


@kernel()
def _cut(strengths: Doubles, rules: npt.NDArray[np.int8], cuts: Doubles) -> None:
    cuts[:] = 0.0
    for i in range(strengths.shape[0]):
        for j in range(strengths.shape[1]):
            if strengths[i, j] > cuts[rules[i, j]]:
                cuts[rules[i, j]] = strengths[i, j]


@kernel()
def _find(known: Doubles, count: int, cuts: Doubles) -> int:
    """The place of ``cuts`` among the first rows of ``known``, or their count: most muscles of a mode are cut alike."""
    for place in range(count):
        same = True
        for number in range(len(cuts)):
            same = same and known[place, number] == cuts[number]
        if same:
            return place
    return count


@kernel()
def _contract(cuts: Doubles, sets: Sets) -> float:
    low, high = sets.contraction_centres[0], sets.contraction_centres[-1]
    return float(min(1.0, max(0.0, (_centroid(cuts, sets) - low) / (high - low))))


@kernel()
def _centroid(cuts: Doubles, sets: Sets) -> float:
    centres, half_width, universe = sets.contraction_centres, sets.contraction_half_width, sets.universe
    extra = np.empty(2 * len(centres))
    active = np.empty(len(centres), np.int64)
    active_count = 0
    for number in range(len(centres)):
        if cuts[number] > 0.0:
            reach = half_width * (1.0 - cuts[number])
            extra[2 * active_count] = centres[number] - reach
            extra[2 * active_count + 1] = centres[number] + reach
            active[active_count] = number
            active_count += 1
    if active_count == 1:
        return float(centres[active[0]])
    found = np.sort(extra[: 2 * active_count])
    begin, end = centres[active[0]] - half_width, centres[active[active_count - 1]] + half_width
    grid, cut = 0, 0
    while grid + 1 < len(universe) and universe[grid + 1] <= begin:
        grid += 1
    area, moment, left, low = 0.0, 0.0, universe[grid], 0.0
    while (grid < len(universe) and left < end) or cut < len(found):
        if cut == len(found) or (grid < len(universe) and universe[grid] <= found[cut]):
            right = universe[grid]
            grid += 1
        else:
            right = found[cut]
            cut += 1
        high = 0.0
        for place in range(active_count):
            number = active[place]
            member = 1.0 - abs(right - centres[number]) / half_width
            high = max(high, min(cuts[number], member))
        width = right - left
        area += width * (low + high) / 2
        moment += width * (low * (2 * left + right) + high * (left + 2 * right)) / 6
        left, low = right, high
    return moment / area
