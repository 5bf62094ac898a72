"""The standard streams, which may be closed, full, or gone with their terminal."""

from __future__ import annotations

import io
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from typing import TYPE_CHECKING, Any

import click

if TYPE_CHECKING:
    from rich.console import Console


class StandardOutputError(OSError):
    """The standard output that cannot be written; from then on what is written to it is lost."""


def watch_output() -> None:
    """Let a standard output that cannot be written raise StandardOutputError.

    A program that was started without one gets one that cannot be written: its number would else go to the next file
    that is opened.
    """
    text: Any = sys.stdout
    file = _Output(os.open(os.devnull, os.O_RDONLY) if text is None else text.fileno(), "w", closefd=False)
    how: dict[str, Any] = {"encoding": "utf-8", "errors": "replace"}
    if text is not None:
        how = {name: getattr(text, name) for name in ("encoding", "errors", "line_buffering", "write_through")}
    sys.stdout = io.TextIOWrapper(io.BufferedWriter(file), **how)


@contextmanager
def output_told() -> Iterator[None]:
    """End the program with code 1 and one line when, in the block, the standard output cannot be written."""
    try:
        yield
        if sys.stdout is not None:
            sys.stdout.flush()
    except StandardOutputError as error:
        _output_failed(error)
        raise SystemExit(1) from None


def say(message: str) -> None:
    """Print what a program that runs on need not have said: where that fails, one line on the standard error."""
    try:
        click.echo(message)
    except StandardOutputError as error:
        _output_failed(error)


def tell(message: str) -> None:
    """Print to the standard error, if there is still one."""
    with suppress(OSError):
        click.echo(message, err=True)


def console() -> Console:
    """For progress, on the standard error; a terminal that goes away stops nothing."""
    from rich.console import Console

    return Console(file=_Terminal())  # type: ignore[arg-type]  # all of a file that a console uses


def _output_failed(error: OSError) -> None:
    reason = f"expected to write it, got: {error.strerror}; give it a file or a program that takes all of it"
    tell(f"agentface: standard output: {reason}")


class _Output(io.FileIO):
    """The file behind the standard output."""

    _lost = False

    def write(self, content: Any) -> int:
        if self._lost:  # the rest, which Python writes when it ends, has been told already
            return memoryview(content).nbytes
        try:
            return super().write(content)
        except OSError as error:
            self._lost = True
            raise StandardOutputError(error.errno, error.strerror) from error


class _Terminal:
    """The standard error; what it does not take is lost."""

    def write(self, text: str) -> int:
        if sys.stderr is not None:
            with suppress(OSError, ValueError):
                sys.stderr.write(text)
        return len(text)

    def flush(self) -> None:
        if sys.stderr is not None:
            with suppress(OSError, ValueError):
                sys.stderr.flush()

    def __getattr__(self, name: str) -> Any:
        return getattr(sys.stderr, name)
