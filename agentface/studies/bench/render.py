"""What a picture costs, stage by stage, beside the least that any picture of its size costs on the machine."""

from __future__ import annotations

import os
import time
from collections import defaultdict
from collections.abc import Iterator
from contextlib import contextmanager
from itertools import cycle
from statistics import median
from typing import TYPE_CHECKING, Any

from agentface.deform.protocol import DEFAULT_DEFORMER, Deformer, make_deformer
from agentface.view.gl.quality import QUALITIES
from agentface.view.gl.targets import Targets
from agentface.view.renderer import Renderer

if TYPE_CHECKING:
    from agentface.deform.geometry import FaceGeometry
    from agentface.head.model import HeadModel
    from agentface.parameters import FacePose

SIZES = ((640, 480), (1280, 720))
_IN_A_ROW = 5
STAGES = ("deform", "upload", "draw", "readback")


def run(
    model: HeadModel | None = None,
    rounds: int = 15,
    sizes: tuple[tuple[int, int], ...] = SIZES,
    deformer_name: str = DEFAULT_DEFORMER,
) -> dict[str, Any]:
    """Medians over interleaved rounds, in milliseconds a frame; ``_cpu_ms`` is the time of all processors together.

    For each quality and size: ``deform``, from a pose to vertices; ``upload``, of what changes with the frame;
    ``draw``, all passes; ``readback``, to an array; the GPU has done its work before and after each. ``frame`` is all
    that in one go, frame after frame as a program calls it, ``frames_hz`` how many of them a second has. ``floor`` is
    clearing a picture of the size and reading it back. The expression changes from frame to frame; one round before
    the first is not counted. Raises GraphicsError where there is no OpenGL.
    """
    if model is None:
        from agentface.head.model import load_model

        model = load_model()
    with _Renderer(model) as renderer, renderer.current():
        return _measure(renderer, model, sizes, rounds, deformer_name)


def _measure(
    renderer: _Renderer, model: HeadModel, sizes: tuple[tuple[int, int], ...], rounds: int, deformer_name: str
) -> dict[str, Any]:
    deformer, stages = make_deformer(deformer_name, model), _Stages(renderer.context)
    targets = {
        (name, size): Targets.make(renderer.context, size, quality.samples)
        for size in sizes
        for name, quality in QUALITIES.items()
    }
    poses = cycle(_poses())
    for turn in range(rounds + 1):
        if turn == 1:
            stages.forget()
        for size in sizes:
            _floor(targets["fast", size], stages)
        for (quality, _), screen in targets.items():
            _frame(renderer, deformer, poses, screen, quality, stages)
    floor = {_name(size): stages.medians(f"floor {_name(size)}") for size in sizes}
    report = {
        "renderer": renderer.context.info["GL_RENDERER"],
        "processors": os.cpu_count(),
        "vertices": len(model.vertices),
        "rounds": rounds,
        "floor": floor,
    }
    report |= {quality: {} for quality in QUALITIES}
    for quality, size in targets:
        figures = stages.medians(f"{quality} {_name(size)}")
        figures["frames_hz"] = 1e3 / figures["frame_ms"]
        figures["frame_to_floor_ratio"] = figures["frame_ms"] / floor[_name(size)]["frame_ms"]
        report[quality][_name(size)] = figures
    return report


class _Renderer(Renderer):
    """A renderer whose upload can be taken for done, to time the rest."""

    uploaded = False

    def upload_skin(self, geometry: FaceGeometry) -> None:
        if not self.uploaded:
            super().upload_skin(geometry)

    def upload_wrinkles(self, geometry: FaceGeometry) -> None:
        if not self.uploaded:
            super().upload_wrinkles(geometry)


class _Stages:
    """Wall and processor milliseconds of stages that are named ``<group>.<stage>``."""

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
        """``<stage>_ms`` and ``<stage>_cpu_ms`` of the stages of ``group``."""
        found: dict[str, float] = {}
        for name, times in self._times.items():
            owner, _, stage = name.partition(".")
            if owner == group:
                wall, processor = zip(*times, strict=True)
                found |= {f"{stage}_ms": median(wall), f"{stage}_cpu_ms": median(processor)}
        return found


def _frame(
    renderer: _Renderer,
    deformer: Deformer,
    poses: Iterator[FacePose],
    screen: Targets,
    quality: str,
    stages: _Stages,
) -> None:
    group = f"{quality} {_name(screen.size)}"
    with stages.stage(f"{group}.deform"):
        geometry = deformer.at(next(poses))
    with stages.stage(f"{group}.upload"):
        renderer.upload_skin(geometry)
        renderer.upload_wrinkles(geometry)
    renderer.uploaded = True
    with stages.stage(f"{group}.draw"):
        renderer.draw(geometry, screen, "front", quality)
    renderer.uploaded = False
    with stages.stage(f"{group}.readback"):
        screen.read()
    for _ in range(_IN_A_ROW):
        with stages.stage(f"{group}.frame"):
            renderer.draw(deformer.at(next(poses)), screen, "front", quality)
            screen.read()


def _floor(screen: Targets, stages: _Stages) -> None:
    group = f"floor {_name(screen.size)}"
    with stages.stage(f"{group}.clear"):
        screen.picture.clear(0.5, 0.5, 0.5, 1.0)
    with stages.stage(f"{group}.readback"):
        screen.read()
    with stages.stage(f"{group}.frame"):
        screen.picture.clear(0.5, 0.5, 0.5, 1.0)
        screen.read()


def _poses() -> list[FacePose]:
    """A surprise that goes from a shade of a smile to a broad one; an odd number, so that every frame meets each."""
    from agentface.emotion.inference import default_inference

    infer = default_inference()
    return [infer.pose({"happiness": 0.2 + 0.1 * step, "surprise": 0.7}) for step in range(7)]


def _name(size: tuple[int, int]) -> str:
    return f"{size[0]}x{size[1]}"
