"""The CC0 base mesh, from which faces are made: fetched once, 48 MB, and kept in the user's cache folder."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import pytest

from agentface.errors import DataError
from agentface.head.build.head import HeadTopology
from agentface.head.build.source import BaseMesh, fetch, source_folder


def base_mesh() -> Path:
    """Its data folder. Where it cannot be had, the test is skipped, which AGENTFACE_REQUIRE_TOOLS=1 makes a failure."""
    try:
        return fetch(source_folder())
    except DataError as error:
        pytest.skip(str(error))


@cache
def topology() -> HeadTopology:
    """What all faces of the base mesh share; it takes three seconds."""
    return HeadTopology(BaseMesh(base_mesh()))
