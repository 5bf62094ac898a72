"""Long hair on the GPU: what may be seen from where one looks, from outside and from inside."""

from __future__ import annotations

from typing import Any

import numpy as np

from agentface.conventions import Doubles, Indices
from agentface.head.model import HeadModel
from agentface.view.gl.drawn_mesh import DrawnMesh
from agentface.view.hair.sheets import Sheet, sheets_mesh
from agentface.view.hair.strands import middle_of, sector_of, skin_round
from agentface.view.hair.visible import before_skin

_INSIDE_BELOW = 0.045
"""Metres over the centre: below it hair stands off forehead, face and neck, and is seen from inside too."""
_BARE_INSIDE = 16.0
"""Up to which number locks are seen from inside: the sheets' and those of the cards at the face."""
_COVERAGE = 0x809E, 0x809F
"""GL_SAMPLE_ALPHA_TO_COVERAGE, GL_SAMPLE_ALPHA_TO_ONE."""


def hanging_first(mesh: DrawnMesh, triangles: Indices, centre: Doubles) -> tuple[Indices, int]:
    """``triangles (T, 3)``, those first that are seen from inside too, and how many: what hangs beside face and neck.

    ``centre (3,)`` m is the head's. Cards behind those at the face have a sheet inside of them.
    """
    low = mesh.fields["place"][triangles, 1].min(axis=1) < centre[1] + _INSIDE_BELOW
    seen = low & (mesh.fields["sheet"][triangles[:, 0], 0] < _BARE_INSIDE)
    return triangles[np.argsort(~seen, kind="stable")], int(seen.sum())


class SheetArray:
    """Sheets on the GPU; they turn with the head."""

    def __init__(self, context: Any, program: Any, grown: list[Sheet], model: HeadModel, centre: Doubles) -> None:
        """``centre`` m: hair well above it has the head behind it and is seen from outside only."""
        self._context, self._program, self._centre = context, program, centre
        self._mesh = sheets_mesh(grown)
        self._layout = self._mesh.layout(context, program)
        self._skin = skin_round(model, centre)
        self._arrays: dict[tuple[int, int, int] | None, tuple[Any, int]] = {}
        self._drawn: tuple[Any, int] = self._seen_from(None)
        self._flags: tuple[int, ...] = ()

    def draw(self, eye: Doubles, *, fine: bool) -> None:
        """Draw what ``eye``, in the model's axes, sees from outside; ``fine``: into several samples a pixel."""
        self._program["least_cover"].value = 0.02 if fine else 0.5
        self._flags = _COVERAGE if fine else ()
        self._drawn = self._seen_from(sector_of(eye - self._centre))
        self._draw("back", self._drawn[0].vertices)

    def draw_inside(self) -> None:
        """Draw what the eye of the last ``draw`` sees from inside, after the skin: hair beside face and neck."""
        self._draw("front", self._drawn[1])

    def _draw(self, culled: str, count: int) -> None:
        context, (array, _) = self._context, self._drawn
        context.cull_face = culled
        context.enable(context.CULL_FACE)
        for flag in self._flags:
            context.enable_direct(flag)
        array.render(vertices=count)
        for flag in self._flags:
            context.disable_direct(flag)
        context.disable(context.CULL_FACE)
        context.cull_face = "back"

    def _seen_from(self, sector: tuple[int, int, int] | None) -> tuple[Any, int]:
        """An array of what may be seen from a sector, and how many of its indices hang: these are seen from inside."""
        if sector not in self._arrays:
            places = self._mesh.fields["place"] - self._centre.astype(np.float32)
            triangles = self._mesh.triangles
            if sector is not None:
                triangles = triangles[before_skin(places, self._skin, middle_of(sector))[triangles].any(axis=1)]
            ordered, hanging = hanging_first(self._mesh, triangles, self._centre)
            buffer = self._context.buffer(ordered.tobytes())
            self._arrays[sector] = self._context.vertex_array(self._program, self._layout, buffer), 3 * hanging
        return self._arrays[sector]
