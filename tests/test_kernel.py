"""The cache of compiled kernels: it may be missing, full or of another version, and the face works all the same."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from agentface import cache, kernel
from tests.test_imports import inner_imports

STEP = """
import sys
from agentface import Face
face = Face()
face.set_emotion("happiness", 1.0, fade=0)
face.step(0.1)
print("moved", float(abs(face.geometry.vertices - face.model.vertices).max()) > 0.001, "numba" in sys.modules)
"""

KERNELS_OF_TWO_ROOMS = """
import numpy as np
from agentface.emotion.inference_compiled import weigh_all
from agentface.mesh.normals_compiled import write_normals
weights, normals = np.empty((1, 6, 6)), np.empty((3, 3), np.float32)
weigh_all(np.eye(6)[:1], 0.5, weights)
write_normals(np.eye(3, dtype=np.float32), np.array([[0, 1, 2]], np.int32), normals)
print("moved", bool(weights[0, 0, 0] == 1.0 and (normals > 0.5).all()))
"""


def run(program: str, **environment: str) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-W", "error", "-c", program]
    return subprocess.run(
        command, check=False, capture_output=True, text=True, env=os.environ | environment, timeout=3000
    )


@pytest.mark.slow
@pytest.mark.parametrize("variable", ["HOME", "XDG_CACHE_HOME"])
def test_kernels_work_where_nothing_can_be_kept_and_it_is_said_once(tmp_path, variable):
    check_without_cache(KERNELS_OF_TWO_ROOMS, tmp_path, variable)


@pytest.mark.soak
@pytest.mark.parametrize("variable", ["HOME", "XDG_CACHE_HOME"])
def test_a_face_works_where_nothing_can_be_kept_and_says_so_once(tmp_path, variable):
    """Every kernel is compiled, which takes minutes on a busy machine."""
    check_without_cache(STEP, tmp_path, variable)


def check_without_cache(program, tmp_path, variable):
    place = tmp_path / "file"
    place.write_text("")
    done = run(program, **{"XDG_CACHE_HOME": ""} | {variable: str(place)})  # no folder can be made in a file, by nobody
    assert done.returncode == 0, done.stderr
    assert done.stdout.startswith("moved True")
    assert done.stderr.count("nothing can be kept between runs") == 1
    assert len(done.stderr.splitlines()) == 1


def test_numba_may_be_forbidden_to_compile():
    done = run(STEP, NUMBA_DISABLE_JIT="1")
    assert (done.stdout.strip(), done.stderr) == ("moved True False", "")


def test_a_disk_that_fills_loses_the_cache_alone(tmp_path, monkeypatch, caplog):
    monkeypatch.setattr(kernel, "_folder", lambda room: tmp_path)
    monkeypatch.setattr(cache, "_told", set())
    twice = kernel.kernel()(_twice)

    def full(*_: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("numba.core.caching.IndexDataCacheFile.save", full)
    assert twice(4) == 8
    assert twice(0.5) == 1.0
    assert [record.message.count("No space left") for record in caplog.records] == [1]


def test_kernels_are_kept_by_the_sources_they_are_made_of(tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    sources = [tmp_path / "one.py", tmp_path / "two.py"]
    for source in sources:
        source.write_text("STEP = 0.2")
    monkeypatch.setattr(kernel, "_sources", lambda room: iter(sources))
    before = kernel._folder.__wrapped__("deform")
    assert before == kernel._folder.__wrapped__("deform")
    sources[1].write_text("STEP = 0.1")
    after = kernel._folder.__wrapped__("deform")
    assert before != after
    assert before.is_dir()
    assert after.is_dir()


def test_every_source_that_a_kernel_reads_counts():
    package = Path(kernel.__file__).parent
    with_kernels = {path.relative_to(package).parts[0] for path in package.rglob("*_compiled.py")}
    assert with_kernels == set(kernel._READS)
    for room, others in kernel._READS.items():
        sources = set(kernel._sources(room))
        assert {package / "parameters.py", package / "kernel.py"} <= sources
        for read in (room, *others):
            assert set((package / read).rglob("*.py")) <= sources
    assert set(kernel._sources("")) >= {source for room in kernel._READS for source in kernel._sources(room)}


def test_rooms_read_no_others_than_the_table_of_kernels_says():
    rooms = set(kernel._READS)
    for room, other, place in inner_imports():
        if room in rooms and other in rooms:
            assert other in kernel._READS[room], place
    plain = {name.removesuffix(".py") for name in kernel._ABOVE}
    assert not [place for room, other, place in inner_imports() if room in rooms and other in plain]


def test_a_user_s_own_cache_folder_stays_the_user_s():
    import numba

    before = numba.config.CACHE_DIR
    kernel.kernel()(_twice)
    assert before == numba.config.CACHE_DIR


def _twice(number: float) -> float:
    return number + number
