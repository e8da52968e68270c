"""Operands, and the target of a compound assignment, are read before what follows changes them, on every back end."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from results_of_glsl import check_results
from sssgen.lang.plain_glsl import load_glsl_text
from sssgen.pipeline.compiler import transpile
from sssgen.run.backends import Backend

CASES = [
    ("float f(float x) { x += x++; return x; }", 3.0, 6.0),
    ("float f(float x) { x -= x = 1.0; return x; }", 3.0, 2.0),
    ("float f(float x) { int i = int(x); i *= (i = 5) + 1; return float(i); }", 3.0, 18.0),
    ("float f(float x) { vec2 v = vec2(x, 1.0); v.x += v.x++; v.yx *= vec2(v.x++, 2.0); return v.x * 10.0 + v.y; }",
      3.0, 126.0),
    ("float f(float x) { int a[3] = int[3](1, 2, 3), i = int(x); a[i] += a[i]++ + i--;"
     " return float(a[0] * 100 + a[1] * 10 + a[2]); }", 1.0, 153.0),
    ("float f(float x) { mat2 m = mat2(x); m[1] *= (m[1] = vec2(2.0)).y; return m[1].x * 10.0 + m[1].y; }", 3.0, 6.0),
    ("struct S { int a; }; float f(float x) { S s = S(int(x)); s.a <<= s.a-- & 1; return float(s.a); }", 3.0, 6.0),
    ("float g(inout float y) { y += 5.0; return y * 2.0; } float f(float x) { x -= g(x); return x; }", 3.0, -13.0),
    ("float g(inout float y) { y += 5.0; return y * 2.0; } float f(float x) { x *= 1.0 + g(x) + x; return x; }",
      3.0, 75.0),
    ("float f(float x) { ivec2 k = ivec2(x, 1); int y = ++k[k.x & 1]; return float(y * 10 + k.x); }", 1.0, 21.0),
    ("float f(float x) { int a[2] = int[2](1, 0); int y = a[a[0]] = 7; return float(y * 100 + a[0] * 10 + a[1]); }",
     0.0, 717.0),
    ("float f(float x) { int a[2] = int[2](0, 5); int y = a[a[0]] = 1; return float(y * 100 + a[0] * 10 + a[1]); }",
     0.0, 115.0),
    ("float f(float x) { ivec2 s = ivec2(9, 3); s[--s[1] & 1] /= int(x); return float(s.x * 10 + s.y); }", 3.0, 32.0),
    ("float f(float x) { int a[3] = int[3](1, 2, 3); a[a[0]++] = a[0] * int(x); return float(a[0] * 100 + a[1]); }",
     3.0, 206.0),
    ("void g(inout float y) { y = 7.0; } float f(float x) { vec2 v = vec2(x); g(v[int(v.x++)]); return v.x + v.y; }",
     1.0, 9.0),
    ("float f(float x) { ivec2 w = ivec2(x, 7); w.yx += w.xy++; return float(w.x * 100 + w.y); }", 3.0, 1010.0),
    ("float f(float x) { int q[3] = int[3](2, 1, int(x)); q[q[1]] = q[q[1]++] + 3;"
     " return float(q[0] * 100 + q[1] * 10 + q[2]); }", 5.0, 245.0),
    ("float f(float x) { int q[3] = int[3](2, 0, int(x)); q[q[1]] = q[1]++ * 7 + q[1];"
     " return float(q[0] * 100 + q[1] * 10 + q[2]); }", 5.0, 115.0),
    ("float f(float x) { bool b = x > 0.0; x += b && (x += 1.0) > 0.0 ? x : 0.0; return x; }", 3.0, 7.0),
]  # fmt: skip
READ = """
float t = 1.0;
float g() { t += 2.0; return t; }
float two(float a, float b) { return a * 10.0 + b; }
float f(float x) { t = x; float y = t + g(); y = y * 100.0 + two(t, g()); return y + (t > 0.0 && g() > t ? 0.0 : 0.5); }
"""
SHARED = """
float t = 1.0;
float g() { t += 2.0; return t; }
float f(float x) { t = x; t *= g(); t -= g() + t; return t; }
"""


@pytest.mark.parametrize(("text", "argument", "expected"), CASES)
def test_the_target_is_read_first(
    backend: Callable[[str], Backend], text: str, argument: float, expected: float
) -> None:
    check_results(text, expected, backend, (argument,))


def test_a_variable_at_file_scope_is_read_first(backend: Callable[[str], Backend]) -> None:
    backends = ("gl", "gl-es", "webgpu", "hlsl", "hlsl-glslang")
    check_results(SHARED, 15.0 - (17.0 + 17.0), backend, (3.0,), backends=backends)


def test_an_operand_is_read_before_a_call_to_its_right(backend: Callable[[str], Backend]) -> None:
    backends = ("gl", "gl-es", "webgpu", "hlsl", "hlsl-glslang")
    check_results(READ, (3.0 + 5.0) * 100.0 + 5.0 * 10.0 + 7.0 + 0.5, backend, (3.0,), backends=backends)


def test_a_target_that_does_not_change_is_assigned_to() -> None:
    text = "int f(int x, int i) { x += i++; x *= i; return x; }"
    files = transpile(load_glsl_text(text, "case.glsl").module, "wgsl", "case", keep=True).files
    emitted = next(content for name, content in files.items() if not name.endswith(".json"))
    assert "x += i_before;" in emitted
    assert "x *= i;" in emitted
