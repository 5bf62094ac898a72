""":class:`Tracked`, a frame of a tracker in the terms of avatars, and the channel that shows a stream of them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from agentface.conventions import Floats, check_fraction, check_range
from agentface.emotion.inference import Inference
from agentface.errors import UnknownNameError
from agentface.head.arkit import ARKIT_SHAPES
from agentface.head.model import HeadModel
from agentface.motion.stream import STREAM_FADE_S, StreamChannel
from agentface.parameters import COUNT, HIGH, LOW, NEUTRAL, PARAMETERS
from agentface.vrm.expression_poses import ExpressionPoses
from agentface.vrm.expressions import PRESETS

if TYPE_CHECKING:
    from agentface.arkit.shape_solver import ArkitSolution, ShapeSolver

TRACKER_CHANNEL = "tracker"
_HEAD, _GAZE = ([known.index for known in PARAMETERS if known.kind == kind] for kind in ("head", "gaze"))


@dataclass(frozen=True, slots=True)
class Tracked:
    """One frame, whole: what it does not name is let go of.

    Attributes:
        weights: pairs of one of ARKit's 52 names and a weight 0..1.
        expressions: pairs of the name of one of VRM 1.0's presets and a weight 0..1.
        head: yaw, pitch and roll in radians as in a pose; None where the head is left to others.
        gaze: yaw, pitch and vergence; None where the eyes are, or where weights and expressions say it.

    Raises UnknownNameError or InvalidValueError.
    """

    weights: tuple[tuple[str, float], ...] = ()
    expressions: tuple[tuple[str, float], ...] = ()
    head: tuple[float, float, float] | None = None
    gaze: tuple[float, float, float] | None = None

    def __post_init__(self) -> None:
        for kind, pairs, known in (
            ("ARKit weight", self.weights, ARKIT_SHAPES),
            ("VRM expression", self.expressions, PRESETS),
        ):
            for name, weight in pairs:
                if name not in known:
                    raise UnknownNameError(kind, name, known)
                check_fraction(name, weight)
        for angles, places in ((self.head, _HEAD), (self.gaze, _GAZE)):
            for angle, place in zip(angles or (), places, strict=angles is not None):
                check_range(PARAMETERS[place].name, angle, PARAMETERS[place].low, PARAMETERS[place].high)


class TrackerChannel(StreamChannel):
    """Frames of a tracker; the solver of ARKit's weights is made with the first that has any."""

    def __init__(self, inference: Inference) -> None:
        super().__init__()
        self._inference = inference
        self._frame = Tracked()
        self._poses: ExpressionPoses | None = None
        self._solver: ShapeSolver | None = None
        self._found: ArkitSolution | None = None

    def warm_up(self, model: HeadModel) -> None:
        """Make now what the first frame needs, which takes seconds the first time on a machine."""
        self._solver_of(model).solve_named({ARKIT_SHAPES[0]: 0.0})
        self._poses_of(model).pose({})

    def change(self, model: HeadModel, frame: Tracked, fade: float = STREAM_FADE_S) -> None:
        """Show a frame."""
        self._frame = frame
        self.arrived(model, fade)

    def solved(self, model: HeadModel) -> tuple[Floats, Floats]:
        """The frame that waits, as values and weights ``(COUNT,)``, on a face."""
        frame, values, moves = self._frame, NEUTRAL.copy(), np.zeros(COUNT, np.bool_)
        if frame.weights:
            self._found = self._solver_of(model).solve_named(dict(frame.weights), self._found)
            moves |= self._found.moves
            values[moves] = self._found.pose.array[moves]
        if frame.expressions:
            posed, moved = self._poses_of(model).pose(dict(frame.expressions))
            values = np.clip(values + posed, LOW, HIGH)
            moves |= moved
        for angles, places in ((frame.head, _HEAD), (frame.gaze, _GAZE)):
            if angles is not None:
                values[places], moves[places] = angles, True
        return values, moves.astype(np.float32)

    def _solver_of(self, model: HeadModel) -> ShapeSolver:
        if self._solver is None:
            from agentface.arkit.shape_solver import ShapeSolver

            self._solver = ShapeSolver(model)
        return self._solver

    def _poses_of(self, model: HeadModel) -> ExpressionPoses:
        if self._poses is None:
            self._poses = ExpressionPoses(model, self._inference)
        return self._poses
