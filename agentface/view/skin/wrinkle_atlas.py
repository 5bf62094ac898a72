"""Wrinkles finer than the mesh: an atlas of the face with every train's relief, combined once a frame."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from agentface.conventions import Doubles, Floats
from agentface.errors import InvalidValueError
from agentface.head.model import HeadModel
from agentface.view.skin.wrinkle_patches import SIDE, Patch, Relief, patches

_BELOW, _ABOVE = 0.35, 0.3  # eye separations beyond chin and hairline
_EVEN = 128  # the byte of a smooth skin
_GRAIN = 4.0  # bytes
_BORDER = 40  # texels over which the grain ends


class WrinkleAtlas:
    """The texture ``wrinkle_atlas`` of ``shaders/wrinkles.glsl``.

    ``heights (S, S)`` are those of the frame in metres, ``texels (S, S, 4)`` its bytes, ``height`` the metres between
    which the atlas lies.

    Args:
        towards_key: ``(3,)`` unit vector to the key light, as the face at rest sees it.
        grain: ``(S, S)`` of :func:`skin_grain`.
    """

    def __init__(self, context: Any, model: HeadModel, towards_key: Doubles, grain: Relief) -> None:
        self.height, self.patches = atlas_height(model), atlas_patches(model)
        self._reliefs = [patch.texels(towards_key) for patch in self.patches]
        self.heights = np.zeros((SIDE, SIDE), np.float32)
        self._smooth = np.full((SIDE, SIDE, 4), _EVEN, np.int16)
        self._smooth[..., 3] += grain
        self.texels = self._smooth.astype(np.uint8)
        self._even = _pixels(self.texels.copy())
        self._levels = np.zeros(len(self.patches), np.float32)
        self.texture = context.texture((SIDE, SIDE), 4, self.texels.tobytes())
        self.texture.filter = (context.LINEAR, context.LINEAR)
        self.texture.repeat_x = self.texture.repeat_y = False

    def update(self, levels: Floats) -> bool:
        """Combine the trains at ``levels (K,)`` and upload them; false when nothing has risen.

        Raises InvalidValueError for levels of another number of trains.
        """
        if levels.shape != self._levels.shape:
            raise InvalidValueError("geometry.wrinkle_levels", f"an array of shape {self._levels.shape}", levels.shape)
        if not np.array_equal(levels, self._levels):
            self._combine(levels)
        return bool(levels.any())

    def _combine(self, levels: Floats) -> None:
        pixels, touched = _pixels(self.texels), [slice(SIDE, 0)]
        for patch in (patch for patch, level in zip(self.patches, self._levels, strict=True) if level > 0.0):
            box = patch.rows, patch.columns
            self.heights[box], pixels[box] = 0.0, self._even[box]
            touched.append(patch.rows)
        for patch, relief, level in zip(self.patches, self._reliefs, levels, strict=True):
            if level > 0.0:
                self._raise(patch, relief, level)
                touched.append(patch.rows)
        self._levels[:] = levels
        low, high = min(rows.start for rows in touched), max(rows.stop for rows in touched)
        if low < high:
            self.texture.write(self.texels[low:high], viewport=(0, low, SIDE, high - low))

    def _raise(self, patch: Patch, relief: Relief, level: np.float32) -> None:
        """Let the higher of two trains stand."""
        box = patch.rows, patch.columns
        heights, here, root = level * patch.heights, self.heights[box], np.sqrt(level)
        # in 256ths: whole numbers of two bytes take a quarter of the time of floats, long rows less than fours
        scale = np.array([256 * root, 256 * root, 256 * level, 256 * level], np.int16)
        raised = relief.reshape(len(relief), -1) * np.tile(scale, relief.shape[1])
        raised >>= 8
        raised = raised.reshape(relief.shape) + self._smooth[box]
        np.copyto(_pixels(self.texels)[box], _pixels(raised.astype(np.uint8)), where=heights > here)
        np.maximum(here, heights, out=here)


def _pixels(texels: npt.NDArray[np.uint8]) -> npt.NDArray[np.uint32]:
    """``(h, w)``: the four bytes of each as one number, in the same memory."""
    return texels.view(np.uint32)[..., 0]


def atlas_height(model: HeadModel) -> tuple[float, float]:
    """The heights between which the atlas lies, m."""
    at = model.landmarks
    chin, hairline = float(at["menton"][1]), float(at["hairline_middle"][1])
    return chin - _BELOW * at.eye_separation, hairline + _ABOVE * at.eye_separation


def atlas_patches(model: HeadModel) -> list[Patch]:
    """The wrinkle trains of a face on its atlas."""
    return model.derived("view.wrinkle_patches", lambda face: patches(face, atlas_height(face)))


def skin_grain(rng: np.random.Generator) -> Relief:
    """``(S, S)``: how uneven the skin is; even where the atlas ends."""
    noise = rng.uniform(-1.0, 1.0, (SIDE, SIDE))
    for _ in range(2):
        noise = (0.5 * noise + 0.25 * np.roll(noise, 1, axis=0) + 0.25 * np.roll(noise, -1, axis=0)).T
    inside = np.clip(np.minimum(np.arange(SIDE), np.arange(SIDE)[::-1]) / _BORDER, 0.0, 1.0)
    return np.asarray(np.round(_GRAIN * noise * inside * inside[:, None]), np.int16)
