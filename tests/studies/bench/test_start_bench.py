import pytest

from agentface.studies.bench import start

pytestmark = [pytest.mark.gl, pytest.mark.slow, pytest.mark.untraced]


def test_starts_are_measured_beside_the_imports():
    report = start.run(rounds=1)
    assert report["rounds"] == 1
    assert report["render_to_imports_ratio"] == pytest.approx(report["render_cpu_ms"] / report["imports_cpu_ms"])
    figures = ("render_cpu_ms", "imports_cpu_ms", "first_face_cpu_ms", "second_face_cpu_ms")
    assert all(report[name] > 0 for name in figures)
