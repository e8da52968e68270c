"""Calls of functions that return a parameter unchanged give way to the argument."""

from __future__ import annotations

import pytest

from pass_cases import assert_is, module_of
from sssgen.passes.conversions import drop_conversions

FUNCTIONS = """
    float same(float x) { return x; }
    float second(float x, float y) { return y; }
    float square(float x) { return x * x; }
    float put(float x, out float y) { y = x; return x; }
    float longer(float x) { float y = x; return y; }
    """


@pytest.mark.parametrize(
    ("before", "after"),
    [
        ("same(a)", "a"),
        ("same(same(a + 1.0))", "a + 1.0"),
        ("second(a, b * 2.0)", "b * 2.0"),
        ("second(a, put(b, b))", "put(b, b)"),
        ("second(put(b, b), a)", "second(put(b, b), a)"),
        ("square(same(a))", "square(a)"),
        ("longer(a)", "longer(a)"),
    ],
)
def test_conversions(before: str, after: str) -> None:
    head = "float f(float a, float b) { return "
    module = drop_conversions(module_of(f"{FUNCTIONS}{head}{before}; }}"))
    assert_is(module, f"{FUNCTIONS}{head}{after}; }}")


def test_a_module_without_conversions_is_unchanged() -> None:
    module = module_of("float square(float x) { return x * x; }")
    assert drop_conversions(module) is module
