"""Where a face comes from: the table of its ``PROVENANCE.md``."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

_FILE = "PROVENANCE.md"
_LARGEST = 1 << 20
_COLUMNS = 3
_FREE = ("CC0",)
_PERMISSIVE = (*_FREE, "MIT", "Apache", "BSD", "ISC", "public domain")


@dataclass(frozen=True)
class Origin:
    """One row: what of the face it is, where it was taken from, and under which licence."""

    what: str
    source: str
    licence: str


@dataclass(frozen=True)
class Provenance:
    """Rows of a face's table; none where it has no such file, or one without a table."""

    origins: tuple[Origin, ...]

    @property
    def licences(self) -> tuple[str, ...]:
        """The licences, each once."""
        return tuple(dict.fromkeys(origin.licence for origin in self.origins))

    @property
    def permissive(self) -> bool:
        """Whether all of it may be changed, sold and passed on."""
        return bool(self.origins) and all(licence.startswith(_PERMISSIVE) for licence in self.licences)

    @property
    def needs_credit(self) -> bool:
        """Whether any of it has to be passed on with a notice."""
        return not self.origins or not all(licence.startswith(_FREE) for licence in self.licences)

    @property
    def copyright_line(self) -> str:
        """One line for a file that has room for one."""
        if not self.origins:
            return "origin not stated"
        return "; ".join(f"{origin.what}: {origin.source} ({origin.licence})" for origin in self.origins)


def read_provenance(folder: str | Path) -> Provenance:
    """The provenance of the face in ``folder``; without rows where nothing can be read."""
    path = Path(folder) / _FILE
    try:
        if path.stat().st_size > _LARGEST:
            return Provenance(())
        lines = path.read_text(encoding="utf-8", errors="replace").splitlines()
    except OSError:
        return Provenance(())
    rows = [[cell.strip() for cell in line.strip("| ").split("|")] for line in lines if line.startswith("|")]
    # the first row has the names of the columns, the second one is a rule
    found = [Origin(*row) for row in rows[2:] if len(row) == _COLUMNS and all(row)]
    return Provenance(tuple(found))
