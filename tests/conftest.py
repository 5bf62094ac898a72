from __future__ import annotations

import pytest
from hypothesis import settings

from tests import heads

# The same examples in every run, and no verdict by the clock: a busy machine fails nothing.
settings.register_profile("agentface", deadline=None, derandomize=True)
settings.load_profile("agentface")


def pytest_addoption(parser):
    parser.addoption("--regen-goldens", action="store_true", help="Store what is drawn and computed now as right.")


@pytest.fixture(scope="session", autouse=True)
def read_once():
    """Every face of a process takes the model, and every deformer the tables, that the first one made."""
    with pytest.MonkeyPatch.context() as patch:
        for module in ("agentface.head.model", "agentface.face"):
            patch.setattr(f"{module}.load_model", heads.uneven_model)
        patch.setattr("agentface.deform.tables.prepare", heads.tables)
        yield
