"""Loops, switches and jumps in each other: on every back end the result that GLSL's rules give."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from random import Random

import numpy as np
import pytest

from control_flow import Body, glsl, pairs, random_body, result
from plain_calls import BACKENDS, called, called_all, module_of
from sssgen.ir.verify import verify
from sssgen.run.backends import Backend

A = np.repeat(np.arange(6, dtype=np.int32), 6)
B = np.tile(np.arange(6, dtype=np.int32), 6)
PAIRS = dict(pairs())
RANDOM = 60
DRIVERS = BACKENDS[1:]


@cache
def programs() -> dict[str, Body]:
    """The functions by name."""
    random = {f"random_{seed}": random_body(Random(seed), 4) for seed in range(RANDOM)}
    return PAIRS | random


@cache
def text() -> str:
    return "".join([glsl(name, body) for name, body in programs().items()])


def test_the_pairs_are_all_there() -> None:
    assert len(PAIRS) == (4 * 4 * 3 - 1) * 4


def test_the_checked_module_is_valid() -> None:
    assert verify(module_of(text())) == []


def differences(backend: Backend, names: tuple[str, ...]) -> list[str]:
    """The functions whose results differ from GLSL's."""
    results = called_all(text(), backend, names, A, B)
    wrong = []
    for title, got in results.items():
        expected = [result(programs()[title], int(a), int(b)) for a, b in zip(A, B, strict=True)]
        if not np.array_equal(np.broadcast_to(got, A.shape), expected):
            wrong.append(glsl(title, programs()[title]))
    return wrong


def test_results_in_numpy(backend: Callable[[str], Backend]) -> None:
    wrong = differences(backend("numpy"), tuple(programs()))
    assert not wrong, "\n".join([f"{len(wrong)} functions, among them", *wrong[:3]])


@pytest.mark.parametrize("name", DRIVERS)
def test_some_results_in_a_driver(name: str, backend: Callable[[str], Backend]) -> None:
    assert differences(backend(name), tuple(programs())[::17]) == []


@pytest.mark.slow
@pytest.mark.parametrize("name", DRIVERS)
def test_results_in_a_driver(name: str, backend: Callable[[str], Backend]) -> None:
    assert differences(backend(name), tuple(programs())) == []


EMPTY_LAST = """
#version 300 es
precision highp float;
int f(int a, int b) {
    int r = a;
    switch (b & 3) {
        case 0: r += 1; break;
        case 1: r += 2;
        case 2: ;
    }
    return r;
}
""".lstrip()
"""An empty statement is a statement, also behind the last label (GLSL ES 3.00, section 6.2)."""


@pytest.mark.parametrize("name", BACKENDS)
def test_a_switch_may_end_with_an_empty_statement(name: str, backend: Callable[[str], Backend]) -> None:
    expected = A + np.where(B & 3 == 0, 1, np.where(B & 3 == 1, 2, 0))
    np.testing.assert_array_equal(called(EMPTY_LAST, backend(name), A, B), expected)


NESTED = """
int f(int a, int b) {
    int r = 0;
    switch (a & 3) {
        default: break;
        case 1: switch (b & 3) { case 2: break; default: r = 7; }
    }
    return r;
}
"""


@pytest.mark.parametrize("name", BACKENDS)
def test_nested_switches_have_variables_of_their_own(name: str, backend: Callable[[str], Backend]) -> None:
    expected = np.where((A & 3 == 1) & (B & 3 != 2), 7, 0)
    np.testing.assert_array_equal(called(NESTED, backend(name), A, B), expected)
