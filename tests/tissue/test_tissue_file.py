"""tissue.yaml is read whole or not at all: every fault with its line, what was expected and what came."""

from __future__ import annotations

import re

import pytest
import yaml

from agentface.errors import DataError
from agentface.resources import face_folder, face_names
from agentface.tissue.reading import anatomy_file, read_tissue, tissue_of
from agentface.tissue.tissue_file import LARGEST_RHO, NAMES, TISSUE_MUSCLES
from agentface.tissue.writing import tissue_yaml

TEXT = anatomy_file().read_text(encoding="utf-8")


@pytest.fixture
def path(tmp_path):
    return tmp_path / "tissue.yaml"


def faults(path, text):
    path.write_text(text, encoding="utf-8")
    with pytest.raises(DataError) as caught:
        read_tissue(path)
    return caught.value.faults


def edited(*edits):
    """The anatomist's text with the first match of each pattern, after the one before, replaced."""
    text, start = TEXT, 0
    for old, new in edits:
        found = re.compile(old, re.MULTILINE).search(text, start)
        assert found, old
        text = text[: found.start()] + found.expand(new) + text[found.end() :]
        start = found.start()
    return text


def line_of(text, needle):
    (line,) = [number for number, row in enumerate(text.splitlines(), start=1) if needle in row]
    return line


@pytest.mark.parametrize("place", [anatomy_file(), *(face_folder(name) / "tissue.yaml" for name in face_names())])
def test_what_ships_is_good(place):
    assert set(read_tissue(place).muscles) == set(TISSUE_MUSCLES)


def test_there_are_23_muscles_in_a_fixed_order():
    assert len(NAMES) == len(set(NAMES)) == 23
    assert NAMES[:3] == ("frontalis_inner_l", "frontalis_inner_r", "frontalis_outer_l")
    assert NAMES[-1] == "orbicularis_oris"


