"""Khronos' reference compiler: GLSL, and HLSL with its own front end (shader model 5, or DX9's samplers)."""

from __future__ import annotations

import re
import subprocess
import tempfile
from pathlib import Path
from subprocess import CompletedProcess

from sssgen.run import machine_parts
from sssgen.run.compilers.calling_entry import glsl_entry, hlsl_entry
from sssgen.run.compilers.compiler_interface import Compiler, CompilerMissing, Message, Severity, Source
from sssgen.run.compilers.gl_driver import with_version
from sssgen.run.compilers.shadertoy_page import as_program

_STAGES = {"vertex": "vert", "fragment": "frag", "compute": "comp", "library": "frag"}
_OWN = (None, "0", "stdin")  # the name of the text without a #line that names it
_SEVERITY: dict[str, Severity] = {"ERROR": "error", "WARNING": "warning"}
LIBRARY_ENTRY = "sssgen_check_main"


class Glslang(Compiler):
    """Runs one `glslangValidator` process a check; it reads standard input and leaves no file."""

    name = "glslang"

    def __init__(self, program: str) -> None:
        self._program = program

    def version(self) -> str:
        text = subprocess.run([self._program, "--version"], capture_output=True, text=True, check=False).stdout
        match = re.search(r"Glslang Version: \S*?(\d+(?:\.\d+)+)", text)
        return f"glslang {match[1]}" if match else text.splitlines()[0]

    def check(self, source: Source) -> list[Message]:
        text = source.text
        if source.language == "hlsl":
            if source.stage == "library":
                return self.check_hlsl(hlsl_entry(text), "fragment", LIBRARY_ENTRY)
            return self.check_hlsl(text, source.stage, source.entry)
        text = with_version(as_program(source), source.language)
        text = glsl_entry(text) if source.stage == "library" else text
        return _messages_of(self._run(text, ["-S", _STAGES[source.stage]]))

    def check_hlsl(self, text: str, stage: str, entry: str, dx9_samplers: bool = False) -> list[Message]:
        """HLSL to SPIR-V. `dx9_samplers` allows `sampler2D` and `tex2D`, as in Unity's built-in pipeline."""
        return _messages_of(self._hlsl(text, stage, entry, dx9_samplers)[0])

    def spirv(self, text: str, stage: str, entry: str, dx9_samplers: bool = False) -> bytes:
        """The SPIR-V of HLSL. Raises ValueError with the compiler's log."""
        completed, module = self._hlsl(text, stage, entry, dx9_samplers)
        if completed.returncode:
            raise ValueError(f"{completed.stdout}{completed.stderr}")
        return module

    def opengl_spirv(self, text: str, stage: str) -> bytes:
        """The SPIR-V of GLSL for OpenGL. Raises ValueError with the compiler's log."""
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "out.spv"
            options = ["-G", "-S", _STAGES[stage], "--auto-map-bindings", "--auto-map-locations", "-o", str(path)]
            completed = self._run(text, options)
            if completed.returncode:
                raise ValueError(f"{completed.stdout}{completed.stderr}")
            return path.read_bytes()

    def _hlsl(self, text: str, stage: str, entry: str, dx9_samplers: bool) -> tuple[CompletedProcess[str], bytes]:
        with tempfile.TemporaryDirectory() as folder:
            options = ["-D", "-V", "-S", _STAGES[stage], "-e", entry]
            options += ["--auto-map-bindings", "--auto-map-locations"]
            options += ["--hlsl-dx9-compatible"] if dx9_samplers else []
            path = Path(folder) / "out.spv"
            completed = self._run(text, [*options, "-o", str(path)])
            return completed, path.read_bytes() if path.is_file() else b""

    def _run(self, text: str, options: list[str]) -> CompletedProcess[str]:
        command = [self._program, "--stdin", *options]
        return subprocess.run(command, input=text, capture_output=True, encoding="utf-8", check=False)


def _messages_of(completed: CompletedProcess[str]) -> list[Message]:
    """The messages of a run; a failure without a message is an error, too."""
    parsed = messages(completed.stdout + completed.stderr)
    if completed.returncode and not any(m.severity == "error" for m in parsed):
        parsed.append(Message("error", 0, 0, completed.stdout.strip() or f"exit status {completed.returncode}"))
    return parsed


def find() -> Glslang:
    """The program on the path; SSSGEN_GLSLANG names another. Raises CompilerMissing where there is none."""
    program = machine_parts.glslang()
    if not program:
        raise CompilerMissing("Debian: glslang-tools · elsewhere: the Vulkan SDK")
    return Glslang(program)


def messages(log: str) -> list[Message]:
    """The messages in glslang's log."""
    result = []
    for line in log.splitlines():
        match = re.match(r"(ERROR|WARNING): (?:((?:[A-Za-z]:)?[^:]*):(\d+): )?(.*)", line)
        if match and not re.search(r"compilation terminated|\d+ compilation errors", match[4]):
            file = "" if match[2] in _OWN else match[2]
            result.append(Message(_SEVERITY[match[1]], int(match[3] or 0), 0, match[4].strip(), file))
    return result
