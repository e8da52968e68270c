"""The benchmarks and the scripts of docs/ import names that exist."""

from __future__ import annotations

import ast
import importlib
from pathlib import Path

import pytest

from folders import DOCS, ROOT

SCRIPTS = sorted([*(ROOT / "benchmarks").glob("*.py"), *DOCS.glob("*.py")])
OLDER_STATES = {"benchmarks/replay.py"}
"""Scripts that also import the modules of older states of the project."""


@pytest.mark.parametrize("path", SCRIPTS, ids=lambda path: path.relative_to(ROOT).as_posix())
def test_imports(path: Path) -> None:
    missing = []
    for node in ast.walk(ast.parse(path.read_text("utf-8"))):
        if isinstance(node, ast.ImportFrom) and (node.module or "").split(".")[0] in ("sssgen", "qualification"):
            missing += [f"{node.module}.{alias.name}" for alias in node.names if not exists(node.module, alias.name)]
    assert not missing or path.relative_to(ROOT).as_posix() in OLDER_STATES


def exists(module: str | None, name: str) -> bool:
    """Whether a module has a name, or a submodule of that name."""
    try:
        return hasattr(importlib.import_module(str(module)), name) or bool(importlib.import_module(f"{module}.{name}"))
    except ImportError:
        return False
