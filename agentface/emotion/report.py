"""An explanation as text tables for people."""

from __future__ import annotations

from io import StringIO

from rich.console import Console
from rich.table import Table

from agentface.emotion.explanation import Explanation, ModeOutcome


def render(explanation: Explanation, width: int) -> str:
    """``explanation`` as plain text, ``width`` columns wide."""
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
    table = Table("strength", "rule that fired", title_justify="left")
    for rule in sorted(mode.rules, key=lambda rule: (rule.muscle, -rule.strength)):
        table.add_row(f"{rule.strength:.3f}", rule.text)
    return table


def _muscles(mode: ModeOutcome) -> Table:
    table = Table("muscle", "sets, each cut at", "centroid", "contraction")
    for outcome in mode.muscles:
        cuts = ", ".join(f"{name} {cut:.3f}" for name, cut in outcome.cuts.items())
        table.add_row(outcome.muscle, cuts, f"{outcome.centroid:.4f}", f"{outcome.contraction:.4f}")
    return table


def _contractions(explanation: Explanation) -> Table:
    table = Table("muscle", "contraction", title="What the face gets", title_justify="left")
    for muscle, value in explanation.contractions.items():
        if value > 0.0:
            table.add_row(muscle, f"{value:.4f}")
    return table
