"""Principal modes: the few movements of which many are made (principal component analysis).

Source: Halko, Martinsson and Tropp, Finding structure with randomness, SIAM Review 53 (2011), algorithm 4.4.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from agentface.conventions import Floats

_BEYOND = 24  # directions more than are asked for
_PASSES = 2
_LEAST = 1e-12  # of the largest variance
_WHOLE = 32767


class ModeSet(NamedTuple):
    """K movements of N points, in the order of what they matter.

    Attributes:
        shapes: ``(K, N, 3)`` int16.
        scales: ``(K,)`` float32 m: mode k moves the points by w ``scales[k]`` ``shapes[k]``, w its weight.
    """

    shapes: npt.NDArray[np.int16]
    scales: Floats

    def moved(self, weights: Floats) -> Floats:
        """``(N, 3)`` float32 m, how far weights ``(K,)`` move the points."""
        along = (weights * self.scales) @ self.shapes.reshape(len(self.shapes), -1).astype(np.float32)
        return along.reshape(self.shapes.shape[1:])


def principal_modes(samples: Floats, count: int, rng: np.random.Generator) -> Floats:
    """``(count, D)`` float32 orthonormal rows: the directions along which ``samples (S, D)`` go farthest from 0.

    Fewer than ``count`` of them where the samples have fewer.
    """
    wanted = min(count, *samples.shape)
    found = samples @ rng.standard_normal((samples.shape[1], min(wanted + _BEYOND, *samples.shape)), np.float32)
    for _ in range(_PASSES):
        across, _ = np.linalg.qr(found)
        found = samples @ (samples.T @ across)
    across, _ = np.linalg.qr(found)
    few = across.T @ samples
    lengths, turned = np.linalg.eigh((few @ few.T).astype(np.float64))
    lengths, turned = lengths[::-1][:wanted], turned[:, ::-1][:, :wanted]
    kept = lengths > _LEAST * max(float(lengths[0]), _LEAST)
    rows = (turned[:, kept] / np.sqrt(lengths[kept])).astype(np.float32).T @ few
    return np.ascontiguousarray(rows)


def stored(rows: Floats, reach: Floats) -> ModeSet:
    """Directions ``(K, 3 N)`` in whole numbers, where the weight 1 goes ``reach (K,)`` m along each."""
    largest = np.maximum(np.abs(rows).max(axis=1), np.finfo(np.float32).tiny)
    shapes = np.rint(rows * (_WHOLE / largest)[:, None]).astype(np.int16)
    return ModeSet(shapes.reshape(len(rows), -1, 3), (reach * largest / _WHOLE).astype(np.float32))
