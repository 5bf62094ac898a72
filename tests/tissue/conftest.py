"""The tissue of amber, prepared once for all of these tests."""

from __future__ import annotations

import numpy as np
import pytest

from agentface.conventions import Doubles
from agentface.emotion.inference import default_inference
from agentface.emotion.state import EMOTIONS
from agentface.head.model import HeadModel, load_model
from agentface.tissue import tables
from agentface.tissue.lattice import Lattice
from agentface.tissue.tables import TissueTables


@pytest.fixture(scope="session")
def model() -> HeadModel:
    return load_model(asymmetry=0.0)


@pytest.fixture(scope="session")
def tissue(model: HeadModel) -> TissueTables:
    return tables.of(model)


@pytest.fixture(scope="session")
def lattice(tissue: TissueTables) -> Lattice:
    return tissue.lattice


@pytest.fixture(scope="session")
def emotions(tissue: TissueTables) -> dict[str, Doubles]:
    """The contractions of the 23 muscles in each of the six emotions."""
    poses = {name: default_inference().pose({name: 1.0}) for name in EMOTIONS}
    return {name: tissue.drive.contractions(pose.array.astype(np.float64)) for name, pose in poses.items()}
