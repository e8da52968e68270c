"""The lines of emitted modules for engines of the web: shader text, the rest of the module, and the shared runtime.

    python benchmarks/module_sizes.py [OLD]

OLD, a folder of the project or a git commit, adds the lines of modules that it emits. Shader text are the functions in
GLSL and WGSL; the rest is the tables of parameters, the glue to the engine's shaders, and code. The runtime is apart.
"""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import NamedTuple

from replay import ROOT, checkout

TARGETS = ("threejs", "babylonjs", "playcanvas")
FUNCTIONS = re.compile(r"^const (?:GLSL|WGSL) = /\* \w+ \*/ `(?:[^`\\]|\\.)*`", re.MULTILINE)


class Size(NamedTuple):
    """Numbers of lines."""

    shader: int
    other: int
    types: int
    """Of the file with TypeScript's types."""
    runtime: int


def sizes(project: Path, out: Path) -> dict[str, Size]:
    """`material target` → the lines of what a state of the project emits."""
    names = sorted(path.stem for path in (ROOT / "examples").glob("*/*.toml") if path.stem == path.parent.name)
    environment = {**os.environ, "PYTHONPATH": str(project / "src"), "SSSGEN_CACHE": ""}
    result = {}
    for target in TARGETS:
        folder = out / target
        command = [sys.executable, "-m", "sssgen", "emit", *names, "-t", target, "-o", str(folder), "--json"]
        printed = subprocess.run(command, cwd=project, env=environment, check=True, capture_output=True).stdout
        rows = [Path(row["file"]) for row in json.loads(printed)["files"]]
        texts = {path.name: (folder / path.name).read_text(encoding="utf-8") for path in rows}
        runtime = sum(len(text.splitlines()) for name, text in texts.items() if name.startswith("sssgen-"))
        for name in names:
            module = next(text for file, text in texts.items() if re.fullmatch(rf"{name}(\.babylon)?\.m?js", file))
            types = next(text for file, text in texts.items() if re.fullmatch(rf"{name}(\.babylon)?\.d\.m?ts", file))
            shader = sum(len(text.splitlines()) for text in FUNCTIONS.findall(module))
            other = len(module.splitlines()) - shader
            result[f"{name} {target}"] = Size(shader, other, len(types.splitlines()), runtime)
    return result


def main() -> None:
    """Prints a row per material and engine."""
    with tempfile.TemporaryDirectory() as temporary:
        work = Path(temporary)
        new = sizes(ROOT, work / "new")
        old = sizes(checkout(sys.argv[1], work / "old"), work / "old_out") if len(sys.argv) > 1 else {}
    print(f"{'material':28} {'shader':>7} {'other':>7} {'before':>7} {'.d.ts':>6} {'runtime of all':>15}")
    for name, size in new.items():
        before = str(old[name].other) if name in old else ""
        print(f"{name:28} {size.shader:7} {size.other:7} {before:>7} {size.types:6} {size.runtime:15}")


if __name__ == "__main__":
    main()
