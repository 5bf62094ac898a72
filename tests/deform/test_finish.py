"""The last part by itself: a deformer that only moves the skin gets of it what the geometric face gets."""

from __future__ import annotations

import numpy as np
import pytest

from agentface.deform.finish.finish import Finish
from agentface.deform.geometry import FaceArrays
from agentface.deform.order import Stage
from agentface.parameters import FacePose
from tests.heads import deformer_of, head_model

POSE = FacePose.of(
    frontalis_medialis=1.0,
    jaw_open=0.4,
    gaze_yaw=0.2,
    head_yaw=0.4,
    head_roll=-0.1,
    tongue_out=0.5,
    pupil_dilation=0.5,
    eye_thrust=0.5,
    breath=0.5,
)


@pytest.mark.parametrize("compiled", [False, True])
def test_a_skin_is_finished_as_the_geometric_face_s(compiled):
    deformer, model = deformer_of(compiled=compiled), head_model()
    expected, geometry = deformer.at(POSE), deformer.at(FacePose())
    stages = deformer.stages(geometry)
    for name in ("muscles", *(stage.name.lower() for stage in Stage), "copy"):
        stages[name](POSE)
    assert geometry != expected
    Finish(model, compiled=compiled).apply(POSE.array, geometry)
    assert geometry == expected


def test_every_last_stage_adds_its_part():
    geometry = deformer_of().at(FacePose())
    before = geometry.copy()
    Finish(head_model()).apply(POSE.array, geometry)
    for name, was, now in zip(FaceArrays._fields, before.arrays(), geometry.arrays(), strict=True):
        assert not np.array_equal(was, now), name
