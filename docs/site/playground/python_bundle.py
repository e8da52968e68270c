"""The part of sssgen that the playground runs, compiled for Pyodide: no NumPy, no compilers, no lark."""

from __future__ import annotations

import importlib.util
import json
import shutil
import subprocess
import tempfile
from collections.abc import Mapping
from pathlib import Path

from packed_file import write_packed
from sssgen.run.machine_parts import node, node_modules
from sssgen.support import paths
from sssgen.support.diagnostics import failure
from sssgen.support.installation import npm_hint
from starts import Start

HERE = Path(__file__).parent
RUN = ("ir", "lang", "material", "passes", "pipeline", "shells", "support", "targets", "techniques")
"""The folders of the package that the way to a shader's text needs."""
MODULES = ("__init__.py", "version.py", "preview/__init__.py", "preview/emitted_head.py", "preview/flat_head.py")
NEVER = ("__pycache__", "numpy_runtime.py", "runtime", "worker_process.py")
"""What runs emitted Python, and what starts processes."""
LIBRARIES = ("jinja2", "markupsafe")
PYODIDE_FILES = ("pyodide.mjs", "pyodide.asm.mjs", "pyodide.asm.wasm")
SECONDS = 280.0


def pyodide() -> Path:
    """The folder of npm's Pyodide. Raises SssgenError where it or Node.js is missing."""
    folder = node_modules() / "pyodide"
    if not (folder / "pyodide.asm.wasm").is_file() or not node():
        raise failure("the playground needs Node.js and the npm package pyodide", npm_hint("pyodide"))
    return folder


def write_bundle(folder: Path, starts: Mapping[str, Start], first: str) -> None:
    """Writes Pyodide, the standard library and sssgen into a folder, each file as the page's worker reads it.

    `starts` are the materials of the page by their names; the caches of the bundle have what the first one needs.
    """
    with tempfile.TemporaryDirectory() as temporary:
        stage, out = Path(temporary, "stage"), Path(temporary, "out")
        out.mkdir()
        _stage(stage, starts, first)
        command = [node(), str(HERE / "precompile.mjs"), str(pyodide()), str(stage), str(out)]
        done = subprocess.run(command, capture_output=True, text=True, timeout=SECONDS)
        if done.returncode:
            raise failure(f"Pyodide cannot compile the playground: {done.stderr.strip()[-2000:]}")
        folder.mkdir(parents=True, exist_ok=True)
        for name in ("app.zip", "stdlib.zip"):
            write_packed(folder / name, (out / name).read_bytes())
    for name in PYODIDE_FILES:
        shutil.copyfile(pyodide() / name, folder / name)
    lock = json.loads((pyodide() / "pyodide-lock.json").read_text(encoding="utf-8"))
    (folder / "pyodide-lock.json").write_text(json.dumps({**lock, "packages": {}}), encoding="utf-8")


def _stage(stage: Path, starts: Mapping[str, Start], first: str) -> None:
    package = stage / "app" / "sssgen"
    for name in RUN:
        shutil.copytree(Path(paths.PACKAGE, name), package / name, ignore=shutil.ignore_patterns(*NEVER))
    for name in MODULES:
        (package / name).parent.mkdir(exist_ok=True)
        shutil.copyfile(Path(paths.PACKAGE, name), package / name)
    for name in ("targets", "templates"):
        shutil.copytree(paths.folder(name), package / "_data" / name, ignore=shutil.ignore_patterns("*.md"))
    for name in LIBRARIES:
        found = importlib.util.find_spec(name)
        assert found is not None and found.origin is not None
        ignored = shutil.ignore_patterns("__pycache__", "*.so", "*.pyd", "*.c", "*.pyi", "py.typed")
        shutil.copytree(Path(found.origin).parent, stage / "app" / name, ignore=ignored)
    shutil.copyfile(HERE / "playground_session.py", stage / "app" / "playground_session.py")
    for name, start in starts.items():
        for file, text in {**start.files, **start.data}.items():
            path = stage / "examples" / name / file
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, encoding="utf-8", newline="")
    asked = {"example": first, "main": starts[first].main}
    (stage / "first.json").write_text(json.dumps(asked), encoding="utf-8")
