"""A compute shader in Metal on the processor: its buffers after a run, and what the languages leave undefined there.

g++ compiles the text with the stand-in for Metal's library, with calls of its thread sanitizer for each access to
memory; `metal_threadgroups` runs the invocations and answers these calls.
"""

from __future__ import annotations

import ctypes
import re
import subprocess
import tempfile
from functools import lru_cache
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from sssgen.run.backends.backend_interface import Array, backend_failure, refusal
from sssgen.run.backends.dispatch import Dispatch
from sssgen.run.backends.metal_backend import MetalOnCpu, bind_texture
from sssgen.run.backends.metal_program import declarations, parameters
from sssgen.run.compilers.metal_compiler import OPTIONS, messages, with_swizzles
from sssgen.targets.runtime.numpy_textures import Texture

FAULTS = (
    (2, "some invocations of a workgroup end where others wait at a barrier"),
    (4, "an index is out of range"),
    (8, "an operation is undefined (a division by 0, a shift, a conversion), or an index is out of range"),
    (16, "shared memory is read before it is written, or without a barrier after that"),
    (1, "an invocation reads what another one writes, without a barrier between them"),
)
"""What a run may find undefined, by the bits of its result; the worst first."""

_CHECKS = (
    "-fsanitize=thread", "-fsanitize=bounds-strict,integer-divide-by-zero,shift,float-cast-overflow",
    "-fsanitize-undefined-trap-on-error",
)  # fmt: skip
_PLACES = {
    "thread_position_in_grid": 0, "thread_position_in_threadgroup": 3, "threadgroup_position_in_grid": 6,
    "threadgroups_per_grid": 9, "thread_index_in_threadgroup": 12,
}  # fmt: skip
_SHARED = re.compile(r"^    threadgroup (.+) (\w+);$", re.MULTILINE)
_LENGTHLESS = re.compile(r"^(    .+ \w+)\[1\];$", re.MULTILINE)


class KernelRun(NamedTuple):
    """The result of a run."""

    buffers: dict[str, Array]
    fault: str
    """What was undefined, or ''."""


def run_kernel(backend: MetalOnCpu, dispatch: Dispatch, order: int = 0) -> KernelRun:
    """Runs a text of the target `metal`; `order` is that of the invocations: 0 upwards, 1 downwards, else random.

    Raises SssgenError where g++ refuses the text.
    """
    textures = list(dispatch.textures)
    log, library = _compile(backend.compiler.program, _program(dispatch, textures))
    if library is None:
        raise refusal(backend.name, dispatch.text, messages(log))
    pictures = [dispatch.textures[name].data for name in textures]
    kept = [bind_texture(library, number, data) for number, data in enumerate(pictures) if isinstance(data, Texture)]
    names = sorted(dispatch.buffers, key=dispatch.bindings.__getitem__)
    buffers = [np.frombuffer(dispatch.buffers[name].tobytes(), np.uint8).copy() for name in names]
    block = np.frombuffer(dispatch.block + bytes(16), np.uint8)
    pointers = (ctypes.c_void_p * len(buffers))(*[buffer.ctypes.data for buffer in buffers])
    sizes = (ctypes.c_ulong * len(buffers))(*[buffer.nbytes for buffer in buffers])
    counts, size = ((ctypes.c_uint * 3)(*three) for three in (dispatch.groups, dispatch.size))
    faults = library.sssgen_dispatch(
        pointers, sizes, ctypes.c_void_p(block.ctypes.data), counts, size, ctypes.c_uint(order)
    )
    del kept  # the library reads the texels until here
    after = {
        name: buffer.view(dispatch.buffers[name].dtype).reshape(dispatch.buffers[name].shape)
        for name, buffer in zip(names, buffers, strict=True)
    }
    return KernelRun(after, next((text for bit, text in FAULTS if faults & bit), ""))


def _program(dispatch: Dispatch, textures: list[str]) -> str:
    """The text with a function `sssgen_dispatch` behind it."""
    number = iter(range(64))

    def shared(match: re.Match[str]) -> str:
        type_, name = match.groups()
        return f"    {type_}& {name} = *static_cast<{type_}*>(group_shared({next(number)}, sizeof({type_})));"

    text = _SHARED.sub(shared, dispatch.text.text)
    text = _LENGTHLESS.sub(r"\1[1 << 24];", text)
    names = sorted(dispatch.buffers, key=dispatch.bindings.__getitem__)
    args = []
    for kind, name, attribute in parameters(text, "kernel"):
        if attribute in _PLACES:
            first = _PLACES[attribute]
            args.append(
                f"place[{first}]"
                if kind == "uint"
                else f"uint3(place[{first}], place[{first + 1}], place[{first + 2}])"
            )
        elif kind == "sampler":
            args.append(f"sssgen_samplers[{textures.index(name.removesuffix('_sampler'))}]")
        elif attribute.startswith("texture"):
            args.append(f"{kind}{{{{&sssgen_images[{textures.index(name)}]}}}}")
        else:
            struct = kind.rstrip("&").split()[-1]
            place = attribute.removeprefix("buffer(").rstrip(")")
            at = "sssgen_block" if place == "0" else f"sssgen_buffers[{_position(names, dispatch, int(place))}]"
            args.append(f"*static_cast<{struct}*>({at})")
    lines = [
        *declarations(len(textures)),
        "static void *sssgen_block, *sssgen_buffers[64];",
        f"static void sssgen_invocation(const unsigned* place) {{ {dispatch.entry}({', '.join(args)}); }}",
        'extern "C" unsigned sssgen_dispatch(void* const* buffers, const unsigned long* sizes, void* block,',
        "    const unsigned* counts, const unsigned* groups, unsigned order) {",
        "    group_reset();",
        "    sssgen_block = block;",
        f"    for (unsigned i = 0; i < {len(names)}; i++)",
        "        memcpy(sssgen_buffers[i] = group_memory(sizes[i], false), buffers[i], sizes[i]);",
        "    unsigned faults = group_dispatch(sssgen_invocation, counts, groups, order);",
        f"    for (unsigned i = 0; i < {len(names)}; i++) memcpy(buffers[i], sssgen_buffers[i], sizes[i]);",
        "    return faults;",
        "}",
    ]
    return "\n".join(["#include <metal_threadgroups>", with_swizzles(text, included=True), *lines, ""])


def _position(names: list[str], dispatch: Dispatch, binding: int) -> int:
    return next(index for index, name in enumerate(names) if dispatch.bindings[name] == binding)


@lru_cache(64)
def _compile(compiler: str, source: str) -> tuple[str, Any]:
    """The compiler's log, and the library; None where there is none."""
    with tempfile.TemporaryDirectory() as folder:
        unit, path = Path(folder) / "kernel.o", Path(folder) / "kernel.so"
        command = [
            compiler,
            *OPTIONS,
            *_CHECKS,
            "-O1",
            "-w",
            "-c",
            "-fPIC",
            "-fno-strict-aliasing",
            "-o",
            str(unit),
            "-",
        ]
        ran = subprocess.run(command, input=source, capture_output=True, encoding="utf-8", check=False)
        if ran.returncode:
            return ran.stderr, None
        # without the sanitizer's library, whose functions the stand-in has
        linked = subprocess.run([compiler, "-shared", "-o", str(path), str(unit)], capture_output=True, check=False)
        if linked.returncode:
            raise backend_failure("metal", f"the linker failed: {linked.stderr.decode(errors='replace').strip()}")
        return ran.stderr, ctypes.CDLL(str(path))
