"""What the whole geometric face costs a frame, beside a blendshape rig with normals, and how it grows with the mesh."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from agentface.deform.finish import smooth_normals, smooth_normals_compiled
from agentface.deform.pipeline import GeometricDeformer
from agentface.deform.protocol import DEFAULT_DEFORMER, make_deformer
from agentface.parameters import PARAMETERS, FacePose
from agentface.studies.bench.deform import SMILE
from agentface.studies.bench.timing import blendshapes, interleave, one_thread

if TYPE_CHECKING:
    from agentface.head.model import HeadModel

COARSEST, FINEST = 2_500, 100_000
"""Vertices of the coarsest mesh, and what the finest has at most."""


def poses() -> dict[str, FacePose]:
    """Eight muscles of a smile at full contraction; a mixed expression that looks aside; everything at its highest."""
    from agentface.emotion.inference import default_inference

    mixed = default_inference().pose({"happiness": 0.8, "surprise": 0.7})
    return {
        "smile": FacePose.of(**dict.fromkeys(SMILE, 1.0)),
        "mixed": mixed.replace({"gaze_yaw": 0.2, "gaze_pitch": 0.1, "head_yaw": 0.1}),
        "all_active": FacePose(np.array([known.high for known in PARAMETERS], np.float32)),
    }


def densities(model: HeadModel, finest: int = FINEST) -> list[HeadModel]:
    """``model`` thinned out, as it is, and subdivided up to at most ``finest`` vertices."""
    from agentface.head.resample import subdivided, thinned

    found = [thinned(model, COARSEST), model]
    while len(found[-1].triangles) * 2 <= finest:  # a closed mesh has half as many vertices as triangles
        found.append(subdivided(found[-1]))
    return found


def run(
    model: HeadModel | None = None, rounds: int = 200, finest: int = FINEST, deformer_name: str = DEFAULT_DEFORMER
) -> dict[str, Any]:
    """Medians over interleaved rounds, in microseconds a frame, and their ratios.

    ``baseline`` is the weighted sum of 52 blendshapes of the same mesh as one float32 product (the faster of the two
    storage orders) and its vertex normals once, by the kernel that the face has. For each of :func:`poses`:
    ``frame_us`` a frame of the geometric deformer, in one call; its stages one by one, in their order; and the ratio to
    the baseline. ``_warm_`` is a call directly after another, with its data still in the caches. ``growth`` has, for
    the same face at several densities (:func:`densities`) and the mixed expression, nanoseconds a vertex and how many
    times those of the coarsest mesh that is: 1 is linear growth. All on one thread (see
    :func:`agentface.studies.bench.deform.run`).
    """
    if model is None:
        from agentface.head.model import load_model

        model = load_model(asymmetry=0.0)
    deformer, faces = make_deformer(deformer_name, model), poses()
    tasks = _baseline(model)
    for name, pose in faces.items():
        whole = partial(deformer.step, pose, 1 / 60)
        tasks |= {f"{name}.frame": whole, f"{name}.frame_warm": whole}
        # behind a whole frame, each stage finds what the ones before it left
        stages = deformer.stages(deformer.at(pose)) if isinstance(deformer, GeometricDeformer) else {}
        tasks |= {f"{name}.stage.{stage}": partial(act, pose) for stage, act in stages.items()}
    with one_thread() as limited:
        times = interleave(tasks, rounds)
    report: dict[str, Any] = {"vertices": len(model.vertices), "gemv_one_thread": limited, "baseline": {}}
    for state in ("", "_warm"):
        gemv = min(times[f"gemv_rows{state}"], times[f"gemv_columns{state}"])
        row = {"gemv": gemv, "normals": times[f"normals{state}"], "baseline": gemv + times[f"normals{state}"]}
        report["baseline"] |= {f"{name}{state}_us": value for name, value in row.items()}
    for name in faces:
        report[name] = _figures(name, times, report["baseline"])
    report["growth"] = _growth(densities(model, finest), faces["mixed"], max(1, rounds // 4), deformer_name)
    return report


def _baseline(model: HeadModel) -> dict[str, Callable[[], Any]]:
    tasks = blendshapes(model.vertices.size, np.random.default_rng(2))
    tables, out = smooth_normals.prepare(model), np.empty_like(model.vertices)
    normals = partial(smooth_normals_compiled.apply, tables, model.vertices, out)
    return tasks | {"normals": normals, "normals_warm": normals}


def _figures(name: str, times: dict[str, float], baseline: dict[str, float]) -> dict[str, Any]:
    frame, warm, stage = times[f"{name}.frame"], times[f"{name}.frame_warm"], f"{name}.stage."
    return {
        "frame_us": frame,
        "frame_warm_us": warm,
        "frame_to_baseline_ratio": frame / baseline["baseline_us"],
        "frame_to_baseline_warm_ratio": warm / baseline["baseline_warm_us"],
        "stages": {f"{key.removeprefix(stage)}_us": time for key, time in times.items() if key.startswith(stage)},
    }


def _growth(models: list[HeadModel], pose: FacePose, rounds: int, deformer_name: str) -> dict[str, Any]:
    deformers = [make_deformer(deformer_name, model) for model in models]
    tasks = {str(index): partial(deformer.step, pose, 1 / 60) for index, deformer in enumerate(deformers)}
    times = interleave(tasks, rounds)
    vertex = [1e3 * times[str(index)] / len(model.vertices) for index, model in enumerate(models)]
    return {
        f"vertices_{len(model.vertices)}": {
            "frame_us": times[str(index)],
            "vertex_ns": vertex[index],
            "vertex_to_coarsest_ratio": vertex[index] / vertex[0],
        }
        for index, model in enumerate(models)
    }
