"""What the vector muscles of one face cost a frame, beside what a plainer way and a blendshape rig cost."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from agentface.conventions import Doubles
from agentface.deform.muscles.combine import STEP, Combiner
from agentface.studies.bench.timing import blendshapes, interleave, one_thread

if TYPE_CHECKING:
    from agentface.head.model import HeadModel

SMILE = ("zygomaticus_major", "orbicularis_oculi_lateralis", "levator_labii_superioris", "frontalis_medialis")
"""A broad smile with raised brows, both sides: eight muscles, among them the face's widest."""


def run(model: HeadModel | None = None, rounds: int = 200) -> dict[str, Any]:
    """Medians over interleaved rounds, in microseconds a frame, and their ratios.

    All muscles that act contract fully, which takes five steps: the dearest frame. ``active_8`` are those of
    :data:`SMILE`. ``loop_us`` is a compiled loop over every muscle and vertex in double precision, ``cutoff_us`` the
    same with the paper's test of the region first, ``gemv_us`` the weighted sum of 52 blendshapes of the same mesh as
    one float32 product of a matrix and a vector, in the faster of the two storage orders; ``copy_us`` a copy of the
    vertices. ``_warm_`` is the same at once again, with its data still in the caches. Muscles and product run on
    one thread each: ``gemv_one_thread`` says whether the library that numpy came with could be told so, else set
    its variable (``OPENBLAS_NUM_THREADS=1``, ``MKL_NUM_THREADS=1``) before the program starts.
    """
    if model is None:
        from agentface.head.model import load_model

        model = load_model()
    from agentface.mesh.normals_compiled import write_normals
    from agentface.studies.bench import plain

    count = len(model.muscles)
    rest = model.vertices
    out = np.empty_like(rest)
    draw = np.random.default_rng(2)
    some = np.array([name[:-2] in SMILE for name in model.muscles.names], dtype=np.float64)
    combiner = Combiner(rest, model.muscles)
    constants = plain.constants(model.muscles)
    region_of = model.regions.region_of
    mask = plain.region_flags(model.muscles, region_of)
    work: tuple[Doubles, Doubles] = (np.empty(rest.shape), np.empty(rest.shape))

    def loops(levels: Doubles, masks: Any) -> Callable[[], Any]:
        return partial(plain.contract, rest, *work, constants, levels, STEP, region_of, masks)

    every = np.full(count, -1, dtype=np.int64)
    tasks: dict[str, Callable[[], Any]] = blendshapes(rest.size, draw)
    tasks["copy"] = lambda: np.copyto(out, rest)
    tasks["normals"] = partial(write_normals, rest, model.triangles, out)
    for name, levels in (("active_8", some), ("active_all", np.ones(count))):
        tasks[f"{name}.ours"] = tasks[f"{name}.ours_warm"] = partial(combiner.apply, levels, out)
        tasks[f"{name}.loop"] = loops(levels, every)
        tasks[f"{name}.cutoff"] = loops(levels, mask)
    with one_thread() as limited:
        times = interleave(tasks, rounds)
    report: dict[str, Any] = {"vertices": len(rest), "muscles": count, "normals_us": times["normals"]}
    report["gemv_one_thread"] = limited
    for name in ("active_8", "active_all"):
        report[name] = _compare(name, times)
    return report


def _compare(name: str, times: dict[str, float]) -> dict[str, float]:
    ours, ours_warm, loop, cutoff = (times[f"{name}.{way}"] for way in ("ours", "ours_warm", "loop", "cutoff"))
    gemv = min(times["gemv_rows"], times["gemv_columns"])
    warm = min(times["gemv_rows_warm"], times["gemv_columns_warm"])
    return {
        "ours_us": ours,
        "ours_warm_us": ours_warm,
        "loop_us": loop,
        "cutoff_us": cutoff,
        "gemv_us": gemv,
        "gemv_warm_us": warm,
        "copy_us": times["copy"],
        "ours_to_gemv_ratio": ours / gemv,
        "ours_to_gemv_warm_ratio": ours_warm / warm,
        "loop_to_ours_ratio": loop / ours,
        "cutoff_to_ours_ratio": cutoff / ours,
    }
