"""How the geometric face's skin comes to be, in its order; its last stages are :mod:`agentface.deform.finish.order`.

The vector muscles have moved the points from where they rest before (:mod:`agentface.deform.muscles.combine`).
"""

from __future__ import annotations

from enum import IntEnum

from agentface.conventions import Floats
from agentface.deform import midpoints, morphs
from agentface.deform.eyes import eyelids
from agentface.deform.mouth import contact, jaw, lips
from agentface.deform.muscles import limits, squash, volumes
from agentface.deform.tables import SkinTables


class Stage(IntEnum):
    """The stages in their order."""

    VOLUMES = 0
    LIMITS = 1
    ORBICULARIS_ORIS = 2
    EYELIDS = 3
    JAW = 4
    LIPS = 5
    MORPHS = 6
    CONTACT = 7
    SQUASH_BY_LIDS_AND_LIPS = 8
    MIDPOINTS = 9


def deform(  # noqa: C901  # a list of stages, in the one form that numba takes
    first: int, last: int, tables: SkinTables, values: Floats, found: Floats, points: Floats
) -> None:
    """The stages ``first`` to ``last`` on ``points (P, 3)`` m, at the pose ``values (COUNT,)``.

    ``found (144, 3)`` m is where orbicularis oris finds its control points: :func:`.lips.contract`.
    """
    for stage in range(first, last + 1):
        if stage == Stage.VOLUMES:
            volumes.apply(tables.volumes, values, points)
        elif stage == Stage.LIMITS:
            limits.apply(tables.limits, points)
        elif stage == Stage.ORBICULARIS_ORIS:
            lips.contract(tables.lips, values, found, points)
        elif stage == Stage.EYELIDS:
            eyelids.apply(tables.eyelids, values, points)
        elif stage == Stage.JAW:
            jaw.apply(tables.jaw, values, points)
        elif stage == Stage.LIPS:
            lips.surface(tables.lips, points)
        elif stage == Stage.MORPHS:
            morphs.apply(tables.morphs, values, points)
        elif stage == Stage.CONTACT:
            contact.apply(tables.contact, values, points)
        elif stage == Stage.SQUASH_BY_LIDS_AND_LIPS:
            squash.apply(tables.creases, points)
        elif stage == Stage.MIDPOINTS:
            midpoints.apply(tables.midpoints, points)
