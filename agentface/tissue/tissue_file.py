"""``tissue.yaml``: the soft tissue of one face and the muscles in it, read and checked."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import Field, model_validator

from agentface.config import Document, Table
from agentface.conventions import SIDES
from agentface.errors import DataError, Fault, did_you_mean
from agentface.head.landmarks import LANDMARKS, PAIRED_LANDMARKS
from agentface.head.muscles import Anchor, Territory
from agentface.head.regions import HALF_REGIONS, SUB_REGIONS
from agentface.parameters import MUSCLES
from agentface.resources import data_folder

TISSUE_FILE = "tissue.yaml"
VolumeForm = Literal["energy", "printed", "signed", "epidermis"]
LARGEST_RHO: dict[str, float] = {"energy": 32.0, "printed": 0.3, "signed": 3.0, "epidermis": 16.0}
"""What each form of the volume force bears before it diverges; ``agentface bench tissue --volume`` shows it."""
TISSUE_MUSCLES = (
    "frontalis_inner", "frontalis_outer", "corrugator", "levator_alaeque_nasi", "levator_labii", "zygomaticus_major",
    "risorius", "depressor_anguli", "depressor_labii", "mentalis", "orbicularis_oculi", "orbicularis_oris",
)  # fmt: skip
"""Without side: ten pairs of linear muscles and sheets, and the three sphincters."""
UNPAIRED = "orbicularis_oris"
_MOVABLE = (*HALF_REGIONS, *SUB_REGIONS)

_Stiffness = Annotated[float, Field(gt=0, le=100)]
_Length = Annotated[float, Field(gt=0, le=5)]
_Millimetres = Annotated[float, Field(gt=0, le=40)]
_Vector = Annotated[list[float], Field(min_length=3, max_length=3)]


class LatticeTable(Table):
    """The three layers: ``thickness`` of them all as a part of the depth of the soft tissue, within ``thickness_mm``.

    ``dermis`` says where the middle layer lies, 0 the epidermis and 1 the hypodermis; ``regions`` makes the layers of
    a region thicker or thinner; round the landmarks of ``carried_mm`` the skin follows the tissue instead of being
    part of it.
    """

    thickness: Annotated[float, Field(gt=0, le=1)]
    thickness_mm: Annotated[list[_Millimetres], Field(min_length=2, max_length=2)]
    dermis: Annotated[float, Field(ge=0.1, le=0.9)]
    regions: dict[str, Annotated[float, Field(ge=0.2, le=3)]] = {}
    carried_mm: dict[str, Annotated[float, Field(gt=0, le=30)]]


class LayersTable(Table):
    """Stiffness of the springs along each layer."""

    epidermis: _Stiffness
    dermis: _Stiffness
    hypodermis: _Stiffness


class GapsTable(Table):
    """Stiffness of springs between epidermis and dermis, and between dermis and hypodermis, for 8 mm2 of skin."""

    upper: _Stiffness
    lower: _Stiffness


class SpringsTable(Table):
    """The springs. ``alpha`` is Eq. 1's; ``unit`` its unit of length, as a part of each spring's length at rest.

    ``bending`` is the part of its stiffness with which a spring also holds its direction: without any, thin skin that
    is pressed together folds, and folds have several equilibria.
    """

    layers: LayersTable
    connecting: GapsTable
    crossed: GapsTable
    alpha: Literal[0, 1, 2]
    unit: Annotated[float, Field(ge=0.05, le=10)]
    bending: Annotated[float, Field(ge=0, le=2)]


class VolumeTable(Table):
    """The volume force: its form and Eq. 3's ``rho``."""

    form: VolumeForm
    rho: Annotated[float, Field(ge=0)]

    @model_validator(mode="after")
    def _bounded(self) -> VolumeTable:
        if self.rho > LARGEST_RHO[self.form]:
            limit = LARGEST_RHO[self.form]
            raise ValueError(f"expected a rho of at most {limit:g}: with the form {self.form} more diverges")
        return self


