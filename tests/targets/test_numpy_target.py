"""The NumPy target: if-conversion and the printer, against numbers worked out by hand and against the interpreter."""

# ruff: noqa: E501 - one program a line

from __future__ import annotations

from random import Random
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from numpy_cases import assert_agrees, compiled, module_of, python_of, run
from random_programs import Programs
from sssgen.ir.types import Sampler
from sssgen.targets import numpy_runtime
from sssgen.targets.printers.numpy_printer import NumpyPrinter
from sssgen.targets.registry import load
from sssgen.targets.runtime.numpy_textures import Texture
from sssgen.targets.runtime.numpy_values import Record, precision, vec
from sssgen.targets.uniform_layout import place

X = np.array([-2.0, -0.5, 0.0, 0.5, 1.0, 3.0])


def text_of(source: str) -> str:
    """The printed functions, without the import."""
    return python_of(module_of(source)).split("\n\n", 1)[1].strip()


def check(source: str, expected: Any, *args: Any, **uniforms: Any) -> None:
    """Runs `f` and compares."""
    np.testing.assert_allclose(np.broadcast_to(run(source, *args, **uniforms), np.shape(expected)), expected)


# What is printed


TEXTS = {
    "straight-line code has no masks": (
        """
/// Softens an edge.
/// More of it.
float soften(float edge, float width) {
    float t = clamp(edge / width, 0.0, 1.0);
    t *= t;
    return t * (3.0 - 2.0 * t);
}
""",
        '''
def soften(edge, width):
    """Softens an edge."""
    t = clamp(edge / width, 0.0, 1.0)
    t = t * t
    return t * (3.0 - 2.0 * t)
''',
    ),
    "loops with constant bounds are plain": (
        """
const int COUNT = 8;
float f(float x) {
    float sum = 0.0;
    for (int i = 1; i <= 4; i++) {
        for (int j = i; j < COUNT; j += 2) {
            if (j == 3) continue;
            sum += x * float(i * j);
        }
        if (i == 3) break;
    }
    return sum;
}
""",
        """
COUNT = 8


def f(x):
    sum_ = 0.0
    for i in range(1, 5):
        for j in range(i, COUNT, 2):
            if j == 3:
                continue
            sum_ = sum_ + x * to_float(i * j)
        if i == 3:
            break
    return sum_
""",
    ),
    "a clamp is one select": (
        "float f(float x) { if (x < 0.0) { x = 0.0; } return x; }",
        "def f(x):\n    x = select(x < 0.0, 0.0, x)\n    return x",
    ),
    "two arms join": (
        "vec2 f(float x) { float a; float b; if (x < 0.0) { a = x; b = 1.0; } else { a = -x; b = 2.0; } return vec2(a, b); }",
        "def f(x):\n    mask = x < 0.0\n    a = select(mask, x, -x)\n    b = select(mask, 1.0, 2.0)\n    return vec(a, b)",
    ),
    "an early return is a select at the end": (
        "float f(float x) { if (x < 0.0) return 0.0; float y = sqrt(x); y += 1.0; return y; }",
        "def f(x):\n    y = sqrt(x)\n    y = y + 1.0\n    return select(x < 0.0, 0.0, y)",
    ),
    "a march runs while any lane does": (
        """
float march(float step_size, out bool found) {
    float t = 0.0;
    found = false;
    for (int i = 0; i < 64; i++) {
        if (t > 1.0) { found = true; break; }
        t += step_size;
    }
    return t;
}
""",
        """
def march(step_size):
    t = 0.0
    found = False
    running = True
    for i in range(64):
        mask = running & (t > 1.0)
        found = select(mask, True, found)
        running = running & not_(mask)
        t = select(running, t + step_size, t)
        if not any(running):
            break
    return t, found
""",
    ),
    "precedence is Python's": (
        "bool f(float a, float b, int i) { return (a < b) == (b < a) && ((i & 3) == 0 || a - (b - a) < -(a + b)); }",
        "def f(a, b, i):\n    return ((a < b) == (b < a)) & (((i & 3) == 0) | (a - (b - a) < -(a + b)))",
    ),
}


@pytest.mark.parametrize("title", TEXTS)
def test_text(title: str) -> None:
    source, expected = TEXTS[title]
    assert text_of(source) == expected.strip()


