"""Storage buffers that HLSL has as bytes: DXC's SPIR-V and WGSL write the same numbers at the same places."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from sssgen.lang.plain_glsl import load_glsl_text
from sssgen.pipeline.compiler import transpile
from sssgen.run.backends import Backend, Text
from sssgen.run.backends.dispatch import Dispatch, by_opengl, by_webgpu
from sssgen.run.compilers import get
from sssgen.support.diagnostics import SssgenError

KERNEL = """#version 450
layout(local_size_x = 4) in;
struct Ray { float far; vec3 way; int hits[3]; };
layout(LAYOUT, binding = 0) buffer Scene {
    uint count; Ray first; mat3 turn; mat2x4 wide; vec3 list[4]; ivec2 pair; Ray rays[];
} scene;
layout(LAYOUT, binding = 1) readonly buffer Given { int offset; vec3 color; } given;
void move(inout Ray ray, out float far) { ray.way += vec3(1.0, 2.0, 3.0); ray.hits[1] = 7; far = ray.far * 2.0; }
void main() {
    uint at = gl_GlobalInvocationID.x;
    scene.rays[at].way.xz = vec2(float(at), 4.0) + given.color.yx;
    scene.rays[at].hits[int(at) % 3] -= given.offset;
    move(scene.rays[at], scene.list[at].y);
    scene.list[at][int(at) % 2 * 2] = 5.5;
    atomicAdd(scene.count, at + 1u);
    if (at == 2u) {
        scene.turn *= 2.0;
        scene.wide[1] = scene.wide[0].wzyx;
        scene.turn[1].yz += vec2(0.5);
        scene.first = scene.rays[3];
        scene.first.hits[2] = scene.rays.length();
        int old = atomicExchange(scene.pair.y, -9);
        scene.pair.x = old;
    }
    for (int i = 0; i < 3; scene.rays[at].hits[2]++, i++) {}
}
"""


def translation(target: str, layout: str) -> tuple[str, dict[str, Any]]:
    module = load_glsl_text(KERNEL.replace("LAYOUT", layout), "kernel.comp").module
    result = transpile(module, target, "kernel", keep=True)
    return next(iter(result.files.values())), dict(result.reflection)


def with_low_bindings(module: bytes) -> bytes:
    """SPIR-V of compushady's DXC, which has the registers t from 1024 and u from 2048 on, with bindings below these."""
    words = np.frombuffer(module, np.uint32).copy()
    at = 5
    while at < len(words):
        if words[at] & 0xFFFF == 71 and words[at + 2] == 33:  # OpDecorate … Binding
            words[at + 3] %= 1024
        at += int(words[at]) >> 16
    return words.tobytes()


@pytest.mark.parametrize("layout", ["std430", "std140"])
def test_hlsl_writes_what_opengl_writes(layout: str, backend: Callable[[str], Backend]) -> None:
    gpu: Any = backend("webgpu")
    gl: Any = backend("gl")
    text, reflection = translation("hlsl", layout)
    assert "RWByteAddressBuffer scene" in text and "ByteAddressBuffer given" in text
    dxc: Any = get("dxc")
    module = with_low_bindings(dxc.spirv(text, "compute", "compute_main"))
    rng = np.random.default_rng(3)
    places = {member["name"]: member for member in reflection["storage_buffers"][0]["members"]}
    size = places["rays"]["offset"] + 4 * places["rays"]["stride"]
    words = rng.integers(1, 50, size // 4).astype(np.float32)
    for name in ("count", "pair"):
        at = places[name]["offset"] // 4
        words.view(np.int32)[at : at + 2 if name == "pair" else at + 1] = 3
    given = np.array([2, 0, 0, 0, 0, 0, 0, 0], np.int32)
    given.view(np.float32)[4:7] = [0.25, 0.5, 0.75]
    buffers = {"Scene": words, "Given": given}
    bindings = {"Scene": 0, "Given": 1}
    head = Dispatch(
        Text(module),
        (1, 1, 1),
        (4, 1, 1),
        buffers,
        bindings,
        "compute_main",
        {},
        group=0,
        readonly=frozenset({"Given"}),
    )
    from_hlsl = by_webgpu(gpu, head)["Scene"]
    own, _ = translation("glsl-330", layout)
    expected = by_opengl(gl, head._replace(text=Text(own), entry="main"))["Scene"]
    np.testing.assert_array_equal(from_hlsl.view(np.uint32), expected.view(np.uint32))
    assert (from_hlsl != words).sum() > 20


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ("scene.rays[at].way.xz =", "copied as a whole"),
        ("atomicExchange(scene.pair.y", "compares as uint"),
    ],
)
def test_what_bytes_cannot_do(change: str, message: str) -> None:
    replaced = {
        "scene.rays[at].way.xz =": "vec3 whole[4] = scene.list; scene.rays[at].way.xz = whole[1].xy +",
        "atomicExchange(scene.pair.y": "atomicMin(scene.pair.y",
    }[change]
    module = load_glsl_text(KERNEL.replace("LAYOUT", "std430").replace(change, replaced), "kernel.comp").module
    with pytest.raises(SssgenError, match=message):
        transpile(module, "hlsl", "kernel", keep=True)
