"""What the tests of the command line share."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from command_line import WAX, FakeCompiler
from sssgen.cli import list_names, transpile
from sssgen.cli.facts import material  # noqa: F401 - before the fake compiler, which it would keep
from sssgen.pipeline import emitted_cache
from sssgen.scene import scene_loading  # noqa: F401 - the same


@pytest.fixture
def compiler(monkeypatch: pytest.MonkeyPatch) -> FakeCompiler:
    fake = FakeCompiler()
    monkeypatch.setitem(sys.modules, "sssgen.pipeline.compiler", fake)
    monkeypatch.setattr(list_names, "all_targets", fake.all_targets)
    monkeypatch.setattr(transpile, "transpile", fake.transpile)
    monkeypatch.setattr(emitted_cache, "load", lambda *_: None)
    monkeypatch.setattr(emitted_cache, "store", lambda *_: None)
    return fake


@pytest.fixture(autouse=True)
def with_wax(in_folder: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.delenv("SSSGEN_DEBUG", raising=False)
    Path("wax.toml").write_text(WAX, encoding="utf-8")
    return in_folder
