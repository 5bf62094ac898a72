"""``agentface calibrate``: fits a face's muscles to its artists' shapes, and measures how well they agree."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from agentface.commands.options import deformer_option, given, json_option, write_json
from agentface.commands.streams import console
from agentface.errors import OutputError

if TYPE_CHECKING:
    from agentface.studies.calibration.agreement import Agreement
    from agentface.studies.calibration.fit import Progress

    Rows = dict[int, Agreement]


@click.command()
@click.argument("named", required=False, metavar="[FACE]")
@click.option(
    "--starts", type=click.IntRange(1, 1000), default=4, show_default=True, help="Searches of each group of muscles."
)
@click.option("--seed", type=click.IntRange(0), default=0, show_default=True, help="Of the searches' starts.")
@click.option("--dry-run", is_flag=True, help="Fit and print, write nothing.")
@click.option("--table", is_flag=True, help="Fit nothing: measure FACE, or all faces that come with agentface.")
@click.option("-o", "--output", metavar="FILE.md|-", help="With --table: the document whose table to renew.")
@json_option
@click.option("--face", metavar="NAME|PATH", help="The same as FACE.")
@deformer_option
@click.pass_context
def calibrate(
    ctx: click.Context,
    *,
    named: str | None,
    starts: int,
    seed: int,
    dry_run: bool,
    table: bool,
    output: str | None,
    json_file: str | None,
    face: str | None,
    deformer: str,
) -> None:
    """Fit the muscles of FACE, a name or a folder, to its artists' shapes.

    Writes its muscles.yaml, or with --deformer tissue its tissue.yaml, of which all but the muscles stays. Takes
    minutes. Prints how well every action unit agrees, before and after.
    """
    from agentface.deform.protocol import TISSUE_DEFORMERS, check_deformer

    check_deformer(deformer)
    if deformer in TISSUE_DEFORMERS and given(ctx) & {"starts", "seed"}:
        raise click.UsageError("--starts and --seed are for vector muscles: the fit of the tissue has one start")
    if named and face:
        raise click.UsageError("expected one face, got FACE and --face")
    chosen = named or face
    if table:
        if dry_run:
            raise click.UsageError("--table fits nothing, so there is nothing to try with --dry-run")
        _measure([chosen] if chosen else None, deformer, output, json_file)
    elif output:
        raise click.UsageError("--output goes with --table; a fit is written to the face's own folder")
    elif not chosen:
        raise click.UsageError("expected the FACE to fit, or --table; for example agentface calibrate amber --dry-run")
    else:
        _fit(chosen, deformer, starts, seed, dry_run, json_file)


def _measure(faces: Sequence[str] | None, deformer: str, output: str | None, json_file: str | None) -> None:
    from agentface.deform.protocol import make_deformer
    from agentface.facs.action_units import load_action_units
    from agentface.head.model import load_model
    from agentface.resources import face_names
    from agentface.studies.calibration.agreement import measure
    from agentface.studies.calibration.calibrate import table

    models = [load_model(face, asymmetry=0.0) for face in faces or face_names()]
    if json_file is not None:
        units = load_action_units()
        rows = {model.name: measure(model, units, make_deformer(deformer, model)) for model in models}
        write_json(json_file, {name: _figures(each, deformer) for name, each in rows.items()})
    if output not in (None, "-"):
        _renew(Path(str(output)), table(models, deformer), deformer)
    elif output == "-" or json_file is None:
        click.echo(table(models, deformer), nl=False)


def _renew(path: Path, table: str, deformer: str) -> None:
    from agentface.io.files import write_file
    from agentface.studies.calibration.limits import with_table

    try:
        text = with_table(path.read_text(encoding="utf-8"), table, deformer)
    except (OSError, UnicodeDecodeError) as error:
        raise OutputError(f"{path}: expected a document to put the table into: {error}") from error
    except OutputError as error:
        raise OutputError(f"{path}: {error}") from error
    write_file(path, text.encode())
    click.echo(f"{path}: table renewed")


def _fit(face: str, deformer: str, starts: int, seed: int, dry_run: bool, json_file: str | None) -> None:
    from agentface.facs.action_units import load_action_units
    from agentface.io.files import check_writable, write_file
    from agentface.studies.calibration.fits import fit_of
    from agentface.studies.calibration.limits import limits_of, missed

    fit = fit_of(face, deformer, starts, seed)
    if not dry_run:
        check_writable(fit.path)
    with _progress(fit.work) as progress:
        before = fit.before()
        text, after = fit.run(progress)
    if json_file is not None:
        write_json(json_file, {"before": _figures(before, deformer), "after": _figures(after, deformer)})
    if json_file != "-":
        _print({number: unit.name for number, unit in load_action_units().items() if number in after}, before, after)
    for sentence in missed(after, limits_of(deformer)):
        click.echo(f"agentface: {sentence}", err=True)
    if not dry_run:
        write_file(fit.path, text.encode())
        click.echo(f"{fit.path}: written", err=True)


@contextmanager
def _progress(work: Sequence[float]) -> Iterator[Progress]:
    """Shows each step of a fit as it ends, ``work`` of which is how much, and the time left."""
    from rich.progress import BarColumn, TextColumn, TimeElapsedColumn, TimeRemainingColumn
    from rich.progress import Progress as Bar

    steps = iter(work)
    columns = (TextColumn("{task.description}"), BarColumn(), TimeElapsedColumn(), TextColumn("left"))
    # No update comes for a minute at times: guess from all of them.
    with Bar(*columns, TimeRemainingColumn(), console=console(), speed_estimate_period=3600) as bar:
        task = bar.add_task("fitting", total=sum(work))
        yield lambda message: bar.update(task, description=message, advance=next(steps, 0))


def _print(names: dict[int, str], before: Rows, after: Rows) -> None:
    from rich.console import Console
    from rich.table import Table

    from agentface.studies.calibration.calibrate import mean_cosine

    table = Table("AU", "name", "mean cosine", "peak ratio", "region")
    for number, name in names.items():
        old, new = before[number], after[number]
        cosine, ratio = f"{old.cosine:.2f} → {new.cosine:.2f}", f"{old.peak_ratio:.2f} → {new.peak_ratio:.2f}"
        region = new.region if new.region == new.artists_region else f"{new.region}, not {new.artists_region}"
        table.add_row(str(number), name, cosine, ratio, region)
    for title, fitted in (("vector muscles", True), ("lids, lips, jaw", False)):
        means = [f"{mean_cosine(rows, fitted=fitted):.2f}" for rows in (before, after)]
        table.add_row("all", f"mean of {title}", " → ".join(means), "", "")
    terminal = Console()
    with terminal.capture() as printed:
        terminal.print(table)
    click.echo(printed.get(), nl=False)


def _figures(rows: Rows, deformer: str) -> dict[str, Any]:
    from agentface.studies.calibration.calibrate import mean_cosine
    from agentface.studies.calibration.limits import limits_of, missed

    units = {str(number): asdict(row) for number, row in rows.items()}
    return {
        "mean_cosine": mean_cosine(rows),
        "mean_cosine_of_others": mean_cosine(rows, fitted=False),
        "missed": missed(rows, limits_of(deformer)),
        "action_units": units,
    }
