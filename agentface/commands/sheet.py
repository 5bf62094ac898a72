"""``agentface sheet``: a contact sheet of emotions or poses."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import click

from agentface.commands.options import (
    camera_option,
    face_options,
    look_option,
    make_face,
    quality_option,
    read_assignments,
    size,
)
from agentface.commands.streams import console

if TYPE_CHECKING:
    from agentface.face import Face
    from agentface.parameters import FacePose
    from agentface.requests import Request


class Cell(NamedTuple):
    """One picture: its label, and what is asked of the face."""

    label: str
    requests: Sequence[Request]

    def pose(self, face: Face) -> FacePose:
        """What ``face`` makes of it."""
        from agentface.requests import Neutral

        for request in (Neutral(0.0), *self.requests):
            face.apply(request)
        return face.pose


def _levels(_: click.Context, __: click.Parameter, value: str) -> list[float]:
    try:
        return [float(part) for part in value.split(",")]
    except ValueError:
        raise click.BadParameter(f"expected intensities like 0.25,0.5,1, got {value!r}") from None


@click.command()
@click.option("--emotions", metavar="NAME,...", help="Which emotions; all six when neither this nor --pose is given.")
@click.option("--levels", default="0.25,0.5,0.75,1", callback=_levels, show_default=True, help="Their intensities.")
@click.option("--pose", "poses", multiple=True, metavar="'LABEL: NAME=V, ...'", help="Emotions, muscles, or both.")
@click.option("--columns", type=click.IntRange(1, 24), help="Pictures in a row; one row an emotion by default.")
@click.option("--size", default="320x360", callback=size, metavar="WxH", show_default=True, help="Of one picture.")
@quality_option
@camera_option
@look_option
@click.option("-o", "--output", type=click.Path(path_type=Path), required=True, metavar="FILE.png")
@face_options
def sheet(
    *,
    emotions: str | None,
    levels: list[float],
    poses: tuple[str, ...],
    columns: int | None,
    size: tuple[int, int],
    quality: str,
    camera: str,
    look: str | None,
    output: Path,
    face: str,
    deformer: str,
) -> None:
    """Write a picture of many pictures: emotions by intensity, or a list of poses, with labels.

    \b
    agentface sheet -o sheet.png
    agentface sheet --emotions fear,surprise --levels 0.3,0.6,1 -o sheet.png
    agentface sheet --pose 'kiss: orbicularis_oris_pucker=1' --pose 'sneer: disgust=0.4, jaw_open=0.1' -o sheet.png
    """  # noqa: D301 - \b is click's mark of lines to keep
    import numpy as np
    from rich.progress import track

    from agentface.io.files import check_writable
    from agentface.io.picture import check_picture_name, write_picture
    from agentface.view.contact_sheet import check_sheet_size
    from agentface.view.contact_sheet import sheet as contact_sheet

    check_picture_name(output)
    check_writable(output)
    shown = [_asked(text) for text in poses]
    if emotions or not poses:
        shown += _by_level(emotions, levels)
    width = columns or (min(4, len(shown)) if poses else len(levels))
    check_sheet_size(size, len(shown), width)
    drawn = make_face(face, deformer, compiled=len(shown) > 4, look=look)
    terminal = console()
    bar = track(shown, "drawing", console=terminal, transient=True, disable=not terminal.is_terminal)
    panels = [(drawn.render(size, camera, quality, pose=cell.pose(drawn)), cell.label, "") for cell in bar]
    write_picture(output, np.asarray(contact_sheet(panels, width)))


def _by_level(emotions: str | None, levels: Sequence[float]) -> list[Cell]:
    from agentface.emotion.state import EMOTIONS, EmotionState
    from agentface.requests import SetEmotions

    names = [name.strip() for name in emotions.split(",")] if emotions else EMOTIONS
    return [
        Cell(f"{name} {level:g}", [SetEmotions(EmotionState.of({name: level}), 0.0)])
        for name in names
        for level in levels
    ]


def _asked(text: str) -> Cell:
    """What ``LABEL: NAME=V, ...`` asks for; without a label it is its own."""
    from agentface.emotion.state import ALIASES, EMOTIONS, NEUTRAL, EmotionState
    from agentface.requests import SetEmotions, SetParameter

    label, colon, given = text.partition(":")
    values = read_assignments([given if colon else text])
    felt = {name: value for name, value in values.items() if name.lower() in (*EMOTIONS, *ALIASES, NEUTRAL)}
    held = [SetParameter(name, value, 0.0) for name, value in values.items() if name not in felt]
    return Cell(label.strip(), [SetEmotions(EmotionState.of(felt), 0.0), *held])
