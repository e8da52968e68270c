"""The levels of detail of a pick, as text."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from sssgen.lab.chart.case_errors import CaseErrors
    from sssgen.lab.chart.levels import Goal, Level

_TITLES = ("level", "distance", "ms", "error", "other lights", "bytes baked", "chain")


def level_table(levels: Sequence[Level], unseen: Sequence[CaseErrors | None]) -> list[str]:
    """A line for each level, below a line of titles; `unseen` are the errors under lights that were not used."""
    rows = [_TITLES]
    for number, (level, lights) in enumerate(zip(levels, unseen, strict=True)):
        others = f"{lights.median:.3g} ({lights.worst:.3g})" if lights is not None else "another bake"
        error = f"{level.error:.3g} ({level.low:.3g} to {level.high:.3g})" + ("" if level.within else " *")
        baked = f"{level.point.get('bytes', 0):,}".replace(",", " ")
        rows.append((str(number), level.range_text, f"{level.ms:.3g}", error, others, baked, level.point["label"]))
    widths = [max(len(row[column]) for row in rows) for column in range(len(_TITLES))]
    lines = ["  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip() for row in rows]
    return [f"  {line}" for line in lines]


def notes(levels: Sequence[Level], goals: Sequence[Goal], max_error: float, budget_ms: float) -> list[str]:
    """What the figures of the table are."""
    first = goals[0]
    lines = [
        f"distance 1 is that of the scene's camera; at {first.distance:g} the body covers {first.pixels:.0f} pixels of "
        "1920 × 1080",
        "error: at the size at which the body is seen there, of the worse view; ms: without what the body reflects",
        "other lights: the error under lights that were not used, at the size of the measurement, median (worst)",
    ]
    if not all(level.within for level in levels):
        lines.append(f"* above {max_error:g}: the least error within {budget_ms:g} ms")
    return [f"  {line}" for line in lines]
