"""Writes docs/safety.md: python -m qualification.pages.safety

What the range pass proves of the library, what is guarded and why, what that costs, and the table of dangerous inputs
on every back end.
"""

from __future__ import annotations

from collections import Counter
from pathlib import Path
from textwrap import wrap

from qualification.mutants import Mutant, mutants
from qualification.safety import Safety, safety
from sssgen.harness.stress import dangerous_inputs as dangerous
from sssgen.harness.stress.stress_run import Machines, Settings, stress
from sssgen.harness.stress.subject import Specimen, specimens
from sssgen.material.material_loading import examples, load_material
from sssgen.pipeline.compiler import guarded_sites

PAGE = Path(__file__).parents[2] / "docs" / "safety.md"
BACKENDS = ("numpy-f32", "gl", "webgpu", "hlsl", "browser")


def introduction() -> list[str]:
    """The head of the page."""
    return [
        "# What is proven, and what is guarded",
        "",
        *_paragraph(
            "`sssgen` finds the range of every value in a program and says of each operation that may go wrong (a "
            "division, a root, `pow`, `normalize`…) whether it can. What is proven carries no guard; the rest gets the "
            "cheapest one that its range asks for. `sssgen lint` shows both, for your files too."
        ),
        *_paragraph(
            "Made by `make stability` (`qualification/pages/safety.py`); "
            "the tests are `tests/qualification/test_safety.py`."
        ),
    ]


def counts(rows: list[Safety]) -> list[str]:
    """How many operations are proven, how many guarded, and what that costs."""
    lines = [
        "## The library",
        "",
        *_paragraph(
            "Each technique for all its inputs, as a function that is called from outside; operations by the static "
            "cost. `auto` guards what is not proven, `all` everything."
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
        f"| **together** | **{proven}** | **{guarded}** | **{cost}** | **{auto}** | **{everywhere}** |",
        "",
        *_paragraph(f"Guards add {auto / everywhere:.0%} of what guards everywhere would add."),
        "| Example, as a shader | Proven | Guarded |",
        "|---|---|---|",
    ]
    for name in sorted(examples()):
        sites = guarded_sites(load_material(name))
        safe = sum(site.proven for site in sites)
        lines.append(f"| {name} | {safe} | {len(sites) - safe} |")
    return [*lines, ""]


def guards(removed: list[Mutant]) -> list[str]:
    """Each guard, the input that needs it, and the fault when it is removed."""
    seen = sum(any(mutant.seen.values()) for mutant in removed)
    needed = sum(mutant.witness is not None for mutant in removed)
    letter = [mutant for mutant in removed if mutant.witness and not any(mutant.seen.values())]
    lines = [
        "## Every guard, removed",
        "",
        *_paragraph(
            f"Of {len(removed)} guards {needed} have an input that needs them: "
            "with NaN for what the language leaves undefined there, the result is NaN. Without the guard the drivers "
            f"here show it for {seen}" + (f"; for {len(letter)} it is the language's letter alone." if letter else ".")
        ),
        f"| Operation | In | Because | Input | {' | '.join(BACKENDS)} |",
        "|---" * (4 + len(BACKENDS)) + "|",
    ]
    for mutant in removed:
        cells = [mutant.seen.get(name, "").replace("another value", "other") or "–" for name in BACKENDS]
        trial = mutant.witness.trial if mutant.witness else "none found"
        place = f"{mutant.site.place.rsplit(':', 1)[0]}"
        says = mutant.site.guard.problem
        lines.append(
            f"| {mutant.site.what} | {mutant.specimen.title} ({place}) | {says} | {trial} | {' | '.join(cells)} |"
        )
    return [*lines, ""]


def dangers(chosen: list[Specimen], machines: Machines) -> list[str]:
    """The table of dangerous inputs, row by row."""
    tried: Counter[str] = Counter()
    lanes: Counter[str] = Counter()
    failed: Counter[tuple[str, str]] = Counter()
    names = tuple(row.name for row in dangerous.ROWS if row.trials is not None)
    for specimen in chosen:
        trials = list(dangerous.trials(specimen))
        lanes.update({name: sum(one.inputs.lanes for one in trials if one.name == name) for name in names})
        tried.update({one.name for one in trials})
        for column in stress(specimen, machines, Settings(1, rows=names)).columns:
            failed.update((fault.trial, column.backend) for fault in column.faults if fault.counts)
    lines = [
        "## Dangerous inputs",
        "",
        *_paragraph("Failures of the techniques that each row concerns (`sssgen stress --row NAME` runs one)."),
        f"| Row | Input | It must be | Techniques | Inputs | {' | '.join(BACKENDS)} |",
        "|---" * (5 + len(BACKENDS)) + "|",
    ]
    for row in dangerous.ROWS:
        told = f"| {row.name} | {row.inputs} | {row.requires} |".replace("|L|", "length of L")
        if row.trials is None:
            lines.append(f"{told} {row.elsewhere} |{' |' * (1 + len(BACKENDS))}")
            continue
        cells = " | ".join(str(failed[row.name, name]) for name in BACKENDS)
        lines.append(f"{told} {tried[row.name]} | {lanes[row.name]:,} | {cells} |")
    return [*lines, ""]


def _paragraph(text: str) -> list[str]:
    return [*wrap(text, 120, break_on_hyphens=False, break_long_words=False), ""]


def main() -> None:
    """Measures and writes."""
    chosen = specimens(())
    with Machines(BACKENDS) as machines:
        found = [one for specimen in chosen for one in mutants(specimen, machines)]
        rows = [safety(one.subject) for one in chosen]
        lines = [*introduction(), *counts(rows), *guards(found), *dangers(chosen, machines)]
        lines += ["## Measured on", "", *(f"- `{name}`: {one.device()}" for name, one in machines.here.items())]
    PAGE.write_text("\n".join(lines).rstrip("\n") + "\n", encoding="utf-8")
    print(f"wrote {PAGE.name}: {len(found)} guards, {len(dangerous.ROWS)} rows")


if __name__ == "__main__":
    main()
