"""``agentface check`` tells every fault of a face with file and line, and calls good only what can be drawn."""

import re
import shutil
from itertools import pairwise

import pytest
from click.testing import CliRunner

from agentface.cli import cli
from agentface.errors import DataError
from agentface.head.model import load_model
from agentface.resources import face_folder
from agentface.tissue.reading import anatomy_file

SAME_END = ("wrinkles.yaml", r"offset: \[0.0, 0.91, 0.0\]", "offset: [0.0, 0.2, 0.0]")


@pytest.fixture
def face(tmp_path):
    return shutil.copytree(face_folder("amber"), tmp_path / "mine")


@pytest.fixture
def untissued(face):
    """A face whose tissue need not be built, which takes seconds."""
    (face / "tissue.yaml").unlink()
    return face


def edit(face, name, old, new):
    """Change the first match of the pattern ``old``; its groups and the line of the last of them."""
    text = (face / name).read_text()
    found = re.search(old, text, re.DOTALL)
    assert found, old
    (face / name).write_text(text[: found.start()] + found.expand(new) + text[found.end() :])
    return found.groups(), text.count("\n", 0, found.start(len(found.groups()))) + 1


def faults(place, *options):
    result = CliRunner().invoke(cli, ["check", str(place), *options])
    assert result.exit_code in (0, 1), result.output
    said = result.output.splitlines()
    assert (result.exit_code == 0) == said[0].endswith(": good")
    return [row.strip() for row in said[1:]]


def same_for_load(face):
    with pytest.raises(DataError) as caught:
        load_model(face)
    return [str(fault) for fault in caught.value.faults]


def test_every_file_of_a_face_is_known():
    files = [path for path in sorted(face_folder("amber").glob("*.yaml")) if path.name != "recipe.yaml"]
    assert "wrinkles.yaml" in [path.name for path in files]
    for path in files:
        assert not faults(path)


FIRST = r"(- upper: )\[(\d+), (\d+),"
SECOND = r"(\n- upper: .*?\n- upper: )\[(\d+), (\d+), (\d+),"
SECOND_LOWER = r"(\n- upper: .*?\n- upper: .*?\n  lower: )\[(\d+), (\d+),"

# file, pattern, its replacement, what is told of its groups
RINGS = [
    ("eyelids.yaml", "edge_ring: 3", "edge_ring: 300", "edge_ring: expected a ring in 0..12, got 300"),
    ("eyelids.yaml", "edge_ring: 3", "edge_ring: 13", "edge_ring: expected a ring in 0..12, got 13"),
    ("eyelids.yaml", FIRST, r"\1[\2] # ", "at least 3 items"),
    ("eyelids.yaml", FIRST, r"\1[] # ", "at least 3 items"),
    ("eyelids.yaml", FIRST, r"\1[\3,", "the same two ends, got {2} and "),
    ("eyelids.yaml", "(rings:)\n  r:\n", r"\1\n  q:\n", "rings: expected the keys l and r"),
    ("lips.yaml", SECOND, r"\1[\2, \4, \3,", "rings.1.upper.0: expected neighbours"),
    ("lips.yaml", SECOND, r"\1[\2, \4,", "neighbours on the mesh, got {1}, then {3}"),
    ("lips.yaml", SECOND, r"\1[\2, \4,", "rings.1: expected 44 vertices, as in the other rings, got 43"),
    ("lips.yaml", SECOND, r"\1[\2, \3, \2, \3, \4,", "expected each vertex once, got {1} again"),
    ("lips.yaml", SECOND_LOWER, r"\1[-3, \3,", "rings.1.lower.0: expected vertices in 0..6158, got -3"),
]


@pytest.mark.parametrize(("name", "old", "new", "told"), RINGS)
def test_rings_that_are_none_are_told_by_line(face, name, old, new, told):
    groups, line = edit(face, name, old, new)
    told = told.format(*groups)
    for found in (faults(face), same_for_load(face)):
        assert any(row.startswith(f"{face / name}:{line}: ") and told in row for row in found), found
        assert all(re.match(rf"{face / name}:\d+: ", row) for row in found)


