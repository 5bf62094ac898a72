"""The layered tissue as a deformer: muscles pull on tissue, and the skin goes where that goes."""

from __future__ import annotations

from functools import partial

import numpy as np

from agentface.conventions import Doubles, Floats, read_only
from agentface.deform import order
from agentface.deform import tables as skin_tables
from agentface.deform.finish import order as last_part
from agentface.deform.finish.order import FinishStage
from agentface.deform.geometry import FaceArrays, FaceGeometry
from agentface.deform.mouth import lips
from agentface.deform.order import Stage
from agentface.deform.protocol import Frames
from agentface.head.model import HeadModel
from agentface.parameters import FacePose, check_pose
from agentface.tissue import skin, tables
from agentface.tissue.columns import unpacked
from agentface.tissue.solvers.equilibrium import equilibrium
from agentface.tissue.solvers.solver import DEFAULT_SOLVER, make_solver
from agentface.tissue.tables import TissueTables
from agentface.tissue.tissue_file import TissueFile


class TissueDeformer:
    """The physical face of Zhang, Prakash and Sung: it has mass, and each pose has one equilibrium.

    Tissue takes the place of the geometric face's vector muscles, of the volumes that they gather and of limits;
    orbicularis oris, lids, jaw, lips, contact, wrinkles and neck are the same. It is solved with the jaw closed, which
    then carries it along.

    Args:
        model: the face; its folder must have a ``tissue.yaml``.
        solver: one of :func:`agentface.tissue.solvers.solver.solver_names`.
        compiled: False for numpy, the same to 0.01 mm, seconds a frame.
        tissue: other tissue than the face's own, of :func:`agentface.tissue.tables.prepare`; then it needs no file.

    Raises:
        DataError: with the faults of ``tissue.yaml``, or that there is none.
        UnknownNameError: for a solver that is not there.
    """

    def __init__(
        self,
        model: HeadModel,
        solver: str = DEFAULT_SOLVER,
        *,
        compiled: bool = True,
        tissue: TissueTables | None = None,
    ) -> None:
        self._model, self._solver_name, self._compiled = model, solver, compiled
        self._tissue = tables.of(model, compiled=compiled) if tissue is None else tissue
        self._tables = skin_tables.of(model)
        self._points = self._tables.skin.rest.copy()
        self._found = lips.as_they_lie(self._tables.skin.lips, self._points)
        self._deform, self._finish, self._put = order.deform, last_part.finish, skin.put
        if compiled:
            from agentface.deform import order_compiled
            from agentface.tissue import skin_compiled

            self._deform, self._finish, self._put = order_compiled.deform, order_compiled.finish, skin_compiled.put
        self._driven = self._tissue.drive.weights.any(axis=0)
        self._solver = make_solver(solver, self._tissue, compiled=compiled)
        self._shown = self._new_geometry()

    def reset(self, pose: FacePose) -> None:
        """Stand still in ``pose``; raises InvalidValueError for a parameter outside its range."""
        self._solver.reset(self._contractions(pose))

    def step(self, pose: FacePose, dt: float) -> FaceGeometry:
        """The face after ``dt`` s on its way to ``pose``, in arrays that the next step overwrites.

        Raises InvalidValueError for a parameter outside its range.
        """
        self._solver.step(self._contractions(pose), dt)
        self._write(self._solver.positions, pose.array, self._shown)
        return self._shown

    def at(self, pose: FacePose) -> FaceGeometry:
        """The equilibrium in ``pose``, in arrays of its own; raises InvalidValueError for what is out of range."""
        geometry = self._new_geometry()
        positions = equilibrium(self._tissue, self._contractions(pose), compiled=self._compiled)
        self._write(positions, pose.array, geometry)
        return geometry

    def worker(self) -> Frames:
        """Writes rows of equilibria into rows of faces; each worker may be at work at the same time as the others."""
        own = TissueDeformer(self._model, compiled=self._compiled, tissue=self._tissue)

        def frames(first: int, last: int, poses: Floats, faces: FaceArrays) -> None:
            for index in range(first, last):
                found = own.at(FacePose(poses[index]))
                for row, array in zip(faces, found.arrays(), strict=True):
                    row[index] = array

        return frames

    @property
    def tissue(self) -> TissueTables:
        """The tables that it was made with."""
        return self._tissue

    @property
    def nodes(self) -> Doubles:
        """``(3, V, 3)`` mm: the lattice as the last step left it, with the jaw closed; a new array."""
        return unpacked(self._tissue.columns, self._solver.positions)

    def remade(self, file: TissueFile, pose: FacePose) -> TissueDeformer:
        """Another one of the face, by ``file`` and with the same solver, that stands still in ``pose``; takes seconds.

        It shares nothing that a step changes, so that this one may go on meanwhile.
        """
        prepared = tables.prepare(self._model, file, compiled=self._compiled)
        other = TissueDeformer(self._model, self._solver_name, compiled=self._compiled, tissue=prepared)
        other.reset(pose)
        return other

    def _contractions(self, pose: FacePose) -> Doubles:
        check_pose(pose.array)
        return self._tissue.drive.contractions(pose.array.astype(np.float64))

    def _write(self, positions: Floats, values: Floats, geometry: FaceGeometry) -> None:
        self._put(self._tissue.epidermis, positions, self._points)
        others = read_only(
            np.where(self._driven, np.float32(0.0), values)
        )  # tissue gathers by itself where its muscles pull
        skin = self._tables.skin
        self._deform(int(Stage.VOLUMES), int(Stage.VOLUMES), skin, others, self._found, self._points)
        self._found[:] = self._points[skin.lips.skin_count :, :1]
        self._deform(int(Stage.ORBICULARIS_ORIS), int(Stage.MIDPOINTS), skin, values, self._found, self._points)
        geometry.vertices[:] = self._points[: len(geometry.vertices)]
        first, last = int(FinishStage.SMOOTH_NORMALS), int(FinishStage.NECK)
        self._finish(first, last, self._tables.finish, values, geometry.arrays())

    def _new_geometry(self) -> FaceGeometry:
        return FaceGeometry.at_rest(self._model)


SemiImplicitTissue = partial(TissueDeformer, solver="semi_implicit")
AdaptiveTissue = partial(TissueDeformer, solver="adaptive")
