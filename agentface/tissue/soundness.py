"""Whether the tissue of a face can be made of its ``tissue.yaml``: what only the table and the face together show."""

from __future__ import annotations

from agentface.errors import InvalidValueError, Place
from agentface.head.model import HeadModel
from agentface.head.regions import REGIONS
from agentface.tissue.lattice import Lattice, build_lattice
from agentface.tissue.muscles import nodal_forces
from agentface.tissue.tissue_file import TISSUE_FILE, TissueFile


def check_tissue(model: HeadModel, file: TissueFile | None = None) -> None:
    """Build the lattice and the muscles of a face, by its ``tissue.yaml`` or by ``file``; takes seconds.

    Raises InvalidValueError, with the place in the file, for what cannot be built: a muscle that pulls on nothing, or a
    lattice that is degenerate somewhere; DataError with the faults of the file.
    """
    lattice = build_lattice(model, file)
    _check_prisms(model, lattice)
    nodal_forces(model, lattice)


def _check_prisms(model: HeadModel, lattice: Lattice) -> None:
    if not len(lattice.degenerate):
        return
    first = int(lattice.triangles[lattice.degenerate[0], 0])
    region = REGIONS[int(model.regions.region_of[first])].removesuffix("_l").removesuffix("_r")
    raise InvalidValueError(
        Place(TISSUE_FILE, ("lattice", "thickness")),
        "layers thin enough that no prism is degenerate",
        f"{len(lattice.degenerate)} that are, the first at vertex {first}",
        f"make them thinner there: lattice.regions.{region}",
    )
