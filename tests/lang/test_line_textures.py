"""Textures of one dimension are textures of two with one row, in every target."""

from __future__ import annotations

import numpy as np
import pytest

from qualification.suites.compiled_texts import complaint
from sssgen.lang.plain_glsl import load_glsl_text
from sssgen.pipeline.compiler import transpile
from sssgen.targets.numpy_runtime import Texture

HEAD = """#version 450
uniform sampler1D ramp;
uniform sampler1DArray ramps;
uniform sampler1DShadow depth;
uniform sampler1DArrayShadow depths;
uniform usampler1D ids;
layout(location = 0) in vec4 p;
layout(location = 0) out vec4 color;
"""
READS = {
    "texture(ramp, p.x)": "texture(ramp, vec2(p.x, 0.5))",
    "texture(ramp, 1)": "texture(ramp, vec2(1.0, 0.5))",
    "texture(ramp, p.x, 0.5)": "texture(ramp, vec2(p.x, 0.5), 0.5)",
    "texture(ramps, p.xy)": "texture(ramps, vec3(p.xy, 0.5).xzy)",
    "texture(depth, p.xyz)": "texture(depth, vec3(p.xz, 0.5).xzy)",
    "texture(depths, p.xyz)": "texture(depths, vec4(p.xyz, 0.5).xwyz)",
    "texture1DLod(ramp, p.x, 1.0)": "textureLod(ramp, vec2(p.x, 0.5), 1.0)",
    "textureGrad(ramp, p.x, p.y, p.z)": "textureGrad(ramp, vec2(p.x, 0.5), vec2(p.y, 0.0), vec2(p.z, 0.0))",
    "textureGradOffset(ramp, p.x, p.y, p.z, -1)":
        "textureGradOffset(ramp, vec2(p.x, 0.5), vec2(p.y, 0.0), vec2(p.z, 0.0), ivec2(-1, 0))",
    "textureOffset(ramps, p.xy, 1)": "textureOffset(ramps, vec3(p.xy, 0.5).xzy, ivec2(1, 0))",
    "textureLodOffset(ramp, p.x, 1.0, 2)": "textureLodOffset(ramp, vec2(p.x, 0.5), 1.0, ivec2(2, 0))",
    "textureProj(ramp, p)": "texture(ramp, vec2(p.x / p.w, 0.5))",
    "textureProj(depth, p)": "texture(depth, vec3((p.xyz / p.w).xz, 0.5).xzy)",
    "texelFetch(ids, 2, 0)": "texelFetch(ids, ivec2(2, 0), 0)",
    "texelFetch(ramps, ivec2(p), 0)": "texelFetch(ramps, ivec3(ivec2(p.xy), 0).xzy, 0)",
    "textureSize(ramp, 0)": "textureSize(ramp, 0).x",
    "textureSize(depths, 0).y": "textureSize(depths, 0).z",
    "textureQueryLod(ramp, p.x)": "textureQueryLod(ramp, vec2(p.x, 0.5))",
}  # fmt: skip
"""A read → the text in GLSL."""


def translated(text: str, target: str) -> dict[str, str]:
    return dict(transpile(load_glsl_text(text, "a.frag").module, target, "a").files)


def test_reads() -> None:
    for read, expected in READS.items():
        (text, *_) = translated(f"{HEAD}void main() {{ color = vec4(({read}).x); }}", "glsl-330").values()
        assert expected in text.replace("\n       ", ""), text


@pytest.mark.parametrize("target", ["wgsl", "hlsl", "glsl-330", "glsl-es-300"])
def test_compilers_accept_them(target: str) -> None:
    reads = [read for read in READS if target != "glsl-es-300" or "Query" not in read]
    own = "vec4 first(sampler1D map, float x) { return texture(map, x); }\n"
    lines = "".join(f"    color += vec4(({read}).x);\n" for read in reads)
    files = translated(f"{HEAD}{own}void main() {{\n    color = first(ramp, p.x);\n{lines}}}\n", target)
    assert complaint({name: text for name, text in files.items() if not name.endswith(".json")}) == ""


def test_a_value() -> None:
    module = load_glsl_text("uniform sampler1D ramp;\nfloat f(float x) { return texture(ramp, x).x; }", "a.glsl").module
    (text, *_) = transpile(module, "numpy", "a").files.values()
    space: dict[str, object] = {}
    exec(text, space)
    texture = Texture(np.arange(4.0).reshape(1, 4, 1), filter="linear")
    function = space["f"]
    assert callable(function)
    np.testing.assert_allclose(function(np.array([0.125, 0.25, 0.5]), ramp=texture), [0.0, 0.5, 1.5])


def test_the_program_is_told() -> None:
    warnings = [warning.message for warning in load_glsl_text(f"{HEAD}void main() {{ color = p; }}", "a.frag").warnings]
    assert warnings[-1] == "'ids' becomes a usampler2D: bind a texture of one row"
