"""Who a face is: the recipe of targets that turns the base mesh into one person."""

from __future__ import annotations

from difflib import get_close_matches
from pathlib import Path
from typing import Annotated

import numpy as np
from pydantic import Field

from agentface.config import Document, Table
from agentface.conventions import Doubles
from agentface.head.build.fold import LidFold
from agentface.head.build.partition import Loops, halves
from agentface.head.build.source import BaseMesh
from agentface.head.build.topology import SkinTopology

Weight = Annotated[float, Field(ge=0, le=1.5)]


class Teeth(Table):
    """How far the person's rows of teeth stand behind the base mesh's, and how wide they are as a part of it."""

    back_mm: Annotated[float, Field(ge=0, le=4)] = 0.0
    width: Annotated[float, Field(ge=0.7, le=1.3)] = 1.0


class Recipe(Table):
    """``recipe.yaml``: the mix of the base mesh's macro targets, detail targets and resting shapes of one face."""

    description: str
    female: Weight
    young: Weight
    muscle: Annotated[float, Field(ge=0, le=1)] = 0.5
    weight: Annotated[float, Field(ge=0, le=1)] = 0.5
    ideal: Weight = 0.0
    ancestry: dict[str, Weight]
    targets: dict[str, Weight]
    resting_shapes: dict[str, Weight] = {}
    lid_fold: LidFold = LidFold()
    teeth: Teeth = Teeth()
    asymmetry: dict[str, Weight] = {}


def read_recipe(path: str | Path, mesh: BaseMesh) -> Recipe:
    """The recipe at ``path``; raises DataError with every fault, also of names that the mesh does not have."""
    document = Document(path)
    recipe = document.collect(Recipe)
    if recipe is not None:
        _check_names(document, recipe, mesh)
    document.check()
    assert recipe is not None, "a document without faults is parsed"  # noqa: S101 - for the type checker
    return recipe


def _check_names(document: Document, recipe: Recipe, mesh: BaseMesh) -> None:
    targets, units = mesh.target_names, set(mesh.face_units())
    for table, names, known, what in (
        ("ancestry", recipe.ancestry, {"african", "asian", "caucasian"}, "one of african, asian, caucasian"),
        ("targets", recipe.targets, targets, "a target of the base mesh"),
        ("resting_shapes", recipe.resting_shapes, units, "one of the 52 shapes"),
        ("asymmetry", recipe.asymmetry, targets, "a target of the base mesh"),
    ):
        for name in names:
            if not known.issuperset(_both_sides(name) if table == "targets" else (name,)):
                near = get_close_matches(name, {*known, *(_either_side(target) for target in known)}, n=3)
                hint = f"did you mean {' or '.join(near)}?" if near else ""
                document.fault((table, name), what, repr(name), hint)


def _both_sides(name: str) -> tuple[str, ...]:
    """The targets that a name in a recipe stands for: two for ``eyes/lr-eye-scale-incr``."""
    folder, _, leaf = name.partition("/")
    return tuple(f"{folder}/{side}-{leaf.removeprefix('lr-')}" for side in "lr") if leaf.startswith("lr-") else (name,)


def _either_side(target: str) -> str:
    folder, _, leaf = target.partition("/")
    return f"{folder}/lr-{leaf[2:]}" if leaf.startswith(("l-", "r-")) else target


def person(mesh: BaseMesh, recipe: Recipe) -> Doubles:
    """The base vertices ``(N, 3)`` of the person, in decimetres, before the lips are closed."""
    positions = mesh.positions.copy()
    for gender, of_gender in (("female", recipe.female), ("male", 1 - recipe.female)):
        for age, of_age in (("young", recipe.young), ("old", 1 - recipe.young)):
            share = of_gender * of_age
            if share == 0:
                continue
            for build, part in _builds(recipe):
                positions += share * part * mesh.target(f"macrodetails/universal-{gender}-{age}-{build}")
            for ancestry, part in recipe.ancestry.items():
                positions += share * part * mesh.target(f"macrodetails/{ancestry}-{gender}-{age}")
            ideal = f"macrodetails/proportions/{gender}-{age}-averagemuscle-averageweight-idealproportions"
            positions += share * recipe.ideal * mesh.target(ideal)
    for name, part in recipe.targets.items():
        for target in _both_sides(name):
            positions += part * mesh.target(target)
    for name, part in recipe.resting_shapes.items():
        positions += part * mesh.face_unit(name)
    return 0.5 * (positions + (positions * [-1, 1, 1])[mesh.mirror])


def asymmetry(mesh: BaseMesh, recipe: Recipe) -> Doubles:
    """The offsets ``(N, 3)`` by which the person's bones differ from the symmetric ones, in decimetres."""
    return sum((part * mesh.target(name) for name, part in recipe.asymmetry.items()), np.zeros_like(mesh.positions))


def _builds(recipe: Recipe) -> list[tuple[str, float]]:
    muscle, weight = _split(recipe.muscle, "muscle"), _split(recipe.weight, "weight")
    return [(f"{m}-{w}", a * b) for m, a in muscle for w, b in weight if a * b > 0]


def _split(value: float, noun: str) -> list[tuple[str, float]]:
    far = abs(value - 0.5) * 2
    return [(f"average{noun}", 1 - far), (f"{'max' if value > 0.5 else 'min'}{noun}", far)]


def close_lips(
    positions: Doubles, skin: SkinTopology, loops: Loops, symmetric: Doubles, gap: float = 0.0015
) -> Doubles:
    """Base vertices with the lips just touching: ``gap`` decimetres apart where they are nearest.

    The gap is measured along x between the lowest points of the upper lip and the highest of the lower; the
    lips are moved together by it, fading out over the rings on both sides of the seam. ``symmetric`` is the
    base head, by which rings are cut into upper and lower halves.
    """
    positions = positions.copy()
    rows = [(ring, 1 - depth / len(loops.lips)) for depth, ring in enumerate(loops.lips)]
    rows += [(ring, 1 - (depth + 1) / (len(loops.mouth) + 1)) for depth, ring in enumerate(loops.mouth)]
    cut = [(*halves(ring, symmetric), weight * weight * (3 - 2 * weight)) for ring, weight in rows]
    for _ in range(12):
        placed = skin.lift(positions)
        corner = float(placed[loops.lips[0], 0].max())
        across = np.linspace(-corner, corner, 81)
        facing = cut[: len(loops.lips) - 3]
        upper = np.min([_height(placed[up], across) for up, _, _ in facing], axis=0)
        lower = np.max([_height(placed[low], across) for _, low, _ in facing], axis=0)
        move = 0.5 * (upper - lower - gap) * np.clip((1 - np.abs(across) / corner) / 0.12, 0, 1)
        if np.abs(move).max() < 2e-4:
            break
        for up, low, weight in cut:
            positions[up, 1] -= 0.8 * weight * np.interp(positions[up, 0], across, move)
            positions[low, 1] += 0.8 * weight * np.interp(positions[low, 0], across, move)
    return positions


def _height(points: Doubles, across: Doubles) -> Doubles:
    order = np.argsort(points[:, 0])
    return np.interp(across, points[order, 0], points[order, 1])
