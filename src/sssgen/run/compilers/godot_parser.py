"""Godot's own parser of its shading language, without a renderer."""

from __future__ import annotations

import re
import subprocess

from sssgen.run.compilers.calling_entry import gdshader_entry
from sssgen.run.compilers.compiler_interface import Compiler, Message, Source
from sssgen.run.compilers.godot_process import Godot as Program
from sssgen.run.compilers.godot_process import find as find_program

SECONDS = 60.0
# Godot parses a shader when its uniforms are asked for; without a renderer its text stays as it is.
_SCRIPT = """extends SceneTree

func _init():
    var shader = Shader.new()
    shader.code = FileAccess.get_file_as_string("res://shader.gdshader")
    print("@@ ", shader.get_shader_uniform_list().size())
    quit()
"""
_ERROR = re.compile(r"^SHADER ERROR: (.*)\n\s+at: .*\(:?[^()]*?:(\d+)\)", re.MULTILINE)


class Godot(Compiler):
    """One process a check: half a second."""

    name = "godot"

    def __init__(self, program: Program, version: str) -> None:
        self._program, self._version = program, version

    def version(self) -> str:
        return f"Godot {self._version}"

    def check(self, source: Source) -> list[Message]:
        text = gdshader_entry(source.text) if source.stage == "library" else source.text
        with self._program.project({"check.gd": _SCRIPT, "shader.gdshader": text}) as project:
            try:
                said = self._program.run(project, "check.gd", [], SECONDS)
            except subprocess.TimeoutExpired:
                return [Message("error", 0, 0, f"Godot takes more than {SECONDS:.0f} s on this shader")]
        messages = [Message("error", int(line), 0, text) for text, line in _ERROR.findall(said)]
        if not messages and ("@@ " not in said or "SHADER ERROR" in said):
            messages.append(Message("error", 0, 0, said.strip()[-500:] or "Godot crashed on this shader"))
        return messages


def find() -> Godot:
    """Godot 4 without a renderer. Raises CompilerMissing where there is none."""
    program = find_program()
    return Godot(program, program.version())
