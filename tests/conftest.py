from __future__ import annotations

from hypothesis import settings

from tests.tools import pytest_make_collect_report, pytest_runtest_makereport  # noqa: F401  # pytest calls them

# The same examples in every run, and no verdict by the clock: a busy machine fails nothing.
settings.register_profile("agentface", deadline=None, derandomize=True)
settings.load_profile("agentface")


def pytest_addoption(parser):
    parser.addoption("--regen-goldens", action="store_true", help="Store what is drawn and computed now as right.")
