"""What a calibrated face must fulfil, and the table that shows it."""

from __future__ import annotations

from agentface.errors import OutputError
from agentface.studies.calibration.agreement import Agreement
from agentface.studies.calibration.calibrate import mean_cosine

LOWEST_MEAN_COSINE = 0.85
LOWEST_COSINE = 0.7
LOWEST_OTHER_COSINE = 0.6
"""Of the action units that lids, lips and jaw make: these are not fitted."""
PEAK_RATIOS = (0.7, 1.4)

BEGIN = "<!-- begin: written by `agentface calibrate --table -o docs/calibration.md` -->\n"
END = "<!-- end -->\n"


def missed(rows: dict[int, Agreement]) -> list[str]:
    """What of the limits a face misses, a sentence each; empty for a good one."""
    result = []
    mean = mean_cosine(rows)
    if mean < LOWEST_MEAN_COSINE:
        result.append(f"mean cosine: expected at least {LOWEST_MEAN_COSINE}, got {mean:.3f}")
    low, high = PEAK_RATIOS
    for number, row in rows.items():
        lowest = LOWEST_COSINE if row.fitted else LOWEST_OTHER_COSINE
        if row.cosine < lowest:
            result.append(f"AU {number}: expected a cosine of at least {lowest}, got {row.cosine:.3f}")
        if not row.fitted:
            continue
        if not low <= row.peak_ratio <= high:
            result.append(f"AU {number}: expected a peak ratio in {low}..{high}, got {row.peak_ratio:.3f}")
        if row.region != row.artists_region:
            result.append(f"AU {number}: expected the largest displacement in {row.artists_region}, got {row.region}")
    return result


def between_marks(document: str) -> str:
    """The table that a document holds; raises OutputError when it has no place for one."""
    _, begin, rest = document.partition(BEGIN)
    table, end, _ = rest.partition(END)
    if not (begin and end):
        raise OutputError(f"expected a document with the lines {BEGIN.strip()} and {END.strip()}, got none of these")
    return table


def with_table(document: str, table: str) -> str:
    """The document with ``table`` in place of the one it holds; raises OutputError when it has no place for one."""
    between_marks(document)
    before, _, rest = document.partition(BEGIN)
    return before + BEGIN + table + END + rest.partition(END)[2]
