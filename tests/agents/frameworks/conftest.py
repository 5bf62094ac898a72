"""These tests need frameworks that are not in the development environment: only make frameworks collects them."""

from __future__ import annotations


def pytest_ignore_collect(config):
    return None if config.option.markexpr == "frameworks" else True
