"""Some fifty poses of both faces, against vertices that were looked at; `pytest --regen-goldens` stores them anew."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from agentface.emotion.inference import default_inference
from agentface.emotion.state import EMOTIONS, EmotionState
from agentface.facs.action_units import load_action_units
from agentface.parameters import FacePose
from agentface.resources import face_names
from tests.heads import deformer_of, head_model

FOLDER = Path(__file__).parent / "goldens"
UNIT_M = 2e-6
EVERY = 7
WITHIN_M = 8e-6

MIXED = {
    "wink": FacePose.of(orbicularis_oculi_palpebralis_l=1.0, zygomaticus_major_l=0.5),
    "squeeze": FacePose.of(orbicularis_oculi_orbitalis=0.8, corrugator_supercilii=0.6),
    "look up, lids half open": FacePose.of(gaze_pitch=0.25, gaze_yaw=-0.3, orbicularis_oculi_palpebralis=0.3),
    "kissing smile": FacePose.of(orbicularis_oris_pucker=0.7, zygomaticus_major=0.6, jaw_open=0.15),
    "pressed, chin up": FacePose.of(orbicularis_oris_press=0.8, mentalis=0.9, depressor_anguli_oris=0.4),
    "shout": FacePose.of(jaw_open=0.9, levator_labii_superioris=0.8, depressor_labii_inferioris=0.9, procerus=0.7),
}


def poses() -> dict[str, FacePose]:
    infer = default_inference()
    shown = {number: unit for number, unit in load_action_units().items() if number != 45 and not unit.turns}
    units = {f"AU {number}": unit.pose for number, unit in shown.items()}
    felt = {f"{name} {level}": infer.pose(EmotionState.of({name: level})) for name in EMOTIONS for level in (0.5, 1.0)}
    return {**units, **felt, **MIXED}


@pytest.mark.parametrize("face", face_names())
def test_every_vertex_is_where_it_was(face, request):
    model = head_model(face)
    deformer = deformer_of(face)
    moved = {name: deformer.at(pose).vertices - model.vertices for name, pose in poses().items()}
    assert len(moved) >= 50
    sampled = np.stack([np.rint(field[::EVERY] / UNIT_M) for field in moved.values()]).astype(np.int16)
    sizes = np.stack([np.linalg.norm(field, axis=1) for field in moved.values()])
    whole = np.stack([sizes.mean(axis=1), sizes.max(axis=1)], axis=1)
    path = FOLDER / f"{face}.npz"
    if request.config.getoption("--regen-goldens"):
        np.savez_compressed(path, names=np.array(list(moved)), sampled=sampled, whole=whole.astype(np.float32))
    stored = np.load(path)
    assert stored["names"].tolist() == list(moved)
    for i, name in enumerate(moved):
        gap = UNIT_M * np.abs(sampled[i].astype(int) - stored["sampled"][i]).max()
        assert gap <= WITHIN_M, f"{face}, {name}: a vertex is {1e3 * gap:.3f} mm from where it was"
        np.testing.assert_allclose(whole[i], stored["whole"][i], atol=WITHIN_M, err_msg=f"{face}, {name}")
