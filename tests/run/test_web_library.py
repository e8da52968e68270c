"""The libraries of the page: the bundle, npm's files, or a hint."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
from pathlib import Path
from typing import Any

import pytest

from folders import ROOT
from sssgen.run import web_library as module
from sssgen.run.web_library import BUNDLE, NPM, bundle, library
from sssgen.support import cache
from sssgen.support.diagnostics import SssgenError

PREVIEW = Path(module.__file__).parent.parent / "preview"
PAGE, EXPORTED = PREVIEW / "page", PREVIEW / "library_bundle.js"


@pytest.fixture
def empty(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A checkout in which nothing was built."""
    monkeypatch.setattr(module, "folder", lambda name: tmp_path / name)
    monkeypatch.setenv("SSSGEN_NODE_MODULES", str(tmp_path / "node_modules"))
    return tmp_path


def written(path: Path) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text("", encoding="utf-8")


def test_without_npm_the_command_that_helps_is_named(empty: Path) -> None:
    with pytest.raises(SssgenError, match="npm package three") as caught:
        library()
    assert "npm install" in str(caught.value)


def test_the_bundle_is_one_file_for_every_import(empty: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("SSSGEN_NODE_MODULES")
    written(bundle())
    found = library()
    assert found.files == {BUNDLE: empty / "build" / "preview" / BUNDLE}
    assert set(json.loads(found.import_map())["imports"].values()) == {f"./library/{BUNDLE}"}


def test_npms_files_serve_where_there_is_no_bundle(empty: Path) -> None:
    for file in (*NPM.values(), *module._IMPORTED_BY_THESE):
        written(empty / "node_modules" / file)
    found = library()
    assert set(found.imports.values()) <= set(found.files)
    assert json.loads(found.import_map())["imports"]["three"] == "./library/three/build/three.module.js"


def test_npm_fetches_the_files_once(
    empty: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.delenv("SSSGEN_NODE_MODULES")
    monkeypatch.setattr(module, "node_modules", lambda: empty / "nothing")
    monkeypatch.setattr(cache, "folder", lambda: str(empty))
    monkeypatch.setattr(shutil, "which", lambda name: name)
    commands = []

    def npm(command: tuple[str, ...], **options: Any) -> None:
        commands.append(command)
        if len(commands) == 1:
            raise subprocess.CalledProcessError(1, command)
        for file in (*NPM.values(), *module._IMPORTED_BY_THESE):
            written(Path(command[3]) / "node_modules" / file)

    monkeypatch.setattr(subprocess, "run", npm)
    with pytest.raises(SssgenError, match="npm package three"):
        library()
    for _ in range(2):
        assert {path.parent for path in library().files.values()} <= {path.parent for path in empty.rglob("*.js")}
    assert len(commands) == 2 and commands[1][-1] == f"three@{module.VERSION}"
    assert capsys.readouterr().err.count("npm fetches three.js") == 2


def test_all_that_the_page_imports_is_in_the_bundle() -> None:
    text = "\n".join(path.read_text(encoding="utf-8") for path in PAGE.glob("*.js"))
    imported = {name for name in re.findall(r"from '([^']+)'", text) if not name.startswith(".")}
    exported = set(re.findall(r"from '([^']+)'", EXPORTED.read_text(encoding="utf-8")))
    assert imported <= exported == set(NPM)


def test_the_network_has_every_import() -> None:
    addresses = json.loads(module.network_import_map())["imports"]
    assert addresses.keys() == NPM.keys()
    assert addresses["three"] == f"https://cdn.jsdelivr.net/npm/three@{module.VERSION}/build/three.module.js"
    assert f"three@{module.VERSION} " in (ROOT / "Makefile").read_text(encoding="utf-8")
