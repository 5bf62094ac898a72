"""Table 1 of Bui, Heylen and Nijholt: what their improvements gain, and ours, in one run on one face."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from agentface.conventions import Doubles, Indices
from agentface.deform.muscles.combine import STEP, Combiner
from agentface.mesh.normals_compiled import write_normals
from agentface.studies.bench import loops, plain
from agentface.studies.bench.timing import interleave

if TYPE_CHECKING:
    from agentface.head.model import HeadModel

PAPER_FPS: dict[str, float] = {"original": 20.5, "cutoff": 30.5, "improved": 35.0}
"""Frames a second in the paper's Table 1: 2480 vertices, a Pentium III of 800 MHz, drawing included."""
WAYS = (*PAPER_FPS, "ours")


class Frames:
    """One face's muscles and normals in the four ways of :data:`WAYS`.

    All compute the same: the muscles' parallel combination in steps of 0.2 with their ``reach``, then the
    area-weighted vertex normals. ``original`` walks over polygons with copies of their vertices, ``cutoff`` looks at
    the region first, ``improved`` shares the vertices and decides by squares (see :mod:`.loops`); these
    are in double precision. ``ours`` is what the deformer runs, in single precision.
    """

    def __init__(self, model: HeadModel) -> None:
        muscles, rest = model.muscles, model.vertices
        self.triangles = model.triangles
        self._combiner = Combiner(rest, muscles)
        self._constants, self._reach = loops.constants(muscles), muscles.reach
        self._flags = plain.region_flags(muscles, model.regions.region_of)
        self._regions = model.regions.region_of
        self._corner_regions = self._regions[self.triangles]
        self._first, self._around = _polygons_around(self.triangles, len(rest))
        self._shared = rest.astype(np.float64)
        self._corners = self._shared[self.triangles]
        self._moved: dict[str, Any] = {way: np.empty_like(self._corners) for way in ("original", "cutoff")}
        self._moved |= {"improved": np.empty_like(self._shared), "ours": np.empty_like(rest)}
        self._change = np.empty_like(self._corners), np.empty_like(self._shared)
        self._normals = {way: np.empty_like(moved) for way, moved in self._moved.items()}

    def muscles(self, way: str, levels: Doubles) -> None:
        """Contract the muscles by ``levels (M,)`` in 0..1."""
        moved, fibres, reach = self._moved[way], self._constants, self._reach
        of_corners, of_vertices = self._change
        if way == "original":
            loops.contract_polygons(self._corners, moved, of_corners, fibres, levels, STEP, self.triangles, reach)
        elif way == "cutoff":
            loops.contract_polygons_in_regions(
                self._corners, moved, of_corners, fibres, levels, STEP, self.triangles, reach, self._corner_regions,
                self._flags,
            )  # fmt: skip
        elif way == "improved":
            loops.contract_vertices(
                self._shared, moved, of_vertices, fibres, levels, STEP, reach, self._regions, self._flags
            )
        else:
            self._combiner.apply(levels, moved)

    def normals(self, way: str) -> None:
        """The normals of what :meth:`muscles` made last."""
        moved, out = self._moved[way], self._normals[way]
        if way in ("original", "cutoff"):
            loops.polygon_normals(moved, self._first, self._around, self.triangles, out)
        elif way == "improved":
            loops.shared_normals(moved, self.triangles, out)
        else:
            write_normals(moved, self.triangles, out)

    def result(self, way: str) -> tuple[Doubles, Doubles]:
        """Positions and normals ``(T, 3, 3)`` of the polygons' corners, as last computed."""
        moved, normals = self._moved[way], self._normals[way]
        if moved.ndim == 2:
            moved, normals = moved[self.triangles], normals[self.triangles]
        return moved.astype(np.float64), normals.astype(np.float64)


def emotion_levels(muscles: int) -> list[Doubles]:
    """The contractions ``(muscles,)`` of the vector muscles in the six emotions at full intensity."""
    from agentface.emotion.inference import default_inference
    from agentface.emotion.state import EMOTIONS
    from agentface.parameters import VECTOR_MUSCLES, indices_of

    first = indices_of(VECTOR_MUSCLES[0])[0]
    poses = (default_inference().pose({emotion: 1.0}).array for emotion in EMOTIONS)
    return [values[first : first + muscles].astype(np.float64) for values in poses]


def run(model: HeadModel | None = None, rounds: int = 20) -> dict[str, Any]:
    """For each way: microseconds a frame, frames a second, and how often faster than the original, beside the paper.

    A frame is the muscles in five steps of 0.2 and the vertex normals that Phong shading needs, computed by every
    polygon for its own corners in ``original`` and ``cutoff``; drawing is no part of it, but was of the paper's
    figures. Medians over interleaved rounds, each of the six emotions at full intensity; one thread.
    ``largest_difference_um`` is how far a vertex is from where the original loop takes it.
    """
    if model is None:
        from agentface.head.model import load_model

        model = load_model()
    frames, poses = Frames(model), emotion_levels(len(model.muscles))
    times = interleave(_tasks(frames, poses), rounds)
    report: dict[str, Any] = {"vertices": len(model.vertices), "polygons": len(model.triangles), "steps": 5}
    apart = _differences(frames, poses)
    frame = {way: (times[f"{way}.muscles"] + times[f"{way}.normals"]) / len(poses) for way in WAYS}
    for way in WAYS:
        report[way] = {
            "muscles_us": times[f"{way}.muscles"] / len(poses),
            "normals_us": times[f"{way}.normals"] / len(poses),
            "frame_us": frame[way],
            "speed_fps": 1e6 / frame[way],
            "speed_to_original_ratio": frame["original"] / frame[way],
            "largest_difference_um": 1e6 * apart[way],
        }
        if way in PAPER_FPS:
            report[way]["paper_speed_fps"] = PAPER_FPS[way]
            report[way]["paper_speed_to_original_ratio"] = PAPER_FPS[way] / PAPER_FPS["original"]
    return report


def _tasks(frames: Frames, poses: list[Doubles]) -> dict[str, Callable[[], Any]]:
    def muscles(way: str) -> None:
        for levels in poses:
            frames.muscles(way, levels)

    def normals(way: str) -> None:
        for _ in poses:
            frames.normals(way)

    tasks: dict[str, Callable[[], Any]] = {}
    for way in WAYS:
        tasks[f"{way}.muscles"], tasks[f"{way}.normals"] = partial(muscles, way), partial(normals, way)
    return tasks


def _differences(frames: Frames, poses: list[Doubles]) -> dict[str, float]:
    apart = dict.fromkeys(WAYS, 0.0)
    for levels in poses:
        for way in WAYS:
            frames.muscles(way, levels)
        original = frames.result("original")[0]
        for way in WAYS:
            apart[way] = max(apart[way], float(np.linalg.norm(frames.result(way)[0] - original, axis=-1).max()))
    return apart


def _polygons_around(triangles: Indices, vertices: int) -> tuple[Indices, Indices]:
    """The polygons round vertex v are ``around[first[v] : first[v + 1]]``."""
    corner = np.argsort(triangles.ravel(), kind="stable")
    first: npt.NDArray[np.int64] = np.zeros(vertices + 1, np.int64)
    np.cumsum(np.bincount(triangles.ravel(), minlength=vertices), out=first[1:])
    return first.astype(np.int32), (corner // 3).astype(np.int32)
