"""Why a face looks as it does: the modes, the rules that fired, and what each muscle got."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from io import StringIO
from typing import TYPE_CHECKING, Any

import numpy as np

from agentface.emotion.mamdani import centroid, cuts_of, rule_strengths
from agentface.emotion.rules import Mode, RuleBase
from agentface.emotion.selector import mode_weights
from agentface.emotion.sets import CONTRACTION_SETS, INTENSITY_SETS, rescale
from agentface.emotion.state import EMOTIONS, EmotionState
from agentface.parameters import MUSCLES

if TYPE_CHECKING:
    from rich.table import Table


@dataclass(frozen=True, slots=True)
class FiredRule:
    """A rule that fired: its strength in 0..1, its text, the emotions' sets, and the set it concludes of a muscle."""

    strength: float
    text: str
    premise: tuple[tuple[str, str], ...]
    muscle: str
    consequent: str


@dataclass(frozen=True, slots=True)
class MuscleOutcome:
    """What one mode asks of one muscle: the height of each contraction set, their centroid, its contraction."""

    muscle: str
    cuts: dict[str, float]
    centroid: float
    contraction: float


@dataclass(frozen=True, slots=True)
class ModeOutcome:
    """One mode that takes part: its weight, the rules that fired in it, and what it asks of each muscle."""

    name: str
    weight: float
    description: str
    source: str
    rules: tuple[FiredRule, ...]
    muscles: tuple[MuscleOutcome, ...]


@dataclass(frozen=True, slots=True)
class Explanation:
    """A state, the modes it calls for, and the contraction of each muscle, the weighted mean over the modes."""

    state: EmotionState
    modes: tuple[ModeOutcome, ...]
    contractions: dict[str, float]

    def as_dict(self) -> dict[str, Any]:
        """The explanation as JSON-ready values."""
        return {
            "emotion": self.state.as_dict(),
            "modes": [asdict(mode) for mode in self.modes],
            "contractions": dict(self.contractions),
        }

    def render(self, width: int = 120) -> str:
        """The explanation as plain text tables, ``width`` columns wide."""
        return _report(self, width)


def explain(rulebase: RuleBase, state: EmotionState) -> Explanation:
    """Infer ``state`` step by step, by the numpy twin of the kernel."""
    weights = mode_weights(state.array, rulebase.gap)
    modes = [_outcome(rulebase.mode(emotions), weight, state) for emotions, weight in weights.items()]
    modes.sort(key=lambda mode: -mode.weight)
    contractions = dict.fromkeys(MUSCLES, 0.0)
    for mode in modes:
        for muscle in mode.muscles:
            contractions[muscle.muscle] += mode.weight * muscle.contraction
    return Explanation(state, tuple(modes), {muscle: min(1.0, value) for muscle, value in contractions.items()})


def _outcome(mode: Mode, weight: float, state: EmotionState) -> ModeOutcome:
    strengths = rule_strengths(state.array[[EMOTIONS.index(emotion) for emotion in mode.emotions]])
    rules = []
    outcomes = []
    for muscle, consequents in mode.consequents.items():
        cuts = cuts_of(strengths, consequents)
        middle = centroid(cuts)
        heights = {name: float(cut) for name, cut in zip(CONTRACTION_SETS, cuts, strict=True) if cut > 0.0}
        outcomes.append(MuscleOutcome(muscle, heights, middle, rescale(middle)))
        for place in np.argwhere(strengths > 0.0):
            sets = [INTENSITY_SETS[index] for index in place]
            consequent = CONTRACTION_SETS[consequents[tuple(place)]]
            premise = tuple(zip(mode.emotions, sets, strict=True))
            text = _text(premise, muscle, consequent)
            rules.append(FiredRule(float(strengths[tuple(place)]), text, premise, muscle, consequent))
    return ModeOutcome(mode.name, weight, mode.description, mode.source, tuple(rules), tuple(outcomes))


def _text(premise: tuple[tuple[str, str], ...], muscle: str, consequent: str) -> str:
    conditions = " and ".join(f"{emotion.capitalize()} is {name}" for emotion, name in premise)
    return f"if {conditions} then contraction of {muscle} is {consequent}"


def _report(explanation: Explanation, width: int) -> str:
    from rich.console import Console

    text = StringIO()
    console = Console(file=text, width=width, color_system=None, legacy_windows=False)
    active = [f"{name} {value:g}" for name, value in explanation.state.as_dict().items() if value > 0.0]
    console.print(f"State: {', '.join(active) or 'neutral'}", highlight=False)
    for mode in explanation.modes:
        console.print(f"\n{mode.name}, weight {mode.weight:.3f}: {mode.description}", highlight=False)
        console.print(_rules(mode))
        console.print(_muscles(mode))
    console.print(_contractions(explanation))
    return text.getvalue()


def _rules(mode: ModeOutcome) -> Table:
    from rich.table import Table

    table = Table("strength", "rule that fired", title_justify="left")
    for rule in sorted(mode.rules, key=lambda rule: (rule.muscle, -rule.strength)):
        table.add_row(f"{rule.strength:.3f}", rule.text)
    return table


def _muscles(mode: ModeOutcome) -> Table:
    from rich.table import Table

    table = Table("muscle", "sets, each cut at", "centroid", "contraction")
    for outcome in mode.muscles:
        cuts = ", ".join(f"{name} {cut:.3f}" for name, cut in outcome.cuts.items())
        table.add_row(outcome.muscle, cuts, f"{outcome.centroid:.4f}", f"{outcome.contraction:.4f}")
    return table


def _contractions(explanation: Explanation) -> Table:
    from rich.table import Table

    table = Table("muscle", "contraction", title="What the face gets", title_justify="left")
    for muscle, value in explanation.contractions.items():
        if value > 0.0:
            table.add_row(muscle, f"{value:.4f}")
    return table
