from __future__ import annotations

import os
import sys

import pytest
from hypothesis import settings

from tests.slow import SlowTests
from tests.tools import pytest_make_collect_report, pytest_runtest_makereport  # noqa: F401  # pytest calls them

# The same examples in every run, and no verdict by the clock: a busy machine fails nothing.
settings.register_profile("agentface", deadline=None, derandomize=True, max_examples=50)
settings.register_profile("soak", settings.get_profile("agentface"), max_examples=100)
settings.load_profile("agentface")
_TRACED_IN_CHILDREN = "COVERAGE_PROCESS_CONFIG"


@pytest.fixture(scope="session", autouse=True)
def patient_voices():
    """A voice has as long as it takes: on a busy machine it is late, and no test is about that but those of its end."""
    from agentface.speech.voices import espeak, flite

    with pytest.MonkeyPatch.context() as patched:
        for module in (espeak, flite):
            patched.setattr(module, "TOOL_S", 240.0)
        yield


@pytest.hookimpl(wrapper=True)
def pytest_runtest_protocol(item):
    """Coverage, under which a test takes half as long again, does not watch those marked ``untraced``.

    Nor those of hypothesis: what has examples of its own is run through by some that are written down, too.
    """
    coverage = sys.modules.get("coverage")
    measured = coverage and coverage.Coverage.current()
    if not measured or not any(map(item.get_closest_marker, ("untraced", "hypothesis"))):
        return (yield)
    children = os.environ.pop(_TRACED_IN_CHILDREN, None)
    measured.stop()
    try:
        return (yield)
    finally:
        measured.start()
        if children is not None:
            os.environ[_TRACED_IN_CHILDREN] = children


def pytest_addoption(parser):
    parser.addoption("--regen-goldens", action="store_true", help="Store what is drawn and computed now as right.")
    parser.addoption("--note-slow", action="store_true", help="Write down which of the tests that run now are slow.")


@pytest.hookimpl(tryfirst=True)  # before those that a mark leaves out are left out
def pytest_collection_modifyitems(items):
    slow = SlowTests.noted()
    for item in items:
        if slow.has(item.nodeid):
            item.add_marker(pytest.mark.slow)


def pytest_terminal_summary(terminalreporter, config):
    if config.getoption("--note-slow"):
        reports = [report for kind in terminalreporter.stats.values() for report in kind if hasattr(report, "duration")]
        times = ((report.nodeid, report.when, report.duration) for report in reports)
        SlowTests.measured(times, SlowTests.noted()).note()
