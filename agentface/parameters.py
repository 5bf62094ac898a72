"""The table of every animation parameter, and :class:`FacePose`, their values at one instant.

This module is the one owner of the names, ranges and units: mixer, controls, OSC, the command line and the documents
read the table. A face's ``muscles.yaml`` says how each vector muscle moves that face; the rules say how far each
muscle contracts; both are checked against it.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from typing import Any, Literal, NamedTuple, get_args

import numpy as np
import numpy.typing as npt

from agentface.conventions import SIDES, Floats, check_range
from agentface.errors import InvalidValueError, UnknownNameError
from agentface.named_array import NamedArray

Kind = Literal["vector", "pseudo", "morph", "jaw", "tongue", "eye", "gaze", "head", "contact", "chest"]
"""What moves: a vector muscle, a muscle of another form, skin by a shape (``morphs.yaml``), jaw, tongue, an eyeball or
its pupil, the gaze, the head, lips until they touch something (:mod:`agentface.deform.mouth.contact`), the chest."""
Unit = Literal["contraction", "opening", "share", "rad"]
"""Contractions and openings are 0..1, at 0 where the face is at rest. A share is that of a whole movement, -1 of the
opposite one. Angles have a sign, too."""
Group = Literal["brow", "eyes", "nose and cheek", "mouth", "jaw", "tongue", "ears", "gaze", "head", "chest"]
GROUPS: tuple[Group, ...] = get_args(Group)
"""From the top of the face down, then what turns, and what is below."""
Way = Literal["replace", "max", "add", "scale"]
"""How what a channel asks is blended with what is there already: see :mod:`agentface.motion.mixer`."""
WAYS: tuple[Way, ...] = get_args(Way)
_FRACTIONS: tuple[Unit, ...] = ("contraction", "opening")


class _Row(NamedTuple):
    """What parameters of one name have in common."""

    kind: Kind
    group: Group
    description: str
    paired: bool = True
    unit: Unit = "contraction"
    low: float = 0.0
    high: float = 1.0
    way: Way = "max"
    sideways: bool = False


def _vector(group: Group, description: str) -> _Row:
    return _Row("vector", group, description)


def _pseudo(group: Group, description: str, *, paired: bool = True) -> _Row:
    return _Row("pseudo", group, description, paired)


def _morph(group: Group, description: str, *, paired: bool = True) -> _Row:
    return _Row("morph", group, description, paired)


def _share(
    group: Group, description: str, *, paired: bool = True, kind: Kind = "morph", sideways: bool = False
) -> _Row:
    return _Row(kind, group, description, paired, "share", -1.0, way="add", sideways=sideways)


def _tongue(description: str, *, low: float = -1.0, sideways: bool = False) -> _Row:
    return _Row("tongue", "tongue", description, False, "share", low, way="add", sideways=sideways)


def _contact(description: str) -> _Row:
    return _Row("contact", "mouth", description, False, "share")


def _angle(
    kind: Literal["gaze", "head"], low_deg: float, high_deg: float, description: str, *, sideways: bool = False
) -> _Row:
    # what a pose, which is float32, gives back at its limit, it takes again
    low, high = (float(np.float32(math.radians(limit))) for limit in (low_deg, high_deg))
    return _Row(kind, kind, description, paired=False, unit="rad", low=low, high=high, way="add", sideways=sideways)


_TABLE: dict[str, _Row] = {
    "frontalis_medialis": _vector("brow", "frontalis, medial fibres: raise the inner brow (AU 1)"),
    "frontalis_intermedius": _vector("brow", "frontalis, middle fibres: raise the middle of the brow (AU 1, 2)"),
    "frontalis_lateralis": _vector("brow", "frontalis, lateral fibres: raise the outer brow (AU 2)"),
    "corrugator_supercilii": _vector("brow", "draws the brow inward and down (AU 4)"),
    "depressor_supercilii": _vector("brow", "draws the inner brow down (AU 4)"),
    "procerus": _vector("brow", "draws the skin between the brows down (AU 4, 9)"),
    "orbicularis_oculi_medialis": _vector(
        "nose and cheek", "orbicularis oculi, orbital part, lower medial fibres: raise the cheek (AU 6)"
    ),
    "orbicularis_oculi_lateralis": _vector(
        "nose and cheek", "orbicularis oculi, orbital part, lower lateral fibres: raise the cheek (AU 6)"
    ),
    "levator_labii_superioris_alaeque_nasi": _vector("nose and cheek", "wrinkles the nose (AU 9)"),
    "nasalis": _vector("nose and cheek", "compresses the nose and wrinkles its side (AU 9)"),
    "levator_labii_superioris": _vector("mouth", "raises the upper lip (AU 10)"),
    "zygomaticus_minor": _vector("mouth", "draws the upper lip up and outward (AU 10, 11)"),
    "zygomaticus_major": _vector("mouth", "draws the lip corner up and outward: the smile (AU 12)"),
    "levator_anguli_oris": _vector("mouth", "raises the lip corner (AU 13)"),
    "depressor_anguli_oris": _vector("mouth", "draws the lip corner down (AU 15)"),
    "depressor_labii_inferioris": _vector("mouth", "draws the lower lip down (AU 16)"),
    "mentalis": _vector("mouth", "pushes the chin and the lower lip up (AU 17)"),
    "risorius": _vector("mouth", "stretches the lip corner outward (AU 20)"),
    "platysma": _vector("mouth", "stretches the lip corner outward and down (AU 20)"),
    "levator_palpebrae": _pseudo("eyes", "opens the upper lid past neutral (AU 5)"),
    "orbicularis_oculi_palpebralis": _pseudo("eyes", "orbicularis oculi, palpebral part: closes the lids (AU 43, 45)"),
    "orbicularis_oculi_orbitalis": _pseudo("eyes", "orbicularis oculi, orbital part: squeezes the eye"),
    "orbicularis_oculi_preseptalis": _pseudo(
        "eyes", "orbicularis oculi, preseptal part: tightens the lower lid (AU 7)"
    ),
    "orbicularis_oris_pucker": _pseudo("mouth", "orbicularis oris, puckering the lips (AU 18)", paired=False),
    "orbicularis_oris_press": _pseudo("mouth", "orbicularis oris, pressing the lips together (AU 24)", paired=False),
    "jaw_open": _Row("jaw", "jaw", "drops the jaw (AU 26, 27)", paired=False, unit="opening"),
    "gaze_yaw": _angle("gaze", -50, 50, "the eyes turn to the person's left", sideways=True),
    "gaze_pitch": _angle("gaze", -40, 40, "the eyes turn upward"),
    "head_yaw": _angle("head", -80, 80, "the head turns to its left", sideways=True),
    "head_pitch": _angle("head", -60, 60, "the head looks up"),
    "head_roll": _angle("head", -50, 50, "the head tilts to its left", sideways=True),
    "gaze_vergence": _angle("gaze", -10, 25, "each eye turns inward"),
    "orbicularis_oris_press_upper": _morph("mouth", "orbicularis oris, upper lip: presses a half of it (AU 24)"),
    "orbicularis_oris_press_lower": _morph("mouth", "orbicularis oris, lower lip: presses a half of it (AU 24)"),
    "orbicularis_oris_funnel_upper": _morph("mouth", "orbicularis oris, upper lip: turns a half of it out (AU 22)"),
    "orbicularis_oris_funnel_lower": _morph("mouth", "orbicularis oris, lower lip: turns a half of it out (AU 22)"),
    "orbicularis_oris_roll_upper": _share("mouth", "orbicularis oris, upper lip: rolls half of it in (AU 28), or out"),
    "orbicularis_oris_roll_lower": _share("mouth", "orbicularis oris, lower lip: rolls half of it in (AU 28), or out"),
    "mouth_shrug_upper": _morph("mouth", "lifts the upper lip towards the nose", paired=False),
    "mouth_shrug_lower": _morph("mouth", "lifts the lower lip over the upper one (AU 17)", paired=False),
    "buccinator": _morph("mouth", "draws the lip corner back against the teeth: the dimple (AU 14)"),
    "mouth_shift": _share("mouth", "the mouth goes to the person's left", paired=False, sideways=True),
    "cheek_puff": _share("nose and cheek", "blows the cheek up (AU 34), or sucks it in (AU 35)"),
    "nostril_flare": _share("nose and cheek", "widens the nostril (AU 38), or narrows it (AU 39)"),
    "nose_raise": _share("nose and cheek", "the tip of the nose goes up", paired=False),
    "nose_bend": _share("nose and cheek", "the tip of the nose goes to the person's left", paired=False, sideways=True),
    "jaw_thrust": _share("jaw", "thrusts the jaw forward (AU 29), or draws it back", paired=False, kind="jaw"),
    "jaw_shift": _share("jaw", "the jaw goes to the person's left (AU 30)", paired=False, kind="jaw", sideways=True),
    "ear_raise": _share("ears", "auricularis superior: raises the ear, or lowers it"),
    "ear_back": _share("ears", "auricularis posterior: draws the ear back, or forward"),
    "tongue_out": _tongue("the tongue comes out, as far as teeth and lips let it", low=0.0),
    "tongue_raise": _tongue("the back of the tongue goes up, or down"),
    "tongue_tip_raise": _tongue("the tip of the tongue goes up, or down"),
    "tongue_tip_shift": _tongue("the tip of the tongue goes to the person's left", sideways=True),
    "tongue_roll": _tongue("the edges of the tongue roll up", low=0.0),
    "pupil_dilation": _share("eyes", "the pupil grows to twice its diameter, or shrinks to half of it", kind="eye"),
    "eye_thrust": _share("eyes", "the eyeball comes out of its socket, or sinks into it", kind="eye"),
    "lip_seal": _contact("draws the lips together, whatever parts them: p, b, m"),
    "lip_bite": _contact("brings the edge of the lower lip to the upper incisors: f, v"),
    "breath": _Row("chest", "chest", "fills the chest and lifts the shoulders", False, "share", way="add"),
}


@dataclass(frozen=True, slots=True)
class Parameter:
    """One animation parameter.

    Attributes:
        name: with its side last where it has one.
        index: its place in a pose.
        kind: what moves.
        unit: of ``low``, ``high`` and ``neutral``.
        low: the least value.
        high: the largest value.
        neutral: its value when nothing moves the face.
        partner: the same on the other side of the face; None in the middle.
        group: the part of the face to which a user would look for it.
        way: how a channel's value is blended with that of the others, where ``rules/conflicts.yaml`` says nothing else.
        sideways: whether it goes to the person's left where it is positive: mirrored, it has the other sign.
        description: what it does.
    """

    name: str
    index: int
    kind: Kind
    unit: Unit
    low: float
    high: float
    neutral: float
    partner: str | None
    group: Group
    way: Way
    sideways: bool
    description: str

    @property
    def contracts(self) -> bool:
        """Whether it is a muscle, or the jaw: something that is held between 0, at rest, and 1."""
        return self.unit in _FRACTIONS

    @property
    def held(self) -> bool:
        """Whether it is set by hand like a muscle and released again; what turns stands beside that."""
        return self.unit != "rad"

    @property
    def morphs(self) -> bool:
        """Whether the face's ``morphs.yaml`` says how it moves the skin."""
        return self.kind == "morph" or (self.kind == "jaw" and self.unit == "share")

    @property
    def bounds(self) -> tuple[float, float]:
        """The range as people give it: contractions and openings 0..1, angles in degrees."""
        if self.unit != "rad":
            return self.low, self.high
        return round(math.degrees(self.low), 4), round(math.degrees(self.high), 4)  # single precision has seven digits


