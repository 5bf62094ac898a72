"""How long it takes until there is a picture: whole commands and first faces, beside importing the libraries alone."""

from __future__ import annotations

import json
import os
import resource
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory
from typing import Any

from agentface.deform.protocol import DEFAULT_DEFORMER
from agentface.resources import DEFAULT_FACE

LIBRARIES = ("numpy", "numba", "moderngl", "pydantic", "PIL.Image", "yaml", "click")
"""What a program with such a face could not do without."""
_IMPORTS = f"import {', '.join(LIBRARIES)}"
_FACES = f"""{_IMPORTS}, agentface.face, agentface.deform.order_compiled, json, sys, time
times = []
for _ in range(2):
    start = time.process_time()
    agentface.face.Face(sys.argv[1], deformer=sys.argv[2]).warm_up()
    times.append(time.process_time() - start)
print(json.dumps(times))
"""


def run(face: str | Path = DEFAULT_FACE, rounds: int = 5, deformer_name: str = DEFAULT_DEFORMER) -> dict[str, Any]:
    """Medians over interleaved rounds, processor time of whole processes from warm caches, and their ratio.

    ``imports`` imports :data:`LIBRARIES`, ``render`` is ``agentface render``, a fast picture of 1280 x 720. In a
    process that has imported everything, ``first_face`` makes a ``Face`` and warms it up, ``second_face`` another.
    """
    choice = "--face", str(face), "--deformer", deformer_name
    with TemporaryDirectory() as folder:
        render = ("-m", "agentface", "render", *choice, "-o", str(Path(folder, "face.png")))
        programs: dict[str, Sequence[str]] = {"imports": ("-c", _IMPORTS), "render": render}
        for words in programs.values():
            _cpu_ms(words)  # fills the caches
        _faces(face, deformer_name)
        cpu: dict[str, list[float]] = {name: [] for name in programs}
        faces: list[list[float]] = []
        for _ in range(rounds):
            for name, words in programs.items():
                cpu[name].append(_cpu_ms(words))
            faces.append(_faces(face, deformer_name))
    times = {name: median(values) for name, values in cpu.items()}
    first, second = (median(row) for row in zip(*faces, strict=True))
    return {
        "rounds": rounds,
        "imports_cpu_ms": times["imports"],
        "render_cpu_ms": times["render"],
        "render_to_imports_ratio": times["render"] / times["imports"],
        "first_face_cpu_ms": 1000.0 * first,
        "second_face_cpu_ms": 1000.0 * second,
    }


def _faces(face: str | Path, deformer_name: str) -> list[float]:
    times: list[float] = json.loads(_python(("-c", _FACES, str(face), deformer_name)))
    return times


def _cpu_ms(words: Sequence[str]) -> float:
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    _python(words)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return 1000.0 * (after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime)


def _python(words: Sequence[str]) -> str:
    # a user's Python keeps its bytecode, whatever this process was told
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
    command = [sys.executable, *words]
    return subprocess.run(command, check=True, capture_output=True, text=True, env=environment).stdout  # noqa: S603
