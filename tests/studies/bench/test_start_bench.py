import pytest

from agentface.studies.bench import start

pytestmark = [pytest.mark.gl, pytest.mark.slow]


def test_starts_are_measured_beside_the_imports():
    report = start.run(rounds=1)
    assert report["rounds"] == 1
    assert report["render_to_imports_ratio"] == pytest.approx(report["render_cpu_ms"] / report["imports_cpu_ms"])
    assert report["render_cpu_ms"] > report["imports_cpu_ms"] > 0  # it imports all but one of them itself
    assert report["first_face_cpu_ms"] >= report["second_face_cpu_ms"] > 0
