"""Loops that nothing leaves, statements that nothing reaches, and what exceeds the limits of compilers: they compile in
every language. Not executed."""

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


LARGE = """#version 310 es
precision highp float;
out vec4 color;
uniform Block { vec4 first; } INSTANCE;
void main() {
    mat3 unused[3][101][88];
    color = INSTANCE.first * float(unused[0].length());
}
""".replace("INSTANCE", "a" * 1024)


UNREACHED = """#version 300 es
precision highp float;
uniform int choice;
out vec4 color;
float chosen(float x) {
    for (int i = 0; i < choice; i++) {
        if (i == 2) { break; } else { continue; }
        x += 1.0;
    }
    if (choice > 3) {
        return x;
    } else {
        if (choice < 1) { return 2.0 * x; } else { return 3.0 * x; }
        x = 1.0;
    }
}
void main() { color = vec4(chosen(2.0)); }
"""


@pytest.mark.parametrize("target", TARGETS)
@pytest.mark.parametrize("source", [ENDLESS, LARGE, UNREACHED], ids=["endless", "large", "unreached"])
def test_the_text_compiles(source: str, target: str) -> None:
    module = load_glsl_text(source, "limits.frag").module
    text = next(iter(transpile(module, target, "limits", keep=True).files.values()))
    assert compile_errors(text, target) == [], text
