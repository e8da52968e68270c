"""Nothing that the project writes or prints installs `sssgen` of the package index, which is a package of others."""

from __future__ import annotations

import json
import os
import re
import shutil
import sys
import tomllib
from collections.abc import Iterator
from itertools import chain
from pathlib import Path

import pytest

from folders import ROOT
from sssgen.run import machine_parts
from sssgen.run.backend_registry import BACKENDS
from sssgen.run.compiler_registry import COMPILERS
from sssgen.support import installation
from sssgen.support.installation import DISTRIBUTION, install_hint, make_hint, npm_hint

OWN = "sssgen"
FOREIGN = re.compile(
    rf"""\b(?:pipx?3?|uvx?|poetry|conda)\b[^\n]*\b(?:install|add|download|run)\b[^\n`;&|]*?["' ]{OWN}(?![-\w/.])"""
    rf"""|(?<![-\w.\\]){OWN}\[(?=[a-z])"""
)
"""A command that installs that package, or a requirement of it with extras."""
SKIPPED = {".git", ".venv", "build", "out", "dist", "node_modules", "__pycache__"}


def texts() -> Iterator[tuple[Path, str]]:
    """The text files of the project."""
    for folder, subfolders, names in os.walk(ROOT):
        subfolders[:] = [name for name in subfolders if name not in SKIPPED and not name.endswith("_cache")]
        for name in names:
            path = Path(folder, name)
            if path.is_file() and path.suffix not in (".json", ".svg"):
                data = path.read_bytes()
                if b"\0" not in data[:4096]:
                    yield path, data.decode("utf-8", "replace")


@pytest.mark.parametrize(
    ("text", "wrong"),
    [
        ("pip install {}", True),
        ("python -m pip install -U '{}[gl]'", True),
        ('uv pip install "{}>=1"', True),
        ("pipx run {}", True),
        ("reference = ['{}[render]']", True),
        ("pip install {}-shaders", False),
        ("pip install '{}-shaders[gl]'", False),
        (".venv/bin/pip install . && {}-vulkan", False),
        ("pip install ./{}_vulkan", False),
        ("`pip install '.[render]'` adds what it needs, and `{} doctor` lists it", False),
    ],
)
def test_what_is_looked_for(text: str, wrong: bool) -> None:
    assert bool(FOREIGN.search(text.format(OWN))) == wrong


def test_no_text_installs_the_package_of_others() -> None:
    read = dict(texts())
    assert {ROOT / "README.md", ROOT / "pyproject.toml", ROOT / "docs" / "harness.md"} <= set(read)
    found = [f"{path.relative_to(ROOT)}: {match[0]}" for path, text in read.items() for match in FOREIGN.finditer(text)]
    assert found == []


def test_no_package_depends_on_the_package_of_others() -> None:
    projects = [path for path, _ in texts() if path.name == "pyproject.toml"]
    assert len(projects) > 1
    for path in projects:
        project = tomllib.loads(path.read_text(encoding="utf-8"))["project"]
        needed = [*project.get("dependencies", ()), *chain(*project.get("optional-dependencies", {}).values())]
        names = {re.split(r"[^\w.-]", requirement)[0].lower() for requirement in needed}
        assert OWN not in names, path
        assert project["name"] != OWN


def test_no_hint_installs_the_package_of_others(monkeypatch: pytest.MonkeyPatch) -> None:
    said = [record.install for record in (*BACKENDS.values(), *COMPILERS.values())]
    said += [how for _, how in machine_parts._PARTS.values()]
    assert len([hint for hint in said if " install " in hint and "[" in hint]) > 10
    assert [hint for hint in said if FOREIGN.search(hint)] == []
    monkeypatch.setattr(installation, "source", lambda: ("", False))
    assert not FOREIGN.search(install_hint("gl"))


def fake_package(folder: Path, monkeypatch: pytest.MonkeyPatch, url: str = "") -> None:
    """Lets sssgen be an installed package in a folder; pip notes the URL of a package that is from no index."""
    (folder / "sssgen" / "_data").mkdir(parents=True)
    if url:
        metadata = folder / f"sssgen_shaders-{installation.VERSION}.dist-info"
        metadata.mkdir()
        (metadata / "direct_url.json").write_text(json.dumps({"url": url, "dir_info": {}}), encoding="utf-8")
    monkeypatch.setattr(installation, "PACKAGE", str(folder / "sssgen"))