def _build() -> tuple[Parameter, ...]:
    rows: list[tuple[str, str | None, _Row]] = []
    for name, row in _TABLE.items():
        left, right = (f"{name}_{side}" for side in SIDES)
        rows += [(left, right, row), (right, left, row)] if row.paired else [(name, None, row)]
    return tuple(
        Parameter(
            name,
            index,
            kind=row.kind,
            unit=row.unit,
            low=row.low,
            high=row.high,
            neutral=0.0,
            partner=partner,
            group=row.group,
            way=row.way,
            sideways=row.sideways,
            description=row.description,
        )
        for index, (name, partner, row) in enumerate(rows)
    )


PARAMETERS: tuple[Parameter, ...] = _build()
NAMES: tuple[str, ...] = tuple(parameter.name for parameter in PARAMETERS)
COUNT = len(PARAMETERS)
MUSCLES: tuple[str, ...] = tuple(name for name, row in _TABLE.items() if row.unit in _FRACTIONS)
"""What a rule may contract: muscles without their side, and the jaw."""
PLAIN_NAMES: tuple[str, ...] = tuple(_TABLE)
"""All names without side."""
CONTRACTIONS: tuple[str, ...] = tuple(parameter.name for parameter in PARAMETERS if parameter.contracts)
"""The parameters that are 0..1, sides apart: every muscle, and the jaw."""
HELD: tuple[str, ...] = tuple(parameter.name for parameter in PARAMETERS if parameter.held)
"""The contractions, and the shares, which are signed: what is set by hand."""
VECTOR_MUSCLES: tuple[str, ...] = tuple(parameter.name for parameter in PARAMETERS if parameter.kind == "vector")
"""The vector muscles with their sides, in the order of their parameters."""
LOW: Floats = np.array([parameter.low for parameter in PARAMETERS], np.float32)
HIGH: Floats = np.array([parameter.high for parameter in PARAMETERS], np.float32)
NEUTRAL: Floats = np.array([parameter.neutral for parameter in PARAMETERS], np.float32)
LOW.flags.writeable = HIGH.flags.writeable = NEUTRAL.flags.writeable = False
_BY_NAME = {parameter.name: parameter for parameter in PARAMETERS}


