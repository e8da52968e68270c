"""Constants without a value: WGSL's compilers accept the text, and what does not depend on them is as it was."""

from __future__ import annotations

import pytest

from sssgen.lang.plain_glsl import load_glsl_text
from sssgen.pipeline.compiler import transpile
from whole_shaders import compile_errors

SHADER = """#version 310 es
precision highp float;
const float inf = 1.0 / 0.0;
const float twice = inf * 2.0;
const vec2 kept = vec2(1.0, 2.0);
float own = log2(-8.9);
out vec4 color;
void main() {
    const float k = cosh(800.0);
    int i = int(gl_FragCoord.x);
    i /= 0;
    i = (i << 33) + (1 << 32);
    color = vec4(k, mod(5.0, 0.0), intBitsToFloat(-1), own) + twice + float(i) + kept.xyxy;
    if (gl_FragCoord.x > 5.0 / 0.0 - inf) { discard; }
}
"""


def wgsl(text: str) -> str:
    return next(iter(transpile(load_glsl_text(text, "a.frag").module, "wgsl", "a", keep=True).files.values()))


def test_compilers_accept_the_text() -> None:
    text = wgsl(SHADER)
    assert compile_errors(text, "wgsl", "fragment") == []
    assert "const kept: vec2f = vec2f(1.0, 2.0);" in text
    assert "twice = inf * 2.0;" in text
    assert text.count("f32 = 0.0;") == 1  # equal operands share a variable


def test_a_number_beyond_the_floats_is_infinity() -> None:
    text = "float f(float x) { return x < 1.0e40 ? -1e100 : 3.4e38; }\n"
    module = load_glsl_text(text, "a.glsl").module
    glsl, own = (
        next(iter(transpile(module, target, "a", keep=True).files.values())) for target in ("glsl-330", "wgsl")
    )
    assert "x < 1.0 / 0.0 ? -(1.0 / 0.0) : 3.4e38" in glsl
    assert "x < late / late_2" in own
    assert compile_errors(own, "wgsl", "library") == []


@pytest.mark.parametrize(
    ("call", "expected"),
    [
        ("smoothstep(1.0, 1.0, x)", "smoothstep(late, late, x)"),
        ("smoothstep(2.0, 1.0, x)", "smoothstep(late, late_2, x)"),
        ("smoothstep(1.0, 2.0, x)", "smoothstep(1.0, 2.0, x)"),
        ("clamp(x, 1.0, 0.0)", "clamp(x, late, late_2)"),
        ("clamp(x, 0.0, 1.0)", "clamp(x, 0.0, 1.0)"),
    ],
)
def test_arguments_that_compilers_check_by_themselves(call: str, expected: str) -> None:
    text = wgsl(f"#version 400\nfloat f(float x) {{ return {call}; }}\n")
    assert f"return {expected};" in text
    assert compile_errors(text, "wgsl", "library") == []