def test_long_lines_are_broken_within_parentheses() -> None:
    terms = " + ".join(f"first_argument * max(second_argument, {i}.0)" for i in range(12))
    source = f"float f(float first_argument, float second_argument) {{ return clamp({terms}, 0.0, 1000.0); }}"
    assert max(map(len, text_of(source).splitlines())) <= 110
    check(source, [132.0 + 0.0 * X[0]], np.array([2.0]), np.array([-1.0]))


def test_reserved_names_and_overloads() -> None:
    source = """
float lambda(float x) { return x + 1.0; }
float lambda(vec2 x) { return x.y; }
float f(float list) { float range = lambda(list); float max = 2.0; return range * lambda(vec2(max, list)); }
"""
    check(source, X * (X + 1.0), X)


# Control flow, lane by lane


CASES: dict[str, tuple[str, Any]] = {
    "if": ("float f(float x) { float y = 1.0; if (x > 0.0) { y = 2.0; y += x; } return y; }", [1, 1, 1, 2.5, 3, 5]),
    "if and else": ("float f(float x) { if (x > 0.0) { x = -x; } else { x *= 2.0; } return x; }", [-4, -1, 0, -0.5, -1, -3]),
    "else if": (
        "float f(float x) { float y; if (x < 0.0) y = 0.0; else if (x < 1.0) y = 1.0; else y = 2.0; return y; }",
        [0, 0, 1, 1, 2, 2],
    ),
    "a condition that its arm changes": ("float f(float x) { if (x > 0.0) { x = -1.0; x *= 3.0; } else x = 7.0; return x; }", [7, 7, 7, -3, -3, -3]),
    "nested if": (
        "float f(float x) { float y = 0.0; if (x < 1.0) { y = 1.0; if (x < 0.0) { y = 2.0; if (x < -1.0) y = 3.0; } y += 10.0; } return y; }",
        [13, 12, 11, 11, 0, 0],
    ),
    "returns": ("float f(float x) { if (x < -1.0) return 1.0; if (x < 0.0) return 2.0; if (x == 0.0) return 3.0; return x; }", [1, 2, 3, 0.5, 1, 3]),
    "returns in both arms": ("float f(float x) { if (x < 0.0) { x *= 2.0; return x; } else { x += 1.0; return x; } }", [-4, -1, 1, 1.5, 2, 4]),
    "a return deep inside": (
        "float f(float x) { if (x > 0.0) { float y = x; if (y > 0.75) { y *= 2.0; if (y > 3.0) return 99.0; } x = y; } return x; }",
        [-2, -0.5, 0, 0.5, 2, 99],
    ),
    "break": ("float f(float x) { for (int i = 0; i < 10; i++) { if (x > 2.0) break; x += 1.0; } return x; }", [3, 2.5, 3, 2.5, 3, 3]),
    "continue": ("float f(float x) { float s = 0.0; for (int i = 0; i < 4; i++) { if (float(i) < x) continue; s += float(i); } return s; }", [6, 6, 6, 6, 6, 3]),
    "break and continue": (
        """
float f(float x) {
    float s = 0.0;
    for (int i = 0; i < 6; i++) {
        x += 0.5;
        if (x < 0.0) continue;
        if (x > 2.0) { s += 100.0; break; }
        s += 1.0;
    }
    return s;
}
""",
        [3, 105, 104, 103, 102, 100],
    ),
    "a break that holds for lanes that continued": (
        "float f(float x) { float s = 0.0; for (int i = 0; i < 4; i++) { x += 1.0; if (x < 1.0) continue; if (x < 1.5) { s += 10.0; break; } s += x; } return s; }",
        [10, 7.5, 10, 12, 14, 22],
    ),
    "a return inside a loop": ("float f(float x) { for (int i = 0; i < 4; i++) { x += 1.0; if (x > 2.5) return float(i); } return -x; }", [-2, 3, 2, 2, 1, 0]),
    "nested loops, a return inside both": (
        "float f(float x) { float s = 0.0; for (int i = 0; i < 3; i++) { for (int j = 0; j < 3; j++) { s += x; if (s > 4.0) return s + 10.0 * float(i); } if (s < -7.0) break; } return s; }",
        [-12, -4.5, 0, 24.5, 15, 6],
    ),
    "a loop in an arm": ("float f(float x) { if (x > 0.0) { for (int i = 0; i < 3; i++) { x *= 2.0; if (x > 5.0) break; } } return x; }", [-2, -0.5, 0, 4, 8, 6]),
    "while": ("float f(float x) { int i = 0; while (i < 5 && x < 2.0) { x += 1.0; i++; } return x + 10.0 * float(i); }", [42, 32.5, 22, 22.5, 12, 3]),
    "a bound that varies": ("float f(float x) { int n = int(x); float s = 0.0; for (int i = 0; i < n; i++) s += float(i + 1); return s; }", [0, 0, 0, 0, 1, 6]),
    "a counter from outside": ("float f(float x) { int i = 5; for (i = 0; i < 4; i++) { if (x < float(i)) break; } return float(i); }", [0, 0, 1, 1, 2, 4]),
    "uniform while": ("float f(float x) { int k = 3; while (k > 0) { if (k == 2) x *= 2.0; k--; x += 1.0; } return x; }", 2.0 * X + 4.0),
    "an unsigned counter": ("float f(float x) { uint s = 0u; for (uint i = 0u; i < 3u; i++) { s += i << 1u; } return x + float(s); }", X + 6),
    "ternary": ("float f(float x) { return x < 0.0 ? -1.0 : x > 0.0 ? 1.0 : 0.0; }", [-1, -1, 0, 1, 1, 1]),
}  # fmt: skip


