"""WGSL in Tint, Chrome's compiler, uniformity check on: the npm package `webgpu` with its null back end."""

from __future__ import annotations

import json
from pathlib import Path

from sssgen.run import machine_parts
from sssgen.run.compilers.calling_entry import wgsl_entry
from sssgen.run.compilers.compiler_interface import Compiler, CompilerMissing, Message, Source
from sssgen.run.compilers.node_process import NodeProcess
from sssgen.support.installation import npm_hint

# One process answers for all checks. Dawn prints warnings there as well.
_SERVER = """
import { createInterface } from 'node:readline';
import { createRequire } from 'node:module';
import { pathToFileURL } from 'node:url';
const path = createRequire(process.argv[1] + '/').resolve('webgpu');
const { create } = await import(pathToFileURL(path));
const gpu = create(['backend=null']);  // kept: Dawn goes down with it
const adapter = await gpu.requestAdapter();
const wanted = ['shader-f16'].filter((f) => adapter.features.has(f));
const device = await adapter.requestDevice({ requiredFeatures: wanted });
const reply = (value) => process.stdout.write('@@' + JSON.stringify(value) + '\\n');
reply('ready');
for await (const line of createInterface({ input: process.stdin })) {
  device.pushErrorScope('validation');
  const shader = device.createShaderModule({ code: JSON.parse(line) });
  const info = await shader.getCompilationInfo();
  const error = await device.popErrorScope();
  const messages = info.messages.map((m) => [m.type, m.lineNum, m.linePos, m.message]);
  if (error && !messages.some((m) => m[0] === 'error')) messages.push(['error', 0, 0, error.message]);
  reply(messages);
}
process.exit(gpu ? 0 : 1);
"""


class Tint(Compiler):
    """Talks to one node process, kept alive; a check takes about two milliseconds."""

    name = "tint"

    def __init__(self, node: str, modules: Path) -> None:
        self._command = [node, "--input-type=module", "-e", _SERVER, str(modules.parent)]
        self._modules = modules
        self._process = NodeProcess(self._command, "webgpu")

    def version(self) -> str:
        package = json.loads((self._modules / "webgpu" / "package.json").read_text(encoding="utf-8"))
        return f"Tint in npm webgpu {package['version']}"

    def check(self, source: Source) -> list[Message]:
        text = wgsl_entry(source.text) if source.stage == "library" else source.text
        try:
            answer = self._process.ask(text)
        except (EOFError, OSError):
            return [Message("error", 0, 0, "Tint crashed on this shader")]
        return [Message(kind, line, column, message) for kind, line, column, message in answer]

    def close(self) -> None:
        """End the process."""
        self._process.close()


def node_modules() -> tuple[str, Path]:
    """node, and the folder that npm filled. Raises CompilerMissing where node is lacking."""
    if not (node := machine_parts.node()):
        raise CompilerMissing("node (Debian: nodejs npm)")
    return node, machine_parts.node_modules()


def find() -> Tint:
    """Tint in node. Raises CompilerMissing where node or the package is lacking."""
    node, modules = node_modules()
    if not (modules / "webgpu" / "package.json").is_file():
        raise CompilerMissing(npm_hint("webgpu@0.6.2"))
    return Tint(node, modules)
