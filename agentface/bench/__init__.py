"""The benchmarks: each times a part of agentface and what one would use instead, side by side in one run."""

from __future__ import annotations

from importlib import import_module
from typing import Any

from agentface.errors import UnknownNameError

BENCHES: dict[str, str] = {
    "deform": "the muscles of one face, beside plain loops and a blendshape product",
    "fuzzy": "one inference of the rules, beside scikit-fuzzy",
}
"""The benchmarks and what they compare; each is a module of this package with ``run() -> dict``."""


def run(name: str) -> dict[str, Any]:
    """The figures of one benchmark, units in the key names; raises UnknownNameError."""
    if name not in BENCHES:
        raise UnknownNameError("benchmark", name, tuple(BENCHES))
    figures: dict[str, Any] = import_module(f"agentface.bench.{name}").run()
    return figures
