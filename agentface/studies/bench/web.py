"""A face in pages: how true its frames are, what they weigh, what they cost, and how late they come."""

from __future__ import annotations

import json
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial
from typing import Any

import numpy as np

from agentface.clock import SystemClock
from agentface.conventions import Doubles, Floats
from agentface.deform.crowd import Crowd
from agentface.deform.protocol import DEFAULT_DEFORMER
from agentface.errors import ServerError
from agentface.face import Face
from agentface.io.web.frames import MODES, FrameReader, FrameWriter, Mode
from agentface.io.web.poses import natural_poses, random_mixtures
from agentface.io.web.server import WebServer
from agentface.io.web.stage import basis_of
from agentface.live.loop import Frame
from agentface.live.loop import run as run_loop
from agentface.resources import DEFAULT_FACE
from agentface.studies.bench.timing import interleave

HZ = 60.0
_SEED = 1414
_ROUNDS = 200
_PAGES = 20
_SECONDS = 4.0
_TIMEOUT_S = 120.0
_HEADER_BYTES = 1 + 4
"""The kind of a message, and what a WebSocket puts before one of this length."""
_PAGE_PROGRAM = """
import asyncio, json, struct, sys, time
from websockets.asyncio.client import connect

async def page(url, until):
    came = []
    async with connect(url, proxy=None, max_queue=1024) as line:
        await line.recv()
        print("ready", flush=True)
        while True:
            try:
                message = await asyncio.wait_for(line.recv(), until)
            except Exception:  # the server has ended
                return came
            if isinstance(message, bytes):
                number = struct.unpack_from("<I", message, 1)[0]
                came.append((number, time.monotonic(), len(message)))
                await line.send('{"ack": %d}' % number)

async def main(url, count, until):
    print(json.dumps(await asyncio.gather(*(page(url, until) for _ in range(count)))))

asyncio.run(main(sys.argv[1], int(sys.argv[2]), float(sys.argv[3])))
"""


def run(face: str = DEFAULT_FACE, deformer_name: str = DEFAULT_DEFORMER, count: int = 200) -> dict[str, Any]:
    """``basis``, the modes and their bytes; ``errors``; ``frame``, bytes and times; ``pages``, of a live server.

    ``errors`` are those of all vertices of skin and tongue, in the head's axes, against the deformer's, of ``count``
    poses each that the basis was not made of: ``natural``, emotions with visemes, gaze, blinks, gestures and a turned
    head, and ``random``, of any parameters. ``bytes_a_second`` counts what a WebSocket adds, at 60 frames a second.
    ``pages``: what of a processor a page costs and how many would fill one, by the time that the server's process is
    at work; ``late_ms`` is from a frame that is there to its arrival in another process, on a machine that may be busy.
    """
    shown = Face(face, deformer=deformer_name, liveliness=1.0)
    basis = basis_of(shown, deformer_name)
    writer = FrameWriter(shown.model, basis)
    figures: dict[str, Any] = {
        "basis": {"skin_modes": len(basis.skin.scales), "tongue_modes": len(basis.tongue.scales)},
        "errors": _errors(shown, deformer_name, writer, basis, count),
        "frame": _frame(shown, writer),
        "pages": _pages(shown, basis),
    }
    figures["basis"]["bytes"] = basis.skin.shapes.nbytes + basis.tongue.shapes.nbytes
    shown.close()
    return figures


def _errors(shown: Face, deformer: str, writer: FrameWriter, basis: Any, count: int) -> dict[str, Any]:
    rng = np.random.default_rng(_SEED)
    kinds = {
        "natural": natural_poses(shown.model, count, rng, head=True),
        "random": random_mixtures(count, rng),
    }
    told: dict[str, Any] = {}
    with Crowd(shown.model, deformer=deformer) as crowd:
        for mode in MODES:
            reader = FrameReader(shown.model, basis, writer.layouts[mode])
            told[mode] = {kind: _told(_off(crowd, writer, reader, mode, poses)) for kind, poses in kinds.items()}
    return told


