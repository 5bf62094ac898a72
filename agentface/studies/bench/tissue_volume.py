"""What each form of the volume force keeps, and at what strength it breaks: the second paper's Eq. 3 beside ours."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from agentface.conventions import Doubles
from agentface.tissue import tables as tissue_tables
from agentface.tissue.columns import law_of, unpacked
from agentface.tissue.layers import EPIDERMIS
from agentface.tissue.solvers.semi_implicit import SemiImplicit, stable_step
from agentface.tissue.tables import TissueTables
from agentface.tissue.tissue_file import VolumeForm

if TYPE_CHECKING:
    from agentface.head.model import HeadModel

FORMS: tuple[tuple[VolumeForm, float], ...] = (
    ("energy", 0.0), ("printed", 0.05), ("printed", 0.3), ("printed", 1.0), ("printed", 3.0), ("printed", 10.0),
    ("signed", 1.0), ("signed", 3.0), ("signed", 10.0), ("epidermis", 8.0), ("epidermis", 16.0), ("energy", 2.0),
    ("energy", 8.0), ("energy", 12.0), ("energy", 16.0),
)  # fmt: skip
"""The forms and their rho; 0 is no volume force."""
_RISE, _STEPS, _LOST_MM = 200, 700, 100.0
_RADIUS = 0.25
"""Of the cheek, half the way from its landmark to the cheek bone's, in eye separations."""


def run(model: HeadModel | None = None, expression: str = "happiness") -> dict[str, Any]:
    """For each form and rho, an expression by the semi-implicit scheme, the load raised over 200 steps of 700.

    ``diverged`` says that nodes went astray; else ``volume_percent`` has percentiles of how the prisms' volumes have
    changed, ``volume_mean_percent`` the mean of that without its sign, ``inverted`` how many prisms are, and
    ``cheek_mm`` how far the cheek has gone out of the face, on average and at most.
    """
    from agentface.emotion.inference import default_inference

    if model is None:
        from agentface.head.model import load_model

        model = load_model(asymmetry=0.0)
    tables = tissue_tables.of(model)
    pose = default_inference().pose({expression: 1.0})
    asked = tables.drive.contractions(pose.array.astype(np.float64))
    cheek = _cheek(model, tables)
    rows = [{"form": form, "rho": rho} | _kept(tables, asked, form, rho, cheek) for form, rho in FORMS]
    return {"expression": expression, "forms": rows}


def _cheek(model: HeadModel, tables: TissueTables) -> np.typing.NDArray[np.bool_]:
    unit, points = 1e3 * model.landmarks.eye_separation, tables.lattice.rest[EPIDERMIS]
    middle = 500.0 * (model.landmarks["cheek_l"] + model.landmarks["cheekbone_l"])
    away = np.linalg.norm(np.abs(points) * [1, 0, 0] + points * [0, 1, 1] - middle, axis=1)
    return np.asarray(tables.lattice.free & (away < _RADIUS * unit))


def _kept(
    tables: TissueTables, asked: Doubles, form: VolumeForm, rho: float, cheek: np.typing.NDArray[np.bool_]
) -> dict[str, Any]:
    lattice = tables.lattice
    volume = lattice.file.volume.model_copy(update={"form": form, "rho": rho})
    law = law_of(replace(lattice, file=lattice.file.model_copy(update={"volume": volume})))
    solver = SemiImplicit(tables._replace(columns=tables.columns._replace(law=law)))
    dt = stable_step(tables)
    for step in range(1, _STEPS + 1):
        solver.iterate(min(1.0, step / _RISE) * asked, dt)
        if step % 20 == 0 and not np.abs(solver.positions - tables.columns.rest).max() < _LOST_MM:
            return {"diverged": True, "steps": step}
    points = unpacked(tables.columns, solver.positions)
    change = 100.0 * (lattice.prisms.volumes(points.reshape(-1, 3)) / lattice.volumes - 1.0)
    out = ((points - lattice.rest)[EPIDERMIS] * lattice.normals).sum(axis=1)[cheek]
    return {
        "diverged": False,
        "volume_percent": dict(
            zip(("1", "5", "95", "99"), np.percentile(change, [1, 5, 95, 99]).tolist(), strict=True)
        ),
        "volume_mean_percent": float(np.abs(change).mean()),
        "inverted": int((change <= -100.0).sum()),
        "cheek_mm": {"mean": float(out.mean()), "max": float(out.max())},
    }
