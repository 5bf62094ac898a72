"""What a deformer makes of a pose: :class:`FaceGeometry`, the same for every deformer, of one face or of many."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import NamedTuple

import numpy as np

from agentface.conventions import SIDES, Floats
from agentface.head.model import HeadModel


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
    tongue: Floats
    pupils: Floats
    eye_thrust: Floats
    shoulders: Floats


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
        jaw: ``(..., 4, 4)`` float32, moves lower teeth and tongue.
        head: ``(..., 4, 4)`` float32, turns the whole head; the other arrays do not contain it.
        smooth_normals: ``(..., V, 3)`` float32, unit normals before the wrinkles rise: pictures add finer ones.
        wrinkle_levels: ``(..., K)`` float32 0..1, how far each train of ``HeadModel.trains`` has risen.
        tongue: ``(..., T, 3)`` float32 m, the vertices of the tongue before ``jaw`` moves them.
        pupils: ``(..., 2)`` float32, the diameters of the left and the right pupil over those at rest.
        eye_thrust: ``(..., 2)`` float32 m, how far each eyeball, with its centre, stands forward of where it rests.
        shoulders: ``(..., 4, 4)`` float32, moves what is below the neck, in the room: a breath lifts it.
    """

    vertices: Floats
    normals: Floats
    wrinkles: Floats
    eye_rotations: Floats
    jaw: Floats
    head: Floats
    smooth_normals: Floats
    wrinkle_levels: Floats
    tongue: Floats
    pupils: Floats
    eye_thrust: Floats
    shoulders: Floats

    @classmethod
    def at_rest(cls, model: HeadModel, *, normals: Floats | None = None, batch: tuple[int, ...] = ()) -> FaceGeometry:
        """The neutral face, ``batch`` times, in new arrays; with its own normals, where none ``(V, 3)`` are given."""

        def repeated(row: Floats) -> Floats:
            rows = np.empty((*batch, *row.shape), np.float32)
            rows[...] = row
            return rows

        count, facing = len(model.vertices), model.normals if normals is None else normals
        turn = np.eye(4, dtype=np.float32)
        return cls(
            vertices=repeated(model.vertices),
            normals=repeated(facing),
            wrinkles=repeated(np.zeros(count, np.float32)),
            eye_rotations=repeated(np.stack([np.eye(3, dtype=np.float32)] * len(SIDES))),
            jaw=repeated(turn),
            head=repeated(turn),
            smooth_normals=repeated(facing),
            wrinkle_levels=repeated(np.zeros(len(model.trains), np.float32)),
            tongue=repeated(model.parts["tongue"].attributes["POSITION"]),
            pupils=repeated(np.ones(len(SIDES), np.float32)),
            eye_thrust=repeated(np.zeros(len(SIDES), np.float32)),
            shoulders=repeated(turn),
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
