"""Errors and times of the paper's schemes and ours: Figures 7 and 8 of Zhang, Prakash and Sung, beside its Table 1.

Times differ from run to run, and measuring takes minutes. So the charts are of a report that is kept beside this
module, which one command makes anew::

    agentface bench tissue --json agentface/studies/figures/tissue_charts.json
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from agentface.errors import DataError, Fault
from agentface.studies.bench.tissue import EQUAL_ERROR
from agentface.studies.figures.bar_chart import Chart
from agentface.studies.figures.mesh_view import Colour
from agentface.studies.figures.overlay import in_colours
from agentface.view.contact_sheet import sheet

if TYPE_CHECKING:
    from PIL.Image import Image

REPORT = Path(__file__).with_suffix(".json")
"""What ``agentface bench tissue --json`` has measured."""


class PaperRow(NamedTuple):
    """One row of the paper's Table 1, and the saving that its text names: what SII takes follows from that.

    Attributes:
        precompute_s: the adaptive scheme's.
        dynamic_ms, quasi_static_ms: of an iteration.
        saved_ratio: of a frame with its drawing, against semi-implicit integration; None where the paper gives none.
    """

    precompute_s: float
    dynamic_ms: float
    quasi_static_ms: float
    saved_ratio: float | None = None


PAPER = {
    "happiness": PaperRow(16.92, 14.7, 8.0, 0.744),
    "anger": PaperRow(20.26, 27.6, 7.0),
    "sadness": PaperRow(22.37, 33.8, 9.2, 0.607),
    "disgust": PaperRow(19.85, 30.3, 7.8),
    "surprise": PaperRow(18.45, 21.7, 7.2),
}
PAPER_DRAW_MS, PAPER_SAVED_MEAN = 5.0, 0.673
_DYNAMIC: Colour = (204, 84, 60)
_QUASI: Colour = (236, 178, 74)
_DRAW: Colour = (150, 150, 158)
_SII: Colour = (84, 116, 176)
_OURS: Colour = (44, 140, 104)
_MEAN: Colour = (238, 178, 160)
_PALE: Colour = (164, 184, 220)


def figures(face: str | Path) -> dict[str, bytes]:
    """``tissue-errors.png`` and ``tissue-times.png``, of the report that is kept, whatever the ``face``.

    Raises DataError where there is no such report.
    """
    del face
    report = read_report(REPORT)
    return {"tissue-errors.png": in_colours(errors(report)), "tissue-times.png": in_colours(times(report))}


def read_report(path: str | Path) -> dict[str, Any]:
    """What ``agentface bench tissue --json`` wrote; raises DataError where it is missing or something else."""
    path = Path(path)
    hint = f"make it with `agentface bench tissue --json {path}`"
    try:
        report = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise DataError([Fault(path, None, "", "a report of agentface bench tissue", str(error), hint)]) from error
    if not (isinstance(report, dict) and isinstance(report.get("expressions"), dict)):
        raise DataError([Fault(path, None, "", "a report of agentface bench tissue", "something else", hint)])
    return report


def errors(report: dict[str, Any]) -> Image:
    """Figure 7: the largest and the mean error of each expression, in mm and of its largest displacement."""
    rows = report["expressions"]
    colours = [{"adaptive, largest": _DYNAMIC}, {"adaptive, mean": _MEAN}, {"ours, largest": _OURS}]
    millimetres = {
        name: [
            (row["adaptive"]["error_max_mm"],),
            (row["adaptive"]["error_mean_mm"],),
            (row["default"]["error_max_mm"],),
        ]
        for name, row in rows.items()
    }
    times = [row["adaptive"]["error_max_mm"] / row["adaptive"]["error_mean_mm"] for row in rows.values()]
    ratios = {
        name: [
            (100.0 * row["adaptive"]["error_max_mm"] / row["largest_mm"],),
            (100.0 * row["adaptive"]["error_mean_mm"] / row["largest_mm"],),
            (100.0 * row["default"]["error_max_mm"] / row["largest_mm"],),
        ]
        for name, row in rows.items()
    }
    said = f"adaptive: largest {min(times):.0f} to {max(times):.0f} times the mean; the paper: about 5 times at most"
    panels = [
        (Chart("mm", colours, millimetres).picture(), "Figure 7: errors of an expression", said),
        (Chart("%", colours, ratios).picture(), "of its largest displacement", "at the end of the ramp, or settled"),
    ]
    return sheet(panels, columns=2)


def times(report: dict[str, Any]) -> Image:
    """Figure 8 (a) to (c): precomputing, an iteration by process, frames a second; the paper's above, ours below."""
    rows, draw = report["expressions"], report["draw_ms"] or 0.0
    saved = f"an iteration; {100.0 * PAPER_SAVED_MEAN:.1f} % saved on average; SII where its text says what is saved"
    panels = [
        (_precompute(_PAPER_ROWS), "Figure 8 (a), the paper's", "before an expression; SII: about a third of that"),
        (_iteration(_PAPER_ROWS, PAPER_DRAW_MS), "Figure 8 (b), the paper's", saved),
        (_frames(_PAPER_ROWS, PAPER_DRAW_MS), "Figure 8 (c), the paper's", "one iteration a frame, with drawing"),
        (_precompute(rows), "(a) here", "before an expression"),
        (_iteration(rows, 0.0), "(b) here, without drawing", _saved(rows, draw)),
        (_frames(rows, draw), "(c) here", f"with drawing; {_TO_ERROR}: no node off by more of the largest move"),
    ]
    return sheet(panels, columns=3)


