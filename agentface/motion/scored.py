"""A score of emotions as a performance: what a face without asymmetry would show of it."""

from __future__ import annotations

import numpy as np

from agentface.conventions import check_rate
from agentface.emotion.score import Change, Score
from agentface.motion.course import EmotionRules
from agentface.motion.emotion import EmotionChannel
from agentface.motion.performance import Performance
from agentface.parameters import COUNT, NEUTRAL, indices_of


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
