"""The head turns about the neck; the compiled form agrees with the numpy one."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from agentface.deform.finish import head_turn
from agentface.deform.finish import head_turn_compiled as compiled
from agentface.parameters import FacePose, parameter
from tests.heads import head_model

TABLES = head_turn.prepare(head_model("amber"))
ANGLES = st.tuples(
    *(st.floats(parameter(name).low, parameter(name).high) for name in ("head_yaw", "head_pitch", "head_roll"))
)


def turned(module, yaw, pitch, roll):
    out = np.full((4, 4), np.nan, np.float32)
    module.apply(TABLES, FacePose.of(head_yaw=yaw, head_pitch=pitch, head_roll=roll).array, out)
    return out


@given(ANGLES)
def test_both_forms_turn_rigidly_about_the_neck(angles):
    matrix = turned(head_turn, *angles)
    np.testing.assert_allclose(turned(compiled, *angles), matrix, atol=2e-7)
    np.testing.assert_allclose(matrix[:3, :3] @ matrix[:3, :3].T, np.eye(3), atol=1e-6)
    assert np.linalg.det(matrix[:3, :3]) == pytest.approx(1.0, abs=1e-5)
    np.testing.assert_allclose(matrix @ [*TABLES.neck, 1.0], [*TABLES.neck, 1.0], atol=2e-7)
    np.testing.assert_array_equal(matrix[3], [0, 0, 0, 1])


@pytest.mark.parametrize("module", [head_turn, compiled])
def test_a_head_that_is_not_turned_stays(module):
    np.testing.assert_array_equal(turned(module, 0, 0, 0), np.eye(4))


@pytest.mark.parametrize("module", [head_turn, compiled])
@pytest.mark.parametrize(
    ("angles", "start", "axis"),
    [((0.5, 0, 0), [0, 0, 1], 0), ((0, 0.5, 0), [0, 0, 1], 1), ((0, 0, 0.5), [0, 1, 0], 0)],
)
def test_positive_angles_turn_left_up_and_tilt_left(module, angles, start, axis):
    """The face looks along +Z, up is +Y, its left is +X."""
    moved = turned(module, *angles)[:3, :3] @ start
    assert moved[axis] == pytest.approx(np.sin(0.5), abs=1e-6)
