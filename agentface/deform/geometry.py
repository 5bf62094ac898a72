"""What a deformer makes of a pose: :class:`FaceGeometry`, the same for every deformer, of one face or of many."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import NamedTuple

import numpy as np

from agentface.conventions import SIDES, Floats


class FaceArrays(NamedTuple):
    """The arrays of a :class:`FaceGeometry`, in the form that kernels take."""

    vertices: Floats
    normals: Floats
    wrinkles: Floats
    eye_rotations: Floats
    jaw: Floats
    head: Floats
    smooth_normals: Floats
    wrinkle_levels: Floats


@dataclass(slots=True, eq=False)
class FaceGeometry:
    """A face at one instant, in the head's axes and metres; with leading dimensions, as many faces as these have.

    The head's axes are the model's where the head is not turned, and turn with it: ``head`` brings everything, the
    vertices too, to where it stands in the room. Two geometries are equal when all of their numbers are.

    Attributes:
        vertices: ``(..., V, 3)`` float32, the skin, raised by its wrinkles; the neck lies where the head's turn leaves
            it, so that ``head`` brings the collar home.
        normals: ``(..., V, 3)`` float32, unit normals of the skin.
        wrinkles: ``(..., V)`` float32, height of the wrinkles in metres.
        eye_rotations: ``(..., 2, 3, 3)`` float32, left eye then right eye, about their centres.
        jaw: ``(..., 4, 4)`` float32, moves lower teeth and tongue from rest.
        head: ``(..., 4, 4)`` float32, turns the whole head; the other arrays do not contain it.
        smooth_normals: ``(..., V, 3)`` float32, unit normals before the wrinkles rise: pictures add finer ones.
        wrinkle_levels: ``(..., K)`` float32 0..1, how far each train of ``HeadModel.trains`` has risen.
    """

    vertices: Floats
    normals: Floats
    wrinkles: Floats
    eye_rotations: Floats
    jaw: Floats
    head: Floats
    smooth_normals: Floats
    wrinkle_levels: Floats

    @classmethod
    def at_rest(cls, vertices: Floats, normals: Floats, trains: int = 0, batch: tuple[int, ...] = ()) -> FaceGeometry:
        """The neutral face, ``vertices (V, 3)`` and K ``trains``, ``batch`` times, in new arrays."""

        def repeated(row: Floats) -> Floats:
            rows = np.empty((*batch, *row.shape), np.float32)
            rows[...] = row
            return rows

        turn = repeated(np.eye(4, dtype=np.float32))
        return cls(
            repeated(vertices),
            repeated(normals),
            repeated(np.zeros(len(vertices), np.float32)),
            repeated(np.stack([np.eye(3, dtype=np.float32)] * len(SIDES))),
            turn,
            turn.copy(),
            repeated(normals),
            repeated(np.zeros(trains, np.float32)),
        )

    @property
    def batch(self) -> tuple[int, ...]:
        """The leading dimensions; none for one face."""
        return self.jaw.shape[:-2]

    def __len__(self) -> int:
        """The length of the first leading dimension; TypeError for one face."""
        if not self.batch:
            raise TypeError("one face has no length; its geometry has no leading dimension")
        return self.batch[0]

    def __getitem__(self, index: int | slice) -> FaceGeometry:
        """One face of many, or some of them; the arrays are parts of these."""
        if not self.batch:
            raise TypeError("one face cannot be indexed; its geometry has no leading dimension")
        return FaceGeometry(*(array[index] for array in self.arrays()))

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, FaceGeometry):
            return NotImplemented
        return all(map(np.array_equal, self.arrays(), other.arrays()))

    __hash__ = None  # type: ignore[assignment]  # the arrays change

    def arrays(self) -> FaceArrays:
        """The arrays themselves."""
        return FaceArrays(*(getattr(self, field.name) for field in fields(self)))

    def copy(self) -> FaceGeometry:
        """The same numbers in arrays of its own: what a deformer's next step does not overwrite."""
        return FaceGeometry(*(array.copy() for array in self.arrays()))
