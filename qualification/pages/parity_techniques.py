"""Measures the parity of the techniques and writes docs/parity_techniques.md.

python -m qualification.pages.parity_techniques
"""

from __future__ import annotations

from pathlib import Path
from textwrap import wrap
from typing import NamedTuple

from qualification.parity_techniques import BACKENDS, BOUND_LANES, LANES, SEED, cases, excess, measure
from sssgen.material import library
from sssgen.run import backends
from sssgen.run.backends import Backend
from sssgen.run.evaluate.deviation import DRAWS, GOAL, MARGIN, Deviation

PAGE = Path(__file__).parents[2] / "docs" / "parity_techniques.md"


class Row(NamedTuple):
    """A technique on the back ends, over all functions bound to its slots."""

    largest: dict[str, float]
    share: float
    furthest: float


def rows(present: list[Backend]) -> dict[str, Row]:
    """The measured deviations by technique."""
    rows_by_name: dict[str, Row] = {}
    for case in cases():
        lanes = BOUND_LANES if case.bind else LANES
        row = rows_by_name.setdefault(case.technique, Row(dict.fromkeys(BACKENDS, -1.0), 0.0, 0.0))
        for backend in present:
            measured: Deviation = measure(case, backend, lanes)
            if wrong := excess(case, backend.name, measured, lanes):
                print(wrong)
            row.largest[backend.name] = max(row.largest[backend.name], measured.largest)
            row = row._replace(
                share=max(row.share, measured.excluded / lanes), furthest=max(row.furthest, measured.furthest)
            )
        rows_by_name[case.technique] = row
    return rows_by_name


def page(present: list[Backend], rows_by_name: dict[str, Row]) -> str:
    """The page's text."""
    texts = [
        "Measured by `python -m qualification.pages.parity_techniques`; "
        "`tests/qualification/test_parity_techniques.py` checks it. "
        f"Each technique gets {LANES:,} random inputs (random seed {SEED}) in the declared range of each parameter "
        f"(`src/sssgen/run/evaluate/random_inputs.py`), and {BOUND_LANES:,} more for each other function of "
        "the library that fits one of its slots. The oracle is the output of the `numpy` target, in float64.",
        "A deviation is |result − oracle| divided by the larger of |oracle| and 1; for a vector, each of the two "
        f"sizes is the largest over its components. The goal is {_number(GOAL)}; larger deviations are in bold.",
        "*Excluded* lanes are beyond the goal because the formula is ill-conditioned there in float32: it makes a "
        "decision, or subtracts nearly equal numbers. The table has the largest share of such lanes and their largest "
        f"deviation. A lane is excluded while its deviation is at most {MARGIN:g} times what rounding causes without "
        "any back end: the larger of how far the oracle's result moves when each input moves by one unit in the last "
        f"place, and how far the same formulas in NumPy's float32 deviate there ({DRAWS} draws of the moves).",
    ]
    lines = [
        "# The techniques on every back end",
        "",
        *(line for text in texts for line in [*wrap(text, 120, break_on_hyphens=False), ""]),
        *(f"- {backend.name}: {backend.device()}" for backend in present),
        "",
        f"| Technique | {' | '.join(BACKENDS)} | Excluded | Up to | Why beyond the goal |",
        f"|---|{'---|' * len(BACKENDS)}---|---|---|",
    ]
    for name, row in sorted(rows_by_name.items()):
        cells = [_number(row.largest[backend]) for backend in BACKENDS]
        excluded = [f"{100.0 * row.share:.2g} %" if row.share else "", _plain(row.furthest) if row.share else ""]
        lines.append(f"| {' | '.join([name, *cells, *excluded, _reasons(name, row)])} |")
    return "\n".join(lines) + "\n"


def _number(value: float) -> str:
    return f"**{_plain(value)}**" if value > GOAL else _plain(value)


def _plain(value: float) -> str:
    if value < 0.0:
        return "–"
    return f"{value:.2g}" if value == 0.0 or value > 0.01 else f"{value:.1e}".replace("e-0", "e-")


def _reasons(name: str, row: Row) -> str:
    if not row.share and max(row.largest.values()) <= GOAL:
        return ""
    reason = library.load(name).attributes.deviation
    return reason or "Single lanes at the threshold of a decision, or where nearly equal numbers are subtracted."


if __name__ == "__main__":
    present = [backend for backend in backends.available() if backend.name in BACKENDS]
    PAGE.write_text(page(present, rows(present)), encoding="utf-8")
    print(f"wrote {PAGE.name}")
