"""Metal's text on the processor: g++ compiles it with the stand-in for Metal's library, and a loop calls it."""

from __future__ import annotations

import ctypes
import subprocess
import tempfile
from collections.abc import Mapping, Sequence
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np

from sssgen.ir.types import BY_NAME, Matrix, Type, Vector, kind_of
from sssgen.run import compilers
from sssgen.run.backends.backend_interface import Array, Backend, Call, Text, refusal
from sssgen.run.backends.call_program import DTYPES, grid
from sssgen.run.backends.metal_program import BLOCKS, program, shading
from sssgen.run.compilers.metal_compiler import OPTIONS, Metal, messages
from sssgen.targets import registry
from sssgen.targets.runtime.numpy_textures import Texture

_WRAPS = ("clamp", "repeat", "mirror")


class MetalOnCpu(Backend):
    """Compiles a library for each text, loads it, and calls it."""

    unsupported_types = frozenset(name for name in BY_NAME if "sampler" in name) - {"sampler2D", "sampler3D"}
    """The stand-in only declares these."""

    def __init__(self, name: str, target: str) -> None:
        self.name = name
        self.target = registry.load(target)
        compiler = compilers.get("metal")
        assert isinstance(compiler, Metal)
        self.compiler = compiler

    def device(self) -> str:
        return self.compiler.version()

    def run(self, text: Text, calls: Sequence[Call], textures: Mapping[str, Texture] | None = None) -> list[Array]:
        textures = textures or {}
        lanes = max(np.shape(arg)[-1] for call in calls for arg in call.args if not isinstance(arg, str))
        used = list(dict.fromkeys(arg for call in calls for arg in call.args if isinstance(arg, str)))
        library = self.library(text, program(self.target, text.text, calls, used))
        kept = [bind_texture(library, number, textures[name]) for number, name in enumerate(used)]
        results = [_run(library, number, call, lanes) for number, call in enumerate(calls)]
        del kept  # the library reads the texels until here
        return results

    def shade(
        self, text: Text, blocks: Mapping[str, bytes], textures: Mapping[str, Texture], points: Array | None,
        size: tuple[int, int], front: bool,
    ) -> Array:  # fmt: skip
        """The picture of a whole shader, (height, width, 4), row 0 at the top.

        `points` are those of `pixel_mesh`, all of them on front faces or on back faces.
        """
        library = self.library(text, shading(text.text, list(textures)))
        kept = [bind_texture(library, number, texture) for number, texture in enumerate(textures.values())]
        buffers = [np.frombuffer(blocks.get(name, b"\0") + bytes(16), np.uint8) for name in BLOCKS]
        pointers = (ctypes.c_void_p * len(buffers))(*[buffer.ctypes.data for buffer in buffers])
        result = np.zeros((size[1], size[0], 4), np.float32)
        vertices = None if points is None else np.ascontiguousarray(points, np.float32)
        given = ctypes.c_void_p() if vertices is None else _pointer(vertices)
        library.sssgen_shade(
            pointers, given, _pointer(result), ctypes.c_long(size[0]), ctypes.c_long(size[1]), int(front)
        )
        del kept, vertices
        return result

    def library(self, text: Text, source: str) -> Any:
        """The compiled program. Raises SssgenError where g++ refuses the text."""
        log, library = _compile(self.compiler.program, source)
        if library is None:
            raise refusal(self.name, text, messages(log))
        return library


@lru_cache(64)
def _compile(compiler: str, source: str) -> tuple[str, Any]:
    """The compiler's log, and the library; None where there is none."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "shader.so"
        command = [compiler, *OPTIONS, "-O1", "-w", "-shared", "-fPIC", "-fno-strict-aliasing", "-o", str(path), "-"]
        ran = subprocess.run(command, input=source, capture_output=True, encoding="utf-8", check=False)
        return ran.stderr, ctypes.CDLL(str(path)) if ran.returncode == 0 else None


def bind_texture(library: Any, number: int, texture: Texture) -> list[Array]:
    """Gives the library a texture; the arrays must live as long as it is read."""
    last = 6 if texture.dim == "Cube" else 1  # faces, or one layer
    sizes = np.array([[*texture.size(level), last][:3] for level in range(len(texture.levels))], np.int32)
    texels = np.concatenate([np.asarray(level, np.float32).ravel() for level in texture.levels])
    library.sssgen_texture(
        number, _pointer(texels), _pointer(sizes), len(sizes), int(texture.filter == "linear"),
        _WRAPS.index(texture.wrap),
    )  # fmt: skip
    return [texels, sizes]


def _run(library: Any, number: int, call: Call, lanes: int) -> Array:
    shape = grid(lanes)
    padded = shape.width * shape.rows
    args = [None if isinstance(arg, str) else _pad(type_, np.asarray(arg), padded)
            for type_, arg in zip(call.params, call.args, strict=True)]  # fmt: skip
    inner = _inner(call.result)
    result = np.zeros((*inner, padded), DTYPES[kind_of(call.result)])
    pointers = (ctypes.c_void_p * len(args))(*[None if arg is None else arg.ctypes.data for arg in args])
    getattr(library, f"sssgen_run_{number}")(
        pointers, _pointer(result), ctypes.c_long(shape.width), ctypes.c_long(shape.rows)
    )
    values = result[..., :lanes]
    return values != 0 if kind_of(call.result) == "bool" else values


def _pad(type_: Type, value: Array, padded: int) -> Array:
    """An argument for every lane of the grid and one more. Where there is none: 0 as in a picture; the last integer, as
    a processor stops at a division by 0."""
    with np.errstate(over="ignore", invalid="ignore"):
        value = value.astype(DTYPES[kind_of(type_)]).reshape(*_inner(type_), -1)
    filled = np.zeros((*_inner(type_), padded + 1), value.dtype)
    if kind_of(type_) in ("int", "uint"):
        filled[...] = value[..., -1:]
    filled[..., : value.shape[-1] if value.shape[-1] > 1 else None] = value
    return filled


def _inner(type_: Type) -> tuple[int, ...]:
    """The axes of a value before that of the lanes."""
    if isinstance(type_, Matrix):
        return type_.columns, type_.rows
    return (type_.size,) if isinstance(type_, Vector) else ()


def _pointer(array: Array) -> ctypes.c_void_p:
    return ctypes.c_void_p(array.ctypes.data)
