"""Constructors of vectors whose last argument is a matrix with more components than needed."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from results_of_glsl import check_results
from sssgen.lang.plain_glsl import load_glsl_text
from sssgen.run.backends import Backend
from sssgen.support.diagnostics import SssgenError

M = "mat2 m = mat2(1.0, 2.0, 3.0, 4.0) * x;"
VALUES = [
    ("vec3(x, m)", [1.0, 1.0, 2.0]), ("vec3(m)", [1.0, 2.0, 3.0]), ("vec3(5.0, x, m)", [5.0, 1.0, 1.0]),
    ("vec3(ivec2(7, 8), m)", [7.0, 8.0, 1.0]), ("vec4(x, m * 2.0).yzw", [2.0, 4.0, 6.0]),
    ("vec3(float(m), float(int(m * 3.5)), bool(m) ? 4.0 : 5.0)", [1.0, 3.0, 4.0]),
    ("vec3(ivec3(9, m))", [9.0, 1.0, 2.0]), ("vec3(bvec3(false, m - 1.0))", [0.0, 0.0, 1.0]),
]  # fmt: skip


@pytest.mark.parametrize(("expression", "expected"), VALUES)
def test_the_last_argument_is_a_matrix(
    expression: str, expected: list[float], backend: Callable[[str], Backend]
) -> None:
    check_results(f"vec3 f(float x) {{ {M} return {expression}; }}", expected, backend, [1.0])


def test_arguments_before_a_matrix_are_evaluated_before_it(backend: Callable[[str], Backend]) -> None:
    text = """float a(inout float n) { n += 1.0; return n; }
    mat2 b(inout float n) { n *= 10.0; return mat2(n); }
    vec3 f(float x) { return vec3(a(x), b(x)); }"""
    check_results(text, [2.0, 20.0, 0.0], backend, [1.0])


@pytest.mark.parametrize("expression", ["vec3(m, x)", "vec3(x, m, m)", "mat2(x, m)", "vec3(1.0, 2.0, x, m)"])
def test_every_argument_is_used(expression: str) -> None:
    with pytest.raises(SssgenError, match=r"cannot be made from|components"):
        load_glsl_text(f"void f(float x) {{ {M} {expression}; }}", "case.glsl")
