"""Bevy's WESL: linked by the npm package `wesl` with stand-ins for Bevy's modules, then given to naga and Tint.

Nothing of Bevy is needed: `bevy_standin` declares the modules, names and types that emitted text imports.
"""

from __future__ import annotations

import json
from pathlib import Path

from sssgen.run.compilers import naga, tint
from sssgen.run.compilers.compiler_interface import Compiler, CompilerMissing, Message, Source
from sssgen.run.compilers.node_process import NodeProcess
from sssgen.support.installation import npm_hint

STANDIN = Path(__file__).with_name("bevy_standin")
PACKAGE = "wesl@0.7.31"

# What Bevy defines for a mesh with everything, one with nothing, and the pass before the light.
CONDITIONS: dict[str, tuple[str, ...]] = {
    "forward": ("VERTEX_UVS_A", "VERTEX_TANGENTS", "VERTEX_OUTPUT_INSTANCE_INDEX"),
    "forward, without attributes": (),
    "deferred": ("VERTEX_UVS_A", "VERTEX_TANGENTS", "VERTEX_OUTPUT_INSTANCE_INDEX", "PREPASS_PIPELINE"),
}

# One process answers for all files, in lines of JSON.
_SERVER = """
import { createInterface } from 'node:readline';
import { pathToFileURL } from 'node:url';
const { link } = await import(pathToFileURL(process.argv[1]));
const reply = (value) => process.stdout.write('@@' + JSON.stringify(value) + '\\n');
reply('ready');
for await (const line of createInterface({ input: process.stdin })) {
  const { text, modules, conditions } = JSON.parse(line);
  try {
    const linked = await link({
      weslSrc: { './main.wesl': text },
      rootModuleName: 'main',
      libs: [{ name: 'bevy_pbr', edition: 'unstable_2025_1', modules }],
      constants: { MATERIAL_BIND_GROUP: 3 },
      conditions,
    });
    reply({ text: linked.dest });
  } catch (error) {
    reply({ error: String(error.message ?? error) });
  }
}
"""


class Bevy(Compiler):
    """Links with each set of conditions, and compiles each result with both compilers."""

    name = "bevy"

    def __init__(self, node: str, modules: Path) -> None:
        self._naga = naga.find()
        self._tint = tint.find()
        self._modules = modules
        command = [node, "--input-type=module", "-e", _SERVER, str(modules / "wesl" / "dist" / "core.js")]
        self._process = NodeProcess(command, "wesl")

    def version(self) -> str:
        standin = "the project's stand-in for Bevy's modules"
        return f"{standin}, {self.linker()}, {self._naga.version()}, {self._tint.version()}"

    def linker(self) -> str:
        """The linker's name and version."""
        package = json.loads((self._modules / "wesl" / "package.json").read_text(encoding="utf-8"))
        return f"npm wesl {package['version']}"

    def check(self, source: Source) -> list[Message]:
        messages: list[Message] = []
        compiled: set[str] = set()
        for name, conditions in CONDITIONS.items():
            try:
                text = self.link(source.text, conditions)
            except ValueError as error:
                return [Message("error", 0, 0, f"{name}: {error}")]
            if text in compiled:
                continue
            compiled.add(text)
            for compiler in (self._naga, self._tint):
                found = compiler.check(Source(text, "wgsl", source.stage, source.entry, source.name))
                messages += [_locate(message, f"{name}, {compiler.name}", text, source.text) for message in found]
        return messages

    def link(self, text: str, conditions: tuple[str, ...]) -> str:
        """The WGSL of a WESL file with the stand-ins. Raises ValueError with the linker's message."""
        chosen = dict.fromkeys(conditions, True)
        answer = self._process.ask({"text": text, "modules": modules(), "conditions": chosen})
        if "error" in answer:
            raise ValueError(answer["error"])
        return str(answer["text"])


def modules() -> dict[str, str]:
    """The stand-ins by their paths."""
    return {
        path.relative_to(STANDIN).as_posix(): path.read_text(encoding="utf-8")
        for path in sorted(STANDIN.rglob("*.wesl"))
    }


def _locate(message: Message, job: str, linked: str, text: str) -> Message:
    """A message about linked text with its line in the WESL file, where exactly one line there is the same."""
    lines = linked.splitlines()
    wrong = lines[message.line - 1].strip() if 0 < message.line <= len(lines) else ""
    same = [number for number, line in enumerate(text.splitlines(), 1) if wrong and line.strip() == wrong]
    return Message(message.severity, same[0] if len(same) == 1 else 0, 0, f"{job}: {message.text}")


def find() -> Bevy:
    """node, npm wesl, naga and Tint. Raises CompilerMissing where one of them is lacking."""
    node, folder = tint.node_modules()
    if not (folder / "wesl" / "package.json").is_file():
        raise CompilerMissing(npm_hint(PACKAGE))
    return Bevy(node, folder)