def test_a_ring_too_few_is_told(face):
    text = (face / "lips.yaml").read_text()
    first, second = (match.start() for match in list(re.finditer("^- upper", text, re.M))[:2])
    (face / "lips.yaml").write_text(text[:first] + text[second:])
    assert any("lips.yaml:3: rings: expected at least 9 items" in row for row in faults(face))


def test_rings_in_another_order_are_told_with_their_file(untissued):
    text = (untissued / "lips.yaml").read_text()
    start = [match.start() for match in re.finditer("^- upper|^orbicularis", text, re.M)]
    rings = [text[i:j] for i, j in pairwise(start)]
    rings[2], rings[5] = rings[5], rings[2]
    (untissued / "lips.yaml").write_text(text[: start[0]] + "".join(rings) + text[start[-1] :])
    load_model(untissued)
    (found,) = faults(untissued)
    assert found.startswith(f"{untissued / 'lips.yaml'}")
    assert "joined one to one" in found


NUMBERS = [
    ("lips.yaml", r"reach: {upper: [\d.]+", "reach: {upper: -1", "reach.upper"),
    ("lips.yaml", r"reach: {upper: [\d.]+", "reach: {upper: 0", "reach.upper"),
    ("lips.yaml", r"(extrusion:\s+upper: )\[[\d.]+,", r"\1[1e30,", "extrusion.upper.0"),
    ("lips.yaml", r"(rotation_deg:\s+upper: )\[[\d.]+,", r"\1[900.0,", "rotation_deg.upper.0"),
    ("eyes.yaml", r"radius: [\d.]+", "radius: 13.457", "radius"),
    ("eyes.yaml", r"centre: \[[\d.]+,", "centre: [13.0,", "centre.0"),
    ("eyes.yaml", r"centre: \[([\d.]+),", r"centre: [-\1,", "centre"),
    ("eyes.yaml", r"centre: \[[\d.]+,", "centre: [0.0,", "centre"),
    ("jaw.yaml", r"pivot: \[0.0,", "pivot: [0.3,", "pivot"),
    ("jaw.yaml", r"pivot: \[0.0, -[\d.]+", "pivot: [0.0, -4.7", "pivot.1"),
    ("volumes.yaml", r"radii: \[[\d.]+,", "radii: [0.0,", "volumes.cheek_apple.radii.0"),
    (
        "volumes.yaml",
        r"muscles: {zygomaticus_major",
        "muscles: {zygomaticus_minus",
        "volumes.cheek_apple.muscles.zygomaticus_minus",
    ),
    ("asymmetry.yaml", r"zygomaticus_major_r: [\d.]+", "zygomaticus_major_r: -1", "gains.zygomaticus_major_r"),
    ("asymmetry.yaml", r"zygomaticus_major_r", "zygomaticus_major", "gains.zygomaticus_major"),
    ("wrinkles.yaml", r"facing: \[0.0, 0.0, 1.0\]", "facing: [0.0, 0.0, 1e300]", "facing.2"),
    ("wrinkles.yaml", r"facing: \[0.0, 0.0, 1.0\]", "facing: [0.0, 0.0, 1e-200]", "facing"),
    (*SAME_END, "trains.forehead_medial.end"),
]
TISSUE = [
    (r"epidermis: [\d.]+", "epidermis: -1.0", "springs.layers.epidermis"),
    (r"thickness_mm: \[0.5, 6.0\]", "thickness_mm: [6.0, 0.5]", "lattice.thickness_mm"),
    (r"rho: [\d.]+", "rho: 300.0", "volume.rho"),
    (r"regions: \[upper_face\]", "regions: [upper_farce]", "muscles.frontalis_inner.regions.0"),
    (r"moved_by: \{mentalis", "moved_by: {mental", "muscles.mentalis.moved_by.mental"),
]
UNPLACED = [
    (
        r"(  mentalis:.*?insertion: )\{[^}]*\}",
        r"\1{at: lower_lip_middle, offset: ORIGIN}",
        "muscles.mentalis.insertion: expected a point apart from the origin",
    ),
    (
        r"(  mentalis:.*?regions: )\[lower_face\]",
        r"\1[upper_eyelid]",
        "muscles.mentalis: expected a muscle that pulls on some of the tissue",
    ),
]


