"""A face as an asset: everything in ``regions/<face>/``, read and checked once."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, fields, is_dataclass, replace
from functools import cached_property, lru_cache
from pathlib import Path
from typing import Annotated, Any, TypeVar

import numpy as np
from pydantic import AfterValidator, Field

from agentface.cache import prepared, stamp_of
from agentface.config import Table, load
from agentface.conventions import SIDES, Floats, Indices, check_fraction
from agentface.errors import DataError, Fault, InvalidValueError
from agentface.head import asymmetry as own
from agentface.head.dental_wall import between_the_teeth
from agentface.head.feature_points import FeaturePointRow, check_parts
from agentface.head.landmarks import Landmarks, place_landmarks, read_landmarks
from agentface.head.morphs import MorphsFile, MorphSkin, PlacedMorph, place_morphs, read_morphs
from agentface.head.muscle_set import MuscleSet
from agentface.head.muscles import Borders, MusclesFile, place_muscles, read_muscles
from agentface.head.regions import Regions, load_regions
from agentface.head.rings import EyelidsFile, LipsFile, load_rings
from agentface.head.unwrap import unwrap, unwrap_centre, unwrap_cover
from agentface.head.volumes import PlacedVolume, VolumesFile, place_volumes, read_volumes
from agentface.head.wrinkles import PlacedTrain, WrinklesFile, place_trains, read_wrinkles
from agentface.mesh.glb import MeshArrays, Shape, read_glb, texture_coordinates
from agentface.mesh.normals import vertex_normals
from agentface.resources import DEFAULT_FACE, face_folder

_Point = Annotated[list[Annotated[float, Field(ge=-0.3, le=0.3)]], Field(min_length=3, max_length=3)]
_T = TypeVar("_T")
_STAMP = "_stamp"
_KEPT = 8
"""Faces that are kept once they are read."""
PARTS = ("teeth_upper", "teeth_lower", "tongue", "eye_l", "eye_r")


def _left(centre: list[float]) -> list[float]:
    if not 0.01 <= centre[0] <= 0.1:
        raise ValueError("expected an x of 0.01 to 0.1 m: the left eye")
    return centre


def _in_the_middle(pivot: list[float]) -> list[float]:
    if pivot[0] != 0.0:
        raise ValueError("expected an x of 0: a point in the median plane")
    return pivot


class EyeHole(Table):
    """How far the eyes turn: half the width and half the height of the elliptic eye hole."""

    yaw_limit_deg: Annotated[float, Field(gt=0, le=60)]
    pitch_limit_deg: Annotated[float, Field(gt=0, le=60)]


class EyesFile(EyeHole):
    """``eyes.yaml``: the left eyeball in metres, and how far the eyes turn."""

    centre: Annotated[_Point, AfterValidator(_left)]
    radius: Annotated[float, Field(ge=0.003, le=0.05)]


class JawFile(Table):
    """``jaw.yaml``: a point of the hinge in metres (the axis is parallel to X) and the widest opening."""

    pivot: Annotated[_Point, AfterValidator(_in_the_middle)]
    widest_deg: Annotated[float, Field(gt=0, le=60)]


MUSCLES_FILE = "muscles.yaml"
TABLES: dict[str, Callable[[Path, MeshArrays], Any]] = {
    "eyes.yaml": lambda path, _: load(path, EyesFile),
    "lips.yaml": lambda path, skin: load_rings(path, LipsFile, skin),
    "eyelids.yaml": lambda path, skin: load_rings(path, EyelidsFile, skin),
    "regions.yaml": lambda path, skin: load_regions(path, len(skin.attributes["POSITION"])),
    "feature_points.yaml": lambda path, skin: read_landmarks(path, len(skin.attributes["POSITION"])),
    "jaw.yaml": lambda path, _: load(path, JawFile),
    MUSCLES_FILE: lambda path, _: read_muscles(path),
    "wrinkles.yaml": lambda path, _: read_wrinkles(path),
    "volumes.yaml": lambda path, _: read_volumes(path),
    "morphs.yaml": lambda path, _: read_morphs(path),
    "asymmetry.yaml": lambda path, _: own.read_asymmetry(path),
}
"""The tables of a face's folder, and how each is read and checked beside the face's skin."""


@dataclass(frozen=True, eq=False)
class HeadModel:
    """A face at rest and what its deformers need.

    Attributes:
        name: the name of its folder.
        folder: where it was read from.
        vertices: ``(V, 3)`` float32 m, the skin at rest.
        triangles: ``(T, 3)`` int32, counter-clockwise seen from outside.
        material: ``(V, 4)`` float32 0..1: lip, inside of the mouth, wet lid margin, ear.
        shade: ``(V, 4)`` float32 0..1: ambient light that reaches the vertex, hair cover, two spare.
        jaw_weights: ``(V,)`` float32 0..1, how far a vertex follows the jaw.
        mirror: ``(V,)`` int32, the vertex that is each vertex's image in the median plane.
        shapes: the artists' ARKit-named shapes of the skin.
        parts: the other meshes: teeth, tongue, eyeballs.
        regions: the eleven regions and the sub-regions.
        landmarks: named points.
        feature_points: the 84 points of MPEG-4 by number: see :mod:`agentface.mpeg4.feature_points`.
        eyes, jaw, lips, eyelids: the tables of the same names.
        muscles_file: the table of the vector muscles.
        wrinkles_file: the table of the trains of wrinkles that follow no single vector muscle.
        volumes_file: the table of the volumes that muscles gather or hollow.
        morphs_file: the table of what moves the skin by shapes.
        own_uv: ``(V, 2)`` float32 0..1, the texture coordinates that the file has, or None.
        gains: ``(COUNT,)`` float32, what a side makes of a contraction that an emotion asks of both.
        part_moves: ``(3,)`` m by name: how far a part's centre is off that of the symmetric face.
    """

    name: str
    folder: Path
    vertices: Floats
    triangles: Indices
    material: Floats
    shade: Floats
    jaw_weights: Floats
    mirror: Indices
    shapes: dict[str, Shape]
    parts: dict[str, MeshArrays]
    regions: Regions
    landmarks: Landmarks
    feature_points: dict[str, FeaturePointRow]
    eyes: EyesFile
    jaw: JawFile
    lips: LipsFile
    eyelids: EyelidsFile
    muscles_file: MusclesFile
    wrinkles_file: WrinklesFile
    volumes_file: VolumesFile
    morphs_file: MorphsFile
    own_uv: Floats | None
    gains: Floats
    part_moves: dict[str, Floats]

    @cached_property
    def muscles(self) -> MuscleSet:
        """The vector muscles in metres."""
        return place_muscles(self.muscles_file, self.landmarks, self.borders, self.vertices)

    @cached_property
    def borders(self) -> Borders:
        """How far each vertex lies inside a territory."""
        return Borders(self.regions, self.vertices, self.triangles)

    @cached_property
    def normals(self) -> Floats:
        """``(V, 3)`` float32, the skin's unit normals at rest."""
        return vertex_normals(self.vertices, self.triangles).astype(np.float32)

    @cached_property
    def volumes(self) -> tuple[PlacedVolume, ...]:
        """The volumes; none moves a lid's wet margin or the inside of the mouth."""
        movable = 1.0 - np.clip(2.0 * self.material[:, 1:3].max(axis=1), 0.0, 1.0)
        skin = self.vertices, self.normals
        return place_volumes(self.volumes_file, self.landmarks, self.borders, skin, movable)

    @cached_property
    def morphs(self) -> tuple[PlacedMorph, ...]:
        """What the parameters that are no single muscle do to the skin."""
        skin = MorphSkin(
            self.vertices,
            self.triangles,
            self.mirror,
            self.normals,
            self.material,
            self.shapes,
            self.landmarks,
            self.borders,
            self.lips.rings,
        )
        return place_morphs(self.morphs_file, skin)

    @cached_property
    def trains(self) -> tuple[PlacedTrain, ...]:
        """The trains of wrinkles; none rises on the lips, on a lid's wet margin or in the mouth."""
        smooth = 1.0 - np.clip(2.0 * self.material[:, :3].max(axis=1), 0.0, 1.0)
        return place_trains(self.muscles, self.muscles_file, self.wrinkles_file, self.landmarks, self.borders, smooth)

    @cached_property
    def uv(self) -> Floats:
        """``(V, 2)`` float32 0..1: texture coordinates, u to the right and v down from the picture's top, as in glTF.

        Those of the file (TEXCOORD_0) where it has any; otherwise ``head/unwrap.py`` makes some.
        """
        if self.own_uv is not None:
            return self.own_uv
        return unwrap(self.vertices, unwrap_centre(self.landmarks))

    @cached_property
    def uv_cover(self) -> Floats:
        """``(V,)`` float32 0..1: how much of a picture at ``uv`` shows; 0 at the back of a head that was unwrapped."""
        if self.own_uv is not None:
            return np.ones(len(self.vertices), np.float32)
        return unwrap_cover(self.vertices, unwrap_centre(self.landmarks))

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, HeadModel):
            return NotImplemented
        return self is other or (type(self) is type(other) and _same_fields(self, other))

    def __hash__(self) -> int:
        return hash((self.name, self.vertices.tobytes()))

    def derived(self, name: str, make: Callable[[HeadModel], _T]) -> _T:
        """What ``make`` makes of this model, made once and kept under ``name``: with it, and for the next run.

        ``name`` also says everything else that it is made of.
        """
        kept: dict[str, Any] = self.__dict__.setdefault("_derived", {})
        if name not in kept:
            stamp = self.__dict__.get(_STAMP)
            kept[name] = make(self) if stamp is None else prepared(stamp, name, lambda: make(self))
        made: _T = kept[name]
        return made

    def eye_centre(self, side: str) -> Floats:
        """The centre ``(3,)`` m of the eyeball of side ``l`` or ``r``."""
        return _eye_centre(self.eyes, side) + self.part_moves[f"eye_{side}"]


