"""What a deformer makes of a pose: :class:`FaceGeometry`, the same for every deformer."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from agentface.conventions import SIDES, Floats


@dataclass(slots=True)
class FaceGeometry:
    """A face at one instant, in the model's axes and metres.

    Attributes:
        vertices: ``(V, 3)`` float32, the skin, raised by its wrinkles.
        normals: ``(V, 3)`` float32, unit normals of the skin.
        wrinkles: ``(V,)`` float32, height of the wrinkles in metres.
        eye_rotations: ``(2, 3, 3)`` float32, left eye then right eye, about their centres.
        jaw: ``(4, 4)`` float32, moves lower teeth and tongue from rest.
        head: ``(4, 4)`` float32, turns the whole head, neck included; the vertices do not contain it.
        smooth_normals: ``(V, 3)`` float32, unit normals before the wrinkles rise: a picture adds finer ones itself.
        wrinkle_levels: ``(K,)`` float32 0..1, how far each train of ``HeadModel.trains`` has risen.
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
    def at_rest(cls, vertices: Floats, normals: Floats, trains: int = 0) -> FaceGeometry:
        """The geometry of the neutral face, which has K ``trains``; the arrays are copied."""
        return cls(
            vertices.copy(),
            normals.copy(),
            np.zeros(len(vertices), np.float32),
            np.stack([np.eye(3, dtype=np.float32)] * len(SIDES)),
            np.eye(4, dtype=np.float32),
            np.eye(4, dtype=np.float32),
            normals.copy(),
            np.zeros(trains, np.float32),
        )
