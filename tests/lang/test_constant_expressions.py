"""Constant expressions of GLSL, at file scope and in functions: their values in every target."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from results_of_glsl import check_results
from sssgen.lang.plain_glsl import load_glsl_text
from sssgen.run.backends import Backend
from sssgen.support.diagnostics import SssgenError

GLOBALS = """
struct S { float x; ivec2 v; int list[2]; };
const int K[3] = int[3](2, 3, 4);
const S s = S(2.5, ivec2(6, 7), int[2](8, 9));
const ivec3 V = ivec3(10, 11, 12);
const mat2 M = mat2(1.0, 2.0, 3.0, 4.0);
const float H = 3.5;
"""
VALUES = [
    ("K.length()", 3), ("K[0]", 2), ("K[1 + 1]", 4), ("K[K[0]]", 4), ("int(3.5)", 3), ("int(-0.5) + 1", 1),
    ("max(2, 3)", 3), ("min(uint(2), 3u)", 2), ("clamp(9, 1, 4)", 4), ("abs(-6)", 6), ("sign(-2) + 2", 1),
    ("int(floor(H))", 3), ("int(H * 2.0)", 7), ("int(sqrt(16.0))", 4), ("int(pow(2.0, 3.0) + 0.5)", 8),
    ("int(dot(vec2(1.0, 2.0), vec2(3.0, 4.0)))", 11), ("int(length(vec2(3.0, 4.0)) + 0.5)", 5),
    ("int(mod(7.0, 4.0))", 3), ("int(mix(2.0, 4.0, 0.5))", 3), ("int(lessThan(ivec2(1, 5), ivec2(3)).x)", 1),
    ("V.y", 11), ("V.zyx.x", 12), ("V[2]", 12), ("s.v.y", 7), ("s.list[1]", 9), ("s.list.length()", 2),
    ("int(s.x * 2.0)", 5), ("int(M[1].x)", 3), ("int(M[1][1])", 4), ("int((M * 2.0)[0].y)", 4),
    ("int(mat3(M)[2][2])", 1), ("int(mat2(5.0)[1][1])", 5), ("S(1.0, ivec2(2, 3), K2).list[1]", 6),
    ("V.x > 9 ? 5 : 6", 5), ("true ? 1 : 2", 1), ("int(V == ivec3(10, 11, 12))", 1), ("int(H > 3.0 && H < 4.0) + 1", 2),
    ("int(K == int[3](2, 3, 4)) + 1", 2), ("~(-5)", 4), ("7 % 4", 3), ("6 ^ 3", 5), ("1 << 3", 8), ("0x10 >> 2", 4),
    ("int(uvec2(3u, 4u).y)", 4), ("vec3(1.0, 2.0, 3.0).length()", 3), ("M.length()", 2), ("gl_MaxDrawBuffers", 8),
]  # fmt: skip


@pytest.mark.parametrize(("expression", "value"), VALUES)
def test_an_expression_has_a_value_wherever_one_must_be_constant(expression: str, value: int) -> None:
    """As an array's length, a case, and in a local constant."""
    text = f"""{GLOBALS}const int K2[2] = int[2](5, 6);
    const int N = int({expression});
    float f(float x) {{
        const int n = int({expression});
        float a[int({expression})], b[N], c[n];
        switch (int(x)) {{ case int({expression}): return float(a.length() + b.length() * 100 + c.length() * 10000); }}
        return -1.0;
    }}"""
    check_results(text, 10101 * value, lambda name: _numpy(), [value], backends=["numpy"])


def _numpy() -> Backend:
    from sssgen.run import backends

    return backends.get("numpy")


SNIPPETS = [
    ("struct S { float x; }; const S s = S(2.0); const float M = s.x; float f(float x) { return M + x; }", 1.0, 3.0),
    ("const float K[3] = float[3](1.0, 2.0, 3.0); float f(float x) { float a[K.length()]; a[2] = x;"
     " return a[2] + float(a.length()); }", 1.0, 4.0),
    ("const int K[2] = int[2](3, 4); float f(float x) { float a[K[0]]; a[2] = x; return a[2] + float(a.length()); }",
     1.0, 4.0),
    ("float f(float x) { float a[int(3.5)]; a[2] = x; return a[2] + float(a.length()); }", 1.0, 4.0),
    ("float f(float x) { float a[max(2, 3)]; a[2] = x; return a[2] + float(a.length()); }", 1.0, 4.0),
    ("float f(float x) { switch (int(x)) { case max(4, 5): return 10.0; case 1: return 20.0; } return 30.0; }",
     5.0, 10.0),
    ("const float A = 2.0; const vec2 B = vec2(A, 3.0); const mat2 C = mat2(B, B.yx); const float D = C[1].x + B.y;"
     " const float E[2] = float[2](D, C[0][0]); float f(float x) { return x + E[0] * 10.0 + E[1]; }", 1.0, 63.0),
    ("struct T { vec3 v; }; struct S { T t; int n[2]; }; const S s = S(T(vec3(1.0, 2.0, 3.0)), int[2](4, 5));"
     " const T t = s.t; const vec2 w = t.v.zy; const int n = s.n[1]; float f(float x) { return x + w.x * float(n); }",
     1.0, 16.0),
    ("const int K[2] = int[2](1, 3); const int N = K[1];"
     " float f(float x) { for (int i = 0; i < N; i++) { x += 1.0; } return x; }", 1.0, 4.0),
    ("float f(float x) { vec4 r = false ? vec4(1, ivec3(2)) : vec4(3); return r.y + x; }", 1.0, 4.0),
    ("float f(float x) { vec4 r = mix(vec4(1.0, vec3(2.0)), vec4(3.0), bvec4(true, false, true, false));"
     " return r.x * 10.0 + r.y + x; }", 1.0, 33.0),
    ("float f(float x) { bvec3 r = true ? bvec3(true) : bvec3(true, bvec2(false)); return float(r.z) + x; }", 1.0, 2.0),
]  # fmt: skip