@pytest.mark.parametrize("title", CASES)
def test_control_flow(title: str) -> None:
    source, expected = CASES[title]
    check(source, expected, X)
    assert_agrees(source, [(x,) for x in X.tolist()])


def test_uniform_lanes_stay_scalar() -> None:
    assert run(CASES["break"][0], np.float64(0.5)) == 2.5
    assert (
        run("float f(float x) { float s = 0.0; for (int i = 0; i < 3; i++) s += x; return s; }", np.float64(2)) == 6.0
    )


# Calls that write


SPLIT = """
float split(float x, out float rest, inout int count) {
    if (x > 1.0) { rest = x - 1.0; count++; return 1.0; }
    rest = 0.0;
    return x;
}
"""


def test_out_parameters_are_returned() -> None:
    value, rest, count = run(SPLIT, X, np.zeros(6, np.int32), name="split")
    np.testing.assert_array_equal(value, np.minimum(X, 1.0))
    np.testing.assert_array_equal(rest, np.maximum(X - 1.0, 0.0))
    np.testing.assert_array_equal(count, [0, 0, 0, 0, 0, 1])
    assert count.dtype == np.int32


WRITES = {
    "under a mask": "float f(float x) { float r = 9.0; int n = 0; float y = 0.0; if (x > 0.0) y = split(x, r, n); return y + 10.0 * r + 1000.0 * float(n); }",
    "alone": "float f(float x) { float r = 9.0; int n = 0; if (x > 0.0) split(x, r, n); return 10.0 * r + 1000.0 * float(n); }",
    "in an expression": "float f(float x) { float r; int n = 2; return r + 2.0 * split(x, r, n) + float(n) * r; }".replace(
        "float r;", "float r = 5.0;"
    ),
    "in a condition": "float f(float x) { float r = 0.0; int n = 0; if (x > 0.0 && split(x, r, n) == 1.0) return r + 50.0; return r + float(n); }",
    "in an arm of a choice": "float f(float x) { float r = 7.0; int n = 0; float y = x < 0.5 ? x : split(x, r, n); return y + 10.0 * r + 100.0 * float(n); }",
    "in a loop's condition": "float f(float x) { float r = 0.0; int n = 0; int i = 0; while (i < 4 && split(x, r, n) == 1.0) { x = r + 0.5; i++; } return r + 10.0 * float(n) + float(i); }",
    "into parts": "float f(float x) { vec3 v = vec3(x); int n[2] = int[2](0, 1); float y = split(x + 1.0, v.y, n[n[1]]); return y + 10.0 * v.y + 100.0 * float(n[1]) + v.z; }",
    "over its own result": "float f(float x) { int n = 0; float y = 3.0; y = split(x, y, n); return y; }",
    "to a parameter": "float g(float x, inout int n) { float r; return split(x, r, n) + r; } float f(float x) { int n = 0; float y = g(x, n); return y + float(n); }",
}


@pytest.mark.parametrize("title", WRITES)
def test_calls_that_write(title: str) -> None:
    assert_agrees(SPLIT + WRITES[title], [(x,) for x in X.tolist()])


def test_discard() -> None:
    source = """
void cut(float x) { if (x < 0.0) discard; }
float f(float x, inout float y) { if (x < 2.0) cut(x + 1.0); y += 1.0; if (y > 3.0) discard; return x; }
"""
    value, y, discarded = run(source, X, np.array([0.0, 0.0, 3.0, 0.0, 0.0, 0.0]))
    np.testing.assert_array_equal(discarded, [True, False, True, False, False, False])
    np.testing.assert_array_equal(value[~discarded], X[~discarded])
    np.testing.assert_array_equal(y[~discarded], 1.0)