def _off(crowd: Crowd, writer: FrameWriter, reader: FrameReader, mode: Mode, poses: Floats) -> Doubles:
    """``(B, V + T)`` mm."""
    rows = []
    for pose in poses:
        geometry = crowd.deform(pose[None])[0]
        _, skin, tongue = reader.read(writer.write(mode, 0, 0.0, geometry))
        off = np.concatenate([skin - geometry.vertices, tongue - geometry.tongue])
        rows.append(1000.0 * np.linalg.norm(off.astype(np.float64), axis=1))
    return np.array(rows)


def _told(errors: Doubles) -> dict[str, float]:
    return {
        "rms_mm": float(np.sqrt((errors**2).mean())),
        "worst_frame_rms_mm": float(np.sqrt((errors**2).mean(axis=1)).max()),
        "p99_9_mm": float(np.quantile(errors, 0.999)),
        "max_mm": float(errors.max()),
    }


def _frame(shown: Face, writer: FrameWriter) -> dict[str, Any]:
    geometry = shown.step(1.0 / HZ)
    sizes = {mode: len(writer.write(mode, 0, 0.0, geometry)) for mode in MODES}
    times = interleave({mode: partial(writer.write, mode, 0, 0.0, geometry) for mode in MODES}, _ROUNDS)
    return {
        mode: {
            "bytes": sizes[mode],
            "bytes_a_second": round(HZ * (sizes[mode] + _HEADER_BYTES - 1)),
            "encode_us": times[mode],
        }
        for mode in MODES
    }


class _Noted:
    """A sink that notes when each frame was there, beside the server's."""

    def __init__(self) -> None:
        self.at: list[float] = []

    def show(self, _: Frame) -> None:
        self.at.append(time.monotonic())


def _pages(shown: Face, basis: Any) -> dict[str, Any]:
    alone, _, _ = _served(shown, basis, 0)
    work, at, came = _served(shown, basis, _PAGES)
    frames = sum(map(len, came))
    late = [1000.0 * (when - at[number - 1]) for rows in came for number, when, _ in rows if number <= len(at)]
    a_page = (work - alone) / max(frames, 1)
    return {
        "pages": _PAGES,
        "frames_shown": len(at),
        "frames_come_of_all": frames / (_PAGES * len(at)),
        "server_us_a_frame": 1e6 * alone / max(len(at), 1),
        "page_us_a_frame": 1e6 * a_page,
        "pages_on_one_core": (1.0 / HZ - alone / len(at)) / a_page,
        "late_ms": {"p50": float(np.median(late)), "p99": float(np.quantile(late, 0.99))},
    }


def _served(shown: Face, basis: Any, pages: int) -> tuple[float, list[float], list[list[tuple[int, float, int]]]]:
    """Seconds of work of this process, when frames were there, and what came to each page."""
    noted = _Noted()
    with (
        WebServer(shown, port=0, encode=lambda *_: b"", measure=lambda *_: basis) as server,
        _looking(f"ws://127.0.0.1:{server.port}/live", pages) as child,
    ):
        start = time.process_time()
        run_loop(shown, SystemClock(), [server], [noted, server], fps=HZ, duration=_SECONDS)
        work = time.process_time() - start
    return work, noted.at, _answer(child) if child is not None else []


@contextmanager
def _looking(url: str, pages: int) -> Iterator[subprocess.Popen[str] | None]:
    """So many pages in a process of their own, all of them connected."""
    if not pages:
        yield None
        return
    words = [sys.executable, "-c", _PAGE_PROGRAM, url, str(pages), str(_TIMEOUT_S)]
    child = subprocess.Popen(words, stdout=subprocess.PIPE, text=True)  # noqa: S603  # our own program
    try:
        for _ in range(pages):
            if child.stdout is None or child.stdout.readline() != "ready\n":
                raise ServerError("web benchmark: expected pages that connect, got none")
        yield child
    except BaseException:
        child.kill()
        raise


def _answer(child: subprocess.Popen[str]) -> list[list[tuple[int, float, int]]]:
    text, _ = child.communicate(timeout=_TIMEOUT_S)
    found: list[list[tuple[int, float, int]]] = json.loads(text)
    return found
