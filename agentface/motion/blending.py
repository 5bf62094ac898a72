"""What several channels want of the same parameters, blended into one pose.

A claim is what one channel wants of one parameter. It goes over what those before it made: ``(1 - w) v + w f(v)`` for a
weight w, where f replaces v, adds to it, scales it or is the larger of both.
"""

from __future__ import annotations

from collections.abc import Iterable
from itertools import pairwise
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from agentface.conventions import Doubles, Indices
from agentface.parameters import WAYS, Way, parameter

MAX, ADD, SCALE = (WAYS.index(way) for way in ("max", "add", "scale"))


class Claim(NamedTuple):
    """One, to be sorted by what comes first."""

    priority: int
    channel: int
    """The place of the channel among all."""
    way: Way
    column: int
    """The place of what is wanted of the parameter among all that all channels want."""
    name: str


class Claims(NamedTuple):
    """Claims in the order in which they are blended, ``(R,)`` each; ``way`` is the place in ``WAYS``."""

    channel: Indices
    way: Indices
    column: Indices
    place: Indices
    bounds: Indices
    """``(G + 1,)``: from each of them to the next, all are of one channel and one way."""

    @classmethod
    def of(cls, claims: Iterable[Claim]) -> Claims:
        """Those of the lowest priority first, of equal priority those of the first channel."""
        ordered = sorted(claims)
        kinds = [(claim.priority, claim.channel, claim.way) for claim in ordered]
        bounds = [0, *(number for number in range(1, len(kinds)) if kinds[number] != kinds[number - 1]), len(kinds)]
        columns = (
            [claim.channel for claim in ordered],
            [WAYS.index(claim.way) for claim in ordered],
            [claim.column for claim in ordered],
            [parameter(claim.name).index for claim in ordered],
            bounds,
        )
        return cls(*(np.array(column, np.int32) for column in columns))


def blend_in_numpy(claims: Claims, wants: npt.NDArray[np.bool_], wanted: Doubles, values: Doubles) -> None:
    """Blend into ``values (COUNT,)`` what those channels want for which ``wants (C,)`` is true.

    ``wanted (2, N)`` are the values and the weights of all channels.
    """
    for first, end in pairwise(claims.bounds.tolist()):
        if end == first or not wants[claims.channel[first]]:
            continue
        places, way = claims.place[first:end], claims.way[first]
        below, (asked, weights) = values[places], wanted[:, claims.column[first:end]]
        if way == MAX:
            asked = np.maximum(below, asked)
        elif way == ADD:
            asked = below + asked
        elif way == SCALE:
            asked = below * asked
        values[places] = np.where(weights == 1.0, asked, (1.0 - weights) * below + weights * asked)