@pytest.mark.parametrize(("text", "x", "expected"), SNIPPETS)
def test_constants_of_constants(text: str, x: float, expected: float, backend: Callable[[str], Backend]) -> None:
    check_results(text, expected, backend, [x])


AT_FILE_SCOPE = [
    ("mat2 g = mat2(vec4(1.0, 2.0, 3.0, 4.0));", "g[1].x + g[0].y", 5.0),
    ("vec4 g = vec4(mat2(1.0, 2.0, 3.0, 4.0));", "g.z + g.y", 5.0),
    ("vec3 g = vec3(1.0, mat2(2.0, 3.0, 4.0, 5.0));", "g.z + g.x", 4.0),
    ("S g = 1 > 0 ? S(2.0, mat2(3.0)) : S(4.0, mat2(5.0));", "g.a + g.m[1].y", 5.0),
    ("mat2 g = true ? mat2(2.0) : mat2(3.0);", "g[1].y", 2.0),
    ("mat2 g = bool(2.0) ? mat2(vec4(2.0)) : mat2(3.0);", "g[1].y", 2.0),
]


@pytest.mark.parametrize("qualifier", ["", "const "])
@pytest.mark.parametrize(("declared", "value", "expected"), AT_FILE_SCOPE)
def test_values_at_file_scope_need_no_statements(
    qualifier: str, declared: str, value: str, expected: float, backend: Callable[[str], Backend]
) -> None:
    text = f"struct S {{ float a; mat2 m; }}; {qualifier}{declared} float f(float x) {{ return x + {value}; }}"
    check_results(text, 1.0 + expected, backend, [1.0])


COMPUTED = [
    ("uniform float u; float g = u * 2.0; float f(float x) { return g + x; }", 7.0),
    ("uniform float u; float g = u * 2.0; float h = g + 1.0; float e(float x) { return h * x; }"
     " float f(float x) { return e(x) + g; }", 13.0),
    ("uniform float u; vec2 g[2] = vec2[2](vec2(u), vec2(u, 1.0));"
     " float f(float x) { return g[1].y + g[0].x + x; }", 5.0),
    ("uniform float u; const float k = 2.0; float a = k; float b = a + u;"
     " float f(float x) { float a = x; return b + a; }", 6.0),
    ("uniform float u; float g = u;"
     " float f(float g2) { float h = 1.0; { float g = 5.0; h += g; } return g * 10.0 + h; }", 36.0),
]  # fmt: skip


@pytest.mark.parametrize(("text", "expected"), COMPUTED)
def test_variables_computed_from_uniforms(text: str, expected: float, backend: Callable[[str], Backend]) -> None:
    check_results(text, expected, backend, [1.0, 3.0])


def test_a_written_variable_needs_a_main() -> None:
    from sssgen.pipeline.compiler import transpile

    text = "uniform float u; float g = u; float f(float x) { g += x; return g; }"
    for target in ("glsl-330", "glsl-es-300", "hlsl", "wgsl"):
        with pytest.raises(SssgenError, match="there is no main"):
            transpile(load_glsl_text(text, "case.glsl").module, target, "case", keep=True)


REFUSED = ["x", "int(x)", "n", "K[n]", "2.5", "1 / 0", "int(1e20)", "g(1)", "m++", "0", "K[5]", "unknown"]


@pytest.mark.parametrize("length", REFUSED)
def test_what_is_not_constant_is_no_length(length: str) -> None:
    declared = "int g(int i) { return i; } const int K[2] = int[2](1, 2); int m; uniform int n;"
    text = f"{declared} void f(float x) {{ int a[{length}]; }}"
    with pytest.raises(SssgenError):
        load_glsl_text(text, "case.glsl")
