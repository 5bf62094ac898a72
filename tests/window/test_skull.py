"""The skull's controls without a window: what is asked for, when the face follows, what the file is told."""

from __future__ import annotations

from concurrent.futures import Future
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from agentface import Face
from agentface.errors import InvalidValueError, OutputError
from agentface.parameters import FacePose
from agentface.tissue.deformer import TissueDeformer
from agentface.tissue.reading import anatomy_file, read_tissue
from agentface.tissue.tissue_file import TISSUE_FILE
from agentface.window import skull as skull_module
from agentface.window.controls import Controls
from agentface.window.skull import SkullControls
from tests.heads import head_model


class Workshop:
    """Does work when it is told to."""

    def __init__(self):
        self.orders = []

    def start(self, work):
        self.orders.append((work, Future()))
        return self.orders[-1][1]

    def finish(self):
        work, future = self.orders[-1]
        try:
            future.set_result(work())
        except Exception as error:
            future.set_exception(error)


@pytest.fixture(scope="module")
def deformer():
    return TissueDeformer(head_model("amber"))


@pytest.fixture
def anew(monkeypatch):
    """What faces are made of anew: at once here, and with the tissue as it was."""
    files = []

    def remade(self, file, pose):
        files.append(file)
        lattice = replace(self.tissue.lattice, file=file)
        return TissueDeformer(self._model, tissue=self.tissue._replace(lattice=lattice))

    monkeypatch.setattr(TissueDeformer, "remade", remade)
    return files


@pytest.fixture
def face(tmp_path):
    (tmp_path / TISSUE_FILE).write_bytes(anatomy_file().read_bytes())
    taken = []
    return SimpleNamespace(
        model=SimpleNamespace(folder=tmp_path), pose=FacePose(), taken=taken, take_deformer=taken.append
    )


@pytest.fixture
def workshop():
    return Workshop()


@pytest.fixture
def controls(face, deformer, anew, workshop):
    return SkullControls(face, deformer, workshop.start)


def test_a_geometric_face_has_no_skull():
    assert Controls(Face(head_model("amber"), compiled=False)).skull is None


def test_a_face_of_tissue_has_one():
    assert Controls(Face(head_model("amber"), deformer="tissue")).skull is not None


def test_the_face_follows_when_a_slider_is_let_go_of(controls, face, workshop, anew):
    for height in (1.0, 2.0, 3.0):
        controls.nudge("translate_mm", 1, height)
    assert workshop.orders == []
    controls.settle()
    controls.settle()
    assert len(workshop.orders) == 1
    assert controls.preparing
    assert not controls.update()
    assert face.taken == []
    workshop.finish()
    assert controls.preparing, "done, and not yet exchanged"
    assert controls.update()
    assert not controls.preparing
    assert [made.tissue.lattice.file.skull for made in face.taken] == [controls.table]
    assert controls.table.translate_mm == [0.0, 3.0, 0.0]
    assert anew[0].muscles == face.taken[0].tissue.lattice.file.muscles
    assert not controls.update()


def test_what_was_asked_for_meanwhile_is_made_next_and_alone(controls, face, workshop, anew):
    for angle in (1.0, 2.0, 3.0):
        controls.nudge("rotate_deg", 0, angle)
        controls.settle()
    assert len(workshop.orders) == 1
    workshop.finish()
    assert controls.update()
    assert controls.preparing
    workshop.finish()
    assert controls.update()
    assert not controls.preparing
    assert [file.skull.rotate_deg[0] for file in anew] == [1.0, 3.0]
    assert face.taken[-1].tissue.lattice.file.skull == controls.table


def test_back_where_it_was_meanwhile_the_first_is_made_again(controls, face, workshop):
    before = controls.table
    controls.nudge("scale", 0, 1.05)
    controls.settle()
    controls.reset()
    workshop.finish()
    controls.update()
    workshop.finish()
    controls.update()
    assert face.taken[-1].tissue.lattice.file.skull == before


