"""``agentface explain``: why a face looks as it does."""

from __future__ import annotations

import click

from agentface.commands.options import assignments, emotion_option, face_options, json_option, make_face, write_json


@click.command()
@emotion_option
@click.argument("more", nargs=-1, callback=assignments, metavar="[NAME=V]...")
@json_option
@face_options
def explain(
    *, emotions: dict[str, float], more: dict[str, float], json_file: str | None, face: str, deformer: str
) -> None:
    """Print which rules fired, how strongly, and what each muscle got."""
    twice = emotions.keys() & more.keys()
    if twice or not (emotions or more):
        raise click.UsageError("expected each emotion once, and at least one; for example --emotion happiness=0.8")
    shown = make_face(face, deformer, compiled=False)
    shown.set_emotion(emotions | more, fade=0.0)
    explanation = shown.explain()
    if json_file is None:
        click.echo(explanation.render())
    else:
        write_json(json_file, explanation.as_dict())
