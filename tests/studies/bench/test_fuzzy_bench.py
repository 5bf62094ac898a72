from __future__ import annotations

import json

import pytest

from agentface.studies.bench.fuzzy import run

pytestmark = pytest.mark.slow


def test_the_benchmark_compares_equal_results():
    figures = json.loads(json.dumps(run(states=1)))
    assert figures.keys() == {"ours_us", "skfuzzy_us", "speedup_ratio", "states", "max_abs_difference"}
    assert figures["max_abs_difference"] < 1e-9
