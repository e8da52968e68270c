"""Microsoft's DirectX shader compiler, shader model 6, which the PyPI package compushady carries."""

from __future__ import annotations

import re
from collections.abc import Callable

from sssgen.harness.compilers.base import LANGUAGES, Compiler, CompilerMissing, Message, Severity, Source
from sssgen.harness.compilers.calls import hlsl_entry
from sssgen.harness.compilers.glslang import LIBRARY_ENTRY

_PROFILES = {"vertex": "vs_6_0", "fragment": "ps_6_0", "library": "ps_6_0"}
_OWN = ("", "hlsl.hlsl")  # what the text is called where no #line names it
_SEVERITY: dict[str, Severity] = {
    "error": "error",
    "fatal error": "error",
    "warning": "warning",
    "note": "info",
}


class Dxc(Compiler):
    """Compiles in this process."""

    name = "dxc"
    languages = LANGUAGES["dxc"]

    def __init__(self, compile_hlsl: Callable[[str, str, str], bytes], version: str) -> None:
        self._compile = compile_hlsl
        self._version = version

    def version(self) -> str:
        return self._version

    def check(self, source: Source) -> list[Message]:
        if source.stage == "library":
            return self.check_hlsl(hlsl_entry(source.text), "fragment", LIBRARY_ENTRY)
        return self.check_hlsl(source.text, source.stage, source.entry)

    def check_hlsl(self, text: str, stage: str, entry: str) -> list[Message]:
        """HLSL with separate textures and samplers, to SPIR-V."""
        try:
            self._compile(text, entry, _PROFILES[stage])
        except ValueError as error:
            return messages(str(error))
        return []


def find() -> Dxc:
    """DXC inside compushady. Raises CompilerMissing where the package is lacking or does not load."""
    try:
        from importlib.metadata import version

        from compushady.shaders import hlsl
    except Exception as error:
        hint = "pip install compushady (Debian, to build it: g++ libvulkan-dev)"
        raise CompilerMissing(hint if isinstance(error, ImportError) else f"{hint}: {error}") from None
    return Dxc(hlsl.compile, f"DXC in compushady {version('compushady')}")


def messages(log: str) -> list[Message]:
    """What DXC's log says."""
    pattern = r"^(?:((?:[A-Za-z]:)?[^:\n]*):(\d+):(\d+): )?(fatal error|error|warning|note): (.*)"
    found = [
        Message(_SEVERITY[kind], int(line or 0), int(column or 0), text, "" if file in _OWN else file)
        for file, line, column, kind, text in re.findall(pattern, log, re.MULTILINE)
    ]
    return found or [Message("error", 0, 0, log.strip())]
