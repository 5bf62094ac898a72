"""``agentface bench``: speed, beside what one would use instead."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import click

from agentface.commands.options import face_options, json_option, write_json


@click.command()
@click.argument("name", required=False)
@click.option("--volume", is_flag=True, help="With tissue: what each form of the volume force keeps, instead.")
@json_option
@face_options
def bench(*, name: str | None, volume: bool, json_file: str | None, face: str, deformer: str) -> None:
    """Run one benchmark, or all.

    They are deform, fuzzy, papers, frame, motion, latency, crowd, render, start, tissue, mpeg4, arkit, web and
    texture. Of all of them, those that draw are left out, and said to be, on a machine without OpenGL, and web without
    its extra. The laws that the mouth keeps while it speaks take half an hour, and are measured when asked for alone:
    speech.
    """
    from agentface.deform.protocol import check_deformer
    from agentface.errors import UnknownNameError
    from agentface.resources import face_folder
    from agentface.studies.bench import BENCHES, PARTS

    check_deformer(deformer)
    if name is not None and name not in BENCHES | PARTS:
        raise UnknownNameError("benchmark", name, (*BENCHES, *PARTS))
    face_folder(face)
    if volume:
        if name != "tissue":
            raise click.UsageError("--volume goes with agentface bench tissue")
        name = "tissue_volume"
    figures = (
        _measured(name, face, deformer)
        if name is not None
        else {each: _if_it_can(each, face, deformer) for each in BENCHES}
    )
    if json_file is not None:
        write_json(json_file, figures)
        return
    for key, value in _flat(figures):
        click.echo(f"{key:<48} {value:.4g}" if isinstance(value, float) else f"{key:<48} {value}")


def _measured(name: str, face: str, deformer: str) -> dict[str, Any]:
    from agentface.studies.bench import BENCHES, PARTS, run

    click.echo(f"measuring {(BENCHES | PARTS)[name]} …", err=True)
    return run(name, face, deformer)


def _if_it_can(name: str, face: str, deformer: str) -> dict[str, Any]:
    from agentface.errors import GraphicsError, ServerError

    try:
        return _measured(name, face, deformer)
    except (GraphicsError, ServerError) as error:
        return {"not_run": " ".join(str(error).split())}


def _flat(figures: dict[str, Any], prefix: str = "") -> Iterator[tuple[str, Any]]:
    for key, told in figures.items():
        value = {str(place): item for place, item in enumerate(told)} if isinstance(told, list) else told
        if isinstance(value, dict):
            yield from _flat(value, f"{prefix}{key}.")
        else:
            yield f"{prefix}{key}", value
