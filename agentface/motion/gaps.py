"""Times when a stream has no frames: short ones are joined smoothly, in long ones the face lets go."""

from __future__ import annotations

import numpy as np

from agentface.conventions import Doubles, Floats
from agentface.motion.performance import HOLD_S, LET_GO_S

LONG_S = HOLD_S + 2.0 * LET_GO_S
"""A gap that is longer lets go: the last frame holds for ``HOLD_S``, fades in ``LET_GO_S``, and likewise back."""


def bridged(times_s: Doubles, poses: Floats, weights: Floats) -> tuple[Doubles, Floats, Floats]:
    """Times ``(T,)``, poses and weights, each ``(T or 1, COUNT)``, with three more frames in every long gap."""
    gaps = np.flatnonzero(np.diff(times_s) > LONG_S)
    if not len(gaps):
        return times_s, poses, weights
    before, after = times_s[gaps], times_s[gaps + 1]
    more = np.stack([before + HOLD_S, before + HOLD_S + LET_GO_S, after - LET_GO_S], axis=1)
    places = np.repeat(gaps + 1, 3)
    from_, full = np.stack([gaps, gaps, gaps + 1], axis=1).ravel(), np.tile([1.0, 0.0, 0.0], len(gaps))
    rows = np.broadcast_to(weights, poses.shape)
    shown = rows[from_] * full[:, None].astype(np.float32)
    return (
        np.insert(times_s, places, more.ravel()),
        np.insert(poses, places, poses[from_], axis=0),
        np.insert(rows, places, shown, axis=0),
    )
