from __future__ import annotations

import json
import subprocess
import sys

import pytest
from hypothesis import given
from hypothesis import strategies as st

from agentface.emotion.inference import Inference, default_inference
from agentface.emotion.state import EmotionState


@given(st.lists(st.floats(0.0, 1.0), min_size=6, max_size=6))
def test_an_explanation_adds_up(intensities: list[float]):
    explanation = default_inference().explain(EmotionState(intensities))
    assert sum(mode.weight for mode in explanation.modes) == pytest.approx(1.0 if any(intensities) else 0.0)
    total = dict.fromkeys(explanation.contractions, 0.0)
    for mode in explanation.modes:
        strongest: dict[tuple[str, str], float] = {}
        for rule in mode.rules:
            place = rule.muscle, rule.consequent
            strongest[place] = max(strongest.get(place, 0.0), rule.strength)
        for outcome in mode.muscles:
            cuts = {name: strength for (muscle, name), strength in strongest.items() if muscle == outcome.muscle}
            assert outcome.cuts == cuts
            total[outcome.muscle] += mode.weight * outcome.contraction
    assert explanation.contractions == pytest.approx(total)


def test_an_explanation_says_its_rules_in_words(inference: Inference):
    explanation = inference.explain({"sad": 0.75, "afraid": 0.75})
    (mode,) = explanation.modes
    assert (mode.name, mode.weight) == ("sadness+fear", 1.0)
    texts = [rule.text for rule in mode.rules]
    assert "if Sadness is High and Fear is High then contraction of frontalis_medialis is VeryBig" in texts


def test_an_explanation_goes_to_json_and_to_text(inference: Inference):
    explanation = inference.explain({"happiness": 0.7, "surprise": 0.55})
    data = json.loads(json.dumps(explanation.as_dict()))
    assert data["emotion"]["happiness"] == 0.7
    assert {mode["name"] for mode in data["modes"]} == {"happiness", "happiness+surprise"}
    assert data["contractions"]["zygomaticus_major"] == explanation.contractions["zygomaticus_major"]
    text = explanation.render(width=140)
    assert "happiness 0.7, surprise 0.55" in text
    assert "zygomaticus_major" in text
    assert max(len(line) for line in text.splitlines()) <= 140


def test_neutral_is_explained_too(inference: Inference):
    assert "neutral" in inference.explain({}).render()


def test_the_modules_load_without_the_compiler():
    code = (
        "import sys, agentface.emotion.inference as _; print({'numba', 'scipy', 'skfuzzy', 'rich'} & set(sys.modules))"
    )
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert run.stdout.strip() == "set()"
