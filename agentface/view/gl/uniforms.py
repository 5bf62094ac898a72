"""What all programs share in one picture: the uniform block ``Frame`` of ``shaders/frame.glsl``."""

from __future__ import annotations

import numpy as np

from agentface.conventions import Doubles, Floats
from agentface.head.look import Lights
from agentface.view.camera import Camera

_SHADOW_HALF_WIDTH = 0.19
_SHADOW_CENTRE = (0.0, -0.03, 0.0)


def pack_frame(camera: Camera, size: tuple[int, int], head: Floats, lights: Lights) -> bytes:
    """The block in std140: matrices by columns, then vectors."""
    width, height = size
    view = camera.projection(width / height) @ camera.view()
    # pixels a metre at one metre from the camera, for hair thinner than a pixel
    scale = 0.5 * height * float(camera.projection(width / height)[1, 1])
    towards, colours = light_rows(lights)
    blocks = [view.T, shadow_projection(lights).T, np.asarray(head).T, [[*camera.eye, scale]], towards, colours]
    blocks += [[[*lights.sky, 0.0]], [[*lights.ground, 0.0]]]
    return np.concatenate([np.asarray(block, np.float32) for block in blocks]).tobytes()


def light_rows(lights: Lights) -> tuple[Floats, Floats]:
    """``(4, 4)`` each: unit vectors towards the lights, and their colours; the last number of a row is spare."""
    towards, colours = np.zeros((4, 4), np.float32), np.zeros((4, 4), np.float32)
    for i, light in enumerate((lights.key, lights.fill, lights.rim_left, lights.rim_right)):
        towards[i, :3] = unit(light.towards)
        colours[i, :3] = np.multiply(light.colour, light.strength)
    return towards, colours


def pixels_a_metre(camera: Camera, size: tuple[int, int]) -> float:
    """How many pixels a metre at the camera's target is long."""
    width, height = size
    return 0.5 * height * float(camera.projection(width / height)[1, 1]) / camera.distance


def shadow_projection(lights: Lights) -> Doubles:
    """``(4, 4)`` from the scene to the clip space of the key light's depth picture."""
    back = unit(lights.key.towards)
    right = unit(np.cross([0.0, 1.0, 0.0], back))
    matrix = np.eye(4)
    matrix[:3, :3] = np.stack([right, np.cross(back, right), -back]) / _SHADOW_HALF_WIDTH
    matrix[:3, 3] = -matrix[:3, :3] @ _SHADOW_CENTRE
    return matrix


def unit(vector: Doubles | list[float]) -> Doubles:
    """A vector of length one."""
    return np.asarray(vector, np.float64) / np.linalg.norm(vector)
