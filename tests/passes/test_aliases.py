"""One name for each value."""

from __future__ import annotations

import pytest

from pass_cases import assert_is, module_of
from sssgen.ir.verify import verify
from sssgen.passes.aliases import drop_aliases

CASES = {
    "the last name of a block stays": (
        "float f(float x) { float a = sin(x); float b = a; float c = b; return a + b * c; }",
        "float f(float x) { float c = sin(x); return c + c * c; }",
    ),
    "a parameter keeps its name": (
        "vec3 f(vec3 place) { vec3 p = place; vec3 q = p; return p.zxy + q; }",
        "vec3 f(vec3 place) { return place.zxy + place; }",
    ),
    "a name of an inner block goes": (
        "float f(float x) { float a = sin(x); if (x > 0.0) { float b = a; a_2(b); } return a; }",
        "float f(float x) { float a = sin(x); if (x > 0.0) { a_2(a); } return a; }",
    ),
    "in the inner block the last name stays": (
        "float f(float x) { if (x > 0.0) { float a = sin(x); float b = a; return a + b; } return x; }",
        "float f(float x) { if (x > 0.0) { float b = sin(x); return b + b; } return x; }",
    ),
    "a value that is computed is no alias": (
        "float f(vec2 v) { float a = v.x; float b = -a; return a + b; }",
        "float f(vec2 v) { float a = v.x; float b = -a; return a + b; }",
    ),
    "a uniform is no local": (
        "uniform float u = 1.0; float f(float x) { float a = u; return a + x * a; }",
        "uniform float u = 1.0; float f(float x) { float a = u; return a + x * a; }",
    ),
}
KEPT = {
    "the alias is assigned": "float f(float x) { float a = sin(x); float b = a; b += 1.0; return a + b; }",
    "the first is assigned": "float f(float x) { float a = sin(x); float b = a; a += 1.0; return a + b; }",
    "a component is assigned": "vec2 f(vec2 v) { vec2 a = v; a.x = 1.0; return a + v; }",
    "an element is assigned": "float f(float v[2]) { float a[2] = v; a[1] = 1.0; return a[0] + v[1]; }",
    "a call writes it": "float f(float x) { float a = x; set_to_one(a); return a + x; }",
    "a call writes the first": "float f(float x) { float a = sin(x); float b = a; set_to_one(a); return a + b; }",
    "an inout parameter is written": "float f(inout float x) { float old = x; x = 2.0; return old; }",
    "the counter of a loop": "int f(int n) { int s = 0; for (int i = n; i < 9; i++) { s += i; } return s + n; }",
    "a value of the round before": """float f(float x) {
        float last = x, now = x;
        for (int i = 0; i < 3; i++) { last = now; now = sin(now); }
        return last + now;
    }""",
    "two variables of one name": """float f(float x) {
        float s = x * 2.0;
        if (x > 0.0) { float a = s; float b = a; b += 1.0; return b; }
        else { float a = 1.0; a += s; return a; }
    }""",
}
AROUND = "void a_2(float x) {} void set_to_one(out float x) { x = 1.0; }"


@pytest.mark.parametrize("case", CASES)
def test_aliases_are_merged(case: str) -> None:
    before, after = CASES[case]
    module = drop_aliases(module_of(f"{AROUND} {before}"))
    assert verify(module) == []
    assert_is(module, f"{AROUND} {after}")


@pytest.mark.parametrize("case", KEPT)
def test_variables_that_differ_stay(case: str) -> None:
    module = module_of(f"{AROUND} {KEPT[case]}")
    assert drop_aliases(module) == module