# Values


def test_stores_to_components_do_not_change_aliases() -> None:
    source = """
vec3 f(inout vec3 v, out vec3 w) {
    w = v;
    v.zx = vec2(8.0, 9.0);
    w.y += 1.0;
    return v;
}
"""
    v = vec(X, 2.0 * X, 3.0 * X)
    before = v.copy()
    result, new, w = run(source, v)
    np.testing.assert_array_equal(v, before)
    np.testing.assert_array_equal(new, [0 * X + 9.0, 2.0 * X, 0 * X + 8.0])
    np.testing.assert_array_equal(result, new)
    np.testing.assert_array_equal(w, [X, 2.0 * X + 1.0, 3.0 * X])


VALUES = {
    "a swizzle under a mask": "float f(float x) { vec4 v = vec4(1.0, 2.0, 3.0, 4.0); if (x > 0.0) { v.wy = v.xz; } return v.y + 10.0 * v.w; }",
    "a component by index": "float f(float x) { vec3 v = vec3(x); v[int(x)] = 7.0; v[2] += 1.0; return v.x + 10.0 * v.y + 100.0 * v.z; }",
    "an array": "float f(float x) { float a[4] = float[4](1.0, 2.0, x, 4.0); for (int i = 0; i < 4; i++) a[i] *= 2.0; a[int(x)] = 0.5; return a[0] + 10.0 * a[1] + a[2] + a[int(x) + 1]; }",
    "an array of vectors": "float f(float x) { vec2 a[2] = vec2[2](vec2(x, 1.0), vec2(2.0)); a[int(x)].y = x; a[1] += a[0]; return a[1].x + 10.0 * a[1].y; }",
    "a struct": "struct S { float a; vec2 b; }; struct T { S s; int n; }; float f(float x) { T t = T(S(x, vec2(1.0)), 3); if (x > 0.0) { t.s.b.y = 5.0; t.n += 1; } S s = t.s; s.a = 9.0; return t.s.a + 10.0 * t.s.b.y + float(t.n) + s.a; }",
    "an array of structs": "struct S { float a; vec2 b; }; float f(float x) { S s[2]; s[0] = S(x, vec2(1.0)); s[1].b = vec2(3.0); s[int(x)].b.x = 7.0; s[1].a += x; return s[0].a + s[0].b.x + 10.0 * s[1].a + 100.0 * s[1].b.x; }",
    "structs by mask": "struct S { float a; vec2 b; }; S g(float x) { if (x > 0.0) return S(1.0, vec2(x)); return S(2.0, vec2(3.0)); } float f(float x) { S s = g(x); S t = S(2.0, vec2(3.0)); return s.a + s.b.y + (s == t ? 100.0 : 0.0) + (s != t ? 1000.0 : 0.0); }",
    "matrices": "float f(float x) { mat2 m = mat2(1.0, x, 3.0, 4.0); mat2 n = m * mat2(2.0); n[1].x = x; n[0] = vec2(5.0, x); vec2 v = (m * n) * vec2(1.0, x) + vec2(x, 2.0) * m; return v.x + 10.0 * v.y + (m == n ? 1.0 : 0.0); }",
    "matrices of other sizes": "float f(float x) { mat3 m = mat3(mat2(x, 2.0, 3.0, 4.0)); mat2 n = mat2(mat4(x)); m[2] = vec3(n[0], 1.0); m = m + 2.0 * m - m / 2.0; vec3 v = m * vec3(1.0, x, 3.0); return v.x + 10.0 * v.y + 100.0 * v.z + transpose(m)[0][1]; }",
    "a column by index": "float f(float x) { mat2 m = mat2(1.0, 2.0, 3.0, 4.0); m[int(x)][1] = 9.0; vec2 c = m[int(x)]; return c.x + 10.0 * c.y + m[0].y; }",
    "vectors of other kinds": "float f(float x) { ivec3 i = ivec3(vec3(x, 2.5, -1.5)); uvec2 u = uvec2(i.xy) + 1u; bvec2 b = bvec2(vec2(x, 0.0)); vec2 v = vec2(i) + vec2(u) + vec2(b); return v.x + 10.0 * v.y + float(i == ivec3(0, 2, -1)); }",
    "relations": "float f(float x) { bvec3 b = lessThan(vec3(x, 0.0, 1.0), vec3(0.5)); return any(b) ? all(not(b)) ? 1.0 : 2.0 : 3.0; }",
    "narrowing": "float f(float x) { vec4 v = vec4(x, 2.0, 3.0, 4.0); vec2 w = vec2(v); return float(v) + float(int(w.y) + int(true)) + vec3(v).z; }",
}


