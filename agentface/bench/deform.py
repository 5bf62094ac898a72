"""What the vector muscles of one face cost a frame, beside what a plainer way and a blendshape rig cost."""

from __future__ import annotations

import ctypes
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from statistics import median
from typing import TYPE_CHECKING, Any

import numpy as np

from agentface.conventions import Doubles
from agentface.deform.combine import STEP, Combiner
from agentface.deform.normals import NormalField

if TYPE_CHECKING:
    from agentface.anatomy.model import HeadModel

BLENDSHAPES = 52
"""The shapes of an ARKit rig."""
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
        from agentface.anatomy.model import load_model

        model = load_model()
    from agentface.bench import plain

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
    tasks: dict[str, Callable[[], Any]] = _blendshapes(rest.size, draw)
    tasks["copy"] = lambda: np.copyto(out, rest)
    field = NormalField(model.triangles, len(rest))
    tasks["normals"] = lambda: field.compute(rest, out)
    for name, levels in (("active_8", some), ("active_all", np.ones(count))):
        tasks[f"{name}.ours"] = tasks[f"{name}.ours_warm"] = partial(combiner.apply, levels, out)
        tasks[f"{name}.loop"] = loops(levels, every)
        tasks[f"{name}.cutoff"] = loops(levels, mask)
    with _one_thread() as limited:
        times = _interleave(tasks, rounds)
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


def _blendshapes(size: int, draw: np.random.Generator) -> dict[str, Callable[[], Any]]:
    basis = draw.random((BLENDSHAPES, size), dtype=np.float32)
    turned = np.ascontiguousarray(basis.T)
    weights = draw.random(BLENDSHAPES, dtype=np.float32)
    out = np.empty(size, dtype=np.float32)
    rows, columns = partial(np.dot, weights, basis, out=out), partial(np.dot, turned, weights, out=out)
    return {"gemv_rows": rows, "gemv_rows_warm": rows, "gemv_columns": columns, "gemv_columns_warm": columns}


@contextmanager
def _one_thread() -> Iterator[bool]:
    """Holds the OpenBLAS of numpy's wheels to one thread; yields whether it could be found."""
    for path in Path(np.__file__).parents[1].glob("numpy.libs/*openblas*"):
        library = ctypes.CDLL(str(path))
        for ending in ("64_", ""):
            get = getattr(library, f"scipy_openblas_get_num_threads{ending}", None)
            limit = getattr(library, f"scipy_openblas_set_num_threads{ending}", None)
            if get and limit:
                before = get()
                limit(1)
                try:
                    yield True
                finally:
                    limit(before)
                return
    yield False


def _interleave(tasks: dict[str, Callable[[], Any]], rounds: int) -> dict[str, float]:
    """The median time of each task in microseconds, all tasks once a round, after one round to compile them."""
    times: dict[str, list[float]] = {name: [] for name in tasks}
    for turn in range(rounds + 1):
        for name, task in tasks.items():
            start = time.perf_counter()
            task()
            if turn:
                times[name].append(1e6 * (time.perf_counter() - start))
    return {name: median(values) for name, values in times.items()}
