"""What a calibrated face must fulfil, and the table that shows it."""

from __future__ import annotations

from typing import NamedTuple

from agentface.deform.protocol import DEFAULT_DEFORMER, TISSUE_DEFORMERS
from agentface.errors import OutputError
from agentface.studies.calibration.agreement import Agreement
from agentface.studies.calibration.calibrate import mean_cosine


class Limits(NamedTuple):
    """What the action units of vector muscles must reach, on average and each; and the others.

    Attributes:
        mean_cosine: the least mean over those that are fitted.
        cosine: the least of each of them.
        other_cosine: the least of those that lids, lips and jaw make, which are not fitted; None for none.
        peak_ratios: the range of those that are fitted.
        same_region: whether they must be largest in the region where the artists' shapes are.
    """

    mean_cosine: float
    cosine: float
    other_cosine: float | None
    peak_ratios: tuple[float, float]
    same_region: bool


VECTOR_MUSCLE_LIMITS = Limits(0.85, 0.7, 0.6, (0.7, 1.4), same_region=True)
TISSUE_LIMITS = Limits(0.9, 0.75, None, (0.7, 1.4), same_region=False)

END = "<!-- end -->\n"


def limits_of(deformer: str) -> Limits:
    """The limits of a face that a deformer moves."""
    return TISSUE_LIMITS if deformer in TISSUE_DEFORMERS else VECTOR_MUSCLE_LIMITS


def begin_of(deformer: str = DEFAULT_DEFORMER) -> str:
    """The line above the table of a deformer in a document."""
    chosen = "" if deformer == DEFAULT_DEFORMER else f" --deformer {deformer}"
    document = "docs/tissue.md" if deformer in TISSUE_DEFORMERS else "docs/calibration.md"
    return f"<!-- begin: written by `agentface calibrate --table{chosen} -o {document}` -->\n"


def missed(rows: dict[int, Agreement], limits: Limits = VECTOR_MUSCLE_LIMITS) -> list[str]:
    """What of the limits a face misses, a sentence each; empty for a good one."""
    result = []
    mean = mean_cosine(rows)
    if mean < limits.mean_cosine:
        result.append(f"mean cosine: expected at least {limits.mean_cosine}, got {mean:.3f}")
    for number, row in rows.items():
        result += [f"AU {number}: expected {sentence}" for sentence in _missed(row, limits)]
    return result


def _missed(row: Agreement, limits: Limits) -> list[str]:
    result = []
    lowest = limits.cosine if row.fitted else limits.other_cosine
    if lowest is not None and row.cosine < lowest:
        result.append(f"a cosine of at least {lowest}, got {row.cosine:.3f}")
    if not row.fitted:
        return result
    low, high = limits.peak_ratios
    if not low <= row.peak_ratio <= high:
        result.append(f"a peak ratio in {low}..{high}, got {row.peak_ratio:.3f}")
    if limits.same_region and row.region != row.artists_region:
        result.append(f"the largest displacement in {row.artists_region}, got {row.region}")
    return result


def between_marks(document: str, deformer: str = DEFAULT_DEFORMER) -> str:
    """The table of a deformer in a document; raises OutputError when it has no place for one."""
    begin_mark = begin_of(deformer)
    _, begin, rest = document.partition(begin_mark)
    table, end, _ = rest.partition(END)
    if not (begin and end):
        raise OutputError(
            f"expected a document with the lines {begin_mark.strip()} and {END.strip()}, got none of these"
        )
    return table


def with_table(document: str, table: str, deformer: str = DEFAULT_DEFORMER) -> str:
    """The document with ``table`` in place of the one it holds; raises OutputError when it has no place for one."""
    between_marks(document, deformer)
    before, begin, rest = document.partition(begin_of(deformer))
    return before + begin + table + END + rest.partition(END)[2]
