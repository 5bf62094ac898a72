"""Files of faces that several tests look at, each written once a worker."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from agentface.deform.protocol import Deformer, make_deformer
from agentface.face import Face
from agentface.head.look import load_look
from agentface.head.model import HeadModel
from agentface.io.gltf.face_glb import FaceGlb, GlbFace
from agentface.live.loop import Frame
from agentface.mpeg4.expressions import EXPRESSIONS, expression_pose
from agentface.mpeg4.natural import natural_poses
from agentface.parameters import FacePose, indices_of

FACE = "amber"


@dataclass(frozen=True)
class Written:
    """A file, what was said of it, and the poses that its animation goes through."""

    path: Path
    made: GlbFace
    poses: tuple[FacePose, ...] = ()
    times_s: tuple[float, ...] = ()


@pytest.fixture(scope="session")
def deformer() -> Deformer:
    return make_deformer("geometric", Face(FACE).model)


@pytest.fixture(scope="session")
def model() -> HeadModel:
    return Face(FACE).model


@pytest.fixture(scope="session")
def face_glb(model: HeadModel, deformer: Deformer) -> FaceGlb:
    return FaceGlb(model, load_look(model), deformer)


@pytest.fixture(scope="session")
def poses() -> tuple[FacePose, ...]:
    """Natural poses one after the other, with head, eyes, tongue and shoulders in motion; the first is at rest."""
    rows = 0.7 * natural_poses(9, np.random.default_rng(11)).astype(np.float32)
    rows[0] = 0.0
    rows[1] = expression_pose(EXPRESSIONS.index("anger"), 63, 0, 0)  # brows that turn
    for name, size in (("head_yaw", 0.6), ("head_pitch", -0.2), ("gaze_yaw", 0.3), ("tongue_raise", 0.5)):
        rows[:, indices_of(name)[0]] = size * np.sin(np.arange(len(rows)))
    rows[:, indices_of("breath")[0]] = np.linspace(0.0, 1.0, len(rows))
    return tuple(FacePose(row) for row in rows)


def played(poses: tuple[FacePose, ...], deformer: Deformer) -> Callable[[Any], None]:
    def play(recorder: Any) -> None:
        for number, pose in enumerate(poses):
            recorder.show(Frame(0.1 * number, 0.0, pose, deformer.at(pose)))

    return play


def written(folder: Path, name: str, made: GlbFace, poses: tuple[FacePose, ...] = ()) -> Written:
    path = folder / name
    path.write_bytes(made.content)
    return Written(path, made, poses, tuple(0.1 * number for number in range(len(poses))))


@pytest.fixture(scope="session")
def arkit_file(face_glb: FaceGlb, tmp_path_factory: Any) -> Written:
    return written(tmp_path_factory.mktemp("arkit"), "arkit.glb", face_glb.with_arkit())


@pytest.fixture(scope="session")
def played_file(face_glb: FaceGlb, deformer: Deformer, poses: Any, tmp_path_factory: Any) -> Written:
    made = face_glb.with_modes(played(poses, deformer))
    return written(tmp_path_factory.mktemp("played"), "played.glb", made, poses)
