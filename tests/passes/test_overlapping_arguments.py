"""Out arguments that share a variable with each other or with the called function.

They are copied in at the call, and out from left to right.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from plain_calls import BACKENDS, called, module_of
from sssgen.ir.nodes import Assign
from sssgen.passes.places import may_overlap
from sssgen.pipeline.compiler import transpile
from sssgen.run.backends import Backend
from sssgen.run.compilers import Compiler, Source, errors, readers

X = np.array([-3.0, -0.5, 0.0, 1.0, 2.5, 8.0])
TWO = "void two(inout float a, inout float b) { a = a + 1.0; b = b * 10.0 + a; a += 3.0; }\n"
STRUCT = "struct S { vec3 v; float w; };\n"

CASES: dict[str, tuple[str, Callable[[float], float]]] = {
    "one variable twice": (TWO + "float f(float x) { two(x, x); return x; }", lambda x: x * 10 + x + 1),
    "in a value": (
        "float two(inout float a, inout float b) { a += 1.0; b *= 3.0; return a + b; }\n"
        "float f(float x) { return x + two(x, x) * x; }", lambda x: x + (x + 1 + 3 * x) * 3 * x,
    ),
    "a component and its vector": (
        STRUCT + "void two(inout float a, inout vec3 b) { a += 1.0; b = b * 2.0 + a; }\n"
        "float f(float x) { S s = S(vec3(x, 1.0, 2.0), 1.0); two(s.v.x, s.v); return s.v.x + 10.0 * s.v.y; }",
        lambda x: (2 * x + x + 1) + 10 * (2 + x + 1),
    ),
    "a vector and its component": (
        STRUCT + "void two(inout vec3 b, inout float a) { a += 1.0; b = b * 2.0 + a; }\n"
        "float f(float x) { S s = S(vec3(x, 1.0, 2.0), 1.0); two(s.v, s.v.x); return s.v.x + 10.0 * s.v.y; }",
        lambda x: (x + 1) + 10 * (2 + x + 1),
    ),
    "elements of an array": (
        TWO + "float f(float x) { float a[2]; a[0] = x; a[1] = 2.0; int i = x > 0.5 ? 1 : 0;\n"
        "two(a[0], a[i]); return a[0] + 1000.0 * a[1]; }",
        lambda x: x + 4 + 1000 * (20 + x + 1) if x > 0.5 else (x * 10 + x + 1) + 2000,
    ),
    "the second part of a swizzle": (
        "void two(inout vec2 a, inout float b) { a += 1.0; b += a.y * 10.0; }\n"
        "float f(float x) { vec3 v = vec3(x, 2.0, 3.0); two(v.zx, v.x); return v.x + v.z * 100.0; }",
        lambda x: x + (x + 1) * 10 + 400,
    ),
    "a module variable twice": (
        f"float g;\n{TWO}float f(float x) {{ g = x; two(g, g); return g; }}", lambda x: x * 10 + x + 1
    ),
    "a module variable that the function writes": (
        "float g; void h(inout float a) { g = 5.0; a = a * 2.0; }\nfloat f(float x) { g = x; h(g); return g; }",
        lambda x: 2 * x,
    ),
    "a module variable that a called function writes": (
        "float g; void k() { g = 5.0; } void h(inout float a) { k(); a = a * 2.0; }\n"
        "float f(float x) { g = x; h(g); return g; }", lambda x: 2 * x,
    ),
    "a module variable that the function reads": (
        "float g; float h(inout float a) { a += 1.0; a += g; return g; }\n"
        "float f(float x) { g = x; float y = h(g); return y + 10.0 * g; }", lambda x: x + 10 * (2 * x + 1),
    ),
    "a part of a module variable": (
        STRUCT + "S g; void h(inout vec3 a) { a *= 2.0; g.w += a.x; g.v += 1.0; a += g.v; }\n"
        "float f(float x) { g = S(vec3(x, 1.0, 2.0), 1.0); h(g.v); return g.v.x + 100.0 * g.w; }",
        lambda x: 3 * x + 1 + 100 * (1 + 2 * x),
    ),
    "an argument that a later one changes": (
        "void add(inout float a, float b) { a += b * 10.0; }\nfloat f(float x) { add(x, x++); return x; }",
        lambda x: x + 1 + 10 * x,
    ),
    "an argument that a later call changes": (
        "float up(inout float a) { a += 1.0; return 1.0; } void add(inout float a, float b) { a += b * 10.0; }\n"
        "float f(float x) { add(x, up(x)); return x; }", lambda x: x + 11,
    ),
    "a part of what a later call changes": (
        STRUCT + "float up(inout S s) { s.v.y += 1.0; return s.v.x; }\n"
        "void add(inout vec3 a, float b) { a += b * 10.0; }\n"
        "float f(float x) { S s = S(vec3(x, 1.0, 2.0), 1.0); add(s.v, up(s)); return s.v.y; }", lambda x: 2 + 10 * x,
    ),
    "an index that a later argument changes": (
        "void add(inout float a, int b) { a += 10.0; }\n"
        "float f(float x) { float a[2]; a[0] = x; a[1] = 2.0; int i = 0; add(a[i], i++); return a[0] + 100.0 * a[1]; }",
        lambda x: x + 10 + 200,
    ),
    "an index that the function changes": (
        "int i; void add(inout float a) { i = 1; a += 10.0; }\n"
        "float f(float x) { i = 0; float a[2]; a[0] = x; a[1] = 2.0; add(a[i]); return a[0] + 100.0 * a[1]; }",
        lambda x: x + 10 + 200,
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", BACKENDS)
@pytest.mark.parametrize("title", CASES)
def test_results(title: str, name: str, backend: Callable[[str], Backend]) -> None:
    text, expected = CASES[title]
    np.testing.assert_allclose(called(text, backend(name), X), [expected(x) for x in X], rtol=1e-5)


@pytest.mark.parametrize("compiler_name", ["naga", "tint", "dxc", "glslang"])
def test_compilers_accept_them(compiler_name: str, compiler: Callable[[str], Compiler]) -> None:
    reader = compiler(compiler_name)
    said = []
    for title, (text, _) in CASES.items():
        for target in ("wgsl", "hlsl", "glsl-330"):
            if compiler_name in readers(target):
                files = transpile(module_of(text), target, "case", keep=True).files
                emitted = next(text for name, text in files.items() if not name.endswith(".json"))
                said += [f"{title}: {error}" for error in errors(reader.check(Source(emitted, target, "library")))]
    assert said == []


def test_text_of_arguments_that_do_not_overlap_is_kept() -> None:
    text = (
        "void two(inout float a, inout float b) {\n    a += b;\n}\n\n"
        "void f(inout vec3 v, inout float list[2]) {\n    two(v.x, v.y);\n    two(list[0], list[1]);\n}\n"
    )
    for target in ("glsl-330", "hlsl"):
        files = transpile(module_of(text), target, "case", keep=True).files
        assert "    two(v.x, v.y);\n    two(list[0], list[1]);\n" in next(iter(files.values()))


OVERLAPS = [
    ("v.x", "v.y", False), ("v.xy", "v.yz", True), ("v.x", "v[0]", True), ("v.x", "v[1]", False), ("v[i]", "v.x", True),
    ("v.zyx[0]", "v.z", True), ("v.zyx[0]", "v.x", False), ("v.zyx.x", "v.x", False), ("v.zyx[i]", "v.xy", True),
    ("v.zy[i]", "v.x", False), ("m[0]", "m[1]", False), ("m[0].x", "m[0][1]", False), ("m[i].x", "m[j].x", True),
    ("m[i].x", "m[j].y", False), ("v", "w", False), ("v", "v.x", True), ("s.a", "s.b", False), ("s.a.x", "s.a", True),
]  # fmt: skip


@pytest.mark.parametrize(("one", "other", "expected"), OVERLAPS)
def test_places(one: str, other: str, expected: bool) -> None:
    head = "struct T { vec3 a; vec3 b; }; void f(vec3 v, vec3 w, mat3 m, T s, int i, int j)"
    body = module_of(f"{head} {{ {one} = {one}; {other} = {other}; }}").functions[0].body
    assert body is not None
    places = [stmt.target for stmt in body if isinstance(stmt, Assign)]
    assert may_overlap(places[0], places[1]) == may_overlap(places[1], places[0]) == expected
