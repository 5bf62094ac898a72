""":class:`ShownExpressions`: how much of each of VRM's expressions a face shows."""

from __future__ import annotations

from functools import cache

import numpy as np

from agentface.arkit.eye_looks import EyeLooks
from agentface.conventions import Doubles, Floats, Indices
from agentface.emotion.inference import Inference
from agentface.emotion.state import EMOTIONS
from agentface.head.model import HeadModel
from agentface.motion.channel import Channel
from agentface.motion.mixer import Mixer
from agentface.motion.playing import PerformanceChannel
from agentface.parameters import COUNT, HELD, PARAMETERS, indices_of
from agentface.vrm.expression_poses import ExpressionPoses
from agentface.vrm.expressions import PRESETS, ExpressionTable

_HELD = np.array([indices_of(name)[0] for name in HELD])
_SIGNED = np.array([not PARAMETERS[place].contracts for place in _HELD])
_SEAL = indices_of("lip_seal")[0]
_LEVELS = np.linspace(0.0, 1.0, 21)


class ShownExpressions:
    """Tells the weights of the eighteen presets, in the order of ``PRESETS``.

    What the face was told to feel is known. What else moves it, speech, single muscles, a stream of weights or FAPs, is
    taken for the emotions, visemes and closed lids whose poses come nearest together (non-negative least squares
    over the held parameters): first all of them, of which the emotions become as strong as the rules need them for so
    much, then visemes and lids again beside what the rules make of these emotions. Lips that are sealed say no vowel.
    ``blink`` is what both eyes have in common.

    Args:
        model: the face.
        inference: the rules of the emotions.
        table: the expressions; those of ``rules/vrm.yaml`` when None.
    """

    def __init__(self, model: HeadModel, inference: Inference, table: ExpressionTable | None = None) -> None:
        from scipy.optimize import nnls

        self._nearest = nnls
        poses = ExpressionPoses(model, inference, table)
        table = poses.table
        self._felt = np.array([[table.felt[emotion].get(name, 0.0) for name in PRESETS] for emotion in EMOTIONS])
        said = [name for name in PRESETS if table[name].viseme is not None]
        emotions = [name for name in PRESETS if self._felt[:, PRESETS.index(name)].any()]
        others = [*said, "blinkLeft", "blinkRight"]
        columns = [*emotions, *others]
        self._poses, self._emotions = poses, emotions
        self._felt_places, self._other_places = (
            np.array([PRESETS.index(name) for name in names]) for names in (emotions, others)
        )
        self._said = np.array([PRESETS.index(name) for name in said], np.intp)
        self._basis = np.stack([poses.pose({name: 1.0})[0][_HELD] for name in columns], axis=1).astype(np.float64)
        self._rises = [_rise(poses, name) for name in emotions]
        self._looks = [(PRESETS.index(name), np.array(table[name].looks)) for name in PRESETS if table[name].looks]
        self._eyes = EyeLooks(model)

    def weights(self, values: Floats, channels: Mixer) -> Doubles:
        """``(18,)`` in 0..1 of the pose ``values (COUNT,)``, which ``channels`` have made."""
        felt, heard = _written(channels.emotion)[0], _written(channels.speech)[1]
        left = np.ones(COUNT)
        for channel in channels.values():
            if isinstance(channel, PerformanceChannel) and channel.playing:
                left *= 1.0 - _written(channel)[1]
        told = channels.emotion.intensities @ self._felt
        if felt.any():
            told *= (felt @ left) / felt.sum()
        return self._weights(values, told, felt * left * (1.0 - heard))

    def _weights(self, values: Floats, told: Doubles, felt: Doubles) -> Doubles:
        beside = np.asarray(values, np.float64) - felt
        whole = self._nearest(self._basis, _to_come_near(beside))[0]
        levels = [float(np.interp(part, *rise)) for part, rise in zip(whole, self._rises, strict=False)]
        beside -= self._poses.pose(dict(zip(self._emotions, levels, strict=True)))[0]
        found = told.copy()
        found[self._felt_places] += levels
        found[self._other_places] += self._nearest(self._basis[:, len(levels) :], _to_come_near(beside))[0]
        found[self._said] *= 1.0 - min(max(float(values[_SEAL]), 0.0), 1.0)
        found = np.minimum(found, 1.0)
        both, left, right = (PRESETS.index(name) for name in ("blink", "blinkLeft", "blinkRight"))
        found[both] = min(found[left], found[right])
        found[[left, right]] -= found[both]
        yaw, pitch = self._looked(values)
        for place, way in self._looks:
            found[place] = min(max(yaw * way[0] + pitch * way[1], 0.0), 1.0)
        return found

    def _looked(self, values: Floats) -> tuple[float, float]:
        """The mean of both eyes, to the left and up, as parts of the way to the side of their hole."""
        yaws, pitches = zip(*self._eyes.angles(values), strict=True)
        limits = self._eyes.limits
        return sum(yaws) / len(yaws) / limits[0], sum(pitches) / len(pitches) / limits[1]


def _to_come_near(values: Doubles) -> Doubles:
    """What of a pose ``(COUNT,)`` expressions can make: contractions are not negative."""
    held = values[_HELD]
    return np.where(_SIGNED, held, np.maximum(held, 0.0))


def _rise(poses: ExpressionPoses, name: str) -> tuple[Doubles, Doubles]:
    """How much of an expression's whole pose there is, rising, and the level of it at which that is so."""
    whole = poses.pose({name: 1.0})[0]
    parts = np.array([float(poses.pose({name: level})[0] @ whole) for level in _LEVELS.tolist()])
    parts = np.maximum.accumulate(parts / max(parts[-1], 1e-12))
    last = np.append(np.diff(parts) > 0.0, True)  # of levels that look alike, the highest
    return parts[last], _LEVELS[last]


def _written(channel: Channel) -> Doubles:
    """``(2, COUNT)``: values and weights of what a channel wants now; nothing of what it does not move."""
    places = _places(tuple(channel.names))
    wanted = np.zeros((2, COUNT))
    values, weights = np.zeros(len(places)), np.ones(len(places))
    if channel.write(values, weights) is not False:
        wanted[0, places], wanted[1, places] = values, weights
    return wanted


@cache
def _places(names: tuple[str, ...]) -> Indices:
    return np.array([indices_of(name)[0] for name in names], np.int32)
