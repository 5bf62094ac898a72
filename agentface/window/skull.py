"""The skull under a face of tissue, nudged by hand: from sliders to numbers, to the face, and to its file."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from agentface.conventions import Floats, Indices
from agentface.errors import AgentFaceError
from agentface.io.files import write_file
from agentface.tissue.deformer import TissueDeformer
from agentface.tissue.layers import HYPODERMIS
from agentface.tissue.nudge import Nearness, as_fitted, nearness, nudged, rewritten
from agentface.tissue.reading import read_tissue
from agentface.tissue.skull import moved
from agentface.tissue.tissue_file import TISSUE_FILE, SkullTable
from agentface.view.parts.bone import Bone

if TYPE_CHECKING:
    from agentface.face import Face

Work = Callable[[], TissueDeformer]
_NEAR_MM = 1.0
"""Bone that is nearer to the tissue is tinted."""


class SkullControls:
    """Where the user wants the skull of ``face``, whose deformer is ``deformer``, and the face that follows.

    The face is made anew only when a slider is let go of, and aside: it goes on until :meth:`update` exchanges it.

    Args:
        face: a face with a :class:`TissueDeformer`.
        deformer: that one.
        start: begins a piece of work that takes seconds; a thread of its own does it when None.
    """

    def __init__(
        self, face: Face, deformer: TissueDeformer, start: Callable[[Work], Future[TissueDeformer]] | None = None
    ) -> None:
        self._face, self._deformer = face, deformer
        self._start = start or ThreadPoolExecutor(1, "agentface-skull").submit
        self._work: Future[TissueDeformer] | None = None
        self._asked = self._saved = self.table = deformer.tissue.lattice.file.skull
        self._triangles = _touched(deformer)
        self._points: tuple[SkullTable, Floats] | None = None
        self.shown = False
        """Whether the window shows the bone."""
        self.message = ""
        """Where the numbers were saved, or what is amiss."""

    @classmethod
    def of(cls, face: Face) -> SkullControls | None:
        """Those of a face; None for one that is not of tissue."""
        deformer = face.deformer
        return cls(face, deformer) if isinstance(deformer, TissueDeformer) else None

    @property
    def preparing(self) -> bool:
        """Whether a face is being made with the numbers that are asked for."""
        return self._work is not None

    @property
    def unsaved(self) -> bool:
        """Whether the file says something else."""
        return self.table != self._saved

    @property
    def nudged(self) -> bool:
        """Whether the skull lies elsewhere than where it was fitted."""
        return self.table != as_fitted(self.table)

    def nudge(self, key: str, axis: int, value: float) -> None:
        """Want one number of :data:`agentface.tissue.nudge.NUDGES` changed; the bone follows, the face does not yet."""
        self.table = nudged(self.table, key, axis, value)

    def reset(self) -> None:
        """Want the skull where it was fitted."""
        self.table = as_fitted(self.table)
        self.settle()

    def settle(self) -> None:
        """Have the face follow."""
        if self._asked != self.table:
            self._asked, self.message = self.table, ""
            if self._work is None:
                self._begin()

    def update(self) -> bool:
        """Exchange the face for one that is done, if there is one; whether there was.

        Whoever uses the face in another thread must not do so meanwhile.
        """
        if self._work is None or not self._work.done():
            return False
        work, self._work = self._work, None
        try:
            made = work.result()
        except AgentFaceError as error:
            self.message = str(error)
        else:
            self._deformer = made
            self._face.take_deformer(made)
        if self._deformer.tissue.lattice.file.skull != self._asked and not self.message:
            self._begin()
        return True

    def save(self) -> None:
        """Write the numbers into the face's file and nothing else; :attr:`message` says where, or why it failed."""
        path = self._face.model.folder / TISSUE_FILE
        try:
            read_tissue(path)
            write_file(path, rewritten(path.read_bytes().decode(), self.table).encode())
        except AgentFaceError as error:
            self.message = str(error)
        else:
            self._saved, self.message = self.table, f"saved to {path}"

    def nearness(self) -> Nearness:
        """How near the bone, where it is wanted, comes to the tissue as it is now."""
        lattice = self._deformer.tissue.lattice
        return nearness(lattice, moved(lattice.skull.fitted, self.table), self._deformer.nodes[HYPODERMIS])

    def bone(self) -> Bone:
        """The bone where it is wanted, tinted where it comes near to the tissue as it is now."""
        skull = self._deformer.tissue.lattice.skull
        near = self.nearness()
        tint = np.where(near.outside > 0.0, 1.0, 0.5 * np.clip(1.0 - near.room / _NEAR_MM, 0.0, 1.0))
        if self._points is None or self._points[0] is not self.table:
            self._points = self.table, (1e-3 * moved(skull.fitted, self.table)).astype(np.float32)
        return Bone(self._points[1], self._triangles, skull.jaw_weights, tint.astype(np.float32))

    def _begin(self) -> None:
        file = self._deformer.tissue.lattice.file.model_copy(update={"skull": self._asked})
        self._work = self._start(partial(self._deformer.remade, file, self._face.pose))


def _touched(deformer: TissueDeformer) -> Indices:
    """The triangles of the bone on which tissue lies: not the eyes' sockets, nor what would be inside the mouth."""
    lattice = deformer.tissue.lattice
    return np.asarray(lattice.triangles[~lattice.members.absent[lattice.triangles].any(axis=1)])
