"""Which muscles contract in the steps of 0.2, and what that is worth: section 3.1 of Bui, Heylen and Nijholt.

The paper combines muscles of other types as it combines vector muscles. Three ways to do so: orbicularis oris contracts
``once``, after the steps; in the ``steps``, where each part of it finds the lips as far as vector muscles have brought
them, which is what the geometric face does; or the steps are ``mutual``: vector muscles find the skin as far as
orbicularis oris and oculi have brought it, too.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, TypeAlias

import numpy as np

from agentface.conventions import SIDES, Doubles, Floats
from agentface.deform import order, tables
from agentface.deform.eyes import eyelids
from agentface.deform.eyes.eyelids import ACROSS, FLOOR, TIGHT_ACROSS, TIGHT_UP, UP
from agentface.deform.finish import order as last_part
from agentface.deform.finish.order import FinishStage
from agentface.deform.geometry import FaceGeometry
from agentface.deform.mouth import lips
from agentface.deform.muscles.combine import STEP, summed
from agentface.deform.muscles.vector_muscle import NOTHING
from agentface.deform.order import Stage
from agentface.facs.action_units import load_action_units
from agentface.head.model import HeadModel
from agentface.parameters import VECTOR_MUSCLES, FacePose, indices_of
from agentface.studies.calibration.agreement import PART_OF_PEAK, agreement

Way: TypeAlias = Literal["once", "steps", "mutual"]
WAYS: tuple[Way, ...] = ("once", "steps", "mutual")
_COUNT = len(VECTOR_MUSCLES)
_MUSCLES = slice(indices_of(VECTOR_MUSCLES[0])[0], indices_of(VECTOR_MUSCLES[0])[0] + _COUNT)
_WIDEST = 1e3  # m; no mouth is thinner for being less wide than that


@dataclass(frozen=True, slots=True)
class Case:
    """Muscles without side that act together, how far, and how much of which artists' shapes show the same."""

    name: str
    muscles: dict[str, float]
    shapes: dict[str, float]

    @property
    def pose(self) -> FacePose:
        """On both sides."""
        return FacePose().replace(self.muscles)

    def artists(self, model: HeadModel) -> Floats:
        """``(V, 3)`` m: the sum of the shapes."""
        shares = {name: share for name, share in self.shapes.items() if name in model.shapes}
        shares |= {name + side: self.shapes[name] for name in self.shapes.keys() - shares for side in ("Left", "Right")}
        count = len(model.vertices)
        return sum(
            (np.float32(share) * model.shapes[name].dense(count) for name, share in shares.items()), 0 * model.vertices
        )


_SMILER, _PUCKER, _PRESS = "zygomaticus_major", "orbicularis_oris_pucker", "orbicularis_oris_press"
_SQUEEZE, _TIGHT = "orbicularis_oculi_orbitalis", "orbicularis_oculi_preseptalis"
CASES = tuple(
    Case(name, muscles, shapes)
    for name, muscles, shapes in (
        ("smile, pucker", {_SMILER: 1.0, _PUCKER: 1.0}, {"mouthSmile": 1.0, "mouthPucker": 1.0}),
        ("half a smile, half a pucker", {_SMILER: 0.5, _PUCKER: 0.5}, {"mouthSmile": 0.5, "mouthPucker": 0.5}),
        ("smile, half a pucker", {_SMILER: 1.0, _PUCKER: 0.5}, {"mouthSmile": 1.0, "mouthPucker": 0.5}),
        ("half a smile, pucker", {_SMILER: 0.5, _PUCKER: 1.0}, {"mouthSmile": 0.5, "mouthPucker": 1.0}),
        ("frown, pucker", {"depressor_anguli_oris": 1.0, _PUCKER: 1.0}, {"mouthFrown": 1.0, "mouthPucker": 1.0}),
        (
            "stretch, pucker",
            {"risorius": 1.0, "platysma": 1.0, _PUCKER: 1.0},
            {"mouthStretch": 1.0, "mouthPucker": 1.0},
        ),
        (
            "raised lip, pucker",
            {"levator_labii_superioris": 1.0, "zygomaticus_minor": 0.6, _PUCKER: 1.0},
            {"mouthUpperUp": 1.0, "mouthPucker": 1.0},
        ),
        (
            "lowered lip, pucker",
            {"depressor_labii_inferioris": 1.0, _PUCKER: 1.0},
            {"mouthLowerDown": 1.0, "mouthPucker": 1.0},
        ),
        (
            "smile, press",
            {_SMILER: 1.0, _PRESS: 1.0},
            {"mouthSmile": 1.0, "mouthRollUpper": 1.0, "mouthRollLower": 1.0},
        ),
        (
            "smile, squeeze",
            {_SMILER: 1.0, _SQUEEZE: 1.0},
            {"mouthSmile": 1.0, "eyeBlink": 1.0, "cheekSquint": 1.0},
        ),
        (
            "half a smile, half a squeeze",
            {_SMILER: 0.5, _SQUEEZE: 0.5},
            {"mouthSmile": 0.5, "eyeBlink": 1.0, "cheekSquint": 0.5},
        ),
        ("smile, tight lids", {_SMILER: 1.0, _TIGHT: 1.0}, {"mouthSmile": 1.0, "eyeSquint": 1.0}),
    )
)
"""What is compared: a squeeze of a half shuts the eye, so its artists' blink is whole."""