def test_a_drag_that_ends_where_it_began_asks_for_nothing(controls, workshop):
    controls.nudge("scale", 2, 1.1)
    controls.nudge("scale", 2, 1.0)
    controls.settle()
    assert workshop.orders == []


def test_what_cannot_be_made_is_told_and_the_face_stays(controls, face, workshop, monkeypatch):
    def fail(*_):
        raise InvalidValueError("the skull", "one", "none")

    with monkeypatch.context() as patch:
        patch.setattr(TissueDeformer, "remade", fail)
        controls.nudge("scale", 0, 0.9)
        controls.settle()
        workshop.finish()
    assert controls.update()
    assert "the skull" in controls.message
    assert face.taken == []
    assert not controls.preparing
    controls.nudge("scale", 0, 0.95)
    controls.settle()
    workshop.finish()
    controls.update()
    assert face.taken
    assert controls.message == ""


def test_saving_writes_the_numbers_and_nothing_else(controls, face):
    path = face.model.folder / TISSUE_FILE
    before = path.read_text().splitlines()
    assert not controls.unsaved
    controls.nudge("translate_mm", 2, -1.5)
    assert controls.unsaved
    controls.save()
    assert not controls.unsaved
    assert str(path) in controls.message
    changed = [line for line, was in zip(path.read_text().splitlines(), before, strict=True) if line != was]
    assert changed == ["  translate_mm: [0.0, 0.0, -1.5]"]
    assert read_tissue(path).skull.translate_mm == [0.0, 0.0, -1.5]
    assert [entry.name for entry in path.parent.iterdir()] == [TISSUE_FILE]


def test_what_others_wrote_into_the_file_since_stays(controls, face):
    path = face.model.folder / TISSUE_FILE
    path.write_text(path.read_text().replace("contact: 50.0", "contact: 52.0  # harder"))
    controls.nudge("scale", 1, 1.02)
    controls.save()
    assert "contact: 52.0  # harder\n" in path.read_text()
    assert read_tissue(path).skull.scale == [1.0, 1.02, 1.0]


@pytest.mark.parametrize("content", [None, b"skull: 3\n", b"\xff\xfe", b"skull: {along: -1}\n"])
def test_a_file_that_is_missing_or_wrong_is_told_and_left(controls, face, content):
    path = face.model.folder / TISSUE_FILE
    path.unlink()
    if content is not None:
        path.write_bytes(content)
    controls.nudge("scale", 1, 1.02)
    controls.save()
    assert controls.unsaved
    assert TISSUE_FILE in controls.message
    assert content == (path.read_bytes() if path.exists() else None)


def test_a_file_that_cannot_be_written_is_told_and_left(controls, face, monkeypatch):
    def full(path: Path, _content: bytes) -> None:
        raise OutputError(f"{path}: no space")

    monkeypatch.setattr(skull_module, "write_file", full)
    controls.nudge("scale", 1, 1.02)
    controls.save()
    assert controls.unsaved
    assert "no space" in controls.message


def test_the_bone_goes_with_the_sliders_before_the_face_does(controls, deformer):
    first = controls.bone()
    assert controls.bone().points is first.points, "what has not moved is not uploaded again"
    assert not first.tint.any() or first.tint.max() < 0.5
    absent = deformer.tissue.lattice.members.absent
    assert not absent[first.triangles].any()
    controls.nudge("translate_mm", 2, 10.0)
    second = controls.bone()
    assert np.allclose(second.points - first.points, [0.0, 0.0, 0.010], atol=1e-6)
    assert second.tint.max() == 1.0
    near = controls.nearness()
    assert near.resting > 100
    assert near.outside_mm > 1.0
    assert np.array_equal(second.tint == 1.0, near.outside > 0.0)
    controls.reset()
    assert not controls.nudged
    assert controls.nearness().outside_mm == 0.0
