"""A sample of each outside suite beside the project, or in the folder that SSSGEN_SUITES names (docs/suites.md)."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from folders import ROOT
from qualification.suites.__main__ import missing, results_of
from qualification.suites.outcomes import CRASH, WRONG
from qualification.suites.sources import SUITES

FOLDER = Path(os.environ.get("SSSGEN_SUITES") or ROOT.parent / "suites")
CASES = 60
"""About how many cases of each suite run: all suites together take less than ten minutes on two cores."""
DRIVER = "driver"


@pytest.mark.slow
@pytest.mark.parametrize("name", SUITES)
def test_a_sample_has_no_wrong_result(name: str) -> None:
    if reason := missing(SUITES[name], FOLDER):
        pytest.skip(reason)
    root = FOLDER / SUITES[name].repository.rpartition("/")[2]
    count = sum(1 for _ in SUITES[name].cases(root))
    results = results_of(name, FOLDER, max(1, count // CASES), 2)
    assert results
    assert [
        (result.case, backend, outcome)
        for result in results
        for backend, outcome in result.outcomes.items()
        if outcome.outcome in (WRONG, CRASH) and backend != DRIVER
    ] == []
