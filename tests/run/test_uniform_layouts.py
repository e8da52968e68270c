"""Uniforms of plain GLSL are read at the offsets of the reflection: matrices that are not square, arrays of arrays."""

from __future__ import annotations

import re
from collections.abc import Callable

import numpy as np
import pytest

from sssgen.ir.nodes import Module
from sssgen.ir.types import BY_NAME, VEC2, VEC4, column_size, components
from sssgen.lang.plain_glsl import load_glsl_text
from sssgen.pipeline.compiler import transpile
from sssgen.run.backends import Backend, Block, Call, DrawingBackend, Place, Text
from sssgen.run.backends.call_program import drawing, results

PROBE = """#version 450 core
uniform mat2x3 a; uniform float b; uniform mat3x4 c; uniform mat4x2 d[2]; uniform vec3 e; uniform mat4x3 f[2];
uniform float g[3][2]; uniform vec3 h[2][2]; uniform mat3x2 k[2][2]; uniform mat2x4 m; uniform vec2 n;
out vec4 color;

vec4 probe(vec2 uv) {
    int i = int(uv.x);
    int j = int(uv.y);
    if (i == 0) { return vec4(a * vec2(1.0, 2.0), b); }
    if (i == 1) { return c * vec3(1.0, 2.0, 3.0); }
    if (i == 2) { return vec4(d[j] * vec4(1.0, 2.0, 3.0, 4.0), e.xy); }
    if (i == 3) { return vec4(f[j] * vec4(1.0, 2.0, 3.0, 4.0), f[0][3].z); }
    if (i == 4) { return vec4(g[j][0], g[j + 1][1], g[2][j], g[0][1]); }
    if (i == 5) { return vec4(h[j][0] + h[1][j] * 10.0, e.z); }
    if (i == 6) { return vec4(k[j][0] * vec3(1.0, 2.0, 3.0), k[1][j][2]); }
    return vec4(m * n);
}

void main() { color = probe(gl_FragCoord.xy); }
"""


@pytest.mark.parametrize("name", ["gl", "gl-es", "webgpu", "hlsl-glslang", "hlsl"])
def test_oblong_matrices_and_nested_arrays(name: str, backend: Callable[[str], Backend]) -> None:
    gpu = backend(name)
    assert isinstance(gpu, DrawingBackend)
    module = load_glsl_text(PROBE, "probe.frag").module
    compiled = transpile(module, gpu.target.name, "probe", keep=True)
    text = re.split(r"(?m)^(?:void main|@fragment|float4 fragment_main)", next(iter(compiled.files.values())))[0]
    text = re.sub(r"(?m)^(#version|precision|out|in) .*\n", "", text)
    uv = np.array(np.meshgrid(np.arange(8), np.arange(2))).reshape(2, -1) + 0.5
    call = Call("probe", (VEC2,), VEC4, (uv,))
    bare, layout = drawing(gpu.target, Text(text), [call], {})
    block = np.zeros((compiled.reflection["uniform_block_size"] or 0) // 4, np.float32)
    values = {}
    functions: dict[str, object] = {}
    for number, uniform in enumerate(compiled.reflection["uniforms"]):
        base, *lengths = uniform["type"].replace("]", "").split("[")
        type_ = BY_NAME[base]
        count = components(type_) * int(np.prod([int(length) for length in lengths]))
        numbers = np.arange(1, count + 1, dtype=np.float32) + 10 * number
        values[uniform["name"]] = numbers
        for place, column in enumerate(numbers.reshape(-1, column_size(type_))):
            if "offset" in uniform:
                start = uniform["offset"] // 4 + 4 * place
                block[start : start + len(column)] = column
    blocks = {"Material": Block(block.tobytes(), Place(gpu.target.material_group, 0))} if block.size else {}
    (actual,) = results([call], layout, gpu.draw(bare._replace(blocks=blocks, values=values)))
    exec(next(iter(transpile(_functions(), "numpy", "probe").files.values())), functions)
    shapes = {"a": (2, 3), "b": (), "c": (3, 4), "d": (2, 4, 2), "e": (3,), "f": (2, 4, 3), "g": (6,), "h": (4, 3),
              "k": (4, 3, 2), "m": (2, 4), "n": (2,)}  # fmt: skip
    expected = functions["probe"](uv, **{name: values[name].reshape(*shape, 1) for name, shape in shapes.items()})
    np.testing.assert_allclose(actual, np.broadcast_to(expected, (4, 16)), rtol=1e-6)


def _functions() -> Module:
    return load_glsl_text(PROBE.replace("out vec4 color;", "").split("void main")[0], "probe.glsl").module
