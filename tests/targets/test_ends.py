"""Loops that nothing leaves compile in every language; they are not executed."""

from __future__ import annotations

import pytest

from sssgen.lang.plain_glsl import load_glsl_text
from sssgen.pipeline.compiler import transpile
from whole_shaders import TARGETS, compile_errors

ENDLESS = """#version 300 es
precision highp float;
uniform int rounds;
out vec4 color;
float never(float x) {
    for (;;) {
        x += 1.0;
        if (x > 5.0) continue;
        while (x > 3.0) {
            if (x > 4.0) break;
            x += 1.0;
        }
    }
    return x;
}
void main() {
    color = vec4(1.0);
    if (rounds > 100) color.x = never(2.0);
    if (rounds > 200) for (;;) {}
}
"""


@pytest.mark.parametrize("target", TARGETS)
def test_a_loop_without_an_exit_compiles(target: str) -> None:
    module = load_glsl_text(ENDLESS, "endless.frag").module
    text = next(iter(transpile(module, target, "endless", keep=True).files.values()))
    assert compile_errors(text, target) == [], text
