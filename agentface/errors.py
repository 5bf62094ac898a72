"""Everything agentface raises on purpose: one tree, rooted in :class:`AgentFaceError`.

Every message says where the fault is, what was expected, what came, and what to do next.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from difflib import get_close_matches
from pathlib import Path
from typing import NamedTuple, NoReturn


class AgentFaceError(Exception):
    """The root of all errors that agentface raises on purpose."""


@dataclass(frozen=True, slots=True)
class Fault:
    """One thing wrong with one data file.

    ``line`` counts from 1; it is None where a fault has no line (a binary file, a missing file).
    ``where`` is the path inside the document, for example ``muscles.risorius.zone_deg``.
    """

    file: Path
    line: int | None
    where: str
    expected: str
    got: str
    hint: str = ""

    def __str__(self) -> str:
        place = f"{self.file}:{self.line}" if self.line is not None else str(self.file)
        where = f"{self.where}: " if self.where else ""
        hint = f" ({self.hint})" if self.hint else ""
        return f"{place}: {where}expected {self.expected}, got {self.got}{hint}"

    def as_dict(self) -> dict[str, object]:
        """The fault as JSON-ready values."""
        return {**asdict(self), "file": str(self.file)}


class DataError(AgentFaceError):
    """One or more faults in data files (YAML, meshes); ``faults`` holds all of them."""

    def __init__(self, faults: Sequence[Fault]) -> None:
        self.faults = tuple(faults)
        super().__init__("\n".join(str(fault) for fault in self.faults))

    def __reduce__(self) -> tuple[type[DataError], tuple[Sequence[Fault]]]:
        return type(self), (self.faults,)


class FaultList:
    """The faults of one file as a reader finds them; bounded, for a file can have as many as it has bytes.

    Args:
        file: what messages call it.
        most: how many are looked for.
    """

    def __init__(self, file: str | Path, most: int = 20) -> None:
        self.file = Path(file)
        self._most = most
        self._faults: list[Fault] = []

    def tell(self, line: int | None, where: str, expected: str, got: object, hint: str = "") -> None:
        """Note one; raises DataError when there are as many as are looked for."""
        self._faults.append(Fault(self.file, line, where, expected, str(got), hint))
        if len(self._faults) >= self._most:
            self.check()

    def stop(self, line: int | None, where: str, expected: str, got: object, hint: str = "") -> NoReturn:
        """Note one after which nothing can be read; raises DataError."""
        self.tell(line, where, expected, got, hint)
        raise DataError(self._faults)

    def check(self) -> None:
        """Raise DataError when there is any."""
        if self._faults:
            raise DataError(sorted(self._faults, key=lambda fault: fault.line or 0))

    def __bool__(self) -> bool:
        return bool(self._faults)


class UnknownNameError(AgentFaceError, KeyError):
    """A name that the registry, the rules or the face does not have."""

    def __init__(self, kind: str, got: object, known: Sequence[str]) -> None:
        self.kind, self.got, self.known = kind, got, tuple(known)
        self.hint = did_you_mean(got, known)
        super().__init__(f"expected the name of one {kind}, got {got!r}; {self.hint}")

    def __str__(self) -> str:  # KeyError would print the repr
        return str(self.args[0])

    def __reduce__(self) -> tuple[type[UnknownNameError], tuple[str, object, Sequence[str]]]:
        return type(self), (self.kind, self.got, self.known)


class Place(NamedTuple):
    """Where in a face's folder a value stands: its file, and the keys and numbers that lead to it in there."""

    file: str
    where: tuple[str | int, ...] = ()

    def __str__(self) -> str:
        return ": ".join(filter(None, (self.file, ".".join(map(str, self.where)))))


class InvalidValueError(AgentFaceError, ValueError):
    """A value of the wrong type, shape or range; ``place`` is where in a face's files it stands, if it does."""

    def __init__(
        self, where: str | Place, expected: str, got: object, hint: str = "", place: Place | None = None
    ) -> None:
        self.where, self.expected, self.got, self.hint = str(where), expected, got, hint
        self.place = where if isinstance(where, Place) else place
        tail = f"; {hint}" if hint else ""
        super().__init__(f"{where}: expected {expected}, got {got!r}{tail}")

    def __reduce__(self) -> tuple[type[InvalidValueError], tuple[str, str, object, str, Place | None]]:
        return type(self), (self.where, self.expected, self.got, self.hint, self.place)


class GraphicsError(AgentFaceError):
    """No picture can be made: no OpenGL on the machine, no display, or a shader that does not compile."""


class OutputError(AgentFaceError):
    """A file that cannot be written."""


class SpeechError(AgentFaceError):
    """No voice, no recogniser or no way to hear it on this machine, or one that fails."""


class ServerError(AgentFaceError):
    """A server that cannot start, for example because its port is taken."""


class MissingPackageError(AgentFaceError, ImportError):
    """A Python package that what was asked for needs, and the extra of agentface that brings it."""

    def __init__(self, package: str, extra: str, purpose: str) -> None:
        self.package, self.extra, self.purpose = package, extra, purpose
        text = f"expected the Python package {package}, got none; {purpose}"
        super().__init__(f'{text}\nInstall the extra that has it:  pip install "agentface[{extra}]"')

    def __reduce__(self) -> tuple[type[MissingPackageError], tuple[str, str, str]]:
        return type(self), (self.package, self.extra, self.purpose)


def shown(text: str, longest: int = 40) -> str:
    """What came, as a message quotes it: in quotes, printable, and not too long."""
    return repr(text) if len(text) <= longest else f"{text[: longest - 3]!r}..."


def did_you_mean(got: object, known: Sequence[str]) -> str:
    """A hint that names the nearest known names, or all of them when none is near."""
    near = get_close_matches(str(got), known, n=3)
    if near:
        return f"did you mean {' or '.join(near)}?"
    return f"known: {', '.join(known)}"
