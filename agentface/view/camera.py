"""Where a face is looked at from: perspective cameras, named views, orbiting."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from agentface.conventions import Doubles, check_finite, check_range
from agentface.errors import InvalidValueError, UnknownNameError
from agentface.head.model import HeadModel

VIEWS: dict[str, tuple[float, float]] = {"front": (0.0, 2.0), "three-quarter": (35.0, 3.0), "profile": (88.0, 2.0)}
"""Name of a view: yaw towards the person's left and pitch upwards, in degrees."""

_FIELD_OF_VIEW = np.radians(18.0)
_HEAD_IN_PICTURE, _DEPTH_IN_PICTURE = 0.76, 0.95
"""Of the picture's height, the head from the chin to the hair; of a narrow one's width, from its front to its back."""
_CROWN_OVER_MENTON = 1.06
_NARROWEST = 0.80
_HIGHEST = np.radians(85.0)


@dataclass(frozen=True, slots=True)
class Camera:
    """A perspective camera; +Y is up.

    Attributes:
        eye: where it stands, metres.
        target: the point in the middle of the picture, metres.
        field_of_view: the vertical opening in radians; pictures narrower than 4:5 keep the width instead.
    """

    eye: tuple[float, float, float]
    target: tuple[float, float, float]
    field_of_view: float = _FIELD_OF_VIEW

    def __post_init__(self) -> None:
        for name in ("eye", "target"):
            point = getattr(self, name)
            if len(point) != 3:
                raise InvalidValueError(f"Camera.{name}", "three numbers in metres", point)
            object.__setattr__(self, name, tuple(check_finite(f"Camera.{name}", value) for value in point))
        check_range("Camera.field_of_view", self.field_of_view, 1e-3, 3.0)
        if np.linalg.norm(np.cross(self._arm, [0.0, 1.0, 0.0])) < 1e-9:
            raise InvalidValueError(
                "Camera.eye", "a place that is not the target, nor right above or below it", self.eye
            )

    @property
    def _arm(self) -> Doubles:
        return np.subtract(self.eye, self.target)

    @property
    def distance(self) -> float:
        """From the eye to the target, metres."""
        return float(np.linalg.norm(self._arm))

    def view(self) -> Doubles:
        """``(4, 4)`` from the model's axes to the camera's (+X right, +Y up, looking along -Z)."""
        back = self._arm / self.distance
        right = np.cross([0.0, 1.0, 0.0], back)
        right /= np.linalg.norm(right)
        matrix = np.eye(4)
        matrix[:3, :3] = right, np.cross(back, right), back
        matrix[:3, 3] = -matrix[:3, :3] @ self.eye
        return matrix

    def projection(self, aspect: float) -> Doubles:
        """``(4, 4)`` from the camera's axes to clip space, for pictures of width over height ``aspect``."""
        half = np.tan(0.5 * self.field_of_view) * max(1.0, _NARROWEST / aspect)
        near, far = 0.2 * self.distance, self.distance + 2.0
        depth = far - near
        return np.array([
            [1.0 / (half * aspect), 0.0, 0.0, 0.0],
            [0.0, 1.0 / half, 0.0, 0.0],
            [0.0, 0.0, -(far + near) / depth, -2.0 * far * near / depth],
            [0.0, 0.0, -1.0, 0.0],
        ])  # fmt: skip

    def orbited(self, yaw: float, pitch: float) -> Camera:
        """The camera moved round its target: ``yaw`` to the person's left, ``pitch`` upwards, radians."""
        x, y, z = self._arm
        heading = np.arctan2(x, z) + check_finite("yaw", yaw)
        height = np.clip(np.arctan2(y, np.hypot(x, z)) + check_finite("pitch", pitch), -_HIGHEST, _HIGHEST)
        return replace(self, eye=_from(self.target, heading, height, self.distance))

    def zoomed(self, factor: float) -> Camera:
        """The camera moved towards its target until things look ``factor`` (0.1..10) times as large."""
        distance = np.clip(self.distance / check_range("factor", factor, 0.1, 10.0), 0.15, 10.0)
        return replace(self, eye=tuple(np.add(self.target, self._arm * (distance / self.distance))))

    def panned(self, right: float, up: float) -> Camera:
        """The camera and its target moved sideways and upwards in the picture, metres."""
        across, upright = self.view()[:2, :3]
        way = check_finite("right", right) * across + check_finite("up", up) * upright
        return replace(self, eye=tuple(np.add(self.eye, way)), target=tuple(np.add(self.target, way)))


def _from(
    target: tuple[float, float, float], heading: float, height: float, distance: float
) -> tuple[float, float, float]:
    flat = np.cos(height)
    arm = distance * np.array([np.sin(heading) * flat, np.sin(height), np.cos(heading) * flat])
    x, y, z = np.add(target, arm)
    return float(x), float(y), float(z)


def named_view(model: HeadModel, name: str) -> Camera:
    """The camera ``front``, ``three-quarter`` or ``profile``: a portrait with the whole head and some of the neck.

    Raises UnknownNameError for another name.
    """
    if name not in VIEWS:
        raise UnknownNameError("view", name, tuple(VIEWS))
    yaw, pitch = np.radians(VIEWS[name])
    crown = float(model.vertices[:, 1].max()) * _CROWN_OVER_MENTON
    chin = float(model.landmarks["menton"][1])
    # the neck below the chin balances the hair above the crown
    middle = 0.5 * (crown + chin) - 0.05 * (crown - chin)
    back, front = float(model.vertices[:, 2].min()), float(model.vertices[:, 2].max())
    half = 0.5 * max((crown - chin) / _HEAD_IN_PICTURE, (front - back) / (_NARROWEST * _DEPTH_IN_PICTURE))
    distance = half / np.tan(0.5 * _FIELD_OF_VIEW)
    target = (0.0, middle, 0.5 * (back + front) + 0.010)
    return Camera(_from(target, yaw, pitch, distance + 0.04), target)
