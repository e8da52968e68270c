"""`sssgen doctor`: what is found and what is missing, and how to get it. It starts nothing by itself."""

from __future__ import annotations

import json
import re
import subprocess
from pathlib import Path

import pytest

from command_line import Run
from folders import ROOT
from sssgen.run import machine_facts, machine_parts
from sssgen.run.backend_registry import BACKENDS
from sssgen.run.compiler_registry import COMPILERS
from sssgen.support import extra_packages
from sssgen.support.installation import install_hint
from sssgen.version import VERSION


@pytest.fixture
def bare(monkeypatch: pytest.MonkeyPatch) -> None:
    """A machine without programs and packages, on which no process can be started."""

    def refuse(*command: object, **_: object) -> None:
        raise AssertionError(f"started: {command}")

    for variable in machine_facts.VARIABLES:
        monkeypatch.delenv(variable, raising=False)
    for variable in ("SSSGEN_NODE_MODULES", "SSSGEN_CHROMIUM", "SSSGEN_FIREFOX", "SSSGEN_GODOT", "PATH"):
        monkeypatch.setenv(variable, "nowhere")
    monkeypatch.setattr(machine_parts, "folder", Path)
    monkeypatch.setattr(machine_parts, "find_spec", lambda _: None)
    monkeypatch.setattr(machine_facts, "installed_version", lambda _: "")
    monkeypatch.setattr(subprocess, "Popen", refuse)


def test_every_back_end_and_compiler_names_its_parts() -> None:
    """Only Python's own compiler needs nothing."""
    without = [name for name, record in [*BACKENDS.items(), *COMPILERS.items()] if not record.parts]
    assert without == ["python"]
    named = {part for record in [*BACKENDS.values(), *COMPILERS.values()] for part in record.parts}
    assert named == machine_parts._PARTS.keys()


def test_every_variable_is_known() -> None:
    read = set()
    for path in (ROOT / "src").rglob("*.py"):
        read |= set(re.findall(r'environ(?:\.get\(|\[)"(SSSGEN_\w+)"', path.read_text(encoding="utf-8")))
    assert read == set(machine_facts.VARIABLES)


@pytest.mark.usefixtures("bare")
def test_on_a_bare_machine_everything_is_missing_with_how_to_get_it(run: Run) -> None:
    data = json.loads(run("doctor", "--json").out)
    assert data["ok"] and data["sssgen"] == VERSION and data["source"] == f"the checkout {ROOT}"
    found = {kind: [row["name"] for row in data[kind] if row["found"]] for kind in ("extras", "compilers", "backends")}
    assert found == {"extras": [], "compilers": ["python"], "backends": []}
    assert [row["name"] for row in data["backends"]] == list(BACKENDS)
    assert [row["name"] for row in data["compilers"]] == list(COMPILERS)
    how = {kind: {row["name"]: row["how"] for row in data[kind]} for kind in ("backends", "extras")}
    assert how["extras"]["render"] == install_hint("render")
    pip = r'\S+ install -e "\S*\[{}\]"'
    assert re.fullmatch(pip.format("webgpu"), how["backends"]["webgpu"])
    assert re.match(pip.format("browser") + r"; Chromium or Chrome \(Debian: chromium;", how["backends"]["threejs"])
    text = run("doctor").out
    assert re.search(
        r"  godot    missing: Godot 4.6: make (-C \S+ )?engines \(Debian, as root\), or SSSGEN_GODOT=", text
    )
    assert "  python   found: Python itself\n" in text


def test_versions_and_variables(run: Run, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    for variable in machine_facts.VARIABLES:
        monkeypatch.delenv(variable, raising=False)
    monkeypatch.setenv("SSSGEN_CACHE", str(tmp_path / "cache"))
    monkeypatch.setenv("SSSGEN_GLSLANK", "x")
    result = run("doctor")
    assert result.status == 0
    assert f"  sssgen    {VERSION}, the checkout {ROOT}\n" in result.out
    assert f"  SSSGEN_CACHE    '{tmp_path / 'cache'}': the cache folder; empty for none\n" in result.out
    assert "  SSSGEN_GLSLANK  x  (sssgen reads no such variable)\n" in result.out
    assert re.search(r"\bjinja2 [\d.]+, lark [\d.]+", result.out)
    assert json.loads(run("doctor", "--json").out)["unknown_variables"] == ["SSSGEN_GLSLANK"]


def test_a_back_end_that_does_not_start(run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    """Each is started in a process of its own, which may fail in any way."""
    monkeypatch.setattr(machine_facts, "COMPILERS", {"python": COMPILERS["python"]})
    broken = BACKENDS["numpy"]._replace(name="broken", parts=())
    monkeypatch.setattr(machine_facts, "BACKENDS", {"broken": broken, "numpy": BACKENDS["numpy"]})
    result = run("doctor", "--run")
    assert result.status == 0
    assert re.search(r"  python  starts: Python 3\.\d+", result.out)
    assert re.search(r"  broken  does not start: 'broken'\n  numpy   starts: NumPy [\d.]+, float64\n", result.out)


def test_the_extras_of_a_checkout_and_of_an_installed_package(monkeypatch: pytest.MonkeyPatch) -> None:
    """The metadata of a package states the requirements as pyproject.toml does, each with a marker for its extra."""
    in_checkout = extra_packages.packages()
    declared = extra_packages._declared_requirements()
    assert in_checkout[extra_packages.NEEDED] == ["argcomplete", "jinja2", "lark"]
    assert {"mitsuba", "trimesh"} <= set(in_checkout["reference"]), "it names the extra render"
    assert "dev" in declared and "dev" not in in_checkout
    stated = [
        text if extra == extra_packages.NEEDED else f"{text}{' and' if ';' in text else ';'} extra == '{extra}'"
        for extra, texts in declared.items()
        for text in texts
    ]
    monkeypatch.setattr(extra_packages, "source", lambda: ("", False))
    monkeypatch.setattr(extra_packages, "requires", lambda _: stated)
    assert extra_packages.packages() == in_checkout


def test_a_package_for_older_pythons_is_not_missed(monkeypatch: pytest.MonkeyPatch) -> None:
    texts = {"": [], "a": ["old>=1; python_version < '3.0'", "new; python_version < '9.0'"]}
    monkeypatch.setattr(extra_packages, "_declared_requirements", lambda: texts)
    assert extra_packages.packages()["a"] == ["new"]


def test_without_metadata_there_are_no_extras(monkeypatch: pytest.MonkeyPatch, run: Run) -> None:
    monkeypatch.setattr(extra_packages, "source", lambda: ("", False))
    monkeypatch.setattr(extra_packages, "DISTRIBUTION", "sssgen-nowhere")
    result = run("doctor", "--json")
    assert result.status == 0 and json.loads(result.out)["extras"] == []