def _same_fields(one: Any, other: Any) -> bool:
    return all(_same(getattr(one, field.name), getattr(other, field.name)) for field in fields(one))


def _same(one: Any, other: Any) -> bool:
    """Whether two values are equal, whatever arrays they are made of."""
    if isinstance(one, np.ndarray):
        return isinstance(other, np.ndarray) and one.dtype == other.dtype and np.array_equal(one, other)
    if isinstance(one, dict):
        return (
            isinstance(other, dict) and one.keys() == other.keys() and all(_same(one[key], other[key]) for key in one)
        )
    if is_dataclass(one):
        return type(one) is type(other) and _same_fields(one, other)
    return bool(one == other)


def load_model(
    face: str | Path = DEFAULT_FACE, muscles: MusclesFile | None = None, asymmetry: float = 1.0
) -> HeadModel:
    """Read a face by name or from a folder; with ``muscles``, take these instead of its ``muscles.yaml``.

    The faces read last are kept while their files do not change: write to none of a model's arrays.
    ``asymmetry`` 0..1 is how much of its own asymmetry it has; without any it is its own mirror image.

    Raises UnknownNameError for an unknown face, InvalidValueError for an asymmetry out of range, and DataError with the
    faults of the first file that has any.
    """
    check_fraction("asymmetry", asymmetry)
    folder = face_folder(face)
    if muscles is not None:
        return _read(folder, muscles, asymmetry)
    return _kept(folder.resolve(), stamp_of(sorted(folder.iterdir()), str(asymmetry)), asymmetry)


