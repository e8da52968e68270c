"""Valid GLSL that few programs have, with its results on every back end."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from results_of_glsl import check_results
from sssgen.lang.plain_glsl import load_glsl_text
from sssgen.pipeline.compiler import transpile
from sssgen.run.backends import Backend
from sssgen.support.diagnostics import SssgenError
from whole_shaders import compile_errors

SWITCH = """float f(float x) {
    float result = x;
    switch (int(x)) {
        case 0: float y = 10.0, z; const float W = 0.5; result += y; break;
        case 1: y = 20.0; result += y + W;
        case 2: int n = 4; break;
        default: n = 5; z = float(n); result += z;
    }
    return result;
}"""
CASES = {
    "a variable of an earlier case": (SWITCH, 1.0, 21.5),
    "a variable of an earlier case in the last one": (SWITCH, 7.0, 12.0),
    "the case with the value": (SWITCH, 0.0, 10.0),
    "labels of another signedness in ES 3.20": (
        "#version 320 es\nfloat f(float x) { switch (int(x)) { case 2u: return 5.0; case 3: return 6.0; } return x; }",
        2.0, 5.0,
    ),
    "an out argument that is converted": (
        "void give(float x, out uint n, out int m) { n = uint(x); m = -int(x); }"
        "float f(float x) { float a; vec2 b; give(x, a, b.y); return a * 10.0 + b.y; }", 3.0, 27.0,
    ),
    "out arguments that are converted in the order of the call": (
        "int give(out int n, int m) { n = m + 1; return m; }"
        "float f(float x) { float a = x; return a * 100.0 + float(give(a, 4)) * 10.0 + a; }", 2.0, 245.0,
    ),
    "an overload with an out argument that is converted": (
        "void give(out uint n) { n = 3u; } void give(out vec2 n) { n = vec2(1.0); }"
        "float f(float x) { give(x); return x; }", 2.0, 3.0,
    ),
    "a macro with any text that is not used": ("#define NEVER \"$ @ ` \\ x\nfloat f(float x) { return x; }", 2.0, 2.0),
    "declarations without their first name": (
        "const float, g = 1.0, h = 2.0; vec3; uniform float; struct S { float a; }; S;"
        "float f(float x) { struct T { float a; }, t; t.a = x; S s; s.a = t.a; S; float, a = 2.0, b[2]; b[1] = a;"
        "const int, c = 1; int, d; d = c; for (int, i = 0; i < 3; i++) d += i; return g + h + s.a + b[1] + float(d); }",
        3.0, 12.0,
    ),
    "the length of an array by its use": (
        "float f(float x) { float a[]; a[3] = x; int b[2], n = 0; a[b.length()] = 2.0;"
        " for (int i = 0; i < a.length(); i++) n++;"
        " return a[2] * 10.0 + a[3] + float(n) * 100.0; }", 3.0, 423.0,
    ),
    "values in braces": (
        "struct S { float a; vec2 b[2]; }; const S C = {1.0, {{1.0, 2.0}, {3, 4},},};"
        "const float G[][2] = {{1, 2}, {3, 4}};"
        "float f(float x) { S none = {}; mat2 m = {{x, 2}, {3, 4}}; vec2 v[3] = {};"
        " S s[] = {C, {x, {vec2(1), {2, x}}}};"
        " return none.b[1].x + m[0][0] + v[2].y + s[1].b[1].y * 10.0 + G[1][0] * 100.0 + s[0].b[1].x * 1000.0; }",
        5.0, 3355.0,
    ),
    "attributes of control flow": (
        "#version 450\n#extension GL_EXT_control_flow_attributes : enable\n"
        "float f(float x) { [[unroll]] for (int i = 0; i < 3; i++) [[flatten, dependency_length(2)]]"
        " if (x > 0.0) x *= 2.0;"
        " int a[2] = int[2](1, 0); [ [ branch ] ] switch (a[a[1]]) { case 1: x += 1.0; } return x; }", 3.0, 25.0,
    ),
    "limits of the language": (
        "float f(float x) { int n = gl_MaxVaryingFloats + gl_MinProgramTexelOffset;"
        " ivec3 s = gl_MaxComputeWorkGroupSize; return x + float(n + s.z); }", 1.0, 117.0,
    ),
    "a struct inside of a variable's scope": (
        "float f(float x) { float S = x; { struct S { float a; }; S s = S(S(2.0).a); x += s.a; } return x + S; }",
        1.0, 4.0,
    ),
    "a variable whose value calls the function that it hides": (
        "float g(float x) { return x * 2.0; } float f(float x) { float g = g(x); { float max = max(g, 1.0); g += max; }"
        " return g; }", 3.0, 12.0,
    ),
    "arms of a statement without values": (
        "void add(inout float n) { n += 1.0; } void take(inout float n) { n -= 1.0; }"
        "float f(float x) { float n = x; x > 0.0 ? add(n) : take(n); int i = 0; x > 0.0 ? i++ : n;"
        " x > 5.0 ? (n, add(n)) : add(n);"
        " return n + float(i); }", 3.0, 6.0,
    ),
    "a function beside the builtins of its name in GLSL ES 1.00": (
        "#version 100\nprecision highp float;\nfloat max(float a, float b, float c) { return max(max(a, b), c); }"
        "float f(float x) { return max(x, 1.0, 4.0) + max(x, 2.0); }", 3.0, 7.0,
    ),
    "a constant from the column of a matrix": (
        "#version 300 es\nprecision highp float; struct S { mat2 m; }; const S s = S(mat2(1.0, 2.0, 3.0, 4.0));"
        "float f(float x) { const S t = S(mat2(5.0)); const vec2 c = vec2(t.m); const vec4 v = vec4(s.m);"
        "return x + c.x + v.w; }", 2.0, 11.0,
    ),
    "an extension pack": (
        "#version 310 es\nprecision highp float;\n"
        "float f(float x) { return x + float(GL_ANDROID_extension_pack_es31a); }",
        2.0, 3.0,
    ),
}  # fmt: skip


@pytest.mark.parametrize("case", CASES)
def test_results(case: str, backend: Callable[[str], Backend]) -> None:
    text, x, expected = CASES[case]
    check_results(text, expected, backend, [x])


def test_a_macro_with_a_fault_that_is_used() -> None:
    with pytest.raises(SssgenError, match="unknown character '@'"):
        load_glsl_text("#define AT @ 1.0\nfloat f() { return AT; }\n", "case.glsl")


def test_the_range_of_depths_is_a_uniform() -> None:
    """WebGPU and D3D have it in the viewport alone."""
    text = (
        "out vec4 color;\nvoid main() { color = vec4(gl_DepthRange.near, gl_DepthRange.far, gl_DepthRange.diff, 1.0); }"
    )
    module = load_glsl_text(text, "case.frag").module
    compiled = transpile(module, "wgsl", "case", keep=True)
    uniforms = [(uniform["name"], uniform["default"]) for uniform in compiled.reflection["uniforms"]]
    assert uniforms == [("DepthRange_near", [0.0]), ("DepthRange_far", [1.0]), ("DepthRange_diff", [1.0])]


def test_a_compute_shader_without_the_size_of_its_workgroup() -> None:
    text = "layout(std430) buffer Numbers { float x[]; };\nvoid main() { x[gl_GlobalInvocationID.x] = 1.0; }\n"
    assert load_glsl_text(text, "case.comp").module.workgroup == (1, 1, 1)
    with pytest.raises(SssgenError, match="belongs to compute shaders"):
        load_glsl_text("shared float x[4];\nvoid main() { x[0] = 1.0; }\n", "case.glsl")


@pytest.mark.parametrize("target", ["wgsl", "hlsl", "glsl-330"])
@pytest.mark.parametrize("value", ["gl_SampleID", "gl_SampleMask[0] = 1 & gl_SampleMaskIn[0]", "gl_SampleMask[0] = 3"])
def test_the_samples_of_a_pixel(target: str, value: str) -> None:
    text = f"out vec4 color;\nvoid main() {{ color = vec4(float({value})); }}\n"
    module = load_glsl_text(text, "case.frag").module
    emitted = next(iter(transpile(module, target, "case", keep=True).files.values()))
    assert compile_errors(emitted, target) == []


COUNTERS = """#version 310 es
precision mediump float;
layout(location = 0) out vec4 color;
layout(binding = 0, offset = 4) uniform atomic_uint hits;
layout(binding = 0) uniform atomic_uint rest[8];
void main() {
    if (atomicCounterIncrement(hits) == 0u) discard;
    atomicCounterIncrement(rest[2]);
    color = vec4(float(atomicCounterDecrement(rest[1]) + atomicCounter(hits)));
}
"""


@pytest.mark.parametrize("target", ["wgsl", "hlsl", "glsl-330"])
def test_atomic_counters_are_storage_buffers(target: str) -> None:
    module = load_glsl_text(COUNTERS, "case.frag").module
    assert [variable.name for variable in module.variables if variable.storage == "buffer"] == [
        "hitsCounter",
        "restCounter",
    ]
    emitted = next(iter(transpile(module, target, "case", keep=True).files.values()))
    assert compile_errors(emitted, target) == []
    if target == "wgsl":
        assert "    atomicAdd(&restCounter.rest[2], 1u);\n" in emitted
        assert "atomicAdd(&restCounter.rest[1], 0xffffffffu);" in emitted  # one less
        assert "- 1u + atomicLoad(&hitsCounter.hits)" in emitted  # the new value


def test_samples_that_a_target_lacks() -> None:
    text = "#version 320 es\nprecision highp float;\nout vec4 color;\nvoid main() { color = vec4(VALUE); }\n"
    for target, value in (
        ("glsl-es-300", "float(gl_SampleID)"),
        ("glsl-es-300", "float(gl_SampleMask[0] = 3)"),
        ("wgsl", "gl_SamplePosition, 0.0, 1.0"),
        ("hlsl", "gl_SamplePosition, 0.0, 1.0"),
    ):
        module = load_glsl_text(text.replace("VALUE", value), "case.frag").module
        with pytest.raises(SssgenError, match="a fragment shader of this target has no gl_Sample"):
            transpile(module, target, "case", keep=True)
