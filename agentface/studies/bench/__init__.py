"""The benchmarks: each times a part of agentface and what one would use instead, side by side in one run."""

from __future__ import annotations

from importlib import import_module
from inspect import signature
from pathlib import Path
from typing import Any

from agentface.deform.protocol import DEFAULT_DEFORMER
from agentface.errors import UnknownNameError
from agentface.resources import DEFAULT_FACE

BENCHES: dict[str, str] = {
    "deform": "the muscles of one face, beside plain loops and a blendshape product",
    "fuzzy": "one inference of the rules, beside scikit-fuzzy",
    "papers": "the paper's Table 1: its loops with and without its improvements, and ours",
    "frame": "the whole face, beside a blendshape product with normals, and how it grows with the mesh",
    "motion": "the motion of a face a frame: still, told, alive, and with all channels on",
    "latency": "from another process's message to the first changed frame, at 60 frames a second, and a picture apart",
    "crowd": "many faces in one call, on one thread and on two",
    "render": "a picture in both qualities and two sizes, stage by stage, beside clearing and reading one back",
    "start": "a picture from a command, and first faces, beside importing the libraries",
    "tissue": "the second paper's results: semi-implicit, adaptive and our solver on five expressions",
    "mpeg4": "FAPs measured and solved, and the errors of the round trip, beside scipy",
    "arkit": "ARKit's weights solved for and given back, and what muscles make of each shape",
    "web": "a face in pages: how true its frames are, what they weigh and cost, how late they come",
    "texture": "a picture worn as skin: how finely it lies, how emotions strain it, what drawing it costs",
}
"""The benchmarks and what they compare; each is a module of this package with ``run() -> dict``."""
PARTS: dict[str, str] = {
    "tissue_volume": "the second paper's volume force, its forms and ours, at several strengths",
    "speech": "the laws of a speaking mouth: every emotion and every two, several rates and loudnesses; half an hour",
}
"""What is measured when it is asked for alone."""


def run(name: str, face: str | Path = DEFAULT_FACE, deformer: str = DEFAULT_DEFORMER) -> dict[str, Any]:
    """The figures of one benchmark, units in the key names; of ``face`` and ``deformer`` where it
    has a choice; raises UnknownNameError.
    """
    from agentface.head.model import load_model

    if name not in BENCHES | PARTS:
        raise UnknownNameError("benchmark", name, tuple(BENCHES))
    bench = import_module(f"agentface.studies.bench.{name}").run
    parameters = signature(bench).parameters
    options: dict[str, Any] = {"face": face, "deformer_name": deformer}
    if "model" in parameters:
        options["model"] = load_model(face, asymmetry=0.0)
    figures: dict[str, Any] = bench(**{name: value for name, value in options.items() if name in parameters})
    return figures
