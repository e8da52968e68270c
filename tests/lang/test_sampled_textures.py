"""Textures with several samples to a texel: `sampler2DMS`."""

from __future__ import annotations

import numpy as np
import pytest

from qualification.suites.compiled_texts import complaint
from sssgen.lang.plain_glsl import load_glsl_text
from sssgen.pipeline.compiler import transpile
from sssgen.support.diagnostics import SssgenError
from sssgen.targets.numpy_runtime import Texture

FUNCTION = """vec4 resolved(sampler2DMS map, ivec2 at) {
    vec4 sum = vec4(0.0);
    for (int i = 0; i < 4; i++) { sum += texelFetch(map, at, i); }
    return sum / 4.0 + float(textureSize(map).x);
}
"""
SHADER = f"""#version 450
uniform sampler2DMS scene;
uniform usampler2DMS ids;
out vec4 color;
{FUNCTION}
void main() {{
    ivec2 at = min(ivec2(gl_FragCoord.xy), textureSize(scene) - 1);
    color = resolved(scene, at) + vec4(texelFetch(ids, at, 2));
}}
"""


@pytest.mark.parametrize("target", ["wgsl", "hlsl", "glsl-330"])
def test_compilers_accept_them(target: str) -> None:
    files = transpile(load_glsl_text(SHADER, "a.frag").module, target, "a").files
    assert complaint({name: text for name, text in files.items() if not name.endswith(".json")}) == ""


def test_other_targets_refuse_them() -> None:
    with pytest.raises(SssgenError, match="cannot supply 'scene': it has no sampler2DMS") as refusal:
        transpile(load_glsl_text(SHADER, "a.frag").module, "glsl-es-300", "a", keep=True)
    assert refusal.value.diagnostics[0].hint == "read a texture of another type, or choose another target"
    with pytest.raises(SssgenError, match=r"this target has no texelFetch \(tsl\)"):
        transpile(load_glsl_text(FUNCTION, "a.glsl").module, "tsl", "a")


def test_samples_are_layers_in_numpy() -> None:
    (text, *_) = transpile(load_glsl_text(FUNCTION, "a.glsl").module, "numpy", "a").files.values()
    space: dict[str, object] = {}
    exec(text, space)
    function = space["resolved"]
    assert callable(function)
    samples = np.arange(4 * 2 * 3, dtype=np.float64).reshape(4, 2, 3, 1)
    result = function(Texture(samples, layers=True), np.array([[2], [1]]))
    np.testing.assert_allclose(result[0], samples[:, 1, 2, 0].mean() + 3.0)