_IMAGES = np.array([_BY_NAME[known.partner or known.name].index for known in PARAMETERS])
_SIGNS = np.array([-1.0 if known.sideways else 1.0 for known in PARAMETERS], np.float32)


def parameter(name: str) -> Parameter:
    """The parameter called ``name``; raises UnknownNameError."""
    try:
        return _BY_NAME[name]
    except (KeyError, TypeError):
        raise UnknownNameError("parameter", name, NAMES) from None


@cache
def indices_of(muscle: str) -> tuple[int, ...]:
    """Where a muscle stands in a pose: two indices for a paired muscle named without its side, else one.

    Raises UnknownNameError, which knows the names without side, too.
    """
    if muscle in _BY_NAME:
        return (_BY_NAME[muscle].index,)
    if f"{muscle}_l" in _BY_NAME:
        return tuple(_BY_NAME[f"{muscle}_{side}"].index for side in SIDES)
    raise UnknownNameError("parameter", muscle, (*PLAIN_NAMES, *NAMES))


@cache
def muscle_names() -> tuple[str, ...]:
    """The names that a muscle is known by: those without side, then those with it, and the jaw."""
    return tuple(dict.fromkeys((*MUSCLES, *CONTRACTIONS)))


@cache
def parameter_names() -> tuple[str, ...]:
    """The names that a parameter is known by: without side, with it, and angles that end in ``_deg``."""
    angles = (f"{known.name}_deg" for known in PARAMETERS if known.unit == "rad")
    return tuple(dict.fromkeys((*PLAIN_NAMES, *NAMES, *angles)))


