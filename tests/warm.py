"""Compiles the kernels and prepares the faces that many tests share, once: ``python -m tests.warm geometric|tissue``.

Each worker of a test run would compile them for itself, slowed by the measuring of coverage.
"""

from __future__ import annotations

import sys

import numpy as np

from agentface import Face
from agentface.arkit.shape_solver import ShapeSolver
from agentface.deform.crowd import Crowd
from agentface.deform.finish.finish import Finish
from agentface.deform.pipeline import GeometricDeformer
from agentface.deform.protocol import DEFAULT_DEFORMER, make_deformer
from agentface.head.model import HeadModel, load_model
from agentface.mpeg4.fap_solver import FapSolver
from agentface.parameters import NEUTRAL, FacePose
from agentface.resources import face_names
from agentface.view.gl.quality import QUALITIES


def warm(deformer: str) -> None:
    """A step of each face with one deformer, with its asymmetry and without.

    With the geometric one also a picture in each quality, its stages one by one, many faces at once, and FAPs and
    ARKit's weights that are solved for.
    """
    for name in face_names():
        with Face(name, deformer=deformer) as face:
            face.set_emotion("happiness", 1.0, fade=0.0)
            face.set_emotion("surprise", 0.5)
            face.set_muscle("risorius", 0.5, fade=0.1)
            face.speak([("p", 0.0, 0.1), ("aa", 0.1, 0.3)])
            for _ in range(3):
                face.step(1 / 60)
            if deformer == DEFAULT_DEFORMER:
                for quality in QUALITIES:
                    face.render(size=(64, 64), quality=quality)
        if deformer == DEFAULT_DEFORMER:
            warm_stages(load_model(name))
            for model in (load_model(name), load_model(name, asymmetry=0.0)):
                FapSolver(model).solve(np.zeros(68))
                ShapeSolver(model).weights(NEUTRAL)
            with Crowd(load_model(name)) as crowd:
                crowd.deform(NEUTRAL[None])
        symmetric = make_deformer(deformer, load_model(name, asymmetry=0.0))
        symmetric.step(FacePose.of(mentalis=0.5), 1 / 60)


def warm_stages(model: HeadModel) -> None:
    """The last part of every deformer and each stage of the geometric one, which are otherwise parts of one kernel."""
    deformer = GeometricDeformer(model)
    geometry = deformer.at(FacePose())
    Finish(model).apply(NEUTRAL, geometry)
    for act in deformer.stages(geometry).values():
        act(FacePose())


if __name__ == "__main__":
    kind = sys.argv[1]
    warm(kind)
    if kind == "tissue":
        warm("tissue-semi-implicit")
