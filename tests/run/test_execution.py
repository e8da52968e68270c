"""Runs whole functions on real back ends and compares them with the numpy target; sets uniforms by their offsets."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import sssgen
from against_numpy import (
    DTYPES,
    Array,
    arguments,
    differences,
    random_per_quad,
    textures,
    transpiled,
)
from against_numpy import random_argument as random_argument
from pitfall_cases import program as pitfalls
from sssgen.ir.types import BY_NAME, VEC2, VEC4, Sampler, Type, column_size, components, kind_of
from sssgen.lang.loader import load_file
from sssgen.run.backends import Backend, Block, Call, DrawingBackend, Place, Text
from sssgen.run.backends.call_program import drawing, results
from sssgen.run.evaluate.evaluation import shape_of

LANES = 12
TARGETS = ["gl", "gl-es", "webgpu", "hlsl-glslang", "hlsl", "unity"]


@pytest.fixture(params=TARGETS)
def gpu(request: pytest.FixtureRequest, backend: Callable[[str], Backend]) -> Backend:
    """Each back end that draws."""
    return backend(request.param)


# Whole functions


def test_pitfalls(gpu: Backend) -> None:
    """The function of each case is compared with its text for the numpy target."""
    module, functions = pitfalls()
    calls = []
    for case, function in functions:
        params = tuple(param.type for param in function.params)
        textured = any(isinstance(type_, Sampler) for type_ in params)
        args = arguments(function, random_per_quad if textured else random_argument, LANES)
        calls.append((case.source, Call(function.name, params, function.result, args)))
    failures = differences(gpu, module, calls, textures())
    assert not failures, "\n\n".join(failures)


# Uniforms

PROBE = """
uniform float a; uniform vec3 b; uniform vec2 c; uniform bool d; uniform float e; uniform mat3 f; uniform vec3 g;
uniform int h; uniform mat2 k; uniform uint m; uniform vec4 n; uniform float o[3]; uniform vec2 q[2]; uniform mat4 r;
uniform bvec2 s; uniform float t; uniform mat3 u[2]; uniform mat2 v[2]; uniform bool w[2]; uniform float z;

float total(float values[3]) { return values[0] + 2.0 * values[1] + 3.0 * values[2]; }

/** Returns the uniforms in turn.
role: lighting
*/
vec3 layout_probe(uv_position uv) {
    int i = int(uv.x);
    int j = int(uv.y);
    if (i == 0) { return vec3(a, c); }
    if (i == 1) { return b; }
    if (i == 2) { return vec3(d ? 1.0 : 0.0, e, float(h)); }
    if (i == 3) { return f[0] + f[1] * 10.0 + f[2] * 100.0; }
    if (i == 4) { return f * vec3(1.0, 2.0, 3.0); }
    if (i == 5) { return g; }
    if (i == 6) { return vec3(k * vec2(1.0, 2.0), float(m)); }
    if (i == 7) { return n.xyz + n.w; }
    if (i == 8) { return vec3(o[j], o[1], total(o)); }
    if (i == 9) { return vec3(q[0] + q[1] * 10.0, q[j].y); }
    if (i == 10) { return (r * vec4(1.0, 2.0, 3.0, 4.0)).xyz; }
    if (i == 11) { return vec3(s, t); }
    if (i == 12) { return u[j] * vec3(1.0, 2.0, 3.0) + u[0][2]; }
    if (i == 13) { return vec3(v[j] * vec2(1.0, 2.0), v[1][1].x); }
    return vec3(w[0] ? 1.0 : 0.0, w[j] ? 1.0 : 0.0, z);
}
"""
MATERIAL = '[material]\nname = "layout"\nshading = "unlit"\n[lighting]\ntechnique = "layout_probe.sss"\n'


def uniforms_of(reflection: dict[str, Any]) -> tuple[bytes, dict[str, tuple[float, ...]]]:
    """Different numbers for all components: a block with the offsets of the reflection, and values by name."""
    block = np.zeros((reflection["uniform_block_size"] or 0) // 4, np.uint32)
    values: dict[str, tuple[float, ...]] = {}
    for number, uniform in enumerate(sorted(reflection["uniforms"], key=lambda uniform: str(uniform["name"]))):
        base, _, length = uniform["type"].rstrip("]").partition("[")
        type_ = BY_NAME[base]
        count = components(type_) * int(length or 1)
        kind = kind_of(type_)
        inputs = np.arange(1, count + 1) + 10 * number if kind != "bool" else np.arange(1, count + 1) % 2
        values[uniform["name"]] = tuple(inputs.tolist())
        if "offset" in uniform:  # std140 uses 16 bytes for each column and each element
            rows = inputs.astype(DTYPES[kind]).astype(np.float32 if kind == "float" else np.int32)
            size = column_size(type_)
            for place, row in enumerate(rows.reshape(-1, size)):
                start = uniform["offset"] // 4 + 4 * place
                block[start : start + size] = row.view(np.uint32)
    return block.tobytes(), values


@pytest.mark.parametrize(
    "gpu", [name for name in TARGETS if name != "unity"], indirect=True
)  # unity has no uniform block
def test_uniforms_have_the_offsets_of_the_reflection(gpu: Backend, tmp_path: Path) -> None:
    (tmp_path / "layout_probe.sss").write_text(PROBE, encoding="utf-8")
    (tmp_path / "layout.toml").write_text(MATERIAL, encoding="utf-8")
    compiled = sssgen.compile(tmp_path / "layout.toml", gpu.target.name)
    text = next(text for name, text in compiled.files.items() if not name.endswith((".json", ".vert")))
    text = re.sub(r"(?m)^(#version|precision|in|out) .*\n", "", text.partition("void main()")[0])
    uv = np.array(np.meshgrid(np.arange(15), np.arange(2))).reshape(2, -1) + 0.5
    call = Call(compiled.reflection["entries"]["color"]["function"], (VEC2,), VEC4, (uv,))
    block, values = uniforms_of(compiled.reflection)
    assert isinstance(gpu, DrawingBackend)
    bare, layout = drawing(gpu.target, Text(text), [call], {})
    blocks = {"Material": Block(block, Place(gpu.target.material_group, 0))} if block else {}
    filled = bare._replace(blocks=blocks, values={name: np.array(value) for name, value in values.items()})
    (actual,) = results([call], layout, gpu.draw(filled))

    names: dict[str, Any] = {}
    exec(transpiled(load_file(tmp_path / "layout_probe.sss"), "numpy"), names)
    expected = names["layout_probe"](uv, **{
        name: in_layout(BY_NAME[type_.partition("[")[0]], "[" in type_, values[name])
        for name, type_ in ((uniform["name"], uniform["type"]) for uniform in compiled.reflection["uniforms"])
    })  # fmt: skip
    np.testing.assert_allclose(actual[:3], np.broadcast_to(expected, (3, 30)), rtol=1e-6)


def in_layout(type_: Type, is_array: bool, numbers: tuple[float, ...]) -> Array:
    """The numbers of a uniform in the layout of the numpy target, for one lane."""
    dtype = np.float64 if kind_of(type_) == "float" else DTYPES[kind_of(type_)]
    return np.array(numbers, dtype).reshape(*([-1] if is_array else []), *shape_of(type_), 1)