def check_degrees(name: str, degrees: Any) -> float:
    """``degrees`` as a float in the range of an angle such as ``gaze_yaw``; raises InvalidValueError."""
    return check_range(f"{name}_deg", degrees, *parameter(name).bounds)


def check_pose(values: Floats) -> None:
    """Raise InvalidValueError, naming the first parameter, unless ``values (COUNT,)`` lie within their ranges."""
    if np.count_nonzero((values >= LOW) & (values <= HIGH)) != len(values):  # a frame's time: faster than all()
        raise _refusal(values)


def check_poses(values: Floats) -> None:
    """As :func:`check_pose` for ``(B, COUNT)``; the error also names the pose."""
    good = ((values >= LOW) & (values <= HIGH)).all(axis=1)
    if not good.all():
        pose = int(np.argmin(good))
        raise _refusal(values[pose], f"pose {pose}: ")


def _refusal(values: Floats, before: str = "") -> InvalidValueError:
    index = int(np.argmin((values >= LOW) & (values <= HIGH)))
    known, got = PARAMETERS[index], float(values[index])
    what, unit = ("angle", " rad") if known.unit == "rad" else (known.unit, "")
    expected = f"a number in {known.low:g}..{known.high:g}{unit}" if np.isfinite(got) else "a finite number"
    return InvalidValueError(f"{before}{what} of {known.name}", expected, got)


class FacePose(NamedArray):
    """Every animation parameter at one instant; immutable, neutral where not said otherwise.

    ``array`` is a read-only float32 array of ``COUNT`` values in the order of ``PARAMETERS``.
    """

    __slots__ = ()
    array: Floats

    def __init__(self, array: npt.NDArray[np.floating[Any]] | None = None) -> None:
        values = np.array(NEUTRAL if array is None else array, np.float32)
        if values.shape != (COUNT,):
            raise InvalidValueError("FacePose", f"{COUNT} values", values.shape)
        if np.count_nonzero(np.isfinite(values)) != COUNT:  # a frame's time: faster than all()
            raise InvalidValueError("FacePose", "finite values", values[~np.isfinite(values)][0])
        self._freeze(values)

    @classmethod
    def of(cls, **contractions: float) -> FacePose:
        """A pose from names: ``FacePose.of(zygomaticus_major=0.8, jaw_open=0.2)``; a paired name sets both sides."""
        return cls().replace(contractions)

    def replace(self, contractions: Mapping[str, float]) -> FacePose:
        """A copy with some parameters changed; raises UnknownNameError or InvalidValueError."""
        values = self.array.copy()
        for name, value in contractions.items():
            for index in indices_of(name):
                known = PARAMETERS[index]
                values[index] = check_range(name, value, known.low, known.high)
        return FacePose(values)

    def mirrored(self) -> FacePose:
        """The pose of the face's image in its median plane."""
        return FacePose(_SIGNS * self.array[_IMAGES])

    def __getitem__(self, name: str) -> float:
        return float(self.array[parameter(name).index])

    def __iter__(self) -> Iterator[str]:
        return iter(NAMES)

    def __repr__(self) -> str:
        active = ", ".join(f"{name}={value:.3g}" for name, value in self.items() if value)
        return f"FacePose.of({active})"