@lru_cache(maxsize=_KEPT)
def _kept(folder: Path, stamp: str, asymmetry: float) -> HeadModel:
    def read() -> HeadModel:
        model = _read(folder, None, asymmetry)
        model.__dict__[_STAMP] = stamp  # what replace() makes of it is of no file
        with suppress(InvalidValueError):  # what cannot be placed is told when it is asked for
            _ = model.normals, model.muscles, model.trains
        return model

    return prepared(stamp, "model", read)


def _read(folder: Path, muscles: MusclesFile | None, asymmetry: float) -> HeadModel:
    meshes = read_glb(folder / "head.glb")
    skin = _checked_skin(folder / "head.glb", meshes)
    vertices = np.ascontiguousarray(skin.attributes["POSITION"], np.float32)
    tables = {
        name: read(folder / name, skin) for name, read in TABLES.items() if not (muscles and name == MUSCLES_FILE)
    }
    counts = {name: len(meshes[name].attributes["POSITION"]) for name in PARTS}
    check_parts(folder / "feature_points.yaml", tables["feature_points.yaml"].feature_points, counts)
    eyes, lips, eyelids = tables["eyes.yaml"], tables["lips.yaml"], tables["eyelids.yaml"]
    shapes = dict(skin.shapes)
    moves = np.zeros_like(vertices)
    if own.SHAPE in shapes:
        moves += np.float32(asymmetry) * shapes.pop(own.SHAPE).dense(len(vertices))
    part_moves = own.part_moves(moves, lips, eyelids)
    vertices = vertices + moves
    ahead = np.array([0, 0, eyes.radius], np.float32)
    pupils = {f"pupil_{side}": _eye_centre(eyes, side) + part_moves[f"eye_{side}"] + ahead for side in SIDES}
    return HeadModel(
        name=folder.name,
        folder=folder,
        vertices=vertices,
        triangles=skin.triangles,
        material=_fractions(skin, "_MATERIAL"),
        shade=_fractions(skin, "_SHADE"),
        jaw_weights=skin.attributes["_JAW"].astype(np.float32),
        mirror=skin.attributes["_MIRROR"].astype(np.int32),
        shapes=shapes,
        parts={name: _moved(part, part_moves[name]) for name, part in _parts(meshes).items()},
        regions=tables["regions.yaml"],
        landmarks=place_landmarks(tables["feature_points.yaml"], vertices, pupils),
        feature_points=tables["feature_points.yaml"].feature_points,
        eyes=eyes,
        jaw=tables["jaw.yaml"],
        lips=lips,
        eyelids=eyelids,
        muscles_file=muscles or tables[MUSCLES_FILE],
        wrinkles_file=tables["wrinkles.yaml"],
        volumes_file=tables["volumes.yaml"],
        morphs_file=tables["morphs.yaml"],
        own_uv=texture_coordinates(skin),
        gains=own.gains_of(tables["asymmetry.yaml"], asymmetry),
        part_moves=part_moves,
    )


