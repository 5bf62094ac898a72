""":class:`ActionUnitStream`: action units over time, as a program has seen them in a film."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from agentface.conventions import Doubles, Floats
from agentface.errors import Fault
from agentface.facs.coding import intensities_of, parts_of, poses_of
from agentface.motion.gaps import bridged
from agentface.motion.performance import Performance, rate_of
from agentface.parameters import HIGH, LOW, indices_of

HEAD = tuple(indices_of(name)[0] for name in ("head_yaw", "head_pitch", "head_roll"))
GAZE = tuple(indices_of(name)[0] for name in ("gaze_yaw", "gaze_pitch"))


@dataclass(frozen=True, eq=False)
class ActionUnitStream:
    """Intensities of some action units over time, with the head and the eyes where they were seen, too.

    Attributes:
        times_s: ``(T,)`` float64, seconds, increasing, T >= 1.
        units: the numbers of the action units.
        intensities: ``(T, U)`` float32, 0..1.
        head: ``(T, 3)`` float32: yaw, pitch and roll in radians as in ``PARAMETERS``; None where they were not seen.
        gaze: ``(T, 2)`` float32: yaw and pitch of the eyes in the head, likewise.
        name: what its author called it.
        notes: what of the file is left out.
    """

    times_s: Doubles
    units: tuple[int, ...]
    intensities: Floats
    head: Floats | None = None
    gaze: Floats | None = None
    name: str = ""
    notes: tuple[Fault, ...] = ()

    @classmethod
    def of(cls, performance: Performance, units: tuple[int, ...]) -> ActionUnitStream:
        """The action units that a performance shows at its own times."""
        poses = performance.poses
        return cls(
            performance.times_s,
            units,
            intensities_of(units, poses),
            poses[:, HEAD],
            poses[:, GAZE],
            performance.name,
        )

    def performance(self) -> Performance:
        """It moves the muscles of its action units, and head and eyes where they were seen, as far as these turn.

        Where nothing was seen for long, it lets go until something is seen again (:func:`bridged`).
        """
        poses = poses_of(self.units, self.intensities)
        moved = np.asarray(parts_of(self.units).any(axis=0), np.float32)
        for places, angles in ((HEAD, self.head), (GAZE, self.gaze)):
            if angles is not None:
                poses[:, places] = angles
                moved[list(places)] = 1.0
        poses = np.clip(poses, LOW, HIGH)
        times, poses, weights = bridged(self.times_s, poses, moved[None])
        return Performance(times, poses, weights, rate_of(times), name=self.name, notes=self.notes)

    def __len__(self) -> int:
        return len(self.times_s)