@pytest.mark.parametrize(("name", "old", "new", "where"), NUMBERS)
def test_impossible_numbers_are_told_by_line(face, name, old, new, where):
    edit(face, name, old, new)
    for found in (faults(face), same_for_load(face)):
        (row,) = found
        assert re.match(rf"{face / name}:\d+: \S*{re.escape(where)}: expected .*, got ", row)
        assert "Anchor(" not in row


@pytest.mark.parametrize(("old", "new", "where"), TISSUE)
def test_faults_of_the_tissue_are_told_by_line(face, old, new, where):
    _, line = edit(face, "tissue.yaml", old, new)
    for found in (faults(face), faults(face / "tissue.yaml")):
        assert any(row.startswith(f"{face / 'tissue.yaml'}:{line}: {where}: expected ") for row in found), found
    load_model(face)  # it is no matter of other deformers


@pytest.mark.slow
@pytest.mark.parametrize(("old", "new", "told"), UNPLACED)
def test_what_cannot_be_built_of_the_tissue_is_told_by_line(face, old, new, told):
    text = (face / "tissue.yaml").read_text()
    origin = re.search(r"  mentalis:.*?origin: \{at: lower_lip_middle, offset: (\[.*?\])\}", text, re.DOTALL)[1]
    edit(face, "tissue.yaml", old, new.replace("ORIGIN", origin))
    (found,) = faults(face)
    assert re.match(rf"{face / 'tissue.yaml'}:\d+: {re.escape(told)}, got ", found)
    line = int(found.removeprefix(f"{face / 'tissue.yaml'}:").partition(":")[0])
    key = told.partition(": ")[0].rpartition(".")[2]
    assert (face / "tissue.yaml").read_text().splitlines()[line - 1].strip().startswith(f"{key}:")


def test_a_face_needs_tissue_only_for_the_deformers_that_move_it(untissued):
    assert not faults(untissued)
    for deformer in ("tissue", "tissue-semi-implicit", "tissue-adaptive"):
        (found,) = faults(untissued, "--deformer", deformer)
        assert found.startswith(f"{untissued / 'tissue.yaml'}: expected this file, for the tissue deformer, got none")


def test_the_anatomists_tissue_is_checked_and_makes_no_face_of_its_folder(tmp_path):
    path = shutil.copy(anatomy_file(), tmp_path)
    assert not faults(path)
    (found,) = faults(tmp_path)
    assert "expected a folder with rules or a face, got neither" in found


def test_a_train_of_no_length_between_landmarks_is_told_by_line(untissued):
    """Only the placed landmarks show it: the way from one to the other goes along ``facing``."""
    model = load_model(untissued)
    way = model.landmarks["subnasale"] - model.landmarks["nose_tip"]
    text = (untissued / "wrinkles.yaml").read_text()
    row = text[text.index("  forehead_medial:") : text.index("  forehead_middle:")]
    new = re.sub(r"facing: .*", f"facing: {(10 * way / abs(way).max()).tolist()}", row)
    new = re.sub(r"start:\n +at: glabella\n +offset: .*", "start:\n      at: nose_tip", new)
    new = re.sub(r"end:\n +at: glabella\n +offset: .*", "end:\n      at: subnasale", new)
    (untissued / "wrinkles.yaml").write_text(text.replace(row, new))
    (found,) = faults(untissued)
    line = text.replace(row, new).count("\n", 0, text.replace(row, new).index("at: subnasale"))
    assert found.startswith(
        f"{untissued / 'wrinkles.yaml'}:{line}: trains.forehead_medial.end: expected a point beside"
    )


