"""From six intensities to muscle contractions, by the rules."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import cache

import numpy as np

from agentface.cache import prepared, stamp_of
from agentface.conventions import Doubles, read_only
from agentface.emotion.batch import infer_in_numpy, weigh_in_numpy
from agentface.emotion.explanation import Explanation, explain
from agentface.emotion.rules import RuleBase
from agentface.emotion.selector import MODES
from agentface.emotion.sets import INTENSITY_SETS, SETS
from agentface.emotion.state import EMOTIONS, EmotionState
from agentface.kernel import can_compile
from agentface.parameters import COUNT, MUSCLES, FacePose, indices_of
from agentface.resources import data_folder

State = EmotionState | Mapping[str, float]


class Inference:
    """Mamdani inference over a rule base, compiled; with ``compiled=False`` in numpy: ready at once, slow a call.

    Deterministic, without memory, safe to share between threads. Where a state is asked for, a mapping from
    emotion names to intensities will do; a wrong one raises UnknownNameError or InvalidValueError.
    """

    def __init__(self, rulebase: RuleBase, *, compiled: bool = True) -> None:
        self.rulebase = rulebase
        self._places = np.array([(index, row) for row, muscle in enumerate(MUSCLES) for index in indices_of(muscle)])
        self._weigh: Callable[..., None] = weigh_in_numpy
        self._infer: Callable[..., None] = infer_in_numpy
        if compiled and can_compile():
            from agentface.emotion.inference_compiled import infer_all, weigh_all

            self._weigh, self._infer = weigh_all, infer_all
        modes = rulebase.modes
        rows = [(muscle, rules) for mode in modes for muscle, rules in mode.consequents.items()]
        first_row = np.cumsum([0, *(len(mode.consequents) for mode in modes)], dtype=np.int32)
        muscle_of_row = np.array([MUSCLES.index(muscle) for muscle, _ in rows], np.int32)
        tables = np.zeros((len(rows), len(INTENSITY_SETS), len(INTENSITY_SETS)), np.int8)
        for row, (_, rules) in enumerate(rows):
            tables[row] = rules if rules.ndim == 2 else rules[:, None]
        mode_of = np.zeros((len(EMOTIONS), len(EMOTIONS)), np.int32)
        for number, emotions in enumerate(MODES):
            mode_of[EMOTIONS.index(emotions[0]), EMOTIONS.index(emotions[-1])] = number
        self._rules = (mode_of, first_row, muscle_of_row, tables)

    @property
    def compiled(self) -> bool:
        """Whether a kernel does it."""
        return self._infer is not infer_in_numpy

    def contractions(self, state: State) -> Doubles:
        """The contraction of each muscle, ``(len(MUSCLES),)`` float64 in 0..1, in the order of ``MUSCLES``."""
        contractions: Doubles = self.course(EmotionState.of(state).array[None])[0]
        return contractions

    def weights(self, states: Doubles) -> Doubles:
        """How much of each mode the states ``(N, 6)`` show, ``(N, 6, 6)``.

        That of two emotions stands at the first and the second, that of one alone on the diagonal.
        """
        out = np.empty((len(states), len(EMOTIONS), len(EMOTIONS)))
        self._weigh(read_only(states), self.rulebase.gap, out)
        return out

    def course(self, states: Doubles, weights: Doubles | None = None) -> Doubles:
        """The contractions of many states, ``(N, 6)`` in 0..1 in the order of ``EMOTIONS``: ``(N, len(MUSCLES))``.

        With ``weights`` in place of those that :meth:`weights` gives.
        """
        out = np.empty((len(states), len(MUSCLES)))
        weights = self.weights(states) if weights is None else weights
        self._infer(read_only(states), weights, *self._rules, SETS, out)
        return out

    def pose(self, state: State) -> FacePose:
        """The face that shows a state: both sides alike, gaze and head straight."""
        values = np.zeros(COUNT, np.float32)
        values[self._places[:, 0]] = self.contractions(state)[self._places[:, 1]]
        return FacePose(values)

    def explain(self, state: State) -> Explanation:
        """Which modes and rules made the contractions of a state."""
        return explain(self.rulebase, EmotionState.of(state))


@cache
def default_inference(*, compiled: bool = True) -> Inference:
    """The inference over the rules that come with agentface, made once; ``compiled`` as for :class:`Inference`."""
    rules = data_folder("rules")
    return Inference(prepared(stamp_of(sorted(rules.iterdir())), "rules", RuleBase.load), compiled=compiled)
