from __future__ import annotations

from io import BytesIO
from pathlib import Path

import numpy as np
import pytest
import yaml
from click.testing import CliRunner
from PIL import Image

from agentface.cli import cli
from agentface.head.muscles import MusclesFile
from agentface.studies.figures.combination import FIGURES, MUSCLES, deformed, figures, strong_muscles
from agentface.studies.figures.mesh_view import MeshView, folded

DOCUMENT = Path(__file__).parents[3] / "docs" / "muscles.md"
IMAGES = DOCUMENT.parent / "images"


def call(*arguments, code=0):
    result = CliRunner().invoke(cli, ["figures", *map(str, arguments)], prog_name="agentface")
    assert result.exit_code == code, result.output
    return result


@pytest.fixture(scope="module")
def face():
    return strong_muscles("amber")


@pytest.fixture(scope="module")
def drawn():
    return figures("amber")


def test_the_command_writes_the_same_bytes_every_time(tmp_path, drawn):
    call("combination", "-o", tmp_path)
    assert {path.name: path.read_bytes() for path in tmp_path.iterdir()} == drawn
    assert set(drawn) == {f"{name}.png" for name in FIGURES}


def test_the_figures_of_the_documents_are_these(drawn):
    for name, content in drawn.items():
        assert len(content) < 300_000
        with Image.open(BytesIO(content)) as now, Image.open(IMAGES / name) as there:
            assert now.size == there.size
            gap = np.abs(np.asarray(now.convert("RGB"), int) - np.asarray(there.convert("RGB"), int)).max(axis=2)
            # Other versions of Pillow and of its font differ in some pixels, other muscles in many.
            assert (gap > 40).mean() < 0.03


def test_an_unknown_figure_is_told(tmp_path):
    assert "'combinations'; did you mean combination" in call("combinations", "-o", tmp_path, code=1).stderr


def test_nothing_is_written_where_no_folder_is(tmp_path):
    assert "no folder" in call("-o", tmp_path / "a" / "b", code=1).stderr
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("name", FIGURES)
def test_summed_overshoots_and_folds_the_skin_where_parallel_does_not(face, name):
    model, muscles = face
    panels = {panel.method: panel for panel in FIGURES[name][-3:]}
    outcomes = {method: deformed(model, muscles, panel)[1] for method, panel in panels.items()}
    assert outcomes["summed"].largest_mm > 1.08 * outcomes["parallel"].largest_mm
    assert outcomes["summed"].folded >= 10 * max(1, outcomes["parallel"].folded)


def test_the_numbers_of_the_documents_are_those_of_the_pictures(face):
    text = " ".join(DOCUMENT.read_text(encoding="utf-8").split())
    two, three = ([deformed(*face, panel)[1] for panel in panels[-3:]] for panels in FIGURES.values())
    assert f"go {two[1].largest_mm - two[0].largest_mm:.1f} mm further" in text
    assert f"and {two[1].folded} triangles turn over" in text
    parallel, summed, sequential = ((f"{outcome.largest_mm:.1f} mm", outcome.folded) for outcome in three)
    assert f"up to {parallel[0]} and {parallel[1]} triangles turn over" in text
    assert f"up to {summed[0]}, and {summed[1]} turn over" in text
    assert f"by `sequential` {sequential[0]} and {sequential[1]}." in text


def test_the_muscles_yaml_of_the_documents_is_valid():
    block = DOCUMENT.read_text(encoding="utf-8").partition("```yaml\n")[2].partition("```")[0]
    file = MusclesFile.model_validate(yaml.safe_load(block))
    assert file.muscles["zygomaticus_major"].fall_finish > file.muscles["zygomaticus_major"].fall_start


def test_the_colours_of_the_muscles_survive_the_palette(drawn):
    with Image.open(BytesIO(drawn["three-muscles.png"])) as image:
        pixels = np.asarray(image.convert("RGB"), int).reshape(-1, 3)
    for colour in MUSCLES.values():
        assert (np.abs(pixels - colour).max(axis=1) < 24).sum() > 500


def test_a_view_shows_what_is_left_of_the_person_right_of_the_middle():
    view = MeshView(np.zeros(3, np.float32), 0.2, 0.0, 100)
    left_up_front = np.array([[0.05, 0.02, 0.01]])
    np.testing.assert_allclose(view.pixels(left_up_front), [[75.0, 40.0, 0.01]])
    turned = MeshView(np.zeros(3, np.float32), 0.2, 90.0, 100).turned(np.array([[1.0, 0.0, 0.0]]))
    np.testing.assert_allclose(turned, [[0.0, 0.0, 1.0]], atol=1e-12)


def test_a_triangle_that_turned_over_is_folded():
    rest = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]])
    moved = rest.copy()
    moved[3] = [-0.5, -0.5, 0.1]
    triangles = np.array([[0, 1, 2], [1, 3, 2]], np.int32)
    assert folded(rest, moved, triangles).tolist() == [False, True]
    assert not folded(rest, rest, triangles).any()
