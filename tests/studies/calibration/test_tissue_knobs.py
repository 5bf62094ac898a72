from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from agentface.studies.calibration.tissue_knobs import knobs, turned, values_of
from agentface.tissue.reading import anatomy_file, read_tissue
from agentface.tissue.tissue_file import TISSUE_MUSCLES, LinearRow

ROWS = read_tissue(anatomy_file()).muscles
PARTS = st.lists(st.floats(0.0, 1.0), min_size=10, max_size=10)


@pytest.mark.parametrize("name", TISSUE_MUSCLES)
def test_the_anatomists_values_are_within_their_ranges_and_come_back(name):
    row = ROWS[name]
    its_knobs = knobs(row)
    values = values_of(row, its_knobs)
    assert all(knob.low <= value <= knob.high for knob, value in zip(its_knobs, values, strict=True))
    assert turned(row, its_knobs, values, row.strength) == row
    assert len({knob.where for knob in its_knobs}) == len(its_knobs)


@pytest.mark.parametrize("name", TISSUE_MUSCLES)
@given(parts=PARTS, strength=st.floats(0.01, 100.0), digits=st.sampled_from([4, 12]))
def test_wherever_the_knobs_stand_the_row_is_valid_and_says_so(name, parts, strength, digits):
    row = ROWS[name]
    its_knobs = knobs(row)
    low, high = np.array([[knob.low, knob.high] for knob in its_knobs]).T
    values = low + (high - low) * np.array(parts[: len(its_knobs)])
    made = turned(row, its_knobs, values, strength, digits)
    assert made.strength == pytest.approx(strength, abs=10.0**-digits)
    back = values_of(made, its_knobs)
    free = [knob.where[0] not in ("fall_start", "fall_finish") for knob in its_knobs]
    np.testing.assert_allclose(back[free], values[free], atol=10.0**-digits)
    assert (back >= values - 10.0**-digits).all(), "the others are only pushed apart"
    if isinstance(made, LinearRow):
        assert made.fall_near < made.fall_start < made.fall_finish
    keep = {"kind", "regions", "not_regions", "fade", "moved_by", "action_unit"}
    assert made.model_dump(include=keep) == row.model_dump(include=keep)
    assert turned(made, its_knobs, back, made.strength, digits) == made, "round trip"


def test_a_muscle_stays_near_where_the_anatomist_has_it():
    row = ROWS["zygomaticus_major"]
    reach = {knob.where: knob.high - knob.low for knob in knobs(row)}
    assert all(reach["origin", "offset", axis] == pytest.approx(0.8) for axis in range(3))
    assert all(reach["insertion", "offset", axis] == pytest.approx(0.5) for axis in range(3))
    sphincter = ROWS["orbicularis_oris"]
    assert all(knob.where != ("centre", "offset", 0) for knob in knobs(sphincter)), "it stays in the middle"
