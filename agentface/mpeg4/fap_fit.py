"""What solving for a face's FAPs needs beforehand: ranges, reach, the Jacobian and the prior, made once a model."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from agentface.cache import stamp_of
from agentface.conventions import Doubles, Floats, Indices
from agentface.mpeg4.jacobian import Coupled, Looks, mean_jacobian
from agentface.mpeg4.meter import FapMeter
from agentface.mpeg4.natural import natural_poses, uniform_poses
from agentface.mpeg4.readings import Kind
from agentface.mpeg4.sight import Features
from agentface.mpeg4.solver import Problem
from agentface.parameters import COUNT, HIGH, LOW, NEUTRAL, PARAMETERS, indices_of
from agentface.resources import rules_file

LIDS = ((19, 21), (20, 22))
"""Upper and lower lid: closed where they sum up to 1024, however the two share it."""
CLOSED = 1024.0
"""Units."""
GAZE = indices_of("gaze_yaw") + indices_of("gaze_pitch") + indices_of("gaze_vergence")
_GIVEN = {"gaze", "head", "contact"}
"""Kinds of parameters that FAPs give by themselves, or never: nothing is solved for them."""
_COUPLED = ("orbicularis_oculi_palpebralis", "orbicularis_oculi_orbitalis")
"""Muscles that do something else on one side than on both: closing one eye squeezes it."""
_NO_RANGE = 10.0
"""Units: a FAP that moves less than this has no range; what is measured of it is noise."""
_UNIFORM, _STARTS, _LEARNED, _MEAN = 500, 200, 400, 40
"""Poses: for the ranges, to begin with, for the prior, for the Jacobian."""
_PATTERN = 0.03
"""Of a parameter's largest effect, what it is not for."""
_LOOSE, _PRIOR = 0.02, 1e-5
"""Standard deviation that every parameter has besides, and the prior's weight."""


class FapFit(NamedTuple):
    """For N FAPs and F parameters.

    Attributes:
        ranges: ``(N,)`` units, largest minus least over poses with every parameter anywhere in its range.
        low, high: ``(N,)`` units, the least and the largest of each that some pose shows.
        usable: ``(N,)`` bool, those that have a range.
        problem: for the solver, in features of :func:`features_of`.
        gaze: ``(N + 2, 3)``, how the features change with the parameters of gaze.
        natural: ``(F, F)``, the precision of natural poses about the face at rest.
        starts: ``(S, COUNT)`` float32, natural poses that look straight ahead, the first at rest.
        shown: ``(S, N + 2)``, their features.
    """

    ranges: Doubles
    low: Doubles
    high: Doubles
    usable: npt.NDArray[np.bool_]
    problem: Problem
    gaze: Doubles
    natural: Doubles
    starts: Floats
    shown: Doubles


def features_of(meter: FapMeter, ranges: Doubles | None = None) -> Features:
    """The meter's FAPs over their ranges, 0 for one without, and how far each eye is shut; without ranges in units."""
    count = len(meter.faps)
    matrix = np.eye(count)
    if ranges is not None:
        matrix *= np.where(ranges > _NO_RANGE, 1.0 / np.maximum(ranges, _NO_RANGE), 0.0)[:, None]
    shut = np.zeros((len(LIDS), count))
    for row, pair in zip(shut, LIDS, strict=True):
        row[np.isin(meter.columns, np.array(pair) - 1)] = 1.0 / CLOSED
    return Features(meter.readings, np.vstack([matrix, shut]))


def fap_fit(meter: FapMeter, looks: Callable[[Features], Looks]) -> FapFit:
    """The fit of the meter's face, kept with its model; ``looks`` makes what looks at poses for some features."""
    rules = (rules_file(name) for name in ("emotions.yaml", "blends.yaml", "visemes.yaml", "faps.yaml"))
    name = f"mpeg4.fap_fit.{stamp_of(rules)}"
    fit: FapFit = meter.model.derived(name, lambda _: _fit(meter, looks))
    return fit


def _fit(meter: FapMeter, looks: Callable[[Features], Looks]) -> FapFit:
    count = len(meter.faps)
    units = looks(features_of(meter))
    uniform = units(uniform_poses(_UNIFORM, np.random.default_rng(0)))[:, :count]
    starts = _starts()
    extremes = units(np.vstack([starts, _single_poses()]))[:, :count]
    ranges, extremes = np.ptp(uniform, axis=0), np.vstack([uniform, extremes])
    free = np.array([known.index for known in PARAMETERS if known.kind not in _GIVEN], np.int32)
    look = looks(features_of(meter, ranges))
    moved = np.concatenate([free, np.array(GAZE, np.int32)])
    coupled = [Coupled(indices_of(name), _sides(meter)) for name in _COUPLED]
    jacobian = mean_jacobian(look, natural_poses(_MEAN, np.random.default_rng(7)), moved, coupled)
    largest = np.abs(jacobian[:count, free]).max(axis=0, initial=1e-9)
    pattern = np.abs(jacobian[:count, free]) > _PATTERN * largest
    shut = [pattern[np.isin(meter.columns, np.array(pair) - 1)].any(axis=0) for pair in LIDS]
    pattern = np.vstack([pattern, *(row[None] for row in shut)]).astype(np.float64)
    problem = Problem(
        free, LOW[free].astype(np.float64), HIGH[free].astype(np.float64), jacobian[:, free] * pattern, pattern
    )
    return FapFit(
        ranges=ranges,
        low=extremes.min(axis=0),
        high=extremes.max(axis=0),
        usable=ranges > _NO_RANGE,
        problem=problem,
        gaze=np.ascontiguousarray(jacobian[:, GAZE]),
        natural=_precision(free),
        starts=starts,
        shown=look(starts),
    )


def _starts() -> Floats:
    poses = natural_poses(_STARTS, np.random.default_rng(1))
    poses[:, [known.index for known in PARAMETERS if known.kind in _GIVEN]] = 0.0
    poses[0] = NEUTRAL
    return poses


def _single_poses() -> Floats:
    """Every parameter by itself and with its other side at both ends of its range."""
    poses = []
    for known in PARAMETERS:
        for end in (known.low, known.high):
            alone, both = np.zeros((2, COUNT), np.float32)
            alone[known.index] = end
            both[[known.index, indices_of(known.partner or known.name)[0]]] = end
            poses += [alone, both]
    return np.array(poses)


def _sides(meter: FapMeter) -> tuple[npt.NDArray[np.bool_], ...]:
    """``(N + 2,)`` for the left and the right: which features are read on that side."""
    readings = meter.readings
    skin = np.isin(readings.kind, (Kind.SKIN, Kind.IN_JAW))
    aside = np.zeros(len(skin))
    aside[skin] = meter.model.vertices[readings.vertex[skin], 0]
    middle = 0.002  # m
    left, right = np.append(aside > middle, [True, False]), np.append(aside < -middle, [False, True])
    return left, right


def _precision(free: Indices) -> Doubles:
    poses = natural_poses(_LEARNED, np.random.default_rng(3))[:, free].astype(np.float64)
    # about rest, not about the mean: a stream of zeros shows a face at rest
    spread = poses.T @ poses / len(poses) + _LOOSE**2 * np.eye(len(free))
    return np.ascontiguousarray(_PRIOR * np.linalg.inv(spread))
