"""Random programs full of operations with domains give finite numbers with guards, on numbers at the ends of ranges."""

from __future__ import annotations

from collections.abc import Callable
from random import Random

import numpy as np
import pytest

from amounts import COUNTED
from hazard_programs import HELPERS, PARAMETERS, source
from hazards import batch, run
from sssgen.run.backends import Backend
from watchdog import bounded

SECONDS = 600


@pytest.mark.parametrize(
    ("name", "seeds", "programs"), [("numpy-f32", 3, 25), ("gl", 1, 4), ("webgpu", 1, 2), ("hlsl", 1, 2)]
)
def test_hazard_programs_are_finite(backend: Callable[[str], Backend], name: str, seeds: int, programs: int) -> None:
    backend(name)
    for seed in range(seeds):
        with bounded(SECONDS, f"running hazard programs of the seed {seed}"):
            count = batch(name, 3, programs, seed)
        assert not count.faults, "\n".join(count.faults)
        assert count.proven and count.guarded
        COUNTED["hazard programs run"] += programs


@pytest.mark.slow
@pytest.mark.parametrize(("name", "seeds", "programs"), [("numpy-f32", 100, 25), ("gl", 15, 4)])
def test_many_hazard_programs_are_finite(
    backend: Callable[[str], Backend], name: str, seeds: int, programs: int
) -> None:
    backend(name)
    for seed in range(1000, 1000 + seeds):
        count = batch(name, 4, programs, seed)
        assert not count.faults, "\n".join(count.faults)
        COUNTED["hazard programs run"] += programs


def test_a_fault_is_seen(backend: Callable[[str], Backend]) -> None:
    """A value of which the range pass knows nothing wrong, but that is infinite, is a fault with its inputs."""
    text = f"{HELPERS}mat4 program_0({PARAMETERS}) {{ return mat4(a / b); }}\n"
    count, (values,) = run(text, 1, backend("numpy-f32"), guards="none")
    assert not np.isfinite(values).all()
    (fault,) = count.faults
    assert "program_0 at {'float a':" in fault and "numpy-f32" in fault


def test_programs_are_reproduced_from_their_seed() -> None:
    assert source(Random(5), 3) == source(Random(5), 3) != source(Random(6), 3)
