"""HLSL, run in OpenGL: a compiler makes SPIR-V, spirv-val checks it, and spirv-cross translates it to GLSL."""

from __future__ import annotations

import shutil
import subprocess
import tempfile
from collections.abc import Collection
from functools import cache, lru_cache
from pathlib import Path
from typing import Any

from sssgen.run.backends.backend_interface import ATTRIBUTES, Drawing, Stage, Text, refusal
from sssgen.run.backends.opengl import _SCREEN, HEADS, OpenGL
from sssgen.run.backends.spirv_rewriting import rewrite
from sssgen.run.compilers import CompilerMissing, Message, dxc, glslang

_ENDINGS = {
    "position": ("POSITION", "_position", "_positionOS", "_vertex"),
    "normal": ("NORMAL", "_normal", "_normalOS"),
    "tangent": ("TANGENT", "_tangent", "_tangentOS"),
    "uv": ("TEXCOORD0", "_uv", "_texcoord"),
    "uv2": ("TEXCOORD1", "_uv2", "_texcoord1"),
    "color": ("COLOR", "COLOR0", "_color"),
}
_TIMEOUT = 120.0


class HLSL(OpenGL):
    """Compiles with `compiler`: DXC or glslang, or glslang with the samplers of Direct3D 9."""

    def __init__(self, name: str, target: str, compiler: str) -> None:
        super().__init__(name, target)
        self.compiler = compiler
        _tools()  # raises CompilerMissing
        self.shader_compiler = dxc.find() if compiler == "dxc" else glslang.find()

    def device(self) -> str:
        return f"{self.shader_compiler.version()}, spirv-cross, {super().device()}"

    def stages(self, drawing: Drawing) -> tuple[str, str]:
        fragment = self.glsl(drawing.fragment, "fragment")
        return self.glsl(drawing.vertex, "vertex") if drawing.vertex else HEADS["glsl-330"] + _SCREEN, fragment

    def glsl(self, stage: Stage, kind: str) -> str:
        """A stage as GLSL."""
        text = self.prepare(stage.text)
        module, log = compile_spirv(text.text, stage.entry, kind, self.compiler)
        if not module:
            raise refusal(self.name, stage.text, self.messages(log))
        glsl, log = cross_compile(module)
        if not glsl:
            raise refusal(self.name, stage.text, [Message("error", 0, 0, log)])
        return glsl

    def owner(self, member: str, names: Collection[str]) -> str:
        """DXC writes `type_` before a block's name; spirv-cross joins a texture's name with its sampler's."""
        for candidate in (member, member.removeprefix("type_")):
            if candidate in names:
                return candidate
        combined = member.removeprefix("SPIRV_Cross_Combined")
        if combined == member:
            return ""
        for name in names:
            if combined.startswith((f"{name}sampler", f"{name}SPIRV_Cross_DummySampler", f"{name}{name}_sampler")):
                return name
        return ""

    def prepare(self, text: Text) -> Text:
        """The compiler's input: Unity's text is preprocessed."""
        return text

    def messages(self, log: str) -> list[Message]:
        """The messages in the compiler's log."""
        return dxc.messages(log) if self.compiler == "dxc" else glslang.messages(log)

    def attribute(self, program: Any, name: str) -> str:
        """DXC names vertex inputs after their semantics, glslang after the members of their struct."""
        ending = _ENDINGS.get(name, name)
        members = (member for member in program if member.endswith(ending) and not member.startswith("gl_"))
        return next((member for member in members if type(program[member]).__name__ == "Attribute"), "")


@lru_cache(64)
def compile_spirv(text: str, entry: str, stage: str, compiler: str) -> tuple[bytes, str]:
    """SPIR-V from HLSL by `dxc`, `glslang` or `dx9` (glslang), checked by spirv-val; or nothing and the log."""
    try:
        if compiler == "dxc":
            module = dxc.find().spirv(text, stage, entry)
        else:
            module = glslang.find().spirv(text, stage, entry, dx9_samplers=compiler == "dx9")
    except ValueError as error:
        return b"", str(error)
    completed = _process([_tools()["spirv-val"], "--target-env", "vulkan1.1"], module)
    return (
        (b"", f"spirv-val: {completed.stderr.decode(errors='replace').strip()}")
        if completed.returncode
        else (module, "")
    )


_GLSL = ("--version", "430", "--no-es", "--force-temporary")
"""Temporaries: else spirv-cross moves a read that stands before a loop into the loop's condition, although the loop
writes the variable."""


@lru_cache(64)
def cross_compile(module: bytes, *options: str) -> tuple[str, str]:
    """GLSL from SPIR-V by spirv-cross (with `options`, another language), or nothing and the log."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "in.spv"
        path.write_bytes(rewrite(module))
        completed = _process([_tools()["spirv-cross"], str(path), *(options or _GLSL)], b"")
    return ("", completed.stderr.decode(errors="replace")) if completed.returncode else (completed.stdout.decode(), "")


def _process(command: list[str], data: bytes) -> subprocess.CompletedProcess[bytes]:
    try:
        return subprocess.run(command, input=data, capture_output=True, check=False, timeout=_TIMEOUT)
    except subprocess.TimeoutExpired:
        return subprocess.CompletedProcess(command, 1, b"", f"{command[0]} took longer than {_TIMEOUT} s".encode())


@cache
def _tools() -> dict[str, str]:
    """The paths of the two programs. Raises CompilerMissing."""
    programs = {name: shutil.which(name) for name in ("spirv-val", "spirv-cross")}
    if lacking := [name for name, path in programs.items() if path is None]:
        raise CompilerMissing(f"{' and '.join(lacking)} (Debian: spirv-tools spirv-cross · elsewhere: the Vulkan SDK)")
    return {name: str(path) for name, path in programs.items()}


assert set(_ENDINGS) == set(ATTRIBUTES)