def _eye_centre(eyes: EyesFile, side: str) -> Floats:
    return np.array(eyes.centre, np.float32) * np.array([1 if side == SIDES[0] else -1, 1, 1], np.float32)


def _parts(meshes: dict[str, MeshArrays]) -> dict[str, MeshArrays]:
    rows = {name: meshes[name] for name in ("teeth_upper", "teeth_lower")}
    return {name: between_the_teeth(meshes[name], rows) if name == "tongue" else meshes[name] for name in PARTS}


def _moved(part: MeshArrays, move: Floats) -> MeshArrays:
    positions = (part.attributes["POSITION"] + move).astype(np.float32)
    return replace(part, attributes={**part.attributes, "POSITION": positions})


def _fractions(mesh: MeshArrays, attribute: str) -> Floats:
    return mesh.attributes[attribute].astype(np.float32) / np.float32(255)


def _checked_skin(path: Path, meshes: dict[str, MeshArrays]) -> MeshArrays:
    faults = [Fault(path, None, name, "a mesh of this name", "none") for name in ("skin", *PARTS) if name not in meshes]
    for name, mesh in meshes.items():
        positions = mesh.attributes.get("POSITION", np.zeros((0, 3)))
        if not len(positions) or not np.isfinite(positions).all():
            faults.append(Fault(path, None, f"{name}.POSITION", "finite coordinates", "NaN, infinity or none"))
        elif len(mesh.triangles) and not 0 <= mesh.triangles.min() <= mesh.triangles.max() < len(positions):
            faults.append(
                Fault(path, None, f"{name}.indices", f"vertices in 0..{len(positions) - 1}", f"{mesh.triangles.max()}")
            )
    if "skin" in meshes:
        missing = {"_MATERIAL", "_SHADE", "_JAW", "_MIRROR"} - meshes["skin"].attributes.keys()
        faults += [Fault(path, None, f"skin.{name}", "this vertex attribute", "none") for name in sorted(missing)]
        faults += _uv_faults(path, meshes["skin"])
    if faults:
        raise DataError(faults)
    return meshes["skin"]


def _uv_faults(path: Path, skin: MeshArrays) -> list[Fault]:
    uv = texture_coordinates(skin)
    if uv is None:
        return []
    expected = (len(skin.attributes.get("POSITION", ())), 2)
    if uv.shape != expected:
        return [Fault(path, None, "skin.TEXCOORD_0", f"an array of shape {expected}", f"{uv.shape}")]
    wrong = np.flatnonzero(~((uv >= 0.0) & (uv <= 1.0)).all(axis=1))
    if len(wrong):
        got = f"{uv[wrong[0]].tolist()} at vertex {wrong[0]}"
        return [Fault(path, None, "skin.TEXCOORD_0", "coordinates in 0..1", got)]
    return []
