"""A user copies examples/ci, runs it, changes it and updates it, with pytest and with `sssgen ci`."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import xml.etree.ElementTree as ET
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from folders import EXAMPLES
from sssgen.cli import main as cli
from sssgen.material.material_loading import examples
from sssgen.run.backends import Backend
from sssgen.scene.pictures import images

pytest.importorskip("flip_evaluator", reason="flip-evaluator is missing: pip install -e '.[render]'")

EXAMPLE = EXAMPLES / "ci"
NO_DRIVER = {"__EGL_VENDOR_LIBRARY_FILENAMES": os.devnull}
GL = ("--backend", "gl")

RunCI = Callable[..., tuple[int, str]]


@pytest.fixture(autouse=True)
def project(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, backend: Callable[[str], Backend]) -> Path:
    """A copy of the example; it is the current folder."""
    backend("gl")
    folder = shutil.copytree(EXAMPLE, tmp_path / "project")
    monkeypatch.chdir(folder)
    return folder


def run(*arguments: str, **variables: str) -> tuple[int, str]:
    """The exit status of a Python module, and its output."""
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path), "PYTEST_DISABLE_PLUGIN_AUTOLOAD": "1"}
    environment.pop("CI", None)
    command = [sys.executable, "-m", *arguments]
    process = subprocess.run(command, env={**environment, **variables}, capture_output=True, text=True, check=False)
    return process.returncode, process.stdout + process.stderr


def run_pytest(*arguments: str, **variables: str) -> tuple[int, str]:
    return run("pytest", "-p", "sssgen.testing.pytest_plugin", "-p", "no:cacheprovider", *arguments, **variables)


@pytest.fixture
def run_ci(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> RunCI:
    """`run_ci(ARGUMENTS)`: `sssgen ci` in the current folder; its exit status and its output."""
    monkeypatch.delenv("CI", raising=False)

    def run_here(*arguments: str) -> tuple[int, str]:
        status = cli.main(["ci", *arguments])
        return status, "".join(capsys.readouterr())

    return run_here


def brighten() -> None:
    material = Path("materials/lamp.toml")
    text = material.read_text(encoding="utf-8")
    assert "scale = 2.0" in text
    material.write_text(text.replace("scale = 2.0", "scale = 2.2"), encoding="utf-8")


def failures() -> list[str]:
    return sorted(path.name for path in Path("scenes/sssgen-failures").glob("*"))


def report(path: str = "report.xml") -> tuple[dict[str, str], dict[str, ET.Element]]:
    """The counts of the test suite, and its test cases by kind."""
    (suite,) = ET.parse(path).getroot().findall("testsuite")
    return suite.attrib, {case.attrib["classname"]: case for case in suite.findall("testcase")}


@pytest.mark.slow
def test_with_pytest() -> None:
    assert run_pytest()[0] == 0
    brighten()
    status, message = run_pytest("-k", "looks")
    assert status == 1
    assert "FLIP 0.0" in message and "is more than 0.005" in message and "max" in message
    assert 'sssgen_golden(SCENE, "lamp")' in message
    assert "pytest_plugin.py" not in message.replace("-p sssgen.testing.pytest_plugin", "")
    assert failures() == ["lamp.actual.png", "lamp.difference.png"]
    assert images.read("scenes/sssgen-failures/lamp.difference.png").shape == (72, 96, 3)
    assert run_pytest("-k", "looks", "--sssgen-flip", "0.2")[0] == 0
    assert run_pytest("-k", "looks", "--sssgen-update")[0] == 0
    assert failures() == []


def test_with_the_command(run_ci: RunCI) -> None:
    status, message = run_ci(".", *GL, "--junit", "report.xml")
    assert status == 0, message
    suite, cases = report()
    assert (suite["tests"], suite["failures"], suite["skipped"], suite["errors"]) == ("3", "0", "0", "0")
    assert set(cases) == {"compile", "render", "eval"}
    assert all(float(case.attrib["time"]) > 0.0 for case in cases.values())
    brighten()
    status, message = run_ci("scenes", "--junit", "report.xml")
    assert status == 1
    assert "FAIL render  scenes/lamp.toml [gl]" in message and "1 failed" in message
    failure = report()[1]["render"].find("failure")
    assert failure is not None and failure.text is not None
    assert "FLIP 0.0" in failure.attrib["message"] and "lamp.difference.png" in failure.text
    assert failures() == ["lamp.actual.png", "lamp.difference.png"]
    assert run_ci("scenes", "--flip", "0.2")[0] == 0
    assert run_ci("scenes", "--update")[0] == 0
    status, message = run_ci("scenes", "--backend", "gl,numpy")
    assert (status, failures()) == (0, []), message


def test_a_missing_back_end_is_skipped_and_fails_in_ci() -> None:
    status, message = run("sssgen", "ci", "scenes", "--junit", "report.xml", **NO_DRIVER)
    assert status == 1 and "nothing was checked" in message and "libgl1-mesa-dri" in message
    skipped = report()[1]["render"].find("skipped")
    assert skipped is not None and "the back end gl is missing" in skipped.attrib["message"]
    assert run("sssgen", "ci", "scenes", "--junit", "report.xml", **NO_DRIVER, CI="true")[0] == 1
    assert report()[0]["failures"] == "1"
    status, message = run_pytest("-rs", "-k", "looks", **NO_DRIVER)
    assert status == 0 and "1 skipped" in message and "libgl1-mesa-dri" in message
    status, message = run_pytest("-k", "looks", **NO_DRIVER, CI="true")
    assert status == 1 and "the back end gl is missing" in message


def test_another_size_and_no_golden_picture(run_ci: RunCI) -> None:
    images.write_png("scenes/golden/lamp.png", np.zeros((36, 48, 3)))
    status, message = run_ci("scenes")
    assert status == 1 and "has 96 × 72 pixels" in message and "has 48 × 36" in message
    assert failures() == ["lamp.actual.png"]
    Path("scenes/golden/lamp.png").unlink()
    status, message = run_ci("scenes")
    assert status == 1 and "no golden picture scenes/golden/lamp.png: --update writes it" in message


def test_folders_that_cannot_be_written(run_ci: RunCI) -> None:
    brighten()
    Path("scenes/sssgen-failures").write_text("a file", encoding="utf-8")
    status, message = run_ci("scenes")
    assert status == 1 and "is more than 0.005" in message and "cannot write" in message
    shutil.rmtree("scenes/golden")
    Path("scenes/golden").write_text("a file", encoding="utf-8")
    status, message = run_ci("scenes", "--update")
    assert status == 1 and "cannot write" in message and "Traceback" not in message
    assert Path("scenes/golden").read_text(encoding="utf-8") == "a file"
    status, message = run_ci("scenes", "--junit", "scenes/golden/report.xml")
    assert status == 2 and "cannot write" in message and "render" not in message


def test_the_workflow_runs_the_commands_of_the_example() -> None:
    text = Path(".github/workflows/shaders.yml").read_text(encoding="utf-8")
    assert "python -m pytest --junitxml report.xml" in text
    assert "sssgen ci . --junit report.xml" in text
    assert "\t" not in text


def test_the_folder_is_not_an_example_material() -> None:
    assert "ci" not in examples()
    assert not list(EXAMPLE.glob("*.toml"))  # the makefile compiles such files as materials
