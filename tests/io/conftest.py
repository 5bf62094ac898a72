from __future__ import annotations

import sys
from pathlib import Path

import pytest

# The handmade datagrams and documents are modules beside the tests.
sys.path.insert(0, str(Path(__file__).parent))


@pytest.fixture
def desk():
    """Where datagrams are taken in for a face."""
    from osc_desk import Desk

    from tests.heads import head_model

    return Desk(head_model())
