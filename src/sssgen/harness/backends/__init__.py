"""The machines that run emitted shaders, behind one interface: compile, run, arrays back.

    gpu = backends.get("gl")
    sums, = gpu.run(Text(text), [Call("add", (FLOAT, VEC3), VEC3, (x, y))])

Each is started once a process and keeps what it has compiled.
"""

from __future__ import annotations

from functools import cache

from sssgen.harness.backends.backend_interface import (
    Array,
    Backend,
    Block,
    Bound,
    Call,
    Drawing,
    Place,
    Stage,
    Text,
    emitted,
)
from sssgen.harness.backends.draw_backend import DrawingBackend
from sssgen.harness.compilers import CompilerMissing
from sssgen.support.diagnostics import did_you_mean, failure

__all__ = [
    "HALF", "NAMES", "Array", "Backend", "Block", "Bound", "Call", "CompilerMissing", "Drawing", "DrawingBackend",
    "Place", "Stage", "Text", "available", "chosen", "emitted", "get", "in_half", "missing", "needed",
]  # fmt: skip

NAMES = {
    "numpy": "the oracle: NumPy in float64",
    "numpy-f32": "the same in float32",
    "numpy-f16": "the same in float16",
    "gl": "GLSL 3.30 in OpenGL",
    "gl-es": "GLSL ES 3.00 in OpenGL",
    "webgpu": "WGSL through naga, in wgpu",
    "webgpu-f16": "the same in half precision",
    "browser": "WGSL through Tint, in a headless Chromium",
    "hlsl": "HLSL through DXC and SPIR-V, in OpenGL",
    "hlsl-glslang": "HLSL through glslang and SPIR-V, in OpenGL",
    "unity": "Unity's built-in pipeline: preprocessed, through glslang and SPIR-V, in OpenGL",
    "unity-urp": "Unity's URP: preprocessed, through DXC and SPIR-V, in OpenGL",
}
"""Every back end, and what it is."""

HALF = {"numpy": "numpy-f16", "webgpu": "webgpu-f16"}
"""The back ends that compute in half precision, too, and what they are called then."""


def get(name: str) -> Backend:
    """The back end of that name. Raises CompilerMissing, which says how to get it, where this machine lacks it."""
    found = _find(name)
    if isinstance(found, str):
        raise CompilerMissing(found)
    return found


def chosen(text: str) -> list[str]:
    """The back ends that `NAME,NAME` names, each once. Raises SssgenError for unknown ones."""
    names = list(dict.fromkeys(name.strip() for name in text.split(",")))
    for name in names:
        if name not in NAMES:
            raise failure(f"unknown back end '{name}'", did_you_mean(name, NAMES) or f"choose from: {', '.join(NAMES)}")
    return names


def in_half(names: list[str]) -> list[str]:
    """What those back ends are called in half precision. Raises SssgenError for one that has none."""
    for name in names:
        if name not in HALF and name not in HALF.values():
            raise failure(f"{name} does not compute in half precision", f"--backend {' or '.join(HALF)}")
    return list(dict.fromkeys(HALF.get(name, name) for name in names))


def needed(name: str) -> Backend:
    """The back end of that name, for who cannot go on without it. Raises SssgenError where this machine lacks it."""
    try:
        return get(name)
    except CompilerMissing as reason:
        raise failure(f"the back end {name} is missing", str(reason)) from None


def available() -> list[Backend]:
    """Every back end that this machine has, started."""
    return [found for found in map(_find, NAMES) if isinstance(found, Backend)]


def missing() -> list[tuple[str, str]]:
    """(name, how to get it) of every back end that this machine lacks."""
    return [(name, found) for name in NAMES if isinstance(found := _find(name), str)]


@cache
def _find(name: str) -> Backend | str:
    try:
        return _start(name)
    except CompilerMissing as reason:
        return str(reason)


def _start(name: str) -> Backend:
    """Imports come late: each back end needs packages of its own."""
    if name.startswith("numpy"):
        from sssgen.harness.backends.numpy_reference import Reference

        return Reference(name, {"numpy-f32": "float32", "numpy-f16": "float16"}.get(name, "float64"))
    if name in ("gl", "gl-es"):
        from sssgen.harness.backends.opengl import OpenGL

        return OpenGL(name, "glsl-330" if name == "gl" else "glsl-es-300")
    if name in ("webgpu", "webgpu-f16"):
        from sssgen.harness.backends.webgpu import WebGPU

        return WebGPU(name, "wgsl" if name == "webgpu" else "wgsl-f16")
    if name == "browser":
        from sssgen.harness.backends.browser import Browser

        return Browser(name)
    if name.startswith("unity"):
        from sssgen.harness.backends.unity_backend import UnityHLSL

        return UnityHLSL(name, *(("unity-urp", "dxc") if name == "unity-urp" else ("unity-builtin", "dx9")))
    from sssgen.harness.backends.hlsl_spirv import HLSL

    return HLSL(name, "hlsl", "glslang" if name == "hlsl-glslang" else "dxc")