ROW = r"^  risorius:\n"
FAULTS = [
    # edits, what stands in the line, where, expected, got
    ([("epidermis: 1.0", "epidermis: -1.0")], "epidermis: -1.0", "springs.layers.epidermis", "greater than 0", "-1.0"),
    ([("upper: 2.4", "upper: 0")], "upper: 0,", "springs.connecting.upper", "greater than 0", "0"),
    ([("across: 0.6", "across: -3")], "across: -3", "skull.across", "greater than 0", "-3"),
    ([("contact: 50.0", "contact: .nan")], "contact: .nan", "skull.contact", "finite", "nan"),
    ([("strength: 1.0", "strength: -1.0")], "strength: -1.0", "muscles.frontalis_inner.strength", "than 0", "-1.0"),
    ([("bending: 0.8", "bending: true")], "bending: true", "springs.bending", "number", "True"),
    ([("alpha: 1", "alpha: 3")], "alpha: 3", "springs.alpha", "0, 1 or 2", "3"),
    ([("form: energy", "form: enery")], "form: enery", "volume.form", "'energy'", "'enery'"),
    ([("rho: 8.0", "rho: -8.0")], "rho: -8.0", "volume.rho", "greater than or equal to 0", "-8.0"),
    ([("rho: 8.0", "rho: 33")], "rho: 33", "volume.rho", "at most 12: with the form energy, more diverges", "33"),
    ([("  cheek: 20.0", "  cheeck: 20.0")], "cheeck: 20.0", "depth_mm.cheeck", "a landmark", "cheeck"),
    ([("  cheek: 20.0", "  pupil: 20.0")], "pupil: 20.0", "depth_mm.pupil", "a landmark", "pupil"),
    ([("  cheek: 20.0", "  cheek: 0.1")], "cheek: 0.1", "depth_mm.cheek", "0.5", "0.1"),
    ([("nasion: {", "nose: {")], "nose: {", "skull.holds.nose", "a landmark", "nose"),
    ([("{mouth_corner: ", "{mouth: ")], "{mouth: ", "lattice.carried_mm.mouth", "a paired landmark", "mouth"),
    ([("{mouth_corner: ", "{nasion: ")], "{nasion: ", "lattice.carried_mm.nasion", "a paired landmark", "nasion"),
    (
        [("  dermis: 0.35\n", r"\g<0>  regions: {cheek: 1.2}\n")],
        "regions: {cheek",
        "lattice.regions.cheek",
        "a region without side",
        "cheek",
    ),
    (
        [("  dermis: 0.35\n", r"\g<0>  regions: {middle_face: 2.5}\n")],
        "regions: {middle",
        "lattice.regions.middle_face",
        "at most 2.38: 0.42 of the depth, that many times, reaches the bone",
        "2.5",
    ),
    (
        [(r"\[0.5, 6.0\]", "[3, 3]")],
        "thickness_mm",
        "lattice.thickness_mm",
        "the least thickness, then a larger one",
        "3, 3",
    ),
    (
        [(r"\[0.5, 6.0\]", "[4.6, 6.0]")],
        "thickness_mm",
        "lattice.thickness_mm.0",
        "at most 4.5, the depth at hairline_middle",
        "4.6",
    ),
    ([(r"\[0.5, 6.0\]", "[0.5]")], "thickness_mm", "lattice.thickness_mm", "at least 2 items", "[0.5]"),
    ([("thickness: 0.42", "thickness: 1.2")], "thickness: 1.2", "lattice.thickness", "less than or equal to 1", "1.2"),
    ([("rotate_deg: .*", "rotate_deg: [0, 90, 0]")], "rotate_deg", "skull.rotate_deg.1", "equal to 45", "90"),
    ([("kind: sheet", "kind: shet")], "kind: shet", "muscles.frontalis_inner.kind", "one of linear, sheet", "'shet'"),
    ([("    kind: sheet\n", "")], "  frontalis_inner:", "muscles.frontalis_inner.kind", "this key", "nothing"),
    ([(ROW, r"\g<0>    half_width: 3\n")], "half_width: 3", "muscles.risorius.half_width", "no such key", "3"),
    ([(r"at: brow_inner\}", "at: brow}")], "at: brow}", "muscles.frontalis_inner.insertion.at", "a landmark", "brow"),
    (
        [(ROW, r"\g<0>"), (r"at: cheek,", "at: cheekbones,")],
        "at: cheekbones,",
        "muscles.risorius.origin.at",
        "a landmark",
        "cheekbones",
    ),
    (
        [(r"belly: \{at: cheekbone,", "belly: {at: cheekbones,")],
        "belly: {at: cheekbones,",
        "muscles.zygomaticus_major.belly.at",
        "a landmark",
        "cheekbones",
    ),
    (
        [(ROW, r"\g<0>"), (r"regions: \[lower_face,", "regions: [jaw,")],
        "regions: [jaw,",
        "muscles.risorius.regions.0",
        "a region without side",
        "jaw",
    ),
    (
        [("{risorius: 0.75", "{risoryus: 0.75")],
        "risoryus",
        "muscles.risorius.moved_by.risoryus",
        "a muscle without side, or jaw_open",
        "risoryus",
    ),
    (
        [("{risorius: 0.75", "{head_yaw: 0.75")],
        "head_yaw",
        "muscles.risorius.moved_by.head_yaw",
        "a muscle without side, or jaw_open",
        "head_yaw",
    ),
    ([("{risorius: 0.75", "{risorius: 1.5")], "risorius: 1.5", "muscles.risorius.moved_by.risorius", "to 1", "1.5"),
    ([(r"moved_by: \{mentalis: 1.0\}", "moved_by: {}")], "moved_by: {}", "muscles.mentalis.moved_by", "1 item", "{}"),
    (
        [("action_unit: 20", "action_unit: lots")],
        "action_unit: lots",
        "muscles.risorius.action_unit",
        "integer",
        "lots",
    ),
    (
        [(ROW, r"\g<0>"), ("fall_finish: 1.1", "fall_finish: 0.55")],
        "fall_finish: 0.55",
        "muscles.risorius.fall_finish",
        "more than fall_start, 0.6",
        "0.55",
    ),
    (
        [(ROW, r"\g<0>    fall_near: 2\n"), ("fall_start: 0.6", "fall_start: 0.61")],
        "fall_start: 0.61",
        "muscles.risorius.fall_start",
        "more than fall_near, 2",
        "0.61",
    ),
    ([("^dynamics: .*\n", "")], None, "dynamics", "this key", "nothing"),
    ([("^dynamics: ", "dynamic: ")], "dynamic: ", "dynamic", "no such key", "frequency_hz"),
]


