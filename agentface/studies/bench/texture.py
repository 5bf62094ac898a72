"""What a picture worn as skin costs and what it keeps: Bui's open question about textures."""

from __future__ import annotations

import tempfile
import time
from pathlib import Path
from statistics import median
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from agentface.deform.protocol import DEFAULT_DEFORMER, make_deformer
from agentface.emotion.inference import default_inference
from agentface.emotion.state import EMOTIONS
from agentface.head.look import load_look
from agentface.view.gl.quality import QUALITIES
from agentface.view.renderer import Renderer
from agentface.view.skin.template import skin_template

if TYPE_CHECKING:
    from agentface.conventions import Doubles, Floats
    from agentface.head.model import HeadModel

SIDE = 2048
_PORTRAIT = (700, 800)
_MIDDLE = np.s_[180:680, 180:520]  # of such a picture: the face
_OUTWARD = 0.05  # light that reaches skin which is seen
_NEITHER = 0.3  # of the material inside the mouth, and of wet lids


def run(
    model: HeadModel | None = None,
    rounds: int = 12,
    size: tuple[int, int] = (1280, 720),
    deformer_name: str = DEFAULT_DEFORMER,
) -> dict[str, Any]:
    """How finely a picture of 2048 pixels a side lies on the face, how emotions strain it, and what drawing it costs.

    ``texels_a_mm``: along the finer and the coarser axis, so that 5 %, 50 % and 95 % of the face's area have fewer.
    ``strain``: of each emotion at 1, the stretch that 95 % of the area stays below and the squeeze it stays above.
    ``fast`` and ``portrait``: ``kept_levels``, by how much of 255 a smiling face that wears its own unchanged template
    differs from itself, at half and at 99 % of its pixels; ``plain_cpu_ms`` and ``worn_cpu_ms``, medians of interleaved
    frames, all processors together. Raises GraphicsError where there is no OpenGL.
    """
    if model is None:
        from agentface.head.model import load_model

        model = load_model()
    return {"rounds": rounds, **_laid(model, deformer_name), **_drawn(model, rounds, size, deformer_name)}


def _laid(model: HeadModel, deformer_name: str) -> dict[str, Any]:
    """How finely the picture lies, and how emotions strain it."""
    deformer, infer = make_deformer(deformer_name, model), default_inference()
    rest = _frames(model.vertices[model.triangles])
    area = np.where(_shown(model), 0.5 * np.linalg.det(rest), 0.0)
    density = _axes(_flat_frames(SIDE * model.uv[model.triangles]) @ np.linalg.inv(rest)) / 1e3
    fineness = {
        name: {f"p{part}": _share(density[:, axis], area, part / 100) for part in (5, 50, 95)}
        for axis, name in enumerate(("finer", "coarser"))
    }
    strain = {}
    for emotion in EMOTIONS:
        strained = _frames(deformer.at(infer.pose({emotion: 1.0})).vertices[model.triangles])
        axes = _axes(strained @ np.linalg.inv(rest))
        strain[emotion] = {
            "stretch_p95": _share(axes[:, 0], area, 0.95),
            "squeeze_p5": _share(axes[:, 1], area, 0.05),
        }
    return {"texels_a_mm": fineness, "strain": strain}


def _drawn(model: HeadModel, rounds: int, size: tuple[int, int], deformer_name: str) -> dict[str, Any]:
    """What each quality keeps of a face that wears its own template, and what that costs."""
    smiling = make_deformer(deformer_name, model).at(default_inference().pose({"happiness": 0.5}))
    renderers = {"plain": Renderer(model), "worn": _wearing_its_template(model)}
    report: dict[str, Any] = {}
    for quality in QUALITIES:
        plain, worn = (each.render(smiling, _PORTRAIT, "front", quality).astype(int) for each in renderers.values())
        gap = np.abs(plain - worn).max(axis=2)[_MIDDLE]
        times: dict[str, list[float]] = {name: [] for name in renderers}
        for _ in range(rounds + 1):  # the first is not counted
            for name, renderer in renderers.items():
                start = time.process_time()
                renderer.render(smiling, size, "front", quality)
                times[name].append(1e3 * (time.process_time() - start))
        costs = {f"{name}_cpu_ms": median(taken[1:]) for name, taken in times.items()}
        report[quality] = {
            "kept_levels": {f"p{part}": float(np.percentile(gap, part)) for part in (50, 99)},
            **costs,
            "worn_to_plain_ratio": costs["worn_cpu_ms"] / costs["plain_cpu_ms"],
        }
    for renderer in renderers.values():
        renderer.close()
    return report


def _wearing_its_template(model: HeadModel) -> Renderer:
    from agentface.io.picture import write_picture

    look = load_look(model)
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "skin.png"
        write_picture(file, skin_template(model, look, SIDE))
        skin = look.skin.model_copy(update={"texture": str(file), "texture_strength": 1.0})
        return Renderer(model, look.model_copy(update={"skin": skin}))


def _shown(model: HeadModel) -> npt.NDArray[np.bool_]:
    """``(T,)``: the triangles of the face, chin to hairline, without mouth, wet lids and what lies in folds."""
    corners, middle = model.triangles, model.vertices[model.triangles].mean(axis=1)
    low, high = float(model.landmarks["menton"][1]), float(model.landmarks["hairline_middle"][1])
    on_face = (middle[:, 2] > 0.0) & (middle[:, 1] > low) & (middle[:, 1] < high)
    dry = (model.material[corners][:, :, 1:3] < _NEITHER).all(axis=(1, 2))
    seen = (model.uv_cover[corners] == 1.0).all(axis=1) & (model.shade[corners][:, :, 0] > _OUTWARD).all(axis=1)
    return np.asarray(on_face & dry & seen)


def _frames(corners: Floats) -> Doubles:
    """``(T, 2, 2)``: two edges of each triangle ``(T, 3, 3)``, in columns, in a frame of its own plane."""
    first, second = (corners[:, k].astype(np.float64) - corners[:, 0] for k in (1, 2))
    length = np.maximum(np.linalg.norm(first, axis=1), 1e-12)
    along = (first * second).sum(axis=1) / length
    across = np.maximum(np.linalg.norm(np.cross(first, second), axis=1) / length, 1e-9)
    return np.stack([np.stack([length, along], axis=1), np.stack([np.zeros_like(along), across], axis=1)], axis=1)


def _flat_frames(corners: Floats) -> Doubles:
    """``(T, 2, 2)``: two edges of each flat triangle ``(T, 3, 2)``, in columns."""
    return np.stack([corners[:, k].astype(np.float64) - corners[:, 0] for k in (1, 2)], axis=2)


def _axes(maps: Doubles) -> Doubles:
    """``(T, 2)``: how much linear maps lengthen, the most and the least."""
    return np.asarray(np.linalg.svd(maps, compute_uv=False))


def _share(values: Doubles, weights: Doubles, part: float) -> float:
    """The value below which ``part`` 0..1 of the weight lies."""
    order = np.argsort(values)
    below = np.cumsum(weights[order])
    return float(values[order][np.searchsorted(below, part * below[-1])])
