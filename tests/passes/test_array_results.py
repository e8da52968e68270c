"""Functions that return arrays, with the expected numbers in every target; HLSL has out parameters in their place."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from results_of_glsl import check_results
from sssgen.lang.plain_glsl import load_glsl_text
from sssgen.pipeline.compiler import transpile
from sssgen.run.backends import Backend

CASES = {
    "all elements": (
        "float[3] g(float x) { return float[3](x, x * 2.0, 3.0); }"
        " float f(float x) { float a[3] = g(x); return a[0] + a[1] * 10.0 + a[2] * 100.0; }", 321.0,
    ),
    "several returns, and calls inside an expression": (
        "float[2] g(float x) { if (x > 0.5) return float[2](x, 2.0); float r[2]; r[0] = 5.0; r[1] = 6.0; return r; }"
        " float f(float x) { return g(x)[1] + g(-x)[0] * 10.0; }", 52.0,
    ),
    "members, arguments, choices, and a result that is not used": (
        "struct S { float a[2]; }; float[2] g(float x) { return float[2](x, 2.0); }"
        " float f(float x) { S q; q.a = g(x); float b[2]; b = g(q.a[1]); g(x); float c = x > 5.0 ? g(x)[0] : g(3.0)[0];"
        " return b[0] + q.a[0] * 10.0 + c * 100.0; }", 312.0,
    ),
    "a result as an argument, in a loop and in its condition": (
        "int[3] g(int n) { int r[3]; for (int i = 0; i < 3; i++) r[i] = i * n; return r; }"
        " int[3] h(int a[3]) { a[0] = 7; return a; }"
        " float f(float x) { float t = 0.0;"
        " for (int i = 0; i < g(2)[2]; i++) t += float(h(g(i))[0] + h(g(i))[1]); return t; }", 34.0,
    ),
    "an out parameter beside it": (
        "vec2[2] g(out float y, float x) { y = x + 1.0; return vec2[2](vec2(x), vec2(y)); }"
        " float f(float x) { float y; vec2 r[2] = g(y, x); return r[1].x + y * 10.0; }", 22.0,
    ),
    "conditions of loops, comparisons, and names that are taken": (
        "float[2] g(float result) { float values = 2.0; return float[2](result, values); }"
        " bool eq(float x) { return g(x) == g(1.0); }"
        " float f(float values) { int n = 0; while (g(float(n))[0] < 3.0) n++;"
        " do { n++; } while (g(float(n))[0] < 6.0); return float(n) + (eq(values) ? 10.0 : 0.0); }", 16.0,
    ),
    "a choice that is not taken": (
        "float[2] g(float x) { if (x > 3.0) for (int i = 0; i < 9; i++) x += 1.0; return float[2](x, 2.0); }"
        " float f(float x) { bool a = x > 3.0 && g(x)[0] > 2.0; return a ? g(x)[0] : g(x)[1]; }", 2.0,
    ),
}  # fmt: skip


@pytest.mark.parametrize("case", CASES)
def test_results(case: str, backend: Callable[[str], Backend]) -> None:
    text, expected = CASES[case]
    check_results(text, expected, backend, [1.0])


def test_hlsl_gets_an_out_parameter() -> None:
    text = "float[2] g(float x) { return float[2](x, 2.0); } void f(float x) { g(x); float a = g(x)[1]; }"
    files = transpile(load_glsl_text(text, "case.glsl").module, "hlsl", "case", keep=True).files
    shown = next(iter(files.values()))
    assert "void g(float x, out float result[2]) {" in shown
    assert shown.count("g(x, values") == 2 and "\n    values;" not in shown
