"""What `agentface calibrate` fits, by deformer: the vector muscles of ``muscles.yaml``, or those of ``tissue.yaml``."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

from agentface.deform.protocol import TISSUE_DEFORMERS, make_deformer
from agentface.facs.action_units import load_action_units
from agentface.head.model import HeadModel, load_model
from agentface.head.muscles import read_muscles
from agentface.resources import face_folder
from agentface.studies.calibration import calibrate as vector_muscles
from agentface.studies.calibration.agreement import Agreement, measure
from agentface.studies.calibration.fit import Progress, groups
from agentface.studies.calibration.tissue_fit import TissueFitter
from agentface.tissue import tables
from agentface.tissue.deformer import TissueDeformer
from agentface.tissue.reading import anatomy_file, read_tissue, tissue_of
from agentface.tissue.tissue_file import TISSUE_FILE, TISSUE_MUSCLES, TissueFile
from agentface.tissue.writing import tissue_yaml

Rows = dict[int, Agreement]


class Fit(NamedTuple):
    """One fit of a face.

    Attributes:
        path: the file to write.
        work: how much each of its steps is, for the time left; ``run`` tells its progress after each.
        before: measures the face as it is, or with the anatomist's table where it has none of its own.
        run: fits, and gives the text of the file and how well the face agrees then.
    """

    path: Path
    work: list[float]
    before: Callable[[], Rows]
    run: Callable[[Progress], tuple[str, Rows]]


def fit_of(face: str | Path, deformer: str, starts: int, seed: int) -> Fit:
    """The fit of what ``deformer`` needs; ``starts`` and ``seed`` are for the searches of vector muscles.

    Raises DataError with the faults of the face.
    """
    return _fit_of_tissue(face) if deformer in TISSUE_DEFORMERS else _fit_of_muscles(face, deformer, starts, seed)


def _fit_of_muscles(face: str | Path, deformer: str, starts: int, seed: int) -> Fit:
    path, units = face_folder(face) / "muscles.yaml", load_action_units()
    model = _model(face)
    # A search's time grows with its parameters, and with the muscles and action units of each evaluation.
    work = [float(len(g.muscles) ** 2 * len(g.units)) for g in groups(list(units.values()))]

    def run(progress: Progress) -> tuple[str, Rows]:
        fitted = vector_muscles.calibrate(face, starts, seed, progress)
        moved = load_model(face, muscles=fitted, asymmetry=0.0)
        return vector_muscles.muscles_yaml(fitted), measure(moved, units, make_deformer(deformer, moved))

    return Fit(
        path=path,
        work=[each for each in work for _ in range(starts)],
        before=lambda: measure(model, units, make_deformer(deformer, model)),
        run=run,
    )


def _fit_of_tissue(face: str | Path) -> Fit:
    path, model = face_folder(face) / TISSUE_FILE, _model(face)
    anatomy = read_tissue(anatomy_file())
    own = tissue_of(path.parent) if path.exists() else anatomy

    def run(progress: Progress) -> tuple[str, Rows]:
        fitted = TissueFitter(model, own.model_copy(update={"muscles": anatomy.muscles})).fit(progress)
        return tissue_yaml(fitted), _measured(model, fitted)

    return Fit(path=path, work=[1.0] * len(TISSUE_MUSCLES), before=lambda: _measured(model, own), run=run)


def _model(face: str | Path) -> HeadModel:
    """The face without its asymmetry; it need not have muscles yet."""
    muscles = None if (face_folder(face) / "muscles.yaml").exists() else read_muscles(vector_muscles.anatomy_file())
    return load_model(face, muscles, asymmetry=0.0)


def _measured(model: HeadModel, file: TissueFile) -> Rows:
    return measure(model, load_action_units(), TissueDeformer(model, tissue=tables.prepare(model, file)))