@pytest.mark.parametrize(("edits", "needle", "where", "expected", "got"), FAULTS)
def test_each_fault_is_told_with_its_line_and_what_holds(path, edits, needle, where, expected, got):
    text = edited(*edits)
    (fault,) = (fault for fault in faults(path, text) if fault.where == where)
    assert expected in fault.expected
    assert got in fault.got
    assert fault.file == path
    assert needle is None or fault.line == line_of(text, needle)


def test_a_mistake_in_one_place_is_one_fault(path):
    for edits, *_ in FAULTS:
        if "dynamic: " not in edits[0][1]:
            assert len(faults(path, edited(*edits))) == 1, edits


def test_near_names_are_offered(path):
    (fault,) = faults(path, edited(("  cheek: 20.0", "  cheeck: 20.0")))
    assert "did you mean cheek" in fault.hint
    (fault,) = faults(path, edited(("{risorius: 0.75", "{risoryus: 0.75")))
    assert "did you mean risorius" in fault.hint


def test_all_faults_are_told_at_once_in_the_order_of_the_lines(path):
    edits = [
        ("  cheek: 20.0", "  cheeck: 20.0"),
        (r"\[0.5, 6.0\]", "[7.0, 6.0]"),
        ("crossed: {upper: 2.0", "crossed: {upper: -2.0"),
        ("rho: 8.0", "rho: 80.0"),
        ("nasion: {times: 5.0", "nasion: {times: 500"),
        ("^  frontalis_outer:", "  frontalis:"),
        ("^  corrugator:\n", r"\g<0>    fall_near: 0.9\n"),
        ("zone_deg: 35.0", "zone_deg: 135"),
        ("strength: 1.0", "strength: -1"),
        (r"\{levator_labii_superioris: ", "{levator: "),
    ]
    found = faults(path, edited(*edits))
    assert [fault.where for fault in found] == [
        "depth_mm.cheeck",
        "lattice.thickness_mm",
        "lattice.thickness_mm.0",
        "springs.crossed.upper",
        "volume.rho",
        "skull.holds.nasion.times",
        "muscles",  # without frontalis_outer
        "muscles.frontalis",
        "muscles.corrugator.zone_deg",
        "muscles.corrugator.fall_start",
        "muscles.corrugator.strength",
        "muscles.levator_labii.moved_by.levator",
    ]


def test_a_missing_muscle_is_named(path):
    text = TEXT[: TEXT.index("  orbicularis_oris:\n")]
    (fault,) = faults(path, text)
    assert (fault.where, fault.expected, fault.got) == ("muscles", "an entry for orbicularis_oris", "none")
    assert text.splitlines()[fault.line - 1] == "muscles:"


@pytest.mark.parametrize("form", LARGEST_RHO)
def test_each_form_of_the_volume_force_has_its_largest_rho(path, form):
    largest = LARGEST_RHO[form]
    path.write_text(edited(("form: energy, rho: 8.0", f"form: {form}, rho: {largest}")), encoding="utf-8")
    assert read_tissue(path).volume.rho == largest
    (fault,) = faults(path, edited(("form: energy, rho: 8.0", f"form: {form}, rho: {1.01 * largest}")))
    assert fault.where == "volume.rho"
    assert form in fault.expected


