"""Arrays, structs and integers in the interface of a stage: GLSL ES 3.00 has fewer, and programs name the rest."""

from __future__ import annotations

import pytest

from sssgen.lang.plain_glsl import load_glsl_text
from sssgen.pipeline.compiler import transpile
from sssgen.run.compilers import Stage
from whole_shaders import TARGETS, compile_errors

ATTRIBUTES = """#version 330
layout(location = 2) in mat2 bases[2];
in vec4 corners[2];
flat out int marks[2];
uniform int n;
void main() {
    gl_Position = corners[n] + vec4(bases[n][1], bases[0][0]);
    marks[n] = n;
}
"""
OUTPUTS = """#version 330
layout(location = 1) out vec4 colors[2];
uniform int n;
void put(int k) { colors[k] += vec4(0.5); }
void main() {
    colors[0] = vec4(0.0);
    colors[1] = vec4(1.0);
    if (n > 3) return;
    put(n);
}
"""
COMPONENTS = """#version 330
out vec4 color;
uniform int n;
void main() {
    color = vec4(0.0);
    for (int i = 0; i < n; i++) color[i & 3] += 0.25;
}
"""
LIGHTS = """#version 330
struct Fall { float near; vec2 steps[2]; };
struct Light { vec3 color; Fall fall; };
uniform Light lights[3];
uniform Light sun;
uniform float grid[2][3];
uniform int n;
out vec4 color;
void main() { color = vec4(lights[n].color * sun.fall.near, sun.fall.steps[1].x * grid[n][1]); }
"""
INTEGERS = """#version 330
in vec4 place;
out int kind;
out uvec2 kinds[2];
void main() {
    gl_Position = place;
    kind = int(place.x);
    kinds[0] = kinds[1] = uvec2(kind);
}
"""
STAGES: dict[str, tuple[str, Stage]] = {
    "attributes": (ATTRIBUTES, "vertex"),
    "outputs": (OUTPUTS, "fragment"),
    "components": (COMPONENTS, "fragment"),
    "lights": (LIGHTS, "fragment"),
    "integers": (INTEGERS, "vertex"),
}


def text_of(name: str, target: str) -> str:
    module = load_glsl_text(STAGES[name][0], f"{name}.{STAGES[name][1][:4]}").module
    return next(iter(transpile(module, target, name, keep=True).files.values()))


@pytest.mark.parametrize("target", TARGETS)
@pytest.mark.parametrize("name", STAGES)
def test_arrays_of_the_interface_compile(name: str, target: str) -> None:
    text = text_of(name, target)
    assert compile_errors(text, target, STAGES[name][1]) == [], text


def test_es_has_an_attribute_for_each_element() -> None:
    text = text_of("attributes", "glsl-es-300")
    assert "layout(location = 2) in mat2 bases_0;\nlayout(location = 4) in mat2 bases_1;" in text
    assert "bases[1] = bases_1;" in text
    assert "in vec4 corners[2];" in text_of("attributes", "glsl-330")


def test_es_copies_outputs_at_every_end() -> None:
    text = text_of("outputs", "glsl-es-300")
    assert text.count("colors[1] = colors_values[1];") == 2
    assert "colors_values[k] += vec4(0.5);" in text
    assert "colors[k] += vec4(0.5);" in text_of("outputs", "glsl-330")


@pytest.mark.parametrize("target", ["glsl-330", "glsl-es-300"])
def test_glsl_keeps_uniforms_of_structs(target: str) -> None:
    """A program sets `lights[0].fall.near` by that name."""
    text = text_of("lights", target)
    assert "uniform Light lights[3];\nuniform Light sun;" in text
    assert "uniform float grid[6];" in text
