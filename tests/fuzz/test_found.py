"""The faults that random programs have found, each as the function that showed it; files are in hostile.py."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from agreement import Oracle, compiles
from sssgen.run.backends import Backend
from sssgen.run.compilers import Source

FAULTS = {
    "HLSL gave a literal the type of the count": "int least_whole(uint h) { return -8 >> h; }",
    "NumPy gave a literal the type of the count": "int some_whole(uint h) { return (7 >> h) - 20; }",
    "a literal that is a uint, shifted by an int": "uint large_whole(int n) { return 4294967295u >> n; }",
    "a count that is below 0": "uint round_whole(uint h) { for (int i = -2; i < 3; i++) { h ^= h >> i; } return h; }",
    "a vector shifted by counts of its own": "ivec2 pair_whole(ivec2 g, uint h) { return (g << g.yx) ^ (g >> h); }",
}


@pytest.mark.parametrize("title", FAULTS)
@pytest.mark.parametrize("name", ["gl", "webgpu", "hlsl"])
def test_shifts(backend: Callable[[str], Backend], name: str, title: str) -> None:
    assert Oracle(FAULTS[title]).differences(backend(name)) == []


@pytest.mark.parametrize("title", FAULTS)
def test_earlier_failures_compile(assert_compiles: Callable[[Source], None], title: str) -> None:
    compiles(Oracle(FAULTS[title]).subject.module, assert_compiles)


def test_a_sign_is_shifted_in() -> None:
    """By hand, as the oracle itself was wrong."""
    (shifted,) = Oracle(FAULTS["NumPy gave a literal the type of the count"]).right.values()
    assert set(shifted.tolist()) <= {(7 >> count) - 20 for count in range(32)}
    (shifted,) = Oracle(FAULTS["HLSL gave a literal the type of the count"]).right.values()
    assert set(shifted.tolist()) <= {-8 >> count for count in range(32)}
