"""``agentface explain``: why a face looks as it does."""

from __future__ import annotations

from pathlib import Path

import click

from agentface.commands.options import assignments, emotion_option, face_options, json_option, make_face, write_json


@click.command()
@emotion_option
@click.argument("more", nargs=-1, callback=assignments, metavar="[NAME=V]...")
@json_option
@click.option(
    "--plot",
    type=click.Path(path_type=Path),
    metavar="FILE.png",
    help="Draw it: the fuzzy sets, the rules that fired, and what they add up to for each muscle.",
)
@face_options
def explain(
    *,
    emotions: dict[str, float],
    more: dict[str, float],
    json_file: str | None,
    plot: Path | None,
    face: str,
    deformer: str,
) -> None:
    """Print, or draw, which rules fired, how strongly, and what each muscle got."""
    twice = emotions.keys() & more.keys()
    if twice or not (emotions or more):
        raise click.UsageError("expected each emotion once, and at least one; for example --emotion happiness=0.8")
    if plot is not None:
        from agentface.io.files import check_writable
        from agentface.io.picture import check_picture_name

        check_picture_name(plot)
        check_writable(plot)
    shown = make_face(face, deformer, compiled=False)
    shown.set_emotion(emotions | more, fade=0.0)
    explanation = shown.explain()
    if plot is not None:
        from agentface.io.picture import write_picture
        from agentface.studies.rule_plot import rule_plot

        write_picture(plot, rule_plot(explanation))
    if json_file is not None:
        write_json(json_file, explanation.as_dict())
    elif plot is None:
        click.echo(explanation.render())
