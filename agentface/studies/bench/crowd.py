"""How many faces a second one and two threads deform, each face in a pose of its own."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from agentface.conventions import Floats
from agentface.deform.crowd import Crowd
from agentface.deform.protocol import DEFAULT_DEFORMER
from agentface.parameters import PARAMETERS
from agentface.studies.bench.timing import interleave

if TYPE_CHECKING:
    from agentface.head.model import HeadModel

SIZES = (1, 10, 100, 1_000)
THREADS = (1, 2)
_FACES = 5_000  # that a size is timed on, at least, in all its rounds
_ROUNDS = 50  # at most


def random_poses(count: int, seed: int = 3) -> Floats:
    """``(count, COUNT)`` float32: every parameter anywhere in its range, the dearest poses there are."""
    low, high = (np.array([getattr(known, end) for known in PARAMETERS], np.float32) for end in ("low", "high"))
    part = np.random.default_rng(seed).random((count, len(PARAMETERS)), dtype=np.float32)
    return np.clip(low + part * (high - low), low, high)


def run(
    model: HeadModel | None = None,
    sizes: tuple[int, ...] = SIZES,
    faces: int = _FACES,
    deformer_name: str = DEFAULT_DEFORMER,
) -> dict[str, Any]:
    """For each number of faces and of threads: microseconds a face and faces a second, of whole frames in one call.

    Medians over interleaved rounds. ``one_to_two_threads_ratio`` is how many times faster two threads are; one face
    stays on one.
    """
    if model is None:
        from agentface.head.model import load_model

        model = load_model()
    crowds = {threads: Crowd(model, threads, deformer=deformer_name) for threads in THREADS}
    report: dict[str, Any] = {"vertices": len(model.vertices)}
    for size in sizes:
        poses = random_poses(size)
        tasks = {f"threads_{threads}": partial(crowd.deform, poses) for threads, crowd in crowds.items()}
        times = interleave(tasks, min(_ROUNDS, -(-faces // size)))
        row: dict[str, Any] = {
            name: {"crowd_us": time, "face_us": time / size, "faces_fps": 1e6 * size / time}
            for name, time in times.items()
        }
        report[f"faces_{size}"] = row | {"one_to_two_threads_ratio": times["threads_1"] / times["threads_2"]}
    for crowd in crowds.values():
        crowd.close()
    return report
