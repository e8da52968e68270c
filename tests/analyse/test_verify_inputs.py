"""What `--verify` sees: changes of emitted texts, branches, undefined operations; and no false alarms."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from sssgen.analyse.verify import driven_function
from sssgen.analyse.verify.machines import Machines
from sssgen.analyse.verify.verification import verify
from sssgen.analyse.verify.verification_report import Coverage, Row
from sssgen.analyse.verify.verified_function import Options
from sssgen.pipeline import compiler

Verify = Callable[..., Row]


@pytest.fixture(scope="module")
def row(machines: Machines) -> Verify:
    """`row(text, samples, seed)` is the row of the last function."""
    return lambda text, samples=1000, seed=0: verify(
        text, "shader.glsl", Options(samples, seed), machines=machines
    ).rows[-1]


CHANGES = [
    ("int f(int a) { return a >> 2; }", "a >> 2", "a / 4"),
    ("int f(int a) { return abs(a) + max(a, 0); }", "abs(a) + max(a, 0)", "a + a"),
    ("int f(int x) { return clamp(x, -10, 10); }", "clamp(x, -10, 10)", "clamp(x, -10, 3)"),
    ("float f(float x) { return x > 100.0 ? 1.0 : 0.0; }", "100.0", "3.0"),
    ("float f(float x) { if (x < 100.0) return 0.0; return 1.0; }", "100.0", "3.0"),
    ("uint f(uint x) { return x >> 28; }", ">> 28", ">> 29"),
    ("int f(int x) { return x >> 28; }", ">> 28", ">> 29"),
]
"""A function, a part of its emitted texts, and what stands there after a change by hand."""


@pytest.mark.parametrize(("text", "right", "wrong"), CHANGES)
def test_a_changed_text_is_found(
    row: Verify, text: str, right: str, wrong: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert row(text).ok
    transpile = compiler.transpile

    def changed(*args: Any, **options: Any) -> Any:
        compiled = transpile(*args, **options)
        files = {
            name: text if name.endswith(".json") else text.replace(right, wrong)
            for name, text in compiled.files.items()
        }
        return compiled._replace(files=files)

    monkeypatch.setattr(driven_function, "transpile", changed)
    found = row(text).comparisons
    assert not found["glsl"].ok and not found["hlsl"].ok
    assert "for a = " in found["glsl"].at or "for x = " in found["glsl"].at


FINE = {
    "voronoi": """
vec2 hash(vec2 p) { return fract(sin(vec2(dot(p, vec2(127.1, 311.7)), dot(p, vec2(269.5, 183.3)))) * 43758.5453); }
float f(vec2 x) {
    vec2 n = floor(x), g = fract(x);
    float d = 8.0;
    for (int j = -1; j <= 1; j++)
        for (int i = -1; i <= 1; i++) {
            vec2 c = vec2(float(i), float(j));
            vec2 r = c + hash(n + c) - g;
            d = min(d, dot(r, r));
        }
    return sqrt(d);
}
""",
    "sampler arrays": """
uniform sampler2D maps[3];
vec4 f(vec2 p) { return texture(maps[2], p) + 2.0 * texture(maps[0], p.yx); }
""",
    "layers": "uniform sampler2DArray maps; vec4 f(vec2 p) { return texture(maps, vec3(p, 1.0)); }",
    "shadow": "float f(sampler2DShadow map, vec3 p) { return texture(map, p); }",
    "gathered shadow": "vec4 f(sampler2DShadow map, vec2 p, float depth) { return textureGather(map, p, depth); }",
    "integer texels": "ivec4 f(isampler2D map, ivec2 p) { return texelFetch(map, p, 0); }",
    "bits": """
uint f(uint x, int n) {
    x ^= x >> 16; x *= 0x7feb352dU; x ^= x << 15;
    return x ^ uint(n >> 3) ^ (x & 0xff00ffu) ^ uint(bitCount(x)) ^ uint(findMSB(n));
}
""",
    "undefined integers": "int f(int a, int b) { return (a << b) + a / b + a % b + bitfieldExtract(a, b, 7); }",
    "undefined conversions": "uint f(float x) { return uint(int(x * 3.0)) + uint(x); }",
    "undefined functions": "float f(float x, float y) { return pow(x, y) + clamp(1.0, x, y) + smoothstep(x, y, 0.5); }",
    "undefined places": "float f(vec4 v, int i) { float a[3] = float[3](v.x, v.y, v.z); return a[i] + v[i + 1]; }",
    "thresholds": "float f(float x) { return (x <= 0.1 ? 1.0 : 0.0) + (x * 3.0 < 0.9 ? 2.0 : 0.0) + step(0.7, x); }",
    "cells": "float f(vec2 p) { return floor(p.x / 0.3) + mod(p.y, 0.7) + fract(p.x * 10.0); }",
    "cancellation": "float f(float x, float y) { return (x + y) * (x - y) - (x * x - y * y); }",
    "angles": "float f(vec2 p) { return atan(p.y, p.x) + sin(p.x) * 100.0 + acos(clamp(p.y, -1.0, 1.0)); }",
    "long loops": "float f(int n, float s) { float t = 0.0; for (int i = 0; i < n; i++) t += s; return t; }",
    "float loops": "float f(float far) { float s = 0.0; for (float t = 0.0; t < far; t += 0.25) s += t; return s; }",
    "known names": "int f(int iTime, ivec2 fragCoord) { return (iTime & 7) + fragCoord.x; }",
    "blend": "float f(float a, float b, float k) { return mix(b, a, clamp(0.5 + (b - a) / k, 0.0, 1.0)); }",
    "open loops": "int f(uint n) { int k = 0; while (n != 0u) { n >>= 1; k++; } return k; }",
}


@pytest.mark.parametrize("name", FINE)
@pytest.mark.parametrize("seed", [0, 1])
def test_no_false_alarm(row: Verify, name: str, seed: int) -> None:
    result = row(FINE[name], seed=seed)
    assert result.ok, result
    assert result.comparisons["glsl"].deviation is not None
    assert result.lanes - result.undefined >= 100, result


def test_undefined_lanes_are_excluded_and_the_others_compared(row: Verify) -> None:
    result = row("int f(int a, int b) { return a / b; }")
    assert result.ok and 0 < result.undefined <= 60 and result.lanes == 1000


def test_a_hash_is_compared_where_it_does_not_depend_on_rounding(row: Verify) -> None:
    result = row("float f(vec2 p) { return floor(fract(sin(dot(p, vec2(12.9898, 78.233))) * 43758.5453) * 8.0); }")
    oracle = result.comparisons["oracle"]
    assert result.ok and oracle.excluded > 100
    assert result.comparisons["glsl"].deviation == 0.0


def test_branches_are_counted_and_those_never_taken_named(row: Verify) -> None:
    text = """float f(int n, float x) {
    if (n == 123456) x += 1.0;
    if (x > 1e3 && x < 1.001e3) x *= 2.0;
    float y = (n & 0xff00) == 0x4200 ? 1.0 : 2.0;
    for (int i = 0; i < n; i++) { if (i > 3) break; y += x; }
    if (x * x < -1.0)
        y = 3.0;
    return y;
}"""
    result = row(text)
    assert result.branches == Coverage(11, 12, ("line 6 (if)",))


def test_a_function_without_an_end_is_not_run(row: Verify) -> None:
    result = row("int f(int n) { while (n < 1000000) { n = n & 7; } return n; }")
    assert result.reason == "its loops do not end" or result.ok
