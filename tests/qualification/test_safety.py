"""The guards of the library: each is needed, their cost is small, and docs/safety.md is current."""

from __future__ import annotations

import re
from functools import cache

import pytest

from folders import DOCS
from qualification.safety import Safety, safety
from sssgen.analyse.stress.guard_witness import sites, witness
from sssgen.analyse.stress.subject import technique
from sssgen.material import library
from sssgen.run.evaluate.probes import subject

PAGE = DOCS / "safety.md"
NAMES = [name for name, path in library.index().items() if library.folder_of(path) != "baselines"]
QUICK = [
    "lobe_normalized", "standard", "capsule", "slab_from_thinness", "thickness_map", "march_light",
    "depth_map_thickness",
]  # fmt: skip


@cache
def library_counts() -> list[Safety]:
    return [safety(subject(name)) for name in NAMES]


def assert_guards_needed(name: str) -> None:
    """Asserts that each guard has an input that needs it: with NaN as its value, the result is NaN."""
    specimen = technique(name)
    for site in sites(specimen):
        if not site.proven:
            assert witness(specimen, site) is not None, (
                f"{name}: no input needs the guard of {site.operation} at {site.place}"
            )


@pytest.mark.parametrize("name", QUICK)
def test_every_guard_is_needed(name: str) -> None:
    assert_guards_needed(name)


@pytest.mark.slow
@pytest.mark.parametrize("name", [name for name in NAMES if name not in QUICK])
def test_every_guard_of_the_library_is_needed(name: str) -> None:
    assert_guards_needed(name)


def test_guards_cost_little() -> None:
    """The guards add at most a third of the operations that guards everywhere would add."""
    auto, everywhere = (sum(entry.added(mode) for entry in library_counts()) for mode in ("auto", "all"))
    assert 0 < auto <= everywhere / 3


def test_most_is_proven() -> None:
    """At least two thirds of the operations with a domain are proven safe."""
    proven, guarded = sum(entry.proven for entry in library_counts()), sum(entry.guarded for entry in library_counts())
    assert proven > 2 * guarded > 0


def test_the_page_has_the_current_counts() -> None:
    text = PAGE.read_text(encoding="utf-8")
    for entry in library_counts():
        row = [entry.proven, entry.guarded, entry.costs["none"].operations, entry.added("auto"), entry.added("all")]
        assert f"| {entry.name} | {' | '.join(map(str, row))} |" in text, "run python -m qualification.pages.safety"
    assert f"Of {sum(entry.guarded for entry in library_counts())} guards" in text


def test_the_page_has_no_failure_among_the_dangerous_inputs() -> None:
    text = PAGE.read_text(encoding="utf-8").split("## Dangerous inputs")[1]
    rows = [line.strip("| ").split(" | ") for line in text.splitlines() if re.match(r"\| [a-z-]+ \|", line)]
    assert len(rows) == 27
    assert all(set(row[5:]) == {"0"} for row in rows if len(row) == 10)
    assert sum(len(row) == 10 for row in rows) == 26
