"""A child process that answers requests over its pipes, as long as we live."""

from __future__ import annotations

import json
import os
import select
import signal
import struct
import subprocess
import sys
import threading
import time
from contextlib import suppress
from pathlib import Path
from typing import Any

from agentface.errors import SpeechError

_MOST_JSON, _MOST_SAMPLES = 1 << 20, 1 << 24


class Child:
    """Runs a script of Python as a process of its own when it is first asked, and anew after a fault.

    The process ends with its standard input: with :meth:`close`, with this object, and when we are killed.
    """

    def __init__(self, script: str | Path, name: str) -> None:
        self._script, self._name = script, name
        self._process: subprocess.Popen[bytes] | None = None
        self._lock = threading.Lock()

    def ask(self, request: dict[str, Any], timeout_s: float) -> tuple[dict[str, Any], bytes]:
        """The answer to ``request``, and the bytes of its ``samples``; raises SpeechError, in time."""
        with self._lock:
            try:
                return self._asked(request, time.monotonic() + timeout_s)
            except (OSError, ValueError, struct.error, KeyError, TypeError) as error:
                self._end()
                expected = f"expected an answer of the process that runs {self._name}"
                raise SpeechError(f"{expected}, got {error}; it was ended") from error

    def close(self) -> None:
        """End the process, also while it is asked; may be called twice."""
        process = self._process
        if process is not None:
            _kill(process)
        with self._lock:
            self._end()

    @property
    def pid(self) -> int | None:
        """The number of the process while there is one."""
        return None if self._process is None else self._process.pid

    def _asked(self, request: dict[str, Any], end: float) -> tuple[dict[str, Any], bytes]:
        if self._process is None or self._process.poll() is not None:
            self._end()
            self._process = subprocess.Popen(  # noqa: S603 - our own script
                [sys.executable, "-I", "-S", str(self._script)],
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=subprocess.DEVNULL,
                start_new_session=True,
                bufsize=0,
            )
        content = json.dumps(request).encode()
        assert self._process.stdin is not None  # noqa: S101 - for the type checker
        self._process.stdin.write(struct.pack("<I", len(content)) + content)
        length = struct.unpack("<I", self._read(4, end))[0]
        if length > _MOST_JSON:
            raise ValueError(f"{length} bytes before the sound")
        answer = json.loads(self._read(length, end))
        count = answer.get("samples", 0) if isinstance(answer, dict) else None
        if not isinstance(count, int) or not 0 <= count <= _MOST_SAMPLES:
            raise ValueError("something else")
        return answer, self._read(2 * count, end)

    def _read(self, count: int, end: float) -> bytes:
        assert self._process is not None and self._process.stdout is not None  # noqa: S101, PT018 - for the type checker
        pipe, found = self._process.stdout.fileno(), bytearray()
        while len(found) < count:
            if not select.select([pipe], [], [], max(0.0, end - time.monotonic()))[0]:
                raise ValueError("nothing in a few seconds")
            piece = os.read(pipe, min(count - len(found), 1 << 16))
            if not piece:
                raise ValueError("its end")
            found += piece
        return bytes(found)

    def _end(self) -> None:
        process, self._process = self._process, None
        if process is None:
            return
        _kill(process)
        for pipe in (process.stdin, process.stdout):
            if pipe is not None:
                pipe.close()
        process.wait()


def _kill(process: subprocess.Popen[bytes]) -> None:
    with suppress(ProcessLookupError, PermissionError):
        os.killpg(process.pid, signal.SIGKILL)
