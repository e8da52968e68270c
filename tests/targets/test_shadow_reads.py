"""Reads of textures that compare, and of layers with offsets: the numbers of every back end that can bind such a
texture."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Literal

import numpy as np
import pytest

from results_of_glsl import check_results
from sssgen.lang.plain_glsl import load_glsl_text
from sssgen.pipeline.compiler import transpile
from sssgen.run.backends import Backend
from sssgen.run.compilers import Source
from sssgen.support.diagnostics import SssgenError
from sssgen.targets.runtime.numpy_textures import Texture

DEPTHS = np.array([[0.1, 0.4], [0.6, 0.9]], np.float32)[..., None]
TEXTURES = {
    "flat": Texture(DEPTHS, "nearest", "clamp", compare=True),
    "cube": Texture(np.full((6, 2, 2, 1), 0.5, np.float32), dim="Cube", compare=True),
    "layers": Texture(np.stack([DEPTHS, DEPTHS * 0.0 + 0.2]), "nearest", "clamp", layers=True, compare=True),
}
ALL, SOME = ("numpy", "gl", "gl-es", "webgpu", "hlsl", "hlsl-glslang"), ("numpy", "webgpu")
CASES = [
    ("sampler2DShadow map", "flat", "textureGrad(map, vec3(0.25, 0.75, x), vec2(0.0), vec2(0.0))", 0.5, 1.0, ALL),
    ("sampler2DShadow map", "flat", "textureGrad(map, vec3(0.25, 0.25, x), vec2(0.0), vec2(0.0))", 0.5, 0.0, ALL),
    ("samplerCubeShadow map", "cube", "textureGrad(map, vec4(1.0, 0.2, 0.1, x), vec3(0.0), vec3(0.0))", 0.4, 1.0, SOME),
    ("samplerCubeShadow map", "cube", "textureGrad(map, vec4(1.0, 0.2, 0.1, x), vec3(0.0), vec3(0.0))", 0.6, 0.0, SOME),
    ("sampler2DArrayShadow map", "layers", "textureGrad(map, vec4(0.2, 0.8, 0.0, x), vec2(0.0), vec2(0.0))", 0.5, 1.0,
     SOME),
    ("sampler2DArrayShadow map", "layers", "textureGrad(map, vec4(0.2, 0.8, 1.0, x), vec2(0.0), vec2(0.0))", 0.5, 0.0,
     SOME),
]  # fmt: skip


@pytest.mark.parametrize(("param", "texture", "read", "reference", "expected", "backends"), CASES)
def test_gradients_of_comparing_reads(
    param: str, texture: str, read: str, reference: float, expected: float, backends: tuple[str, ...],
    backend: Callable[[str], Backend],
) -> None:  # fmt: skip
    text = f"float f({param}, float x) {{ return {read}; }}"
    check_results(text, expected, backend, [reference], {"map": TEXTURES[texture]}, backends)


COLORS = np.arange(32, dtype=np.float32).reshape(2, 2, 2, 4)  # layer, row, column, channel
LAYERED = {"map": Texture(COLORS, "nearest", "clamp", layers=True)}
OFFSET_CASES = [
    # texel (0, 0) of a 2×2 texture with the offset (1, 1) is texel (1, 1), with the depth 0.9
    ("sampler2DShadow", "flat", "textureOffset(map, vec3(0.25, 0.25, x), ivec2(1, 1))", 0.8, 1.0, ALL),
    ("sampler2DShadow", "flat", "textureOffset(map, vec3(0.25, 0.25, x), ivec2(1, 0))", 0.8, 0.0, ALL),
    ("sampler2DShadow", "flat", "textureLodOffset(map, vec3(0.25, 0.25, x), 0.0, ivec2(0, 1))", 0.5, 1.0, ALL),
    ("sampler2DShadow", "flat", "textureGradOffset(map, vec3(0.25, 0.75, x), vec2(0), vec2(0), ivec2(0, -1))", 0.5, 0.0,
     ALL),
    ("sampler2DArrayShadow", "layers", "textureOffset(map, vec4(0.25, 0.25, 0.0, x), ivec2(1, 1))", 0.8, 1.0, SOME),
    ("sampler2DArrayShadow", "layers", "textureOffset(map, vec4(0.25, 0.25, 1.0, x), ivec2(1, 1))", 0.8, 0.0, SOME),
    ("sampler2DArrayShadow", "layers",
     "textureGradOffset(map, vec4(0.25, 0.25, 0.0, x), vec2(0), vec2(0), ivec2(0, 1))", 0.5, 1.0, SOME),
]  # fmt: skip
GATHER_CASES = [
    # the order is that of GLSL: (0, 1), (1, 1), (1, 0), (0, 0), here the depths 0.6, 0.9, 0.4, 0.1
    ("sampler2DShadow", "flat", "textureGather(map, vec2(0.5), x)", 0.5, (1, 1, 0, 0), ALL),
    ("sampler2DShadow", "flat", "textureGather(map, vec2(0.5), x)", 0.3, (1, 1, 1, 0), ALL),
    ("sampler2DShadow", "flat", "textureGatherOffset(map, vec2(0.5), x, ivec2(0, 1))", 0.7, (0, 1, 1, 0), ALL),
    ("samplerCubeShadow", "cube", "textureGather(map, vec3(1.0, 0.2, 0.1), x)", 0.4, (1, 1, 1, 1), SOME),
    ("samplerCubeShadow", "cube", "textureGather(map, vec3(1.0, 0.2, 0.1), x)", 0.6, (0, 0, 0, 0), SOME),
    ("sampler2DArrayShadow", "layers", "textureGather(map, vec3(0.5, 0.5, 0.0), x)", 0.5, (1, 1, 0, 0), SOME),
    ("sampler2DArrayShadow", "layers", "textureGather(map, vec3(0.5, 0.5, 1.0), x)", 0.15, (1, 1, 1, 1), SOME),
    ("sampler2DArrayShadow", "layers", "textureGatherOffset(map, vec3(0.5, 0.5, 0.0), x, ivec2(0, 1))", 0.7,
     (0, 1, 1, 0), SOME),
]  # fmt: skip
LAYER_CASES = [
    # channel c of texel (column, row) of a layer is 16 * layer + 8 * row + 4 * column + c
    ("textureOffset(map, vec3(0.25, 0.25, 1.0), ivec2(1, 0)).y", 21),
    ("textureOffset(map, vec3(x, 0.25, 1.0) * 1.0, ivec2(0, 1)).x", 24),
    ("textureOffset(map, vec3(0.25, 0.25, 1.0), ivec2(1, 0), 0.5).y", 21),
    ("textureLodOffset(map, vec3(x, 0.25, 0.0), 0.0, ivec2(1, 1)).z", 14),
    ("textureGradOffset(map, vec3(x, 0.25, 1.0), vec2(0.0), vec2(0.0), ivec2(1, 0)).w", 23),
    ("texelFetchOffset(map, ivec3(0, 1, 1), 0, ivec2(1, -1)).x", 20),
    ("dot(textureGather(map, vec3(0.5, 0.5, 1.0)), vec4(1.0, 10.0, 100.0, 1000.0))", 24 + 280 + 2000 + 16000),
    ("dot(textureGather(map, vec3(0.5, 0.5, 0.0), 2), vec4(1.0, 10.0, 100.0, 1000.0))", 10 + 140 + 600 + 2000),
    ("textureGatherOffset(map, vec3(0.5, 0.5, 0.0), ivec2(0, 1), 3).z", 15),
]


@pytest.mark.parametrize(("sampler", "texture", "read", "reference", "expected", "backends"), OFFSET_CASES)
def test_offsets_of_comparing_reads(
    sampler: str, texture: str, read: str, reference: float, expected: float, backends: tuple[str, ...],
    backend: Callable[[str], Backend],
) -> None:  # fmt: skip
    text = f"float f({sampler} map, float x) {{ return {read}; }}"
    check_results(text, expected, backend, [reference], {"map": TEXTURES[texture]}, backends)


@pytest.mark.parametrize(("sampler", "texture", "read", "reference", "expected", "backends"), GATHER_CASES)
def test_gathers_of_comparing_textures(
    sampler: str, texture: str, read: str, reference: float, expected: tuple[int, ...], backends: tuple[str, ...],
    backend: Callable[[str], Backend],
) -> None:  # fmt: skip
    text = f"vec4 f({sampler} map, float x) {{ return {read}; }}"
    check_results(text, expected, backend, [reference], {"map": TEXTURES[texture]}, backends)


@pytest.mark.parametrize(("read", "expected"), LAYER_CASES)
def test_offsets_and_gathers_of_layers(read: str, expected: float, backend: Callable[[str], Backend]) -> None:
    check_results(f"float f(sampler2DArray map, float x) {{ return {read}; }}", expected, backend, [0.25], LAYERED, ALL)


@pytest.mark.parametrize("target", ["glsl-330", "hlsl", "wgsl"])
def test_a_coordinate_is_evaluated_once(target: str) -> None:
    """The languages need the parts of the coordinate; the offset stays constant."""
    text = """
        float calls = 0.0;
        vec4 place(float x) { calls += 1.0; return vec4(0.25, 0.25, 0.0, x); }
        float f(sampler2DArrayShadow map, float x) { return textureOffset(map, place(x), ivec2(1, 1)); }
    """
    emitted = transpile(load_glsl_text(text, "case.glsl").module, target, "case", keep=True).files
    (output,) = [content for name, content in emitted.items() if not name.endswith(".json")]
    assert len(re.findall(r"= place\(", output)) == 1 == len(re.findall(r"(?:int2|ivec2|vec2i)\(?1|\(int2\)1", output))


@pytest.mark.parametrize("constant", ["const ivec2 D = ivec2(1, 0); const int C = 2;", ""])
def test_constants_in_variables(constant: str, backend: Callable[[str], Backend]) -> None:
    """Also in local ones: these are no constant expressions in WGSL, and HLSL has the channel in the method's name."""
    inside = "" if constant else "const ivec2 D = ivec2(1, 0); const int C = 1 + 1;"
    text = f"""
        {constant}
        float f(sampler2DArray map, float x) {{
            {inside}
            return textureOffset(map, vec3(x, x, 0.0), D).x + 100.0 * textureGather(map, vec3(0.5, 0.5, 0.0), C).w;
        }}
    """
    check_results(text, 4.0 + 200.0, backend, [0.25], LAYERED, ALL)


