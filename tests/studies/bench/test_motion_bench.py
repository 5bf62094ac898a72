from __future__ import annotations

import pytest

from agentface.studies.bench import motion
from tests.heads import head_model

pytestmark = pytest.mark.slow


def test_the_report_has_its_keys_and_every_face_costs_something():
    report = motion.run(head_model(), seconds=2)
    faces = ("still", "told", "living", "all")
    assert set(report) == {
        *(f"{name}_us" for name in faces), *(f"{name}_mean_us" for name in faces),
        "life_us", "life_mean_us", "all_to_told_ratio",
    }  # fmt: skip
    assert all(report[f"{name}_us"] > 0 for name in faces)
