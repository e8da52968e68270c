"""Random programs of the whole language: every compiler accepts them, and every back end computes what NumPy does."""

from __future__ import annotations

from collections.abc import Callable
from random import Random

import pytest
from hypothesis import given
from hypothesis import strategies as st

from agreement import Oracle, compiles, subject_of
from amounts import COUNTED, examples
from shader_programs import source
from slow_cases import some_slow
from sssgen.run.backends import Backend
from sssgen.run.compilers import Source
from watchdog import bounded

BATCH = 4
"""Programs in one shader. Software drivers take minutes for shaders of some dozens."""
SEEDS = st.integers(0, 1 << 32)
SECONDS = 120


@examples(8, 0.1, shrink=False)  # a seed that is smaller makes no smaller program
@given(SEEDS)
def test_programs_compile(assert_compiles: Callable[[Source], None], seed: int) -> None:
    with bounded(SECONDS, f"compiling programs of the seed {seed}"):
        compiles(subject_of(source(Random(seed), BATCH)).module, assert_compiles)
    COUNTED["programs compiled"] += BATCH


@pytest.mark.parametrize("name", some_slow(["gl", "webgpu", "hlsl", "tsl"], "gl", "webgpu", "hlsl"))
@examples(6, 0.1, shrink=False)
@given(seed=SEEDS)
def test_programs_agree(backend: Callable[[str], Backend], name: str, seed: int) -> None:
    gpu = backend(name)
    text = source(Random(seed), BATCH)
    with bounded(SECONDS, f"running programs of the seed {seed}"):
        oracle = Oracle(text)
        failures = oracle.differences(gpu)
    assert not failures, "\n\n".join([f"seed {seed}", *failures, text])
    COUNTED["programs run"] += BATCH
    COUNTED["lanes excused, of a thousand"] += round(1000 * oracle.excused())


def test_a_wrong_program_is_seen(backend: Callable[[str], Backend]) -> None:
    """Another float, and another whole number, in what is computed are differences."""
    text = source(Random(1), BATCH)
    for old, new in (("o = vec2(0.0);", "o = vec2(0.01);"), ("made = pair;", "made = pair; made.count ^= 1;")):
        assert old in text
        oracle = Oracle(text)
        assert oracle.differences(backend("numpy-f32")) == []
        oracle.right = Oracle(text.replace(old, new)).right
        assert oracle.differences(backend("numpy-f32"))
