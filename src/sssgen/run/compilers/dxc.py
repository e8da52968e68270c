"""Microsoft's DirectX shader compiler, shader model 6, which the PyPI package compushady carries.

It runs in its own process: a process with both its library and drivers of OpenGL or Vulkan sometimes hangs when it ends
(in the library's llvm_shutdown).
"""

from __future__ import annotations

import re
from collections.abc import Callable
from functools import cache

from sssgen.run.compilers.calling_entry import hlsl_entry
from sssgen.run.compilers.compiler_interface import Compiler, CompilerMissing, Message, Severity, Source
from sssgen.run.compilers.glslang import LIBRARY_ENTRY
from sssgen.support.installation import install_hint
from sssgen.support.worker_process import LostError, Process

_PROFILES = {"vertex": "vs_6_0", "fragment": "ps_6_0", "compute": "cs_6_0", "library": "ps_6_0"}
_OWN = ("", "hlsl.hlsl")  # the name of the text without a #line that names it
_SEVERITY: dict[str, Severity] = {
    "error": "error",
    "fatal error": "error",
    "warning": "warning",
    "note": "info",
}


SECONDS = 60.0
"""How long one text may take."""

Question = tuple[str, str, str]
"""Text, entry point, stage."""


class Dxc(Compiler):
    """Asks the other process."""

    name = "dxc"

    def __init__(self, process: Process) -> None:
        self._process = process
        self._version = str(process.start())

    def version(self) -> str:
        return self._version

    def check(self, source: Source) -> list[Message]:
        if source.stage == "library":
            return self.check_hlsl(hlsl_entry(source.text), "fragment", LIBRARY_ENTRY)
        return self.check_hlsl(source.text, source.stage, source.entry)

    def check_hlsl(self, text: str, stage: str, entry: str) -> list[Message]:
        """HLSL with separate textures and samplers, to SPIR-V."""
        try:
            self.spirv(text, stage, entry)
        except ValueError as error:
            return messages(str(error))
        return []

    def spirv(self, text: str, stage: str, entry: str) -> bytes:
        """The SPIR-V of HLSL. Raises ValueError with the compiler's log."""
        try:
            return bytes(self._process.ask((text, entry, stage)))
        except LostError as reason:
            raise ValueError(f"error: DXC {reason} on this text") from None


@cache
def find() -> Dxc:
    """DXC, started. Raises CompilerMissing where the package is lacking or does not load."""
    try:
        return Dxc(Process(__name__, "dxc", seconds=SECONDS))
    except LostError as reason:
        raise CompilerMissing(f"DXC {reason} as it started") from None


def serve(_: str) -> tuple[str, Callable[[Question], bytes]]:
    """The first answer of the other process, and its function for questions. Raises CompilerMissing."""
    try:
        from importlib.metadata import version

        from compushady.shaders import hlsl
    except Exception as error:
        hint = f"{install_hint('dxc')} (Debian, to build it: g++ libvulkan-dev)"
        raise CompilerMissing(hint if isinstance(error, ImportError) else f"{hint}: {error}") from None

    def answer(question: Question) -> bytes:
        text, entry, stage = question
        return bytes(hlsl.compile(text, entry, _PROFILES[stage]))

    return f"DXC in compushady {version('compushady')}", answer


def messages(log: str) -> list[Message]:
    """The messages in DXC's log."""
    pattern = r"^(?:((?:[A-Za-z]:)?[^:\n]*):(\d+):(\d+): )?(fatal error|error|warning|note): (.*)"
    result = [
        Message(_SEVERITY[kind], int(line or 0), int(column or 0), text, "" if file in _OWN else file)
        for file, line, column, kind, text in re.findall(pattern, log, re.MULTILINE)
    ]
    return result or [Message("error", 0, 0, log.strip())]
