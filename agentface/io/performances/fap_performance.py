"""A stream of FAPs as a performance: frame by frame, each pose sought from the one before."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

import numpy as np
import numpy.typing as npt

from agentface.conventions import Floats
from agentface.motion.performance import Performance
from agentface.mpeg4.fap_solver import FapSolution
from agentface.mpeg4.fap_stream import EXPRESSION, FapStream
from agentface.parameters import COUNT, NEUTRAL


class FramePlayer(Protocol):
    """What makes poses of frames: ``agentface.mpeg4.fap_player.FapPlayer``."""

    def play(
        self,
        faps: npt.ArrayLike,
        mask: npt.ArrayLike,
        viseme: tuple[int, ...],
        expression: tuple[int, ...],
        previous: FapSolution | None,
    ) -> FapSolution:
        """The pose of a frame."""


def performance_of_faps(
    stream: FapStream, player: FramePlayer, told: Callable[[int], object] = lambda _: None
) -> tuple[Performance, dict[int, int]]:
    """The poses that show a stream, at its own times.

    What a frame's FAPs do not determine, it leaves to others: its weight there is 0. Visemes and expressions
    determine, in all frames that have some, every parameter that they move in one of them.

    Args:
        stream: what is shown.
        player: new, for it keeps what a stream defines.
        told: called with the number of frames that are done.

    Returns the performance, and how many frames ask more than the face can show, by the number of the FAP.
    """
    poses, weights = np.tile(NEUTRAL, (len(stream), 1)), np.zeros((len(stream), COUNT), np.float32)
    beyond: dict[int, int] = {}
    found: FapSolution | None = None
    high = np.asarray(stream.mask[:, : EXPRESSION + 1].any(axis=1))
    visemes, expressions = stream.visemes.tolist(), stream.expressions.tolist()
    for frame, mask in enumerate(stream.mask):
        found = player.play(stream.values[frame], mask, tuple(visemes[frame]), tuple(expressions[frame]), found)
        weights[frame][found.moves] = 1.0
        moved = np.logical_or(found.moves, high[frame])
        poses[frame][moved] = found.pose.array[moved]
        for number in found.out_of_reach:
            beyond[number] = beyond.get(number, 0) + 1
        told(frame + 1)
    by_high = np.asarray((poses[high] != NEUTRAL).any(axis=0))
    weights[np.ix_(high, by_high)] = 1.0
    return Performance.regular(stream.rate, poses, _shortest(weights), name=stream.name), dict(sorted(beyond.items()))


def _shortest(weights: Floats) -> Floats:
    """One row where all are the same."""
    return weights[:1] if (weights == weights[0]).all() else weights
