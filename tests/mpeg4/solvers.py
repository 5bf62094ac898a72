"""Meters and solvers of the faces that ship, shared: nothing may write to their arrays."""

from __future__ import annotations

from functools import cache

import numpy as np

from agentface.conventions import Floats
from agentface.deform.crowd import Crowd
from agentface.head.model import load_model
from agentface.mpeg4.fap_solver import FapSolver
from agentface.mpeg4.natural import natural_poses, uniform_poses


@cache
def solver_of(face: str) -> FapSolver:
    return FapSolver(load_model(face))


@cache
def crowd_of(face: str) -> Crowd:
    return Crowd(load_model(face))


def measured(face: str, poses: Floats) -> Floats:
    """``(B, 68)``: what the whole face shows, with wrinkles and all."""
    return solver_of(face).meter.measure(crowd_of(face).deform(poses))


@cache
def ranges_of(face: str) -> Floats:
    """``(68,)``: largest minus least over 500 poses with every parameter anywhere in its range."""
    return np.ptp(measured(face, uniform_poses(500, np.random.default_rng(0))), axis=0)


def some_poses(kind: str, count: int, seed: int) -> Floats:
    make = {"uniform": uniform_poses, "natural": natural_poses}[kind]
    return make(count, np.random.default_rng(seed))
