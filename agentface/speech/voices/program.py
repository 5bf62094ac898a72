"""A program that is run for a moment: bounded in time and in what it says, and gone when we are."""

from __future__ import annotations

import os
import select
import shutil
import signal
import subprocess
import time
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path

from agentface.errors import SpeechError

_MOST_BYTES = 1 << 20


def run_program(command: Sequence[str], folder: str | Path, timeout_s: float) -> str:
    """What ``command`` prints within ``timeout_s``, run in ``folder``; raises SpeechError when it fails or hangs.

    It and what it has started are killed at the end, and, where the machine has setpriv (util-linux), also when this
    process is killed.
    """
    name = Path(command[0]).name
    bound = shutil.which("setpriv")
    tied = [bound, "--pdeathsig", "KILL", "--", *command] if bound else list(command)
    try:
        with subprocess.Popen(  # noqa: S603 - a list of arguments, no shell
            tied,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            cwd=folder,
            start_new_session=True,
            bufsize=0,
        ) as program:
            try:
                said = _said(program, time.monotonic() + timeout_s)
            finally:
                with suppress(ProcessLookupError, PermissionError):
                    os.killpg(program.pid, signal.SIGKILL)
    except OSError as error:
        raise SpeechError(f"expected the program {name} to start, got: {error.strerror or error}") from error
    if said is None:
        raise SpeechError(f"expected {name} to be done in a few seconds, got no end of it; it was killed")
    if program.returncode not in (0, -signal.SIGKILL):
        raise SpeechError(f"expected {name} to succeed, got exit code {program.returncode}")
    return said.decode("utf-8", "replace")


def _said(program: subprocess.Popen[bytes], end: float) -> bytes | None:
    """All that it prints until it ends; None when that is too much, or takes too long."""
    assert program.stdout is not None  # noqa: S101 - for the type checker
    pipe, said = program.stdout.fileno(), b""
    while (left := end - time.monotonic()) > 0.0:
        if not select.select([pipe], [], [], left)[0]:
            return None
        piece = os.read(pipe, 65536)
        said += piece
        if len(said) > _MOST_BYTES:
            return None
        if not piece:
            with suppress(subprocess.TimeoutExpired):
                program.wait(max(0.0, end - time.monotonic()))
                return said
            return None
    return None
