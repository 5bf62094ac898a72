"""ARKit's weights over time as a performance, and the weights that a performance shows."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from agentface.arkit.shape_solver import ArkitSolution, ShapeSolver
from agentface.arkit.stream import ArkitStream
from agentface.arkit.turns import HEAD, HEAD_ANGLES, angles_of, head_of
from agentface.motion.gaps import bridged
from agentface.motion.performance import Performance
from agentface.parameters import COUNT, NEUTRAL

_Told = Callable[[int], object]


def performance_of_weights(stream: ArkitStream, solver: ShapeSolver, told: _Told = lambda _: None) -> Performance:
    """The poses that show a stream, each sought from the frame before.

    The eyes turn by their weights, the head by its angles where there are any. Where the stream has no frames for
    long, it lets go (:func:`bridged`). ``told`` gets the number of frames that are done.
    """
    poses, moves = np.tile(NEUTRAL, (len(stream), 1)), np.zeros(COUNT, np.bool_)
    found: ArkitSolution | None = None
    for frame, (pose, weights) in enumerate(zip(poses, stream.weights, strict=True)):
        found = solver.solve(weights, previous=found)
        pose[:], moves = found.pose.array, found.moves
        told(frame + 1)
    if stream.angles[:, HEAD_ANGLES].any():
        poses[:, HEAD], moves[HEAD] = head_of(stream.angles), True
    times, poses, moved = bridged(stream.times_s, poses, np.asarray(moves[None], np.float32))
    rate = stream.rate_hz if len(times) == len(stream) else None
    return Performance(times, poses, moved, rate, name=stream.name, notes=stream.notes)


def weights_of_performance(performance: Performance, solver: ShapeSolver, told: _Told = lambda _: None) -> ArkitStream:
    """The weights that a performance shows on the solver's face, at its own times, and the angles of head and eyes."""
    weights, eyes = [], []
    for frame, pose in enumerate(performance.poses):
        weights.append(solver.weights(pose))
        eyes.append(solver.eyes.angles(pose))
        told(frame + 1)
    angles = angles_of(performance.poses, np.array(eyes))
    return ArkitStream(performance.times_s, np.stack(weights), angles, performance.rate_hz, performance.name)
