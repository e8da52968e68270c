"""The library's guards: each is needed, they cost little, and docs/safety.md is current."""

from __future__ import annotations

import re
from functools import cache

import pytest

from folders import DOCS
from qualification.safety import Safety, safety
from sssgen.harness.evaluate.probes import subject
from sssgen.harness.stress.guard_witness import sites, witness
from sssgen.harness.stress.subject import technique
from sssgen.material import library

PAGE = DOCS / "safety.md"
NAMES = [name for name, path in library.index().items() if library.folder_of(path) != "baselines"]
QUICK = [
    "lobe_normalized", "standard", "capsule", "slab_from_thinness", "thickness_map", "march_light",
    "depth_map_thickness",
]  # fmt: skip


@cache
def counted() -> list[Safety]:
    return [safety(subject(name)) for name in NAMES]


def needed(name: str) -> None:
    """Of each guard there is an input that needs it: NaN in its place reaches the result."""
    specimen = technique(name)
    for site in sites(specimen):
        if not site.proven:
            assert witness(specimen, site) is not None, (
                f"{name}: nothing needs the guard of {site.what} at {site.place}"
            )


@pytest.mark.parametrize("name", QUICK)
def test_every_guard_is_needed(name: str) -> None:
    needed(name)


@pytest.mark.slow
@pytest.mark.parametrize("name", [name for name in NAMES if name not in QUICK])
def test_every_guard_of_the_library_is_needed(name: str) -> None:
    needed(name)


def test_guards_cost_little() -> None:
    """At most a third of the cost of guards everywhere."""
    auto, everywhere = (sum(one.added(mode) for one in counted()) for mode in ("auto", "all"))
    assert 0 < auto <= everywhere / 3


def test_most_is_proven() -> None:
    """The guarded operations are the smaller part; none is missing."""
    proven, guarded = sum(one.proven for one in counted()), sum(one.guarded for one in counted())
    assert proven > 2 * guarded > 0


def test_the_page_has_the_current_counts() -> None:
    text = PAGE.read_text(encoding="utf-8")
    for one in counted():
        row = [one.proven, one.guarded, one.costs["none"].operations, one.added("auto"), one.added("all")]
        assert f"| {one.name} | {' | '.join(map(str, row))} |" in text, (
            "python -m qualification.pages.safety writes it anew"
        )
    assert f"Of {sum(one.guarded for one in counted())} guards" in text


def test_the_page_has_no_failure_among_the_dangerous_inputs() -> None:
    text = PAGE.read_text(encoding="utf-8").split("## Dangerous inputs")[1]
    rows = [line.strip("| ").split(" | ") for line in text.splitlines() if re.match(r"\| [a-z-]+ \|", line)]
    assert len(rows) == 26
    assert all(set(row[5:]) == {"0"} for row in rows if len(row) == 10)
    assert sum(len(row) == 10 for row in rows) == 25
