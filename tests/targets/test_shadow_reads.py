"""Comparing reads with given derivatives: the numbers of every back end that can bind such a texture."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from results_of_glsl import check_results
from sssgen.harness.backends import Backend
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