@pytest.mark.parametrize("title", VALUES)
def test_values(title: str) -> None:
    assert_agrees(VALUES[title], [(x,) for x in X.tolist()])


# Numbers


INTEGERS = {
    "wraps though all is literal": "int f(int x) { int big = 2147483647; big = big + 1; return big - x; }",
    "wraps in a loop": "int f(int x) { int h = 7; for (int i = 0; i < 20; i++) { h = h * 31 + i; } return h ^ x; }",
    "steps": "int f(int x) { int n = 0; for (int i = 0; i < 5; i++) { if (i == 3) n -= 2; n += 1; } return n - x; }",
    "negation": "int f(int x) { int low = -2147483647; low -= 1; return -low + x; }",
    "by zero": "int f(int x) { int zero = 0; return x / zero + 7 % zero + x / -3 + x % 3; }",
    "shifts": "int f(int x) { int n = 3; return (x << 2) + (x >> 1) + (x >> n) + (1 << n) + (1 << 35); }",
    "bits": "int f(int x) { return (x & 6 | 1) ^ ~x; }",
    "an argument that is a literal": "int g(int a, int b) { return a * b * 65536; } int f(int x) { return g(40000, 3) + x; }",
    "a result that is a literal": "int g(int a) { return 2147483647; } int f(int x) { return g(x) + 1; }",
    "a choice of literals": "int f(int x) { int y = x > 0 ? 2147483647 : 1; y += 1; return y; }",
}
UNSIGNED = {
    "hash": "uint f(uint x) { x = (x ^ (x >> 16u)) * 0x7feb352du; x = (x ^ (x >> 15u)) * 0x846ca68bu; return x ^ (x >> 16u); }",
    "literals alone": "uint f(uint x) { uint a = 5u; uint b = a - 6u; return b / 2u + x * (3u - 4u) + (1u << 31u) + max(2u, 3u); }",
    "negation": "uint f(uint x) { uint a = 1u; return -a + ~x + ~0u - -x; }",
    "a counter": "uint f(uint x) { uint s = 0u; for (uint i = 0u; i < 3u; i++) { s += (i - 2u) * x; } return s; }",
    "choices": "uint f(uint x) { uint y = x > 9u ? 1u : 4000000000u; y += x; uvec2 v = uvec2(1u, 2u) * y; return v.x % 7u + v.y; }",
    "a constant": "const uint SEED = 4000000000u; uint f(uint x) { return x * SEED + SEED * 3u; }",
    "an argument": "uint g(uint a) { return a * a; } uint f(uint x) { return g(70000u) + g(x); }",
    "an array": "uint f(uint x) { uint a[2] = uint[2](4000000000u, 2u); return a[int(x % 2u)] * 3u; }",
    "out": "void g(out uint a) { a = 3000000000u; } uint f(uint x) { uint a; if (x > 0u) g(a); else a = 1u; return a * 2u; }",
}


@pytest.mark.parametrize("title", INTEGERS)
def test_integers(title: str) -> None:
    assert_agrees(INTEGERS[title], [(x,) for x in (0, 1, -1, 7, 12345, 2**31 - 1, -(2**31))])


@pytest.mark.parametrize("title", UNSIGNED)
def test_unsigned(title: str) -> None:
    assert_agrees(UNSIGNED[title], [(x,) for x in (0, 1, 7, 12345, 2**31, 2**32 - 1)])


def test_plain_numbers_divide_by_zero() -> None:
    source = (
        "float g(float a, float b) { return a / b; } float f(float x) { float zero = 0.0; return x + g(1.0, zero); }"
    )
    check(source, X + np.inf, X)
    check("uniform float k; float f(float x) { return 1.0 / k + x; }", X + np.inf, X, k=0.0)