@pytest.mark.parametrize(
    ("read", "message"),
    [
        ("textureOffset(map, p, ivec2(i))", "the offset of textureOffset must be a constant expression"),
        ("textureOffset(map, p, ivec2(8, 0))", "the offset of textureOffset must be in -8..7"),
        ("textureGather(map, p, i)", "the channel of textureGather must be a constant expression"),
        ("textureGather(map, p, 4)", "the channel of textureGather must be in 0..3"),
        ("texelFetchOffset(map, ivec3(p), 0, ivec2(-9))", "the offset of texelFetchOffset must be in -8..7"),
    ],
)
def test_offsets_and_channels_are_constants(read: str, message: str) -> None:
    with pytest.raises(SssgenError) as caught:
        load_glsl_text(f"vec4 f(sampler2DArray map, vec3 p, int i) {{\n return {read};\n}}", "case.glsl")
    (error,) = caught.value.diagnostics
    assert (error.message, error.span.line) == (message, 2)


@pytest.mark.parametrize("target", ["hlsl", "wgsl", "glsl-330", "glsl-es-300"])
@pytest.mark.parametrize(
    "read",
    ["texture(map, vec4(0.5))", "textureOffset(map, vec4(0.5), ivec2(1))"],
)
@pytest.mark.parametrize("stage", ["vert", "frag"])
def test_comparing_reads_without_neighbours(
    target: str, read: str, stage: str, assert_compiles: Callable[[Source], None]
) -> None:
    """In a vertex shader, and where pixels diverge."""
    out, value = ("gl_Position", "") if stage == "vert" else ("color", "out vec4 color;")
    text = f"""#version 330
        uniform sampler2DArrayShadow map;
        in float x;
        {value}
        void main() {{ {out} = vec4(0.0); if (x > 0.5) {{ {out} = vec4({read}); }} }}
    """
    emitted = transpile(load_glsl_text(text, f"case.{stage}").module, target, "case", keep=True)
    (shader,) = [content for name, content in emitted.files.items() if not name.endswith(".json")]
    kind: Literal["vertex", "fragment"] = "vertex" if stage == "vert" else "fragment"
    entry = f"{kind}_main" if target in ("hlsl", "wgsl") else "main"
    assert_compiles(Source(shader, target, kind, entry, f"case.{stage}"))
