"""A score of emotions as a performance, what a face without asymmetry would show of it; and back."""

from __future__ import annotations

import numpy as np

from agentface.conventions import check_rate
from agentface.emotion.inference import Inference
from agentface.emotion.recognition import states_shown
from agentface.emotion.score import Change, Score
from agentface.motion.course import EmotionRules
from agentface.motion.emotion import EmotionChannel
from agentface.motion.performance import Performance
from agentface.parameters import COUNT, MUSCLES, NEUTRAL, indices_of


def performance_of_score(score: Score, rules: EmotionRules, rate_hz: float = 60.0) -> Performance:
    """The contractions of a score, ``rate_hz`` times a second, until the face is neutral again."""
    rate = check_rate("rate_hz", rate_hz)
    channel = EmotionChannel(rules)
    places = [indices_of(name)[0] for name in channel.names]
    frames = int(np.ceil(score.length_s * rate - 1e-6)) + 1
    poses = np.tile(NEUTRAL, (frames, 1))
    values, weights = np.zeros(len(places)), np.ones(len(places))
    told: Change | None = None
    for frame, pose in enumerate(poses):
        if frame:
            channel.advance(1.0 / rate)
        change = score.change(frame / rate)
        if change is not told:
            told = change
            channel.change(change.state, change.fade_s, None)
        values[:] = 0.0
        channel.write(values, weights)
        pose[places] = values
    moved = np.zeros((1, COUNT), np.float32)
    moved[:, places] = poses[:, places].any(axis=0)
    return Performance.regular(rate, poses, moved, notes=score.notes)


def score_of_performance(performance: Performance, rules: Inference, rate_hz: float = 25.0) -> Score:
    """The emotions, of one or two at a time, that a performance shows ``rate_hz`` times a second.

    What emotions cannot show, such as one side alone or where the eyes look, is not in it; two sides count by their
    mean, muscles that the performance does not move not at all.
    """
    rate = check_rate("rate_hz", rate_hz)
    frames = int(np.floor(performance.duration_s * rate + 1e-6)) + 1
    values, weights = performance.sample(np.arange(frames) / rate)
    shown = values * weights
    places = [list(indices_of(name)) for name in MUSCLES]
    contractions = np.column_stack([shown[:, place].mean(axis=1) for place in places])
    moved = np.array([bool(weights[:, place].any()) for place in places])
    return Score.sampled(np.round(states_shown(rules, contractions, moved), 3), rate)