def combined_units() -> tuple[Case, ...]:
    """The action units of orbicularis oris and vector muscles of which the artists drew the whole, not the parts."""
    units = load_action_units()
    return tuple(Case(f"AU {number}", units[number].muscles, units[number].shapes) for number in (23, 24))


@dataclass(frozen=True, slots=True)
class Comparison:
    """A case, a way: how far it is from ``once`` and from the sum of the artists' shapes.

    Attributes:
        largest_mm: the largest distance of a vertex from where it is once.
        mean_mm: the mean, over the vertices that the case moves by 0.1 mm or more.
        error_mm: the mean distance from the artists' sum, where this moves by more than a quarter of its maximum.
        cosine: the mean cosine with it, at the same vertices.
    """

    largest_mm: float
    mean_mm: float
    error_mm: float
    cosine: float


def compare(model: HeadModel, case: Case) -> dict[Way, Comparison]:
    """The three ways of a case on a face."""
    artists = case.artists(model)
    far = np.linalg.norm(artists, axis=1)
    chosen = far > PART_OF_PEAK * far.max()
    moved = {way: SteppedFace(model, way).at(case.pose).vertices - model.vertices for way in WAYS}
    some = np.linalg.norm(moved["once"], axis=1) > 1e-4
    result: dict[Way, Comparison] = {}
    for way, field in moved.items():
        apart = 1e3 * np.linalg.norm(field - moved["once"], axis=1)
        error = 1e3 * np.linalg.norm(field - artists, axis=1)[chosen]
        cosine = agreement(model, field, artists).cosine
        result[way] = Comparison(float(apart.max()), float(apart[some].mean()), float(error.mean()), cosine)
    return result


def table(models: dict[str, HeadModel]) -> str:
    """The ways of every case on each face, by its name, in Markdown."""
    rows = [
        "| face | together | steps: from once, mm | mutual: from once, mm | once: error, mm | steps | mutual "
        "| once: cosine | steps | mutual |",
        "|" + "---|" * 10,
    ]
    for face, model in models.items():
        for case in (*CASES, *combined_units()):
            ways = compare(model, case)
            apart = [f"{ways[way].largest_mm:.2f} ({ways[way].mean_mm:.2f})" for way in WAYS[1:]]
            errors, cosines = ([f"{getattr(ways[way], of):.2f}" for way in WAYS] for of in ("error_mm", "cosine"))
            rows.append(f"| {' | '.join([face, case.name, *apart, *errors, *cosines])} |")
    return "\n".join(rows)