def test_whole_numbers_are_numbers(path):
    """As in every other table of a face."""
    whole = re.sub(r"\b(\d+)\.0\b", r"\1", TEXT)
    assert whole.count(".0") < TEXT.count(".0") / 10
    path.write_text(whole, encoding="utf-8")
    assert read_tissue(path) == read_tissue(anatomy_file())
    (fault,) = faults(path, whole.replace("[0.5, 6]", "[7, 6]").replace("cheek: 20", "cheek: 20 "))[:1]
    assert fault.where == "lattice.thickness_mm"


@pytest.mark.parametrize(
    "content",
    [
        "",
        "[1, 2]",
        "1: 2",
        "muscles: 3",
        "muscles: [1]",
        "muscles: {1: 2, risorius: [a], mentalis: {kind: 3}, corrugator: {kind: linear, origin: 3, regions: {a: b}}}",
        "lattice: {thickness: a, thickness_mm: [a, [b]], regions: [1], carried_mm: 3}\nskull: {holds: {3: 4}}",
        "lattice: {thickness: 1.0, thickness_mm: [1" + 400 * "0" + ", 2], regions: {middle_face: 1" + 400 * "0" + "}}",
        "depth_mm: {cheek: a, 3: 4, nasion: true}\nvolume: {form: [energy], rho: {}}",
        "volume: {form: energy, rho: .inf}",
        "depth_mm: {}",
    ],
)
def test_rubbish_is_faults_and_no_other_error(path, content):
    found = faults(path, content)
    assert all(fault.file == path for fault in found)


@pytest.mark.parametrize("key", yaml.safe_load(TEXT))
def test_a_section_that_is_none_is_told_once(path, key):
    content = yaml.safe_load(TEXT)
    content[key] = 3
    text = yaml.safe_dump(content, sort_keys=False)
    assert [fault.where for fault in faults(path, text) if fault.where == key and "table" in fault.expected] == [key]


def test_a_face_without_one_says_what_to_do(tmp_path):
    with pytest.raises(DataError) as caught:
        tissue_of(tmp_path)
    (fault,) = caught.value.faults
    assert fault.file == tmp_path / "tissue.yaml"
    assert f"agentface calibrate {tmp_path} --deformer tissue" in fault.hint
    assert str(anatomy_file()) in fault.hint


@pytest.mark.parametrize("place", [anatomy_file(), *(face_folder(name) / "tissue.yaml" for name in face_names())])
def test_what_is_written_is_read_back(path, place):
    file = read_tissue(place)
    path.write_text(tissue_yaml(file), encoding="utf-8")
    assert read_tissue(path) == file
    assert tissue_yaml(read_tissue(path)) == path.read_text(encoding="utf-8")


def test_what_is_written_is_laid_out_and_commented_as_the_anatomists(path):
    written = tissue_yaml(read_tissue(anatomy_file())).splitlines()
    assert "artists' shapes of" in written[0]
    lost = [row for row in TEXT.splitlines()[1:] if row not in written]
    assert all(row.strip().startswith("insertion: ") and "[0.0, 0.0, 0.0]" in row for row in lost)  # the default
    assert max(map(len, written)) <= 120


def test_numbers_of_any_size_are_written_so_that_they_are_read_back(path):
    file = read_tissue(anatomy_file())
    odd = [1e-7, 0.1 + 0.2, -1 / 3]
    skull = file.skull.model_copy(update={"translate_mm": odd, "holds": {}})
    file = file.model_copy(update={"skull": skull, "depth_mm": {"cheek": 12.345678901234567}})
    path.write_text(tissue_yaml(file), encoding="utf-8")
    assert read_tissue(path) == file
    assert read_tissue(path).skull.translate_mm == odd
