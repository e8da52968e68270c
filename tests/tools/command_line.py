"""A compiler that records its calls, so that tests of the command line do not depend on the compiler."""

from __future__ import annotations

import json
import types
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

from sssgen.ir.nodes import Module
from sssgen.material.model import Material
from sssgen.support.diagnostics import Diagnostic, failure

WAX = """\
[material]
name = "wax"
[thickness]
technique = "transmittance_map"
[translucency]
technique = "lobe_normalized"
"""
GLSL = "float twice(float x)\n{\n    return 2.0 * x;\n}\n"


class Compiled(NamedTuple):
    files: dict[str, str]
    warnings: list[Diagnostic]

    @property
    def reflection(self) -> dict[str, object]:
        return {"renames": {}}


class Target(NamedTuple):
    title: str
    draws_passes: str = ""
    draws_light: bool = False

    def drawer(self, name: str) -> str:
        return self.draws_passes if self.draws_light else ""


class FakeCompiler(types.ModuleType):
    """A compiler that records its arguments, so that the tests cover only the command line."""

    def __init__(self) -> None:
        super().__init__("sssgen.pipeline.compiler")
        self.calls: list[tuple[str, str, str, Path | None]] = []
        self.text = "text 1"
        self.name = "{}.{}.txt"
        self.failing: dict[str, Exception] = {}
        self.refused: set[tuple[str, str]] = set()
        """Material and target"""
        self.warnings: list[Diagnostic] = []

    def all_targets(self) -> dict[str, Target]:
        return {"glsl-330": Target("GLSL 3.30"), "wgsl": Target("WGSL")}

    def compile(
        self,
        material: Material,
        target: str,
        form: str,
        templates: Path | None,
        guards: str,
        trace: object = None,
        prefix: str = "",
        standalone: bool = False,
    ) -> Compiled:
        self.calls.append((material.name, target, form, templates))
        if target in self.failing:
            raise self.failing[target]
        if (material.name, target) in self.refused:
            raise failure(f"{material.name} is refused")
        name = self.name.format(material.name, target)
        files = {name: f"{self.text}\n", f"{material.name}.{target}.reflection.json": "{}\n"}
        return Compiled(files, self.warnings)

    def transpile(self, module: Module, target: str, name: str, guards: str, **stored: object) -> Compiled:
        text = f"// {name}: {', '.join(function.name for function in module.functions)}\n"
        return Compiled({f"{name}.{target}.txt": text, f"{name}.{target}.reflection.json": "{}\n"}, [])


class CommandResult(NamedTuple):
    status: int
    out: str
    err: str

    @property
    def data(self) -> dict[str, Any]:
        """What `--json` prints."""
        report: dict[str, Any] = json.loads(self.out)
        return report


Run = Callable[..., CommandResult]


def folder_content(path: str = "out") -> dict[str, str]:
    return {file.name: file.read_text(encoding="utf-8") for file in sorted(Path(path).iterdir())}