class SteppedFace:
    """The geometric face in numpy, with its steps taken one by one; ``steps`` makes what the deformer makes."""

    def __init__(self, model: HeadModel, way: Way) -> None:
        self._model, self._way = model, way
        self._tables = tables.of(model)
        skin = self._tables.skin
        self._muscles = tables.muscles_of(model, skin.lips)
        self._without_thinning = skin.lips._replace(width=_WIDEST)
        self._thinning_alone = skin.lips._replace(shift=0 * skin.lips.shift, pull=0 * skin.lips.pull)
        fields = skin.eyelids.fields.copy()
        fields[:, [ACROSS, UP, TIGHT_ACROSS, TIGHT_UP]] = 0.0
        self._lids_alone = skin.eyelids._replace(fields=fields)

    def at(self, pose: FacePose) -> FaceGeometry:
        """The face in ``pose``."""
        values, skin = pose.array, self._tables.skin
        by_vectors, by_others = self._contracted(values)
        points: Floats = (skin.rest + by_vectors).astype(np.float32)
        found = lips.as_they_lie(skin.lips, points)
        order.deform(Stage.VOLUMES, Stage.LIMITS, skin, values, found, points)
        if self._way == "once":
            found = lips.as_they_lie(skin.lips, points)
            order.deform(Stage.ORBICULARIS_ORIS, Stage.EYELIDS, skin, values, found, points)
        else:
            lips.contract(self._thinning_alone, values, found, points)
            points += by_others
            self._move_lids(values, by_others, points)
        order.deform(Stage.JAW, Stage.MIDPOINTS, skin, values, found, points)
        return self.shown(values, points[: len(self._model.vertices)])

    def shown(self, values: Floats, vertices: Floats) -> FaceGeometry:
        """The face whose skin is at ``vertices (V, 3)`` m, ready to be drawn."""
        geometry = FaceGeometry.at_rest(self._model)
        geometry.vertices[:] = vertices
        first, last = FinishStage.SMOOTH_NORMALS, FinishStage.NECK
        last_part.finish(first, last, self._tables.finish, values, geometry.arrays())
        return geometry

    def _contracted(self, values: Floats) -> tuple[Doubles, Floats]:
        """``(P, 3)`` m each: what the vector muscles have moved after the steps, and what the others have."""
        skin, mutual = self._tables.skin, self._way == "mutual"
        left = np.concatenate([values[_MUSCLES], values[skin.lips.parameters], *self._of_eyes(values)]).astype(float)
        lip_muscles, eye_muscles = slice(_COUNT, _COUNT + 2), slice(_COUNT + 2, None)
        done = np.zeros_like(left)
        by_vectors, by_others = np.zeros((2, *skin.rest.shape))
        while (left > NOTHING).any():
            part = np.minimum(left, STEP)
            start = skin.rest + by_vectors
            there = start + by_others * mutual
            by_others += self._lips(done[lip_muscles], part[lip_muscles], start)
            if mutual:
                by_others += self._eyes(done[eye_muscles], part[eye_muscles])
            by_vectors += summed(there, self._muscles, part[:_COUNT]) - there
            done, left = done + part, left - part
        return by_vectors, by_others.astype(np.float32)

    def _of_eyes(self, values: Floats) -> tuple[list[float], list[float]]:
        """The squeeze of each eye and the tightening of each lower lid that is not shut."""
        of = self._tables.skin.eyelids
        eyes = [(float(values[of.closing[i]]), float(values[of.squeezing[i]])) for i in range(len(SIDES))]
        both = [eyelids.coupled(*eyes[i], *eyes[1 - i]) for i in range(len(SIDES))]
        tight = [(1.0 - shut) * float(values[of.tightening[i]]) for i, (shut, _) in enumerate(both)]
        return [squeeze for _, squeeze in both], tight

    def _lips(self, done: Doubles, part: Doubles, start: Doubles) -> Floats:
        """What a part of orbicularis oris moves that finds the lips at ``start``, less what it has itself moved."""
        ends: list[Floats] = []
        of = self._without_thinning
        for levels in (done, done + part):
            pose, points = FacePose().array.copy(), start.astype(np.float32)
            pose[of.parameters] = levels
            lips.contract(of, pose, lips.as_they_lie(of, points), points)
            ends.append(points)
        return ends[1] - ends[0]

    def _eyes(self, done: Doubles, part: Doubles) -> Doubles:
        """What parts of a squeeze and of tight lids move: fields over the skin, wherever it is."""
        of = self._tables.skin.eyelids
        moved = np.zeros(self._tables.skin.rest.shape)
        fields = np.moveaxis(of.fields, 1, 0).reshape(FLOOR + 1, -1)
        way = (done + part) * (2.0 - done - part) - done * (2.0 - done)
        for i in range(len(SIDES)):
            vertex, sign, tight = of.vertex[i].ravel(), 1 - 2 * i, part[len(SIDES) + i]
            moved[vertex, 0] = sign * (way[i] * fields[ACROSS] + tight * fields[TIGHT_ACROSS])
            moved[vertex, 1] = way[i] * fields[UP] + tight * fields[TIGHT_UP]
        return moved

    def _move_lids(self, values: Floats, by_others: Floats, points: Floats) -> None:
        """The lids' turns; where the eyes' muscles have moved the skin in the steps, not once more."""
        of = self._tables.skin.eyelids
        if self._way == "mutual":
            rest = np.moveaxis(self._model.vertices[of.vertex] + by_others[of.vertex], 3, 2)
            of = self._lids_alone._replace(rest=np.ascontiguousarray(rest))
        eyelids.apply(of, values, points)