@pytest.fixture
def pip_in_path(monkeypatch: pytest.MonkeyPatch) -> None:
    """As in an activated environment."""
    pip = str(Path(sys.executable).with_name("pip"))
    monkeypatch.setattr(shutil, "which", lambda *_, **__: pip)


@pytest.mark.usefixtures("pip_in_path")
class TestHints:
    def test_in_a_checkout(self, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
        monkeypatch.chdir(ROOT)
        assert install_hint("gl") == 'pip install -e ".[gl]"'
        monkeypatch.chdir(tmp_path)
        assert install_hint("gl") == f'pip install -e "{ROOT}[gl]"'
        monkeypatch.chdir(ROOT.parent)
        assert install_hint("gl") == f'pip install -e ".{os.sep}{ROOT.name}[gl]"'

    def test_packages_of_npm_and_what_make_installs(self, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
        monkeypatch.chdir(ROOT)
        assert npm_hint("three") == f"make setup, or npm install --prefix {Path('build', 'node')} three"
        assert make_hint("engines", "another way", "as root") == "make engines (as root), or another way"
        monkeypatch.chdir(tmp_path)
        assert npm_hint("three") == f"make -C {ROOT} setup, or npm install --prefix {ROOT / 'build' / 'node'} three"
        fake_package(tmp_path, monkeypatch)
        assert npm_hint("three") == "npm install three, and SSSGEN_NODE_MODULES=/path/to/node_modules"
        assert make_hint("engines", "another way", "as root") == "another way"

    def test_from_an_index(self, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
        fake_package(tmp_path, monkeypatch)
        assert install_hint("gl,webgpu") == f'pip install "{DISTRIBUTION}[gl,webgpu]"'

    def test_from_a_folder(self, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
        source = tmp_path / "a checkout"
        source.mkdir()
        fake_package(tmp_path / "installed", monkeypatch, source.as_uri())
        assert install_hint("gl") == f'pip install "{source}[gl]"'
        monkeypatch.chdir(source)
        assert install_hint("gl") == 'pip install ".[gl]"'

    def test_from_a_folder_that_is_gone(self, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
        fake_package(tmp_path / "installed", monkeypatch, (tmp_path / "gone").as_uri())
        assert install_hint("gl") == f'pip install "{DISTRIBUTION}[gl]"'

    @pytest.mark.parametrize("record", ["", "[]", "{}", '{"url": 1}', '{"url": "https://example.org/a.whl"}', "\xff"])
    def test_of_a_record_that_names_no_folder(
        self, monkeypatch: pytest.MonkeyPatch, tmp_path: Path, record: str
    ) -> None:
        fake_package(tmp_path, monkeypatch, "file:///")
        (tmp_path / f"sssgen_shaders-{installation.VERSION}.dist-info" / "direct_url.json").write_text(
            record, "latin-1"
        )
        assert install_hint("gl") == f'pip install "{DISTRIBUTION}[gl]"'


def test_the_pip_of_an_environment_that_is_not_activated(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    programs = tmp_path / "env" / "bin"
    programs.mkdir(parents=True)
    pip = programs / ("pip.exe" if sys.platform == "win32" else "pip")
    pip.touch(0o755)
    monkeypatch.setattr(sys, "executable", str(programs / "python"))
    monkeypatch.setattr(installation, "source", lambda: ("", False))
    monkeypatch.chdir(tmp_path)
    assert install_hint("gl") == f'{pip.relative_to(tmp_path)} install "{DISTRIBUTION}[gl]"'
    pip.unlink()
    python = Path("env", "bin", "python")
    assert install_hint("gl") == f'{python} -m pip install "{DISTRIBUTION}[gl]"'
    monkeypatch.chdir("env")
    assert install_hint("gl").startswith(f"{Path('bin', 'python')} -m pip install ")
