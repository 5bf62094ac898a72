"""What a picture costs, stage by stage, beside the least that any picture of its size costs on the machine."""

from __future__ import annotations

import os
import time
from collections import defaultdict
from collections.abc import Iterator
from contextlib import contextmanager
from itertools import cycle, islice
from statistics import median
from typing import TYPE_CHECKING, Any

from agentface.deform.pipeline import GeometricDeformer
from agentface.view.renderer import QUALITIES, Renderer
from agentface.view.targets import Targets

if TYPE_CHECKING:
    from agentface.anatomy.model import HeadModel
    from agentface.deform.geometry import FaceGeometry
    from agentface.parameters import FacePose

SIZES = ((640, 480), (1280, 720))
STAGES = ("deform", "upload", "draw", "readback")


class _Stages:
    """Wall and processor time of named stages, the GPU's work done at both ends of each."""

    def __init__(self, context: Any) -> None:
        self._finish = context.finish
        self._times: defaultdict[str, list[tuple[float, float]]] = defaultdict(list)

    @contextmanager
    def stage(self, name: str) -> Iterator[None]:
        self._finish()
        wall, processor = time.perf_counter(), time.process_time()
        yield
        self._finish()
        self._times[name].append((1e3 * (time.perf_counter() - wall), 1e3 * (time.process_time() - processor)))

    def forget(self) -> None:
        self._times.clear()

    def medians(self, group: str) -> dict[str, float]:
        """``<stage>_ms`` and ``<stage>_cpu_ms`` of the stages named ``<group>.<stage>``."""
        found = {}
        for name, times in self._times.items():
            if name.startswith(group + "."):
                stage = name.removeprefix(group + ".")
                wall, processor = zip(*times, strict=True)
                found |= {f"{stage}_ms": median(wall), f"{stage}_cpu_ms": median(processor)}
        return found


class _Bench(Renderer):
    """A renderer whose uploads are a stage of their own."""

    stages: _Stages | None = None
    group = ""

    def upload(self, geometry: FaceGeometry) -> None:
        if self.stages is None:
            super().upload(geometry)
            return
        with self.stages.stage(f"{self.group}.upload"):
            super().upload(geometry)


def run(model: HeadModel | None = None, rounds: int = 15, sizes: tuple[tuple[int, int], ...] = SIZES) -> dict[str, Any]:
    """Medians over interleaved rounds, in milliseconds a frame; ``_cpu_ms`` is the time of all processors together.

    For each quality and size: ``deform``, from a pose to vertices; ``upload``, of what changed; ``draw``, all passes;
    ``readback``, to an array; each with the GPU's work done before and after. ``frame`` is the same in one go, as a
    program calls it, ``rate_hz`` how many of them a second has. ``floor`` is clearing a picture of the size and
    reading it back. The expression changes from round to round. One round before the first is not counted.
    """
    from agentface.anatomy.model import load_model

    model = model or load_model()
    renderer, deformer = _Bench(model), GeometricDeformer(model)
    stages = _Stages(renderer.context)
    for turn, pose in enumerate(islice(cycle(_poses()), rounds + 1)):
        if turn == 1:
            stages.forget()
        for size in sizes:
            _floor(renderer, size, stages)
            for quality in QUALITIES:
                _frame(renderer, deformer, pose, size, quality, stages)
    report: dict[str, Any] = {
        "renderer": renderer.context.info["GL_RENDERER"],
        "processors": os.cpu_count(),
        "vertices": len(model.vertices),
        "rounds": rounds,
        "floor": {_name(size): stages.medians(f"floor.{_name(size)}") for size in sizes},
    }
    for quality in QUALITIES:
        report[quality] = {
            _name(size): _figures(stages.medians(f"{quality}.{_name(size)}"), report["floor"][_name(size)])
            for size in sizes
        }
    renderer.context.release()
    return report


def _poses() -> list[FacePose]:
    """A smile that widens in surprise."""
    from agentface.emotion.inference import default_inference

    infer = default_inference()
    return [infer.pose({"happiness": 0.2 + 0.1 * step, "surprise": 0.7}) for step in range(8)]


def _floor(renderer: Renderer, size: tuple[int, int], stages: _Stages) -> None:
    targets = Targets.make(renderer.context, size, 0)
    name = f"floor.{_name(size)}"
    with stages.stage(f"{name}.frame"):
        with stages.stage(f"{name}.clear"):
            targets.picture.clear(0.5, 0.5, 0.5, 1.0)
        with stages.stage(f"{name}.readback"):
            targets.picture.read(components=3, alignment=1)
    targets.release()


def _frame(
    renderer: _Bench,
    deformer: GeometricDeformer,
    pose: FacePose,
    size: tuple[int, int],
    quality: str,
    stages: _Stages,
) -> None:
    group = f"{quality}.{_name(size)}"
    renderer.stages = None
    with stages.stage(f"{group}.frame"):
        renderer.render(deformer.deform(pose), size, "front", quality)
    renderer.stages, renderer.group = stages, group
    with stages.stage(f"{group}.deform"):
        geometry = deformer.deform(pose)
    targets = renderer.targets(size, quality)
    with stages.stage(f"{group}.draw_and_upload"):
        renderer.draw(geometry, targets, "front", quality)
    with stages.stage(f"{group}.readback"):
        targets.picture.read(components=3, alignment=1)
