""":class:`ExpressionPoses`: the pose that some of VRM's expressions make of a face."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from agentface.arkit.eye_looks import Flags
from agentface.conventions import Floats
from agentface.deform.eyes import eyeballs
from agentface.emotion.inference import Inference
from agentface.emotion.state import EMOTIONS
from agentface.head.model import HeadModel
from agentface.parameters import COUNT, HIGH, LOW, MUSCLES, NEUTRAL, indices_of
from agentface.speech.visemes import viseme_table
from agentface.vrm.expressions import ExpressionTable, Preset, expression_table

_FELT = np.array([(index, row) for row, muscle in enumerate(MUSCLES) for index in indices_of(muscle)])
_LIDS = dict(zip(("left", "right"), indices_of("orbicularis_oculi_palpebralis"), strict=True))
_GAZE = [indices_of(name)[0] for name in ("gaze_yaw", "gaze_pitch")]


class ExpressionPoses:
    """Emotions by the rules, visemes and lids by their own shapes, not by those of an artist.

    Several emotions are one state of the six, as far as it goes; of visemes whose weights exceed 1 together, each has
    its share. All else is added, as avatars add their shapes, within the range of each parameter.

    Args:
        model: whose asymmetry the emotions have, and whose eyes look.
        inference: the rules of the emotions.
        table: the expressions; those of ``rules/vrm.yaml`` when None.
    """

    def __init__(self, model: HeadModel, inference: Inference, table: ExpressionTable | None = None) -> None:
        self.table = expression_table() if table is None else table
        self._inference, self._gains = inference, model.gains
        eyes = eyeballs.prepare(model)
        self._hole = np.array([eyes.yaw_limit, eyes.pitch_limit], np.float32)
        mouth = [viseme_table()[row.viseme].values for row in self.table.values() if row.viseme is not None]
        self._mouth: Flags = np.any([values != 0.0 for values in mouth], axis=0) if mouth else np.zeros(COUNT, np.bool_)

    def pose(self, weights: Mapping[str, float]) -> tuple[Floats, Flags]:
        """``(COUNT,)`` each: the pose that ``weights``, 0..1 by VRM 1.0's names, make, and what it moves.

        What is moved depends on the names alone, so that a weight of 0 holds still what it would move. Raises KeyError
        for another name.
        """
        rows = [(self.table[name], weight) for name, weight in weights.items()]
        values, moves = NEUTRAL.copy(), np.zeros(COUNT, np.bool_)
        self._feel(rows, values, moves)
        self._speak(rows, values, moves)
        for row, weight in rows:
            for eye in row.closes:
                values[_LIDS[eye]] += weight
                moves[_LIDS[eye]] = True
            if row.looks is not None:
                values[_GAZE] += weight * self._hole * row.looks
                moves[_GAZE] |= np.array(row.looks) != 0.0
        return np.clip(values, LOW, HIGH), moves

    def _feel(self, rows: list[tuple[Preset, float]], values: Floats, moves: Flags) -> None:
        felt = [(row.emotions, weight) for row, weight in rows if row.emotions]
        if not felt:
            return
        state = np.zeros((1, len(EMOTIONS)))
        for emotions, weight in felt:
            for emotion, share in emotions.items():
                state[0, EMOTIONS.index(emotion)] += weight * share
        places, muscles = _FELT.T
        values[places] = self._inference.course(np.minimum(state, 1.0))[0][muscles] * self._gains[places]
        moves[places] = True

    def _speak(self, rows: list[tuple[Preset, float]], values: Floats, moves: Flags) -> None:
        said = [(row.viseme, weight) for row, weight in rows if row.viseme is not None]
        if not said:
            return
        mixed = sum(weight * viseme_table()[name].values for name, weight in said)
        values += np.asarray(mixed / max(sum(weight for _, weight in said), 1.0), np.float32)
        moves |= self._mouth
