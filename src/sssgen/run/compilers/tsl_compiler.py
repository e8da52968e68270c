"""TSL: three's own builders make WGSL and GLSL of a module in node; Tint and glslang compile these."""

from __future__ import annotations

import json
from pathlib import Path

from sssgen.run.compilers import glslang, tint
from sssgen.run.compilers.compiler_interface import Compiler, CompilerMissing, Message, Source
from sssgen.run.compilers.node_process import NodeProcess
from sssgen.support.installation import npm_hint

_SCRIPT = Path(__file__).with_name("tsl_builder.mjs")


class Tsl(Compiler):
    """Imports a module as a program does, and builds each function that has a layout."""

    name = "tsl"

    def __init__(self, node: str, modules: Path) -> None:
        self._compilers: dict[str, Compiler] = {"wgsl": tint.find(), "glsl-es-300": glslang.find()}
        self._modules = modules
        self._process = NodeProcess([node, str(_SCRIPT), str(modules)], "three")

    def version(self) -> str:
        package = json.loads((self._modules / "three" / "package.json").read_text(encoding="utf-8"))
        others = ", ".join([compiler.version() for compiler in self._compilers.values()])
        return f"npm three {package['version']}, {others}"

    def check(self, source: Source) -> list[Message]:
        try:
            answer = self._process.ask(source.text)
        except (EOFError, OSError):
            return [Message("error", 0, 0, "three ended on this module")]
        complaints = [*([answer["error"]] if "error" in answer else []), *answer["complaints"]]
        if complaints:
            return [Message("error", 0, 0, complaint) for complaint in complaints]
        return [
            Message(message.severity, 0, 0, f"{language} of three, {self._compilers[language].name}: {message.text}")
            for language, text in (("wgsl", answer["wgsl"]), ("glsl-es-300", answer["glsl"]))
            for message in self._compilers[language].check(Source(text, language, "library", name=source.name))
        ]


def find() -> Tsl:
    """node, npm three, Tint and glslang. Raises CompilerMissing where one of them is lacking."""
    node, modules = tint.node_modules()
    if not (modules / "three" / "src").is_dir():
        raise CompilerMissing(npm_hint("three"))
    return Tsl(node, modules)
