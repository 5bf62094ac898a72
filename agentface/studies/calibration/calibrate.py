"""Calibrates a face: anatomy in, ``muscles.yaml`` out, and the table that says how well it fits."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import yaml

from agentface.deform.protocol import DEFAULT_DEFORMER, make_deformer
from agentface.facs.action_units import load_action_units
from agentface.head.model import HeadModel, load_model
from agentface.head.muscles import MusclesFile, read_muscles
from agentface.resources import data_folder
from agentface.studies.calibration.agreement import Agreement, measure, measure_shapes
from agentface.studies.calibration.fit import Fitter, Progress, groups

_TITLE = """\
# The vector muscles of this face, relative to its landmarks; lengths in eye separations, one entry a pair.
# Calibrated by `agentface calibrate` to the artists' shapes of this face, within the bounds of anatomy.yaml.
"""


def anatomy_file() -> Path:
    """The anatomist's table of the muscles, from which every calibration starts."""
    return data_folder("regions") / "anatomy.yaml"


def calibrate(face: str | Path, starts: int, seed: int, progress: Progress) -> MusclesFile:
    """Fit the muscles of a face to its artists' shapes; ``starts`` searches a group of action units."""
    anatomy = read_muscles(anatomy_file())
    model = load_model(face, muscles=anatomy, asymmetry=0.0)
    rng = np.random.default_rng(seed)
    muscles = dict(anatomy.muscles)
    for group in groups(list(load_action_units().values())):
        fitter = Fitter(model, anatomy, group)
        values, _ = fitter.solve(starts, rng, progress)
        muscles.update(fitter.fitted(values))
    return MusclesFile(falloff=anatomy.falloff, muscles=muscles)


def muscles_yaml(file: MusclesFile) -> str:
    """The text of ``muscles.yaml``."""
    content = file.model_dump(exclude_none=True)
    return _TITLE + yaml.safe_dump(content, sort_keys=False, default_flow_style=None, width=118)


def table(models: list[HeadModel], deformer_name: str = DEFAULT_DEFORMER) -> str:
    """The agreement of every action unit and of every single artists' shape on every face, as a Markdown table."""
    units = load_action_units()
    lines = [
        "| face | AU | name | mean cosine | covered | peak ratio | artists' peak, mm | region | artists' region |",
        "|---|---|---|---|---|---|---|---|---|",
    ]
    for model in models:
        rows = measure(model, units, make_deformer(deformer_name, model))
        for number, row in rows.items():
            lines.append(
                f"| {model.name} | {number} | {units[number].name} | {row.cosine:.2f} | {row.covered:.2f} "
                f"| {row.peak_ratio:.2f} | {row.peak_mm:.1f} | {row.region} | {row.artists_region} |"
            )
        shapes = measure_shapes(model, make_deformer(deformer_name, model))
        lines += [
            f"| {model.name} | | {name} | {row.cosine:.2f} | {row.covered:.2f} | {row.peak_ratio:.2f} "
            f"| {row.peak_mm:.1f} | {row.region} | {row.artists_region} |"
            for name, row in shapes.items()
        ]
        mean = float(np.mean([row.cosine for row in shapes.values()])) if shapes else float("nan")
        lines.append(f"| {model.name} | all | mean of single shapes | {mean:.2f} | | | | | |")
        for title, fitted in (("vector muscles", True), ("lids, lips, jaw", False)):
            lines.append(f"| {model.name} | all | mean of {title} | {mean_cosine(rows, fitted=fitted):.2f} | | | | | |")
    return "\n".join(lines) + "\n"


def mean_cosine(rows: dict[int, Agreement], *, fitted: bool = True) -> float:
    """The mean over the action units that are fitted, or over the others; NaN without any."""
    chosen = [row.cosine for row in rows.values() if row.fitted == fitted]
    return float(np.mean(chosen)) if chosen else float("nan")
