from __future__ import annotations

import numpy as np
import pytest

from agentface.arkit.stream import ArkitStream
from agentface.io.performances.live_link import write_live_link
from agentface.io.performances.openface import write_openface
from agentface.io.performances.poses_json import write_json
from agentface.io.performances.poses_npz import write_npz
from agentface.io.performances.unit_stream import ActionUnitStream
from agentface.motion.performance import Performance
from agentface.mpeg4.fap_file import write_fap
from agentface.mpeg4.fap_stream import FapStream
from agentface.parameters import COUNT, HIGH, LOW, indices_of

EMOTIONML = (
    '<emotionml version="1.0" xmlns="http://www.w3.org/2009/10/emotionml"'
    ' category-set="http://www.w3.org/TR/emotion-voc/xml#big6">\n'
    '<emotion duration="500"><category name="surprise" value="0.5"/></emotion>\n</emotionml>\n'
)
PY_FEAT = (
    "FaceRectX,FaceScore,Pitch,Roll,Yaw,AU01,AU12,AU43,anger,input,frame\n"
    '1.5,0.99,-3.5,2.0,10.0,0.25,0.5,0.0,0.1,"a,b.mp4",0\n'
    '1.5,0.99,-3.5,2.0,20.0,0.5,0.75,0.0,0.1,"a,b.mp4",1\n'
)


def some_performance(count=3):
    rng = np.random.default_rng(1)
    weights = np.zeros((1, COUNT), np.float32)
    used = [*indices_of("zygomaticus_major"), *indices_of("jaw_open"), *indices_of("head_yaw")]
    weights[:, used] = 1.0
    poses = (LOW + rng.uniform(size=(count, COUNT)) * (HIGH - LOW)).astype(np.float32).clip(LOW, HIGH)
    return Performance.regular(30.0, np.where(weights > 0, poses, np.float32(0)), weights, name="a nod")


def some_stream(count=3):
    rng = np.random.default_rng(2)
    numbers = rng.uniform(size=(4, count, 3)).astype(np.float32)
    return ActionUnitStream(np.arange(count) / 30, (1, 12, 26), numbers[0], numbers[1] - 0.5, 0.4 * numbers[2, :, :2])


def some_weights(count=3):
    rng = np.random.default_rng(3)
    return ArkitStream(np.arange(count) / 60, rng.uniform(size=(count, 52)), rng.normal(size=(count, 9)), 60.0, "take")


def good_files():
    """A good file of each kind, as bytes, by the kind's name."""
    faps = FapStream.measured(np.random.default_rng(0).integers(-99, 99, (3, 68)), 25, "a b\\c.fap")
    return {
        "fap": write_fap(faps).encode(),
        "emotionml": EMOTIONML.encode(),
        "openface": write_openface(some_stream()).encode(),
        "py-feat": PY_FEAT.encode(),
        "live-link": write_live_link(some_weights()).encode(),
        "poses-json": write_json(some_performance()).encode(),
        "poses-npz": write_npz(some_performance()),
    }


GOOD = good_files()


@pytest.fixture(params=GOOD)
def kind(request):
    return request.param