_TO_ERROR = f"to {100.0 * EQUAL_ERROR:g} %"
_STEP = "one step"


def _paper_row(row: PaperRow) -> dict[str, Any]:
    """A row of the paper in the form of a report's; what it does not say is None."""
    adaptive = row.dynamic_ms + row.quasi_static_ms
    whole = None
    if row.saved_ratio is not None:
        whole = (adaptive + PAPER_DRAW_MS) / (1.0 - row.saved_ratio) - PAPER_DRAW_MS
    return {
        "adaptive": {
            "precompute_s": row.precompute_s,
            "dynamic_ms": row.dynamic_ms,
            "quasi_static_ms": row.quasi_static_ms,
            "iteration_ms": adaptive,
        },
        "semi_implicit": {"precompute_s": None, "iteration_ms": whole},
    }


_PAPER_ROWS = {name: _paper_row(row) for name, row in PAPER.items()}


def _precompute(rows: dict[str, Any]) -> Image:
    bars = {
        name: [(row["adaptive"]["precompute_s"],), (row["semi_implicit"]["precompute_s"],)]
        for name, row in rows.items()
    }
    return Chart("s", [{"adaptive": _DYNAMIC}, {"semi-implicit": _SII}], bars).picture()


def _iteration(rows: dict[str, Any], draw: float) -> Image:
    """The processes of an iteration; with ``draw`` ms of drawing, unless that is 0."""
    parts = [{"dynamic": _DYNAMIC, "quasi-static": _QUASI}, {"semi-implicit": _SII}]
    bars = {
        name: [
            [row["adaptive"]["dynamic_ms"], row["adaptive"]["quasi_static_ms"]],
            [row["semi_implicit"]["iteration_ms"]],
        ]
        for name, row in rows.items()
    }
    if draw:
        parts = [part | {"drawing": _DRAW} for part in parts]
        bars = {name: [[*bar, draw if bar[0] is not None else None] for bar in both] for name, both in bars.items()}
    return Chart("ms", parts, bars).picture()


def _saved(rows: dict[str, Any], draw: float) -> str:
    with_drawing, without = (
        100.0 * sum(row["adaptive"][key] for row in rows.values()) / len(rows)
        for key in ("saved_with_drawing_ratio", "saved_ratio")
    )
    return f"{without:.1f} % saved on average; {with_drawing:.1f} % with drawing, {draw:.0f} ms"


def _frames(rows: dict[str, Any], draw: float) -> Image:
    """One step a frame, as the paper counts; and where it was measured, as many as keep to the error."""
    bars = {
        name: [[_rate(row["adaptive"]["iteration_ms"], draw)], [_rate(row["semi_implicit"]["iteration_ms"], draw)]]
        for name, row in rows.items()
    }
    parts = [{f"adaptive, {_STEP}": _DYNAMIC}, {f"semi-implicit, {_STEP}": _SII}]
    if all("default" in row for row in rows.values()):
        parts += [{f"semi-implicit, {_TO_ERROR}": _PALE}, {f"ours, {_TO_ERROR}": _OURS}]
        for name, row in rows.items():
            bars[name] += [[_rate(row[solver]["frame_ms"], draw)] for solver in ("semi_implicit", "default")]
    return Chart("1/s", parts, bars).picture()


def _rate(milliseconds: float | None, draw: float) -> float | None:
    return None if milliseconds is None else 1e3 / (milliseconds + draw)
