"""How the benchmarks take their times, and the blendshape product that they compare with."""

from __future__ import annotations

import ctypes
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from statistics import median
from typing import Any, TypeAlias

import numpy as np

BLENDSHAPES = 52
"""The shapes of an ARKit rig."""

Task: TypeAlias = Callable[[], Any]


def interleave(tasks: Mapping[str, Task], rounds: int) -> dict[str, float]:
    """The median time of each task in microseconds, all tasks once a round, after one round to compile them.

    Each task meets the others' data in the caches, and a noisy spell of the machine meets all tasks alike.
    """
    times: dict[str, list[float]] = {name: [] for name in tasks}
    for turn in range(rounds + 1):
        for name, task in tasks.items():
            start = time.perf_counter()
            task()
            if turn:
                times[name].append(1e6 * (time.perf_counter() - start))
    return {name: median(values) for name, values in times.items()}


def blendshapes(size: int, draw: np.random.Generator) -> dict[str, Task]:
    """The weighted sum of 52 blendshapes of ``size`` coordinates as one float32 product, in both storage orders.

    ``_warm`` is the same again, for a run directly after, with its data still in the caches.
    """
    basis = draw.random((BLENDSHAPES, size), dtype=np.float32)
    turned = np.ascontiguousarray(basis.T)
    weights = draw.random(BLENDSHAPES, dtype=np.float32)
    out = np.empty(size, dtype=np.float32)
    rows, columns = partial(np.dot, weights, basis, out=out), partial(np.dot, turned, weights, out=out)
    return {"gemv_rows": rows, "gemv_rows_warm": rows, "gemv_columns": columns, "gemv_columns_warm": columns}


@contextmanager
def one_thread() -> Iterator[bool]:
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