class HoldTable(Table):
    """Round a landmark: ``times`` the hold on the bone within ``radius_mm``, fading to once at twice that."""

    times: Annotated[float, Field(ge=0.02, le=20)]
    radius_mm: _Millimetres


class SkullTable(Table):
    """What holds the tissue: springs to the bone ``along`` and ``across`` the skin, for 8 mm2, and ``contact`` with it.

    ``holds`` say how much more, or less, the skin over a landmark is held. The skull is fitted to the depths; then it
    is rotated, scaled about its centre, and translated, as the paper's user does.
    """

    along: _Stiffness
    across: _Stiffness
    contact: _Stiffness
    holds: dict[str, HoldTable] = {}
    rotate_deg: _Vector = [0.0, 0.0, 0.0]
    translate_mm: _Vector = [0.0, 0.0, 0.0]
    scale: Annotated[list[Annotated[float, Field(ge=0.8, le=1.2)]], Field(min_length=3, max_length=3)] = [1.0, 1.0, 1.0]


class DynamicsTable(Table):
    """``frequency_hz`` of a muscle of average reach, and the part of critical damping that tissue has."""

    frequency_hz: Annotated[float, Field(ge=1, le=30)]
    damping: Annotated[float, Field(ge=0.2, le=2)]


class _MuscleRow(Territory):
    """What every muscle has: a territory, a strength, what contracts it, and the action unit that it is fitted to."""

    strength: Annotated[float, Field(gt=0, le=100)]
    moved_by: Annotated[dict[str, Annotated[float, Field(gt=0, le=1)]], Field(min_length=1)]
    action_unit: int


class _FibreRow(_MuscleRow):
    origin: Anchor
    insertion: Anchor


class LinearRow(_FibreRow):
    """Pulls toward its bone end within a cone: from ``fall_near`` on, most at ``fall_start``, to ``fall_finish``."""

    kind: Literal["linear"]
    zone_deg: Annotated[float, Field(gt=0, le=90)]
    fall_near: Annotated[float, Field(ge=0, le=5)] = 0.0
    fall_start: _Length
    fall_finish: _Length

    @model_validator(mode="after")
    def _ordered(self) -> LinearRow:
        if not self.fall_near < self.fall_start < self.fall_finish:
            got = f"{self.fall_near:g}, {self.fall_start:g}, {self.fall_finish:g}"
            raise ValueError(f"expected fall_near, fall_start and fall_finish to grow, not {got}")
        return self


class SheetRow(_FibreRow):
    """Pulls along parallel fibres: a strip ``half_width`` to each side, fading ``above`` and ``below`` its skin end."""

    kind: Literal["sheet"]
    half_width: _Length
    above: _Length
    below: _Length


class SphincterRow(_MuscleRow):
    """Pulls toward its centre, most on an ellipse of ``crest`` times its ``radii``, not at all on its rim.

    ``upper`` is the weight of its upper half; ``outward`` the part that pushes out of the face.
    """

    kind: Literal["sphincter"]
    centre: Anchor
    radii: Annotated[list[_Length], Field(min_length=2, max_length=2)]
    crest: Annotated[float, Field(gt=0, lt=1)]
    upper: Annotated[float, Field(ge=0, le=1)]
    outward: Annotated[float, Field(ge=-1, le=1)]


MuscleRow = Annotated[LinearRow | SheetRow | SphincterRow, Field(discriminator="kind")]


class TissueFile(Table):
    """``tissue.yaml``."""

    depth_mm: dict[str, Annotated[float, Field(ge=0.5, le=40)]]
    lattice: LatticeTable
    springs: SpringsTable
    volume: VolumeTable
    skull: SkullTable
    dynamics: DynamicsTable
    muscles: dict[str, MuscleRow]


