"""What a file holds, as a performance of one face."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from agentface.arkit.stream import ArkitStream
from agentface.bml.block import Block
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
    """

    def __init__(self, model: HeadModel) -> None:
        self._model = model

    def performance(
        self, recording: Recording, where: str | Path, told: Callable[[int], object] = lambda _: None
    ) -> Performance:
        """The performance of a recording of the file ``where``; ``told`` gets the number of frames that are done.

        Raises DataError for BML, whose speeches have no frames before they are spoken.
        """
        if isinstance(recording, Performance):
            return recording
        if isinstance(recording, ActionUnitStream):
            return recording.performance()
        if isinstance(recording, Score):
            return performance_of_score(recording, default_inference())
        if isinstance(recording, ArkitStream):
            return self._of_weights(recording, told)
        if isinstance(recording, Block):
            hint = "agentface play films it, and measures it in FAPs"
            raise DataError([Fault(Path(where), None, "", "a file that has frames, or emotions in time", "BML", hint)])
        return self._of_faps(recording, where, told)

    def arkit_stream(self, performance: Performance, told: Callable[[int], object] = lambda _: None) -> ArkitStream:
        """The weights of ARKit that a performance shows on this face; ``told`` as above."""
        from agentface.arkit.performances import weights_of_performance
        from agentface.arkit.shape_solver import ShapeSolver

        return weights_of_performance(performance, ShapeSolver(self._model), told)

    def _of_weights(self, stream: ArkitStream, told: Callable[[int], object]) -> Performance:
        from agentface.arkit.performances import performance_of_weights
        from agentface.arkit.shape_solver import ShapeSolver

        return performance_of_weights(stream, ShapeSolver(self._model), told)

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
