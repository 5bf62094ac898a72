import numpy as np
import pytest

from agentface.bench import deform, plain
from agentface.deform.combine import STEP, parallel
from tests.deform.rig import make_rig


def test_the_report_has_its_keys_and_positive_numbers():
    report = deform.run(make_rig(), rounds=2)
    for name in ("active_8", "active_all"):
        keys = {f"{way}_us" for way in ("ours", "ours_warm", "loop", "cutoff", "gemv", "gemv_warm", "copy")}
        ratios = {"ours_to_gemv_ratio", "ours_to_gemv_warm_ratio", "loop_to_ours_ratio", "cutoff_to_ours_ratio"}
        assert set(report[name]) == keys | ratios
        assert all(value > 0 for value in report[name].values())


def test_the_expression_of_the_report_has_eight_muscles():
    names = [name for name in make_rig().muscles.names if name[:-2] in deform.SMILE]
    assert len(names) == len(set(names)) == 8


def test_the_plain_loop_computes_what_the_muscles_do_without_their_reach():
    face = make_rig(falloff="waters")
    levels = np.zeros(len(face.muscles))
    levels[[0, 5, 20]] = [1.0, 0.5, 0.3]
    moved, change = np.empty(face.vertices.shape), np.empty(face.vertices.shape)
    flags = np.full(len(levels), -1)
    constants = plain.constants(face.muscles)
    plain.contract(face.vertices, moved, change, constants, levels, STEP, face.regions.region_of, flags)
    everywhere = type(face.muscles)(
        **{name: getattr(face.muscles, name) for name in face.muscles.__slots__ if name != "reach"},
        reach=np.ones_like(face.muscles.reach),
    )
    assert moved == pytest.approx(parallel(face.vertices, everywhere, levels), abs=1e-12)
