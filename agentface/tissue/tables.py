"""What the tissue of a face needs to move, made once a model and kept between runs."""

from __future__ import annotations

from functools import partial
from typing import NamedTuple

import numpy as np

from agentface.conventions import Doubles, Floats, Indices
from agentface.deform import tables as skin_tables
from agentface.head.model import HeadModel
from agentface.tissue import skin
from agentface.tissue.columns import Columns, coloured, pack
from agentface.tissue.lattice import Lattice, build_lattice
from agentface.tissue.layers import HYPODERMIS
from agentface.tissue.muscles import Drive, nodal_forces
from agentface.tissue.oscillators import Oscillators
from agentface.tissue.relaxation import new_loads
from agentface.tissue.responses import LEVELS, Responses, linear, measure
from agentface.tissue.skin import EpidermisTables
from agentface.tissue.tissue_file import DynamicsTable, TissueFile


class TissueTables(NamedTuple):
    """The tissue of one face.

    Attributes:
        lattice: as it is built.
        columns: as kernels take it.
        mirror: ``(V,)`` each vertex's image.
        forces: ``(23, V, 3)`` the muscles' on the hypodermis, fully contracted.
        loads: ``(23, B, 3, LANES)`` the same, as kernels take them.
        drive: what of a pose contracts them.
        epidermis: where the skin goes with it.
        responses: what each muscle does alone.
        swing: the muscles' dynamics.
        mass: of a node, force s2 / mm.
        drag: force s / mm, its damping.
    """

    lattice: Lattice
    columns: Columns
    mirror: Indices
    forces: Doubles
    loads: Floats
    drive: Drive
    epidermis: EpidermisTables
    responses: Responses
    swing: Oscillators
    mass: float
    drag: float


def of(model: HeadModel, *, compiled: bool = True) -> TissueTables:
    """The tables of a face, prepared once; raises DataError where its ``tissue.yaml`` has faults or is missing.

    Without compiled kernels, the responses are linear ones.
    """
    name = "tissue.tables" if compiled else "tissue.tables.numpy"
    tables: TissueTables = model.derived(name, partial(prepare, compiled=compiled))
    return tables


def prepare(model: HeadModel, file: TissueFile | None = None, *, compiled: bool = True) -> TissueTables:
    """The tables of a face, by its ``tissue.yaml`` or by ``file``; takes seconds."""
    lattice = build_lattice(model, file)
    columns = pack(lattice, coloured(lattice, model.mirror))
    forces = nodal_forces(model, lattice)
    loads = new_loads(columns, forces)
    responses = measure(columns, loads) if compiled else linear(lattice, columns, forces)
    swing, mass, drag = _dynamics(lattice.file.dynamics, columns, loads, responses)
    return TissueTables(
        lattice=lattice,
        columns=columns,
        mirror=model.mirror,
        forces=forces,
        loads=loads,
        drive=Drive.of(lattice.file),
        epidermis=skin.prepare(columns, lattice.carried, skin_tables.of(model).skin),
        responses=responses,
        swing=swing,
        mass=mass,
        drag=drag,
    )


def _dynamics(
    table: DynamicsTable, columns: Columns, loads: Floats, responses: Responses
) -> tuple[Oscillators, float, float]:
    """The muscles' oscillators, and every node's mass and damping.

    A muscle that moves the tissue by u with the force f swings with the square of its angular frequency at
    (f . u) / (m u . u) (Rayleigh's quotient). The mass m is such that the mean frequency is the table's.
    """
    count = len(columns.first) - 1
    whole = responses.columns.reshape(len(loads), len(LEVELS), count, -1, loads.shape[-1]).sum(axis=1)
    hypodermis = whole[:, :, 3 * HYPODERMIS :]
    ratio = np.sqrt((loads * hypodermis).sum(axis=(1, 2, 3)) / (whole * whole).sum(axis=(1, 2, 3))).astype(np.float64)
    mean = 2.0 * np.pi * table.frequency_hz
    frequency: Doubles = ratio * mean / ratio.mean()
    mass = float((ratio.mean() / mean) ** 2)
    return Oscillators(frequency, table.damping * mean / frequency), mass, 2.0 * table.damping * mean * mass
