"""What a file holds, as a performance of one face."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from agentface.arkit.stream import ArkitSolver, ArkitStream
from agentface.emotion.inference import default_inference
from agentface.emotion.score import Score
from agentface.errors import DataError, Fault
from agentface.head.model import HeadModel
from agentface.io.performances.fap_performance import performance_of_faps
from agentface.io.performances.kinds import Recording
from agentface.io.performances.unit_stream import ActionUnitStream
from agentface.motion.performance import Performance
from agentface.motion.scored import performance_of_score
from agentface.mpeg4.fap_stream import FapStream


class Performer:
    """Makes performances of recordings; what a kind needs of the face is made when the first of that kind comes.

    Args:
        model: the face.
        arkit: makes what finds poses of ARKit's weights.
    """

    def __init__(self, model: HeadModel, *, arkit: Callable[[HeadModel], ArkitSolver] | None = None) -> None:
        self._model, self._arkit = model, arkit

    def performance(
        self, recording: Recording, where: str | Path, told: Callable[[int], object] = lambda _: None
    ) -> Performance:
        """The performance of a recording of the file ``where``; ``told`` gets the number of frames that are done.

        Raises DataError for a kind that this face cannot show.
        """
        if isinstance(recording, Performance):
            return recording
        if isinstance(recording, ActionUnitStream):
            return recording.performance()
        if isinstance(recording, Score):
            return performance_of_score(recording, default_inference())
        if isinstance(recording, ArkitStream):
            return self.arkit_solver(where).performance(recording)
        return self._of_faps(recording, where, told)

    def arkit_solver(self, where: str | Path) -> ArkitSolver:
        """What finds poses of ARKit's weights, and weights of poses; raises DataError where there is none."""
        if self._arkit is None:
            raise DataError([Fault(Path(where), None, "", "a kind that this version shows", "ARKit's weights")])
        return self._arkit(self._model)

    def _of_faps(self, stream: FapStream, where: str | Path, told: Callable[[int], object]) -> Performance:
        from agentface.mpeg4.fap_player import FapPlayer
        from agentface.mpeg4.fap_solver import FapSolver

        performance, beyond = performance_of_faps(stream, FapPlayer(FapSolver(self._model)), told)
        path, all_frames = Path(where), len(stream)
        notes = tuple(
            Fault(path, None, f"FAP {number}", "what this face can show", f"more, in {frames} of {all_frames} frames")
            for number, frames in beyond.items()
        )
        return Performance(
            performance.times_s,
            performance.poses,
            performance.weights,
            performance.rate_hz,
            name=performance.name,
            notes=notes,
        )
