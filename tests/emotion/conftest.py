from __future__ import annotations

from pathlib import Path
from shutil import copyfile

import numpy as np
import pytest

from agentface.emotion.inference import Inference, default_inference
from agentface.emotion.rules import RuleBase
from agentface.resources import rules_file


@pytest.fixture(scope="session")
def inference() -> Inference:
    return default_inference()


@pytest.fixture(scope="session")
def rulebase() -> RuleBase:
    return default_inference().rulebase


@pytest.fixture
def rng(request: pytest.FixtureRequest) -> np.random.Generator:
    return np.random.default_rng(sum(request.node.name.encode()))


@pytest.fixture
def rules_folder(tmp_path: Path) -> Path:
    """A copy of the rules, to be spoilt."""
    for name in ("emotions.yaml", "blends.yaml"):
        copyfile(rules_file(name), tmp_path / name)
    return tmp_path


@pytest.fixture(scope="session")
def gives_way() -> set[tuple[str, str]]:
    """Emotions and muscles that relax again: lips pressed in held-back anger; fury opens the mouth."""
    return {("anger", "orbicularis_oris_press"), ("anger", "mentalis")}
