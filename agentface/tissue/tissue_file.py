"""The tables of ``tissue.yaml``: the soft tissue of one face and the muscles in it.

What a table holds by itself is checked here; what its names mean, and how numbers fit together, when it is read
(:mod:`agentface.tissue.reading`).
"""

from __future__ import annotations

from typing import Annotated, Literal, get_args

from pydantic import Field

from agentface.config import Table
from agentface.conventions import SIDES
from agentface.head.muscles import Anchor, Territory

TISSUE_FILE = "tissue.yaml"
VolumeForm = Literal["energy", "printed", "signed", "epidermis"]
FORMS: tuple[VolumeForm, ...] = get_args(VolumeForm)
LARGEST_RHO: dict[str, float] = {"energy": 12.0, "printed": 1.0, "signed": 10.0, "epidermis": 16.0}
"""What each form of the volume force bears before it diverges; ``agentface bench tissue --volume`` shows it."""
TISSUE_MUSCLES = (
    "frontalis_inner", "frontalis_outer", "corrugator", "levator_alaeque_nasi", "levator_labii", "zygomaticus_major",
    "risorius", "depressor_anguli", "depressor_labii", "mentalis", "orbicularis_oculi", "orbicularis_oris",
)  # fmt: skip
"""Without side: ten pairs of linear muscles and sheets, and the three sphincters."""
SHALLOWEST_MM = 0.5
"""The least depth that soft tissue has anywhere."""
UNPAIRED = "orbicularis_oris"
NAMES: tuple[str, ...] = tuple(
    full for name in TISSUE_MUSCLES for full in ([name] if name == UNPAIRED else [f"{name}_{side}" for side in SIDES])
)
"""The 23 muscles with their sides, in the order of forces and contractions."""


def row_and_side(name: str) -> tuple[str, str | None]:
    """The name of a muscle's row, and its side; None for the one in the middle."""
    return (name, None) if name == UNPAIRED else (name[:-2], name[-1])


_Stiffness = Annotated[float, Field(gt=0, le=100)]
_Length = Annotated[float, Field(gt=0, le=5)]
_Millimetres = Annotated[float, Field(gt=0, le=40)]
_Degrees = Annotated[float, Field(ge=-45, le=45)]
_Way = Annotated[float, Field(ge=-40, le=40)]


class LatticeTable(Table):
    """The three layers: ``thickness`` of them all as a part of the depth of the soft tissue, within ``thickness_mm``.

    ``dermis`` says where the middle layer lies, 0 the epidermis and 1 the hypodermis; ``regions`` makes the layers of
    a region thicker or thinner; round the landmarks of ``carried_mm`` the skin follows the tissue instead of being
    part of it.
    """

    thickness: Annotated[float, Field(ge=0.05, le=1)]
    thickness_mm: Annotated[list[Annotated[float, Field(ge=0.1, le=40)]], Field(min_length=2, max_length=2)]
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
    rotate_deg: Annotated[list[_Degrees], Field(min_length=3, max_length=3)] = [0.0, 0.0, 0.0]
    translate_mm: Annotated[list[_Way], Field(min_length=3, max_length=3)] = [0.0, 0.0, 0.0]
    scale: Annotated[list[Annotated[float, Field(ge=0.8, le=1.2)]], Field(min_length=3, max_length=3)] = [1.0, 1.0, 1.0]


class DynamicsTable(Table):
    """``frequency_hz`` of a muscle of average reach, and the part of critical damping that tissue has."""

    frequency_hz: Annotated[float, Field(ge=1, le=30)]
    damping: Annotated[float, Field(ge=0.2, le=2)]


class _MuscleRow(Territory):
    """What every muscle has: a territory, a strength, what contracts it, and the action unit that it is fitted to."""

    strength: Annotated[float, Field(gt=0, le=1000)]
    moved_by: Annotated[dict[str, Annotated[float, Field(gt=0, le=1)]], Field(min_length=1)]
    action_unit: Annotated[int, Field(ge=1, le=99)]


class _FibreRow(_MuscleRow):
    origin: Anchor
    insertion: Anchor


class BellyTable(Anchor):
    """Where a muscle that shortens thickens, and how hard it lifts the fat over it there, for 8 mm2 of skin."""

    radius: _Length
    strength: Annotated[float, Field(gt=0, le=20)]


class LinearRow(_FibreRow):
    """Pulls toward its bone end within a cone: from ``fall_near`` on, most at ``fall_start``, to ``fall_finish``.

    With a ``belly`` it pushes out of the face as well, round that.
    """

    kind: Literal["linear"]
    zone_deg: Annotated[float, Field(gt=0, le=90)]
    fall_near: Annotated[float, Field(ge=0, le=5)] = 0.0
    fall_start: _Length
    fall_finish: _Length
    belly: BellyTable | None = None


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

    depth_mm: Annotated[dict[str, Annotated[float, Field(ge=SHALLOWEST_MM, le=40)]], Field(min_length=1)]
    lattice: LatticeTable
    springs: SpringsTable
    volume: VolumeTable
    skull: SkullTable
    dynamics: DynamicsTable
    muscles: dict[str, MuscleRow]