@pytest.mark.parametrize("dtype", [np.float16, np.float32, np.float64])
def test_precision_is_that_of_the_inputs(dtype: type[np.floating[Any]]) -> None:
    source = """
const vec3 UP = vec3(0.0, 1.0, 0.0);
const float ROOT = sqrt(2.0);
const float HALF = 0.5;
vec3 f(float x, int n) {
    float s = 1.0;
    vec3 v = UP * HALF;
    for (int i = 0; i < n; i++) { if (x > 1.0) { s = -1.0; continue; } v.x += float(i) * ROOT; }
    return normalize(v) * s + vec3(0.5, 1.0, 2.0) * mix(0.25, x, 0.5);
}
"""
    function = compiled(source)["f"]
    with precision(dtype):
        result = function(X.astype(dtype), np.int32(3))
    assert result.dtype == dtype and result.shape == (3, 6)


# Uniforms, constants and textures


def test_globals_are_read_from_the_module() -> None:
    source = """
const float TAU = 6.25;
const vec2 AXIS = vec2(0.0, TAU);
const vec2 BOTH = AXIS + vec2(1.0);
uniform float scale = 2.0;
uniform int steps = 3;
uniform sampler2D image : default_white;
float f(vec2 uv) {
    float s = 0.0;
    for (int i = 0; i < steps; i++) s += texture(image, uv).r * scale;
    return s + dot(BOTH, AXIS);
}
"""
    uv = vec(np.array([0.25, 0.75]), 0.5)
    texture = Texture(np.array([[[1.0], [3.0]]]), filter="nearest")
    check(source, np.array([6.0, 18.0]) + 7.25 * 6.25, uv, scale=2.0, steps=3, image=texture)
    check(source, np.array([8.0, 6.0]) + 7.25 * 6.25, uv, scale=2.0, steps=np.array([4, 1]), image=texture)


def test_struct_results_are_records() -> None:
    result = run("struct S { float a; vec2 b; }; S f(float x) { return S(x, vec2(x)); }", X)
    assert isinstance(result, Record)
    np.testing.assert_array_equal(result.b, [X, X])


def test_a_member_may_have_a_name_of_records() -> None:
    source = "struct S { float self; float replace; }; float f(float x) { S s = S(x, x); s.replace += 1.0; return s.replace; }"
    np.testing.assert_array_equal(run(source, X), np.asarray(X) + 1.0)


# Random programs


LANES = st.tuples(
    *[st.integers(-4, 8).map(lambda i: i / 2)] * 2, st.integers(0, 3), st.integers(-4, 8).map(lambda i: i / 2)
)


@settings(max_examples=150)
@given(st.randoms(use_true_random=False), st.lists(LANES, min_size=1, max_size=12), st.booleans())
def test_random_programs(random: Random, lanes: list[tuple[float, float, int, float]], discards: bool) -> None:
    assert_agrees(Programs(random, discards).program(), lanes)


@pytest.mark.parametrize("seed", [*range(25), *(pytest.param(seed, marks=pytest.mark.slow) for seed in range(25, 60))])
def test_large_random_programs(seed: int) -> None:
    random = Random(seed)
    lanes = [(random.randrange(-4, 9) / 2, random.randrange(-4, 9) / 2, random.randrange(4), 1.0) for _ in range(16)]
    assert_agrees(Programs(random, seed % 3 == 0, size=6).program(), lanes)


def test_uniforms_and_textures_are_declared_with_their_defaults() -> None:
    source = """
uniform vec2 a = vec2(1.0, 2.0);
uniform uvec2 b = uvec2(3u, 4u);
uniform mat2 c;
uniform float d[2];
uniform bool e = true;
uniform sampler2D bumps : default_bump;
uniform samplerCube sky;
uniform sampler3D fog : default_black;
"""
    module = module_of(source)
    printer = NumpyPrinter(load("numpy"), module)
    members, _ = place(module.uniforms, "")
    textures = [uniform for uniform in module.uniforms if isinstance(uniform.type, Sampler)]
    lines = printer.print_uniforms(members) + printer.print_textures(textures)
    assert [line.text for line in lines] == [
        "a = vec(1.0, 2.0)",
        "b = vec(to_uint(3), 4)",
        "c = mat(2, 1.0, 0.0, 0.0, 1.0)",
        "d = array(0.0, 0.0)",
        "e = True",
        "bumps = Texture([[[0.5, 0.5, 1.0, 1.0]]])",
        'sky = Texture([[[[1.0, 1.0, 1.0, 1.0]]]] * 6, dim="Cube")',
        "fog = Texture([[[[0.0, 0.0, 0.0, 1.0]]]])",
    ]
    exec("\n".join(line.text for line in lines), dict(vars(numpy_runtime)))
