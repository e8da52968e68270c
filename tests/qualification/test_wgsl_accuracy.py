"""Builtins on WGSL's back ends are as accurate as its specification promises."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from qualification.pages.parity import share_cell
from qualification.parity import cases, oracle
from qualification.wgsl_accuracy import LIMITS, WGSL_BACKENDS, share, shares
from slow_cases import back_end_cases
from sssgen.run.backends import Backend

LANES = 240


@pytest.mark.parametrize("name", back_end_cases([*WGSL_BACKENDS, "numpy-f32"], "numpy-f32"))
def test_the_promise_is_kept(name: str, backend: Callable[[str], Backend]) -> None:
    largest = shares(backend(name), cases(LANES))
    assert set(largest) == set(LIMITS)
    assert not {name: each for name, each in largest.items() if each > 1.0}


@pytest.mark.parametrize(("name", "error"), [("sin", 2.0**-10), ("exp", 1e-3), ("floor", 1.0), ("log", 1e-5)])
def test_a_larger_error_is_seen(name: str, error: float) -> None:
    (case,) = [case for case in cases(LANES) if case.title == f"{name}(float)"]
    right = oracle(case).astype(np.float32)
    assert share(case, right) < 0.51
    assert share(case, right + error * np.maximum(np.abs(right), 1.0).clip(max=1e30)) > 1.0


def test_the_cell_of_the_page() -> None:
    assert share_cell("exp", [{"exp": 0.25}, {"exp": 0.5}]) == "50%"
    assert share_cell("exp", [{"exp": 1.5}]) == "**150%**"
    assert share_cell("mod", [{}]) == "–"
