"""Ranges of sums of products: they contain every value, rounded in float32, and are tighter than intervals."""

from __future__ import annotations

import random
import re

import numpy as np
import pytest

from sssgen.ir.formats import FLOAT32
from sssgen.ir.intervals import Range
from sssgen.lang.plain_glsl import load_glsl_text
from sssgen.passes.ranges.range_pass import RangeAnalysis


def range_of(expression: str, low: float, high: float, unguarded: bool = True) -> Range:
    """The range of an expression of a and b, which are between two numbers."""
    bounds = f"{low!r} <= a <= {high!r}, {low!r} <= b <= {high!r}"
    text = f"float f(float a, float b) // sssgen: assume {bounds}\n{{\n    return {expression};\n}}\n"
    module = load_glsl_text(text, "f.glsl", assumptions=True).module
    analysis = RangeAnalysis(module, FLOAT32, False, unguarded=unguarded)
    function = module.functions[0]
    result, _ = analysis.enter(function, [analysis.outside(param) for param in function.params])
    assert result is not None
    return result.parts[0]


@pytest.mark.parametrize(
    ("expression", "low", "high", "exact"),
    [
        ("a * (a * (a * (3.0 - a) - 3.0) + 1.0)", 0.0, 1.0, None),
        ("a * a * (3.0 - 2.0 * a)", 0.0, 1.0, (0.0, 1.0)),
        ("a + b - a * b", 0.0, 1.0, (0.0, 1.0)),
        ("a * (0.983729 * a + 0.432951) + 0.238081", -1e6, 1e6, (0.19, 9.8373e11)),
        ("(1.0 - a) * (1.0 - a) + 2.0 * a", -10.0, 10.0, (1.0, 101.0)),
        ("a * a * b - b", -2.0, 2.0, (-6.0, 6.0)),
    ],
)
def test_these_are_tight(expression: str, low: float, high: float, exact: tuple[float, float] | None) -> None:
    tight, wide = range_of(expression, low, high), range_of(expression, low, high, unguarded=False)
    assert tight.low >= wide.low and tight.high <= wide.high and tight != wide
    if exact is not None:
        slack = 1e-4 * max(1.0, abs(exact[1]))
        assert exact[0] - min(slack, 1e-3) <= tight.low <= exact[0] + slack
        assert exact[1] - slack <= tight.high <= exact[1] + 0.02 * slack + 1e-3 * abs(exact[1])


def expression(rng: random.Random, depth: int) -> str:
    if depth == 0 or rng.random() < 0.15:
        return rng.choice(["a", "a", "b", f"{rng.uniform(-3.0, 3.0):.3f}"])
    return f"({expression(rng, depth - 1)} {rng.choice('+-*')} {expression(rng, depth - 1)})"


def test_what_cancels_has_rounded() -> None:
    assert range_of("(a + 8388608.0) - 8388608.0", 0.0, 0.4).low <= 0.0
    assert range_of("(a + 8388608.0) - 8388608.0", 0.6, 0.7).high >= 1.0


@pytest.mark.parametrize("seed", range(60))
def test_every_value_is_in_its_range(seed: int) -> None:
    rng = random.Random(seed)
    text = expression(rng, 4)
    low, high = sorted(round(rng.choice([rng.uniform(-2.0, 2.0), rng.uniform(-1e4, 1e4)]), 3) for _ in range(2))
    found = range_of(text, low, high)
    points = np.random.default_rng(seed).uniform(low, high, (2, 4000)).astype(np.float32)
    points[:, :2] = np.float32(low), np.float32(high)
    points = np.clip(points, np.float32(low), np.float32(high))
    code = text.replace("a", "points[0]").replace("b", "points[1]")
    values = eval(re.sub(r"(?<![\w\[])(\d+\.\d+)", r"np.float32(\1)", code), {"np": np, "points": points})
    values = np.asarray(values, dtype=np.float64)
    if np.all(np.isfinite(values)):
        assert values.min() >= found.low and values.max() <= found.high, text