def anatomy_file() -> Path:
    """The anatomist's table, which every face's begins with."""
    return data_folder("regions") / TISSUE_FILE


def tissue_of(folder: Path) -> TissueFile:
    """The table of a face's folder; raises DataError with all faults, also when there is none."""
    path = folder / TISSUE_FILE
    if not path.is_file():
        hint = f"make one with `agentface calibrate {folder.name} --deformer tissue`, or copy {anatomy_file()}"
        raise DataError([Fault(path, None, "", "the file: the tissue deformer needs it", "none", hint)])
    return read_tissue(path)


def read_tissue(path: str | Path) -> TissueFile:
    """The checked table; raises DataError with all faults."""
    document = Document(path)
    file = document.collect(TissueFile)
    data = document.data if isinstance(document.data, dict) else {}
    _check_names(document, ("depth_mm",), data.get("depth_mm"), _POINTS, "a landmark (paired ones without side)")
    lattice = data.get("lattice")
    if isinstance(lattice, dict):
        _check_names(document, ("lattice", "regions"), lattice.get("regions"), _MOVABLE, "a region without side")
        carried = lattice.get("carried_mm")
        _check_names(document, ("lattice", "carried_mm"), carried, PAIRED_LANDMARKS, "a paired landmark without side")
        _check_thickness(document, lattice.get("thickness_mm"))
    skull = data.get("skull")
    if isinstance(skull, dict):
        _check_names(document, ("skull", "holds"), skull.get("holds"), _POINTS, "a landmark (paired ones without side)")
    muscles = data.get("muscles")
    if isinstance(muscles, dict):
        _check_muscles(document, muscles)
    document.check()
    assert file is not None, "a document without faults is parsed"  # noqa: S101 - for the type checker
    return file


_POINTS = tuple(name for name in (*LANDMARKS, *PAIRED_LANDMARKS) if name != "pupil")


def _check_names(document: Document, where: tuple[str, ...], table: Any, known: tuple[str, ...], what: str) -> None:
    for name in table if isinstance(table, dict) else ():
        if name not in known:
            document.fault((*where, name), what, str(name), did_you_mean(str(name), known))


def _check_thickness(document: Document, bounds: Any) -> None:
    if isinstance(bounds, list) and len(bounds) == 2 and all(isinstance(bound, float) for bound in bounds):
        low, high = bounds
        if high <= low:
            document.fault(("lattice", "thickness_mm"), "the least, then a larger one", str(bounds))


def _check_muscles(document: Document, muscles: dict[str, Any]) -> None:
    for name in sorted(set(TISSUE_MUSCLES) - muscles.keys()):
        document.fault(("muscles",), f"an entry for {name}", "none")
    _check_names(document, ("muscles",), muscles, TISSUE_MUSCLES, "a muscle of the tissue")
    for name, row in muscles.items():
        if isinstance(row, dict):
            where = ("muscles", name)
            _check_names(document, (*where, "moved_by"), row.get("moved_by"), MUSCLES, "a muscle without side")
            for key in ("origin", "insertion", "centre"):
                at = row[key].get("at") if isinstance(row.get(key), dict) else None
                if isinstance(at, str) and at not in (*_POINTS, "pupil"):
                    document.fault((*where, key, "at"), "a landmark (paired ones without side)", at)
            for key in ("regions", "not_regions"):
                for i, region in enumerate(row[key] if isinstance(row.get(key), list) else []):
                    if region not in _MOVABLE:
                        hint = did_you_mean(str(region), _MOVABLE)
                        document.fault((*where, key, i), f"one of {', '.join(_MOVABLE)}", str(region), hint)


NAMES: tuple[str, ...] = tuple(
    name if name == UNPAIRED else f"{name}_{side}"
    for name in TISSUE_MUSCLES
    for side in ("m" if name == UNPAIRED else SIDES)
)
"""The 23 muscles with their sides, in the order of forces and contractions."""
