"""Programs that random plain GLSL has found to be wrong, on every back end."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from results_of_glsl import check_results
from sssgen.run.backends import Backend

CASES = {
    "a bound that reads the counter": ("float f(float x) { for (int i = 0; i < 5 - i; i++) x += 1.0; return x; }", 4.0),
    "a bound that is the counter": ("float f(float x) { for (int h = 0; h < h; h++) x += 1.0; return x; }", 1.0),
    "a builtin after a return": ("float f(float x) { return x; x -= fma(x, 2.0, 1.0); }", 1.0),
    "an end that is never reached": (
        "float f(float x) { if (x > 0.5) { return x; } else { return 2.0; } if (x == 2.0) { } }", 1.0,
    ),
    "a builtin after a break": ("float f(float x) { while (true) { x++; break; x = fma(x, x, x); } return x; }", 2.0),
    "a builtin that is never reached": ("float f(float x) { if (true) return x; return fma(x, 2.0, 1.0); }", 1.0),
    "a list in order": ("float f(float x) { float a[2] = {x, x++}; return a[0] * 10.0 + x; }", 12.0),
    "a list of structs in order": (
        "struct S { int a, b; }; float f(float x) { int i = 3; S s = {i++, i * i}; return float(s.a * 100 + s.b); }",
        316.0,
    ),
    "a call between a read and an effect": (
        "float g(inout float y) { y += 5.0; return 1.0; }"
        "float f(float x) { float z = 1.0; vec3 v = vec3(x, g(x), z--); return v.x * 100.0 + v.y * 10.0 + v.z; }",
        111.0,
    ),
    "an index with an out argument": (
        "float f(float x) { uint i = 3u; int a[2] = int[2](5, 6); int w = a[usubBorrow(2u, i, i) & 1u]--;"
        "return float(1000u * i) + float(100 * w + 10 * a[0] + a[1]); }", 1655.0,
    ),
    "a place with an index that another argument writes": (
        "void g(out int n, out float y) { n = 1; y = 5.0; }"
        "float f(float x) { int i = 0; float a[2] = float[2](x, 2.0); g(i, a[i]); return 10.0 * a[0] + a[1]; }", 52.0,
    ),
    "a place with an index that an earlier argument's call changes": (
        "float g(inout int n) { n++; return 4.0; } void h(float x, inout int n, out float y) { n = 0; y = x; }"
        "float f(float x) { int i = 0; float a[2] = float[2](x, 2.0); h(g(i), i, a[i]); return 10.0 * a[0] + a[1]; }",
        14.0,
    ),
    "an out argument of one of two overloads": (
        "float g(mat4 a, out bool b, inout vec2 c) { return 0.0; }"
        "float g(out int before, out uint n, ivec2 old) { before = 1; return 1.0; }"
        "float f(float x) { ivec2 a = ivec2(7, 8); uint n; g(a.t, n, a++); return float(10 * a.x + a.y); }", 81.0,
    ),
    "members with the names of structs": (
        "struct A { float x; }; struct B { int A[3]; A b; };"
        "float f(float x) { B s = B(int[3](1, 2, 3), A(x)); return s.b.x + float(s.A[2]); }", 4.0,
    ),
    "a choice between numbers by a constant": (
        "const bvec3 c = bvec3(true); float f(float x) { float q = mix(mix(0.125, 0.0, c.t), 1.0, 0.5); return q; }",
        0.5,
    ),
    "a second gl": ("struct M { int a; }; float f(float gl) { { M gl = M(4), b = gl; return float(b.a); } }", 4.0),
    "a constant that another one needs": (
        "struct S { int x; }; const S w = S(4); const int A = w.x;"
        "float f(float x) { float w = x * 10.0; return step(w, 0.0) + w + float(A); }", 14.0,
    ),
    "variables of two switches, of which one is read later": (
        "float f(float x) { switch (int(x)) {"
        "case 1: switch (uint(abs(x * -4.0))) { case 7u: case 4u: return 15.0; case 0u: } break;"
        "case 3: switch (1) { default: x; case 0: } } return 1.0; }", 15.0,
    ),
    "a switch without cases": (
        "float g(out float y) { y = 5.0; return 1.0; }"
        "float f(float x) { switch (g(x) > 0.5 ? 1 : 1) { } switch (int(g(x))) { default: x *= 2.0; } return x; }",
        10.0,
    ),
    "a blend whose other argument has an effect": (
        "float g(inout float y) { y += 5.0; return 1.0; }"
        "float f(float x) { int k = mix(8 >> int(g(x)), 0, true); return x + float(k); }", 6.0,
    ),
    "bodies that run once": (
        "float f(float x) { if (x > 0.0) do { float y = x; x = y * 2.0; } while (false); float y = 3.0;"
        "do { x += y; if (x > 4.0) break; x = 9.0; } while (false);"
        "for (int i = 0; i < 3; i++) do do { x += 1.0; if (i == 1) continue; x += 10.0; } while (false);"
        "while (x++ > 100.0 && false); return x; }", 31.0,
    ),
    "a switch with two labels": (
        "int g(inout float y) { y += 5.0; return 2; }"
        "float f(float x) { switch (g(x)) { case 1: case 2: x *= 2.0; } return x; }", 12.0,
    ),
    "an array that is made of itself": (
        "int g(ivec3 c[2]) { c = ivec3[2](c[c[1].y & 1], ivec3(1)); return c[1].y; }"
        "float f(float x) { return x + float(g(ivec3[2](ivec3(-2, 3, 8), ivec3(15)))); }", 2.0,
    ),
    "a value from before a loop that writes what it was read from": (
        "float f(float x) { vec2 o = vec2(x, 8.0); float g = o[1];"
        "for (int i = 0; i != 3 && g > 3.0; i++) o.y *= 0.25; return o[int(x) & 1]; }", 0.125,
    ),
    "a loop inside of its own condition": (
        "float f(float x) { bool b = x > 0.0; if (b) for (int i = 0; i != 2 && b; i++) x *= 8.0; return x; }", 64.0,
    ),
    "a loop with a condition that is always true": (
        "float f(float x) { bool b = x > 0.0; for (int i = 0; b == b && i != 2; i++) x *= 8.0; if (b == b) x++;"
        "return x; }", 65.0,
    ),
    "a loop that never runs": (
        "float f(float x) { int c = 2; while (false) { x += 8.0; c--; if (!(c > int(x))) break; }"
        "for (; false;) { x += 16.0; if (x > 3.0) break; } return x; }", 1.0,
    ),
}  # fmt: skip


@pytest.mark.parametrize("title", CASES)
def test_found(backend: Callable[[str], Backend], title: str) -> None:
    text, expected = CASES[title]
    check_results(text, expected, backend, (1.0,))