def test_a_muscle_of_no_length_is_told_by_line(untissued):
    text = (untissued / "muscles.yaml").read_text()
    row = text[text.index("  risorius:") :]
    at, offset = re.search(r"origin:\n\s+at: (.*)\n\s+offset: (.*)\n", row).groups()
    same = re.sub(r"(insertion:\n\s+at: ).*(\n\s+offset: ).*", rf"\g<1>{at}\g<2>{offset}", row, count=1)
    (untissued / "muscles.yaml").write_text(text.replace(row, same))
    (found,) = faults(untissued)
    assert re.match(rf"{untissued / 'muscles.yaml'}:\d+: muscles.risorius.insertion: expected a point apart", found)


def test_all_faults_of_a_file_are_told_at_once(face):
    edit(face, "regions.yaml", "upper_lip: ", "upper_lp: ")
    edit(face, "regions.yaml", "lower_face: 0", "lower_face: -0")
    edit(face, "regions.yaml", r"eyebrow_l: \[\d+,", "eyebrow_l: [1,")
    edit(face, "lips.yaml", FIRST, r"\1[99999, \3,")
    edit(face, "lips.yaml", "roll_from: 0.4", "roll_from: .nan")
    edit(face, "eyelids.yaml", r"meeting: 0.15", "meeting: two")
    edit(face, "eyelids.yaml", FIRST, r"\1[88888, \3,")
    edit(face, "eyelids.yaml", "edge_ring: 3", "edge_ring: 13")
    edit(face, *SAME_END)
    edit(face, "wrinkles.yaml", "count: 4", "count: 0")
    found = faults(face)
    for name, where in (
        ("regions.yaml", "limits.upper_lp"),
        ("regions.yaml", "limits.lower_face"),
        ("regions.yaml", "limits"),
        ("regions.yaml", "sub_regions.eyebrow_l"),
        ("lips.yaml", "rings.0.upper.0"),
        ("lips.yaml", "orbicularis_oris.roll_from"),
        ("eyelids.yaml", "meeting"),
        ("eyelids.yaml", "rings.r.0.upper.0"),
        ("eyelids.yaml", "edge_ring"),
        ("wrinkles.yaml", "trains.forehead_medial.end"),
        ("wrinkles.yaml", "trains.forehead_medial.count"),
    ):
        assert sum(bool(re.match(rf"{face / name}:\d+: {re.escape(where)}: ", row)) for row in found) == 1, (
            where,
            found,
        )
    assert len(found) == 11
    assert any("did you mean upper_lip" in row for row in found)


RUBBISH = [
    "",
    "[1, 2]",
    "a: 1",
    "1: 2",
    "rings: 3",
    "rings: [1, {upper: 2}, {lower: [a]}]",
    "rings: {l: 3, r: [{upper: [1], lower: [.nan]}], 3: []}\nedge_ring: yes",
    "regions: {1: 2, a: [1, b]}\nlimits: {1: 2}\nsub_regions: 3\nvertices: x",
    "trains: {a: {start: 1, end: {at: 3}, facing: [a], muscles: [[1]]}, 3: 4}",
]


@pytest.mark.parametrize("name", ["regions.yaml", "lips.yaml", "eyelids.yaml", "wrinkles.yaml", "tissue.yaml"])
@pytest.mark.parametrize("content", RUBBISH)
def test_rubbish_is_faults_and_no_error(face, name, content):
    (face / name).write_text(content)
    found = faults(face)
    assert found
    assert all(str(face / name) in row for row in found)


@pytest.mark.parametrize(
    ("options", "told"),
    [
        (["bench", "nope"], "known: deform"),
        (["bench", "fuzy"], "did you mean fuzzy"),
        (["bench", ""], "known: deform"),
        (["bench", "deform", "--face", "ambre"], "did you mean amber"),
        (["figures", "qqq"], "known: lips"),
        (["figures", "wrinkle"], "did you mean wrinkles"),
    ],
)
def test_names_are_checked_before_anything_is_measured_or_drawn(options, told):
    result = CliRunner().invoke(cli, options)
    assert result.exit_code == 1
    assert told in result.output
    assert "measuring" not in result.output
