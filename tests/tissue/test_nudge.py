"""The skull nudged by hand: where it lies then, what the tissue makes of it, and that a file keeps all else."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from agentface.head.model import HeadModel
from agentface.parameters import FacePose
from agentface.tissue.columns import coloured, pack
from agentface.tissue.deformer import TissueDeformer
from agentface.tissue.forces import held
from agentface.tissue.lattice import Lattice, build_lattice
from agentface.tissue.layers import EPIDERMIS, HYPODERMIS
from agentface.tissue.muscles import nodal_forces
from agentface.tissue.nudge import NUDGES, as_fitted, nearness, nudged, rewritten
from agentface.tissue.reading import anatomy_file, read_tissue
from agentface.tissue.relaxation import new_loads, relax
from agentface.tissue.skull import moved
from agentface.tissue.tables import TissueTables
from agentface.tissue.tissue_file import SkullTable

TEXT = anatomy_file().read_text()
LISTS = {
    "as it ships": "  rotate_deg: [0.0, 0.0, 0.0]\n  translate_mm: [0.0, 0.0, 0.0]\n  scale: [1.0, 1.0, 1.0]\n",
    "with words": (
        "  rotate_deg: [0.0, 0.0, 0.0] # by eye\n"
        "  # forward, for the chin\n  translate_mm: [ 0,0.0 , 0.0]\n  scale:   [1.0,\n    1.0, 1.0]   # no larger\n"
    ),
    "item by item": (
        "  rotate_deg:\n  - 0.0 # nods\n  - 0.0\n  - 0.0\n\n  # after an empty line\n"
        "  translate_mm:\n    - 0\n    - 0\n    - 0\n  scale: [1, 1, 1]\n"
    ),
    "in another order": "  scale: [1.0, 1.0, 1.0]\n  rotate_deg: [0.0, 0.0, 0.0]\n",
    "none": "",
}
FORMS = {name: TEXT.replace(LISTS["as it ships"], lists) for name, lists in LISTS.items()}
FORMS["in braces"] = (
    TEXT[: TEXT.index("skull:")]
    + "skull: {along: 0.08, across: 0.6, contact: 10.0} # short\n\n"
    + TEXT[TEXT.index("dynamics:") :]
)
FORMS["from Windows"] = FORMS["in another order"].replace("\n", "\r\n")
NUMBERS = st.lists(st.floats(-10, 10).map(lambda number: round(number, 3) + 0.0), min_size=3, max_size=3)
SCALES = st.lists(st.floats(0.9, 1.1).map(lambda number: round(number, 3)), min_size=3, max_size=3)


def skull_of(text: str, folder: Path) -> SkullTable:
    path = folder / "tissue.yaml"
    path.write_bytes(text.encode())
    return read_tissue(path).skull


def lines_without(text: str) -> list[str]:
    """The lines of a file that bear none of the numbers."""
    own = (*NUDGES, "- ", "1.0")
    return [line for line in text.splitlines() if not line.strip().startswith(own) and "skull: {" not in line]


@pytest.mark.parametrize("form", FORMS)
def test_a_file_says_what_was_nudged_and_else_what_it_said(form: str, tmp_path: Path) -> None:
    text = FORMS[form]
    before = skull_of(text, tmp_path)
    wanted = before.model_copy(
        update={"rotate_deg": [1.5, 0.0, -10.0], "translate_mm": [0.25, 3.0, 0.0], "scale": [0.9, 1.0, 1.003]}
    )
    after = rewritten(text, wanted)
    assert skull_of(after, tmp_path) == wanted
    assert lines_without(after) == lines_without(text)
    assert after.count("#") == text.count("#")
    assert ("\r\n" in after) == ("\r\n" in text)
    assert "\n" not in after.replace("\r\n", "") or "\r\n" not in after
    assert rewritten(after, wanted) == after
    assert skull_of(rewritten(after, before), tmp_path) == before


@pytest.mark.parametrize("form", FORMS)
def test_a_file_that_says_so_already_is_left_to_the_byte(form: str, tmp_path: Path) -> None:
    assert rewritten(FORMS[form], skull_of(FORMS[form], tmp_path)) == FORMS[form]


@settings(max_examples=25)
@given(rotate=NUMBERS, translate=NUMBERS, scale=SCALES)
def test_any_numbers_are_read_as_they_were_written(
    tmp_path_factory: pytest.TempPathFactory, rotate: list[float], translate: list[float], scale: list[float]
) -> None:
    folder = tmp_path_factory.getbasetemp()
    file = read_tissue(anatomy_file())
    wanted = file.skull.model_copy(update={"rotate_deg": rotate, "translate_mm": translate, "scale": scale})
    path = folder / "tissue.yaml"
    path.write_text(rewritten(TEXT, wanted))
    assert read_tissue(path) == file.model_copy(update={"skull": wanted})


def test_a_nudge_keeps_to_its_range_and_changes_no_other_number(lattice: Lattice) -> None:
    table = lattice.file.skull
    for key, (low, high, rest) in NUDGES.items():
        for wanted, expected in ((1e9, high), (-1e9, low), (rest, rest), (-0.0, max(low, 0.0))):
            other = nudged(table, key, 1, wanted)
            assert getattr(other, key) == [rest, expected, rest]
            assert "-0.0" not in repr(getattr(other, key))
            assert as_fitted(other) == table == as_fitted(table)
    assert table.translate_mm == [0.0, 0.0, 0.0]


def test_the_fitted_skull_lies_under_the_tissue(lattice: Lattice) -> None:
    near = nearness(lattice, lattice.skull.points, lattice.rest[HYPODERMIS])
    assert near.least_mm > 0.5
    assert near.resting == 0
    assert near.outside_mm == 0.0
    assert np.array_equal(np.isfinite(near.room), lattice.free)
    assert np.allclose(lattice.skull.points, lattice.skull.fitted)


def test_bone_through_the_skin_is_seen_where_it_is(lattice: Lattice) -> None:
    rest, normals, patch = lattice.rest, lattice.normals, np.flatnonzero(lattice.free)[:5]
    bone = lattice.skull.points.copy()
    bone[patch] = rest[EPIDERMIS, patch] + 2.0 * normals[patch]
    near = nearness(lattice, bone, rest[HYPODERMIS])
    assert near.outside_mm == pytest.approx(2.0)
    assert np.flatnonzero(near.outside).tolist() == patch.tolist()
    assert near.resting == len(patch)
    assert near.least_mm == 0.0, "tissue rests where the bone would push it out: nothing moves by itself"


def test_room_is_what_the_force_of_contact_reckons_with(lattice: Lattice) -> None:
    points = lattice.points + np.random.default_rng(7).normal(0.0, 4.0, lattice.points.shape)
    near = nearness(lattice, lattice.skull.points, points.reshape(3, -1, 3)[HYPODERMIS])
    pressed = held(lattice, points).across > lattice.tether[:, 1]
    assert np.array_equal(pressed[lattice.free], (near.room < 0.0)[lattice.free])
    assert near.resting >= pressed[lattice.free].sum() > 100


def test_tissue_on_the_bone_comes_to_rest(model: HeadModel, lattice: Lattice) -> None:
    table = nudged(lattice.file.skull, "translate_mm", 2, 10.0)
    pressed = build_lattice(model, lattice.file.model_copy(update={"skull": table}))
    assert (pressed.gap[pressed.free] == 0.0).sum() > 1000
    columns = pack(pressed, coloured(pressed, model.mirror))
    for load in new_loads(columns, nodal_forces(model, pressed))[::6]:
        sweeps, step = relax(columns, columns.rest.copy(), load, tolerance=1e-3)
        assert sweeps < 400
        assert step < 1e-3


@pytest.mark.slow
def test_a_face_made_anew_goes_by_the_skull_that_was_nudged(model: HeadModel, tissue: TissueTables) -> None:
    frown, deformer = FacePose.of(corrugator_supercilii=1.0, procerus=1.0), TissueDeformer(model)
    lattice = tissue.lattice
    table = nudged(nudged(lattice.file.skull, "translate_mm", 2, 6.0), "rotate_deg", 0, 3.0)
    other = deformer.remade(lattice.file.model_copy(update={"skull": table}), frown)
    assert other.tissue.lattice.file.skull == table
    assert np.allclose(other.tissue.lattice.skull.points, moved(lattice.skull.fitted, table))
    assert np.allclose(deformer.nodes, lattice.rest, atol=1e-4), "the one that it came from has not moved"
    shift = np.abs(other.step(frown, 1 / 60).vertices - deformer.at(frown).vertices).max()
    assert 5e-4 < shift < 5e-3
    assert np.abs(other.nodes[EPIDERMIS] - lattice.rest[EPIDERMIS]).max() > 1.0
    assert np.array_equal(other.at(FacePose()).vertices, deformer.at(FacePose()).vertices)
