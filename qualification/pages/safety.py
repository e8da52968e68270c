"""Writes docs/safety.md: python -m qualification.pages.safety

For each technique: the operations proven safe, the guarded ones with reason and cost, and the results of the table of
dangerous inputs on every back end.
"""

from __future__ import annotations

from collections import Counter
from pathlib import Path
from textwrap import wrap

from qualification.mutants import Mutant, mutants
from qualification.safety import Safety, safety
from sssgen.analyse.stress import dangerous_inputs as dangerous
from sssgen.analyse.stress.stress_run import Machines, Settings, stress
from sssgen.analyse.stress.subject import Specimen, specimens
from sssgen.material.material_loading import examples, load_material
from sssgen.pipeline.compiler import guarded_sites

PAGE = Path(__file__).parents[2] / "docs" / "safety.md"
BACKENDS = ("numpy-f32", "gl", "webgpu", "hlsl", "browser")


def introduction() -> list[str]:
    """The head of the page."""
    return [
        "# Proven and guarded operations",
        "",
        *_paragraph(
            "`sssgen` computes the range of every value in a program, and decides for each operation with a domain (a "
            "division, a root, `pow`, `normalize`…) whether it can fail. An operation that is proven safe has no "
            "guard; every other one gets the cheapest guard that its range requires ([guards.md](guards.md)). `sssgen "
            "lint` shows both, for your own files too."
        ),
        *_paragraph(
            "`make stability` writes this page (`qualification/pages/safety.py`); `tests/qualification/test_safety.py` "
            "checks it."
        ),
    ]


def counts(rows: list[Safety]) -> list[str]:
    """The numbers of proven and of guarded operations, and the cost of the guards."""
    lines = [
        "## The library",
        "",
        *_paragraph(
            "The table analyses each technique as a function that other code calls, for all inputs that its contract "
            "allows. Operations are those of the static cost; `auto` and `all` add operations in these modes of "
            "`--guards`."
        ),
        "| Technique | Proven | Guarded | Operations | `auto` adds | `all` adds |",
        "|---|---|---|---|---|---|",
    ]
    for row in rows:
        cost = row.costs["none"].operations
        lines.append(
            f"| {row.name} | {row.proven} | {row.guarded} | {cost} | {row.added('auto')} | {row.added('all')} |"
        )
    auto, everywhere = (sum(row.added(mode) for row in rows) for mode in ("auto", "all"))
    proven, guarded = sum(row.proven for row in rows), sum(row.guarded for row in rows)
    cost = sum(row.costs["none"].operations for row in rows)
    lines += [
        f"| **total** | **{proven}** | **{guarded}** | **{cost}** | **{auto}** | **{everywhere}** |",
        "",
        *_paragraph(f"`auto` adds {auto / everywhere:.0%} of the operations that `all` adds."),
        "| Example, as a shader | Proven | Guarded |",
        "|---|---|---|",
    ]
    for name in sorted(examples()):
        sites = guarded_sites(load_material(name))
        safe = sum(site.proven for site in sites)
        lines.append(f"| {name} | {safe} | {len(sites) - safe} |")
    return [*lines, ""]


def guards(removed: list[Mutant]) -> list[str]:
    """The table of guards: the input that needs each, and the failure without it."""
    failing = sum(any(mutant.faults.values()) for mutant in removed)
    needed = sum(mutant.witness is not None for mutant in removed)
    by_specification = [mutant for mutant in removed if mutant.witness and not any(mutant.faults.values())]
    lines = [
        "## Each guard removed",
        "",
        *_paragraph(
            f"Of {len(removed)} guards {needed} have an input that needs them: if an undefined result counts as "
            f"NaN, the technique returns NaN. On the devices below, {failing} fail without the guard"
            + (
                f"; {len(by_specification)} are undefined only by the language's specification."
                if by_specification
                else "."
            )
        ),
        f"| Operation | Technique | Problem | Input | {' | '.join(BACKENDS)} |",
        "|---" * (4 + len(BACKENDS)) + "|",
    ]
    for mutant in removed:
        cells = [mutant.faults.get(name, "").replace("another value", "other") or "–" for name in BACKENDS]
        trial = mutant.witness.trial if mutant.witness else "none found"
        place = f"{mutant.specimen.title} ({mutant.site.place.rsplit(':', 1)[0]})"
        problem = mutant.site.guard.problem
        lines.append(f"| {mutant.site.operation} | {place} | {problem} | {trial} | {' | '.join(cells)} |")
    return [*lines, ""]


def dangers(chosen: list[Specimen], machines: Machines) -> list[str]:
    """The table of dangerous inputs, row by row."""
    tried: Counter[str] = Counter()
    lanes: Counter[str] = Counter()
    failed: Counter[tuple[str, str]] = Counter()
    names = tuple(row.name for row in dangerous.ROWS if row.trials is not None)
    for specimen in chosen:
        trials = list(dangerous.trials(specimen))
        lanes.update({name: sum(trial.inputs.lanes for trial in trials if trial.name == name) for name in names})
        tried.update({trial.name for trial in trials})
        for column in stress(specimen, machines, Settings(1, rows=names)).columns:
            failed.update((fault.trial, column.backend) for fault in column.faults if fault.counts)
    lines = [
        "## Dangerous inputs",
        "",
        *_paragraph(
            "The table shows the number of failures over the techniques that each row applies to. `sssgen stress --row "
            "NAME` runs a single row."
        ),
        f"| Row | Input | Required | Techniques | Inputs | {' | '.join(BACKENDS)} |",
        "|---" * (5 + len(BACKENDS)) + "|",
    ]
    for row in dangerous.ROWS:
        start = f"| {row.name} | {row.inputs} | {row.requires} |".replace("|L|", "length of L")
        if row.trials is None:
            lines.append(f"{start} {row.elsewhere} |{' |' * (1 + len(BACKENDS))}")
            continue
        cells = " | ".join(str(failed[row.name, name]) for name in BACKENDS)
        lines.append(f"{start} {tried[row.name]} | {lanes[row.name]:,} | {cells} |")
    return [*lines, ""]


def _paragraph(text: str) -> list[str]:
    return [*wrap(text, 120, break_on_hyphens=False, break_long_words=False), ""]


def main() -> None:
    """Measures, and writes the page."""
    chosen = specimens(())
    with Machines(BACKENDS) as machines:
        removed = [mutant for specimen in chosen for mutant in mutants(specimen, machines)]
        rows = [safety(specimen.subject) for specimen in chosen]
        lines = [*introduction(), *counts(rows), *guards(removed), *dangers(chosen, machines)]
        lines += [
            "## Measured on",
            "",
            *(f"- `{name}`: {backend.device()}" for name, backend in machines.backends.items()),
        ]
    PAGE.write_text("\n".join(lines).rstrip("\n") + "\n", encoding="utf-8")
    print(f"wrote {PAGE.name}: {len(removed)} guards, {len(dangerous.ROWS)} rows")


if __name__ == "__main__":
    main()
