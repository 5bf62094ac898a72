"""What ``make page`` builds of the page: there in a wheel, and in a checkout once it was built."""

from __future__ import annotations

from pathlib import Path

from agentface.errors import OutputError

FOLDER = Path(__file__).parent / "page" / "dist"


def page_file(name: str) -> str:
    """The text of one of the page's files; raises OutputError where it was not built."""
    try:
        return (FOLDER / name).read_text(encoding="utf-8")
    except OSError:
        what = "expected the page of this package, got none; make page builds it"
        raise OutputError(f"{FOLDER / name}: {what}") from None
