"""The wheel has the data of `sssgen emit`, and emits the same files in an empty environment as the checkout.

`make dist` runs these tests with the wheel that it built: DIST names its folder.
"""

from __future__ import annotations

import ast
import json
import os
import re
import shlex
import shutil
import subprocess
import sys
import tomllib
import venv
import zipfile
from collections.abc import Callable
from pathlib import Path

import pytest

from folders import ROOT
from sssgen.cli.output import WRONG_INPUT
from sssgen.material.material_loading import examples
from sssgen.support.installation import DISTRIBUTION
from sssgen.support.paths import folder
from sssgen.version import VERSION


def run(*command: str | Path, cwd: Path, status: int = 0, **variables: str) -> str:
    """The output of a command that has to end with the status, run without this environment's Python settings."""
    stored = [name for name in os.environ if not name.startswith(("PYTHON", "SSSGEN"))]
    environment = {name: os.environ[name] for name in stored}
    done = subprocess.run(
        [str(part) for part in command],
        cwd=cwd,
        env={**environment, "PIP_DISABLE_PIP_VERSION_CHECK": "1", **variables},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == status, f"{command}\n{done.stdout}\n{done.stderr}"
    return done.stdout


def pip(programs: Path) -> tuple[str | Path, ...]:
    """This environment's pip, for the environment that has these programs."""
    return (sys.executable, "-m", "pip", "--python", programs / "python")


@pytest.fixture(scope="session")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The wheel of this checkout, or the one in the folder $DIST."""
    if built := os.environ.get("DIST"):
        (given,) = Path(built).resolve().glob("*.whl")
        return given
    path = tmp_path_factory.mktemp("wheel")
    run(sys.executable, "-m", "pip", "wheel", "--quiet", "--no-deps", "--wheel-dir", path, ROOT, cwd=path)
    (made,) = path.glob("*.whl")
    return made


BUNDLE = ROOT / "build" / "preview"


def test_the_wheel_has_the_libraries_of_the_preview(wheel: Path) -> None:
    """With their licence, where `make setup` made the bundle."""
    with zipfile.ZipFile(wheel) as archive:
        carried = {name: archive.read(name) for name in archive.namelist() if name.startswith("sssgen/_data/preview/")}
    made = (BUNDLE / "library.js").is_file()
    assert set(carried) == (
        {f"sssgen/_data/preview/{name}" for name in ("library.js", "three.LICENSE")} if made else set()
    )
    if made:
        assert b"The MIT License" in carried["sssgen/_data/preview/three.LICENSE"]
        assert carried["sssgen/_data/preview/library.js"] == (BUNDLE / "library.js").read_bytes()


@pytest.mark.slow
def test_a_checkout_without_npm_is_installed(tmp_path: Path) -> None:
    ignored = shutil.ignore_patterns(
        "build", ".venv", ".git", "dist", "out", "tests", "docs", ".*_cache", "__pycache__"
    )
    shutil.copytree(ROOT, tmp_path / "checkout", ignore=ignored)
    run(
        sys.executable,
        "-m",
        "pip",
        "wheel",
        "--quiet",
        "--no-deps",
        "-w",
        tmp_path,
        tmp_path / "checkout",
        cwd=tmp_path,
    )
    (made,) = tmp_path.glob("*.whl")
    with zipfile.ZipFile(made) as archive:
        assert not [name for name in archive.namelist() if "_data/preview" in name]


@pytest.fixture(scope="session")
def installed(wheel: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The programs of an environment that has only the wheel and its dependencies."""
    path = tmp_path_factory.mktemp("environment")
    venv.create(path)
    programs = path / ("Scripts" if sys.platform == "win32" else "bin")
    run(*pip(programs), "install", "--quiet", wheel, cwd=path)
    return programs


def test_the_wheel_has_exactly_its_data(wheel: Path) -> None:
    with zipfile.ZipFile(wheel) as archive:
        names = set(archive.namelist())
        texts = {name: archive.read(name) for name in names}
    for name in ("templates", "targets", "examples"):
        prefix = f"sssgen/_data/{name}/"
        carried = {Path(one.removeprefix(prefix)) for one in names if one.startswith(prefix)}
        files = {path.relative_to(ROOT / name) for path in (ROOT / name).rglob("*") if path.is_file()}
        assert carried == {file for file in files if "__pycache__" not in file.parts}
    for path in (ROOT / "src" / "sssgen").rglob("*"):
        inside = path.relative_to(ROOT / "src")
        if path.is_file() and not any(part.startswith((".", "__pycache__")) for part in inside.parts):
            assert inside.as_posix() in names
    assert {name.split("/")[0] for name in names} == {"sssgen", f"sssgen_shaders-{VERSION}.dist-info"}
    assert not any("__pycache__" in name or "qualification" in name for name in names)
    assert not [name for name, text in texts.items() if str(ROOT).encode() in text]
    metadata = texts[f"sssgen_shaders-{VERSION}.dist-info/METADATA"].decode()
    assert f"Version: {VERSION}" in metadata
    assert "License-Expression: MIT\nLicense-File: LICENSE\n" in metadata
    assert f"sssgen_shaders-{VERSION}.dist-info/licenses/LICENSE" in names
    assert b"sssgen = sssgen.cli.main:main" in texts[f"sssgen_shaders-{VERSION}.dist-info/entry_points.txt"]


def test_the_source_distribution_carries_the_qualification() -> None:
    """What proves the project is for those who build it: it is in the sdist, not in the wheel."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    assert "/qualification" in project["tool"]["hatch"]["build"]["targets"]["sdist"]["include"]
    assert "/tests" in project["tool"]["hatch"]["build"]["targets"]["sdist"]["include"], "they import it"
    for path in (ROOT / "src").rglob("*.py"):
        assert "import qualification" not in (text := path.read_text(encoding="utf-8")), path
        assert "from qualification" not in text, path


@pytest.mark.slow
def test_the_wheel_and_the_checkout_emit_equal_files(installed: Path, tmp_path: Path) -> None:
    """Every example for every target, each side with its own hash seed and with no cache to begin with."""
    names = list(examples())
    wheel_run = [installed / "sssgen", "emit", *names, "--target", "all", "-o", "wheel"]
    run(*wheel_run, cwd=tmp_path, PYTHONHASHSEED="1", SSSGEN_CACHE=str(tmp_path / "cache_1"))
    checkout_run = [sys.executable, "-m", "sssgen", "emit", *names, "--target", "all", "-o", "checkout"]
    run(
        *checkout_run,
        cwd=tmp_path,
        PYTHONPATH=str(ROOT / "src"),
        PYTHONHASHSEED="2",
        SSSGEN_CACHE=str(tmp_path / "cache_2"),
    )
    ours = {path.name: path.read_bytes() for path in (tmp_path / "checkout").iterdir()}
    theirs = {path.name: path.read_bytes() for path in (tmp_path / "wheel").iterdir()}
    assert len(ours) > len(names)
    assert theirs == ours


@pytest.mark.slow
def test_the_wheel_checks_and_runs_unitys_text(
    wheel: Path, tmp_path: Path, compiler: Callable[[str], object], backend: Callable[[str], object]
) -> None:
    """Outside of a checkout the stand-in headers are found."""
    compiler("unity"), backend("unity-urp")
    with zipfile.ZipFile(wheel) as archive:
        archive.extractall(tmp_path / "installed")
    own = {"PYTHONPATH": str(tmp_path / "installed"), "SSSGEN_UNITY_INCLUDES": ""}
    program = [sys.executable, "-m", "sssgen"]
    checked = run(*program, "check", "ice", "--target", "unity-urp", cwd=tmp_path, **own)
    assert "the project's stand-in headers" in checked
    evaluated = run(*program, "eval", "beer_lambert", "--samples", "9", "-b", "unity,unity-urp", cwd=tmp_path, **own)
    assert evaluated.count("the project's stand-in headers") == 2


def test_the_installed_program(installed: Path, tmp_path: Path) -> None:
    assert run(installed / "sssgen", "--version", cwd=tmp_path) == f"sssgen {VERSION}\n"
    assert run(installed / "python", "-m", "sssgen", "--version", cwd=tmp_path) == f"sssgen {VERSION}\n"
    packages = run(*pip(installed), "list", "--format", "freeze", cwd=tmp_path).lower()
    assert "numpy" not in packages
    listed = run(installed / "sssgen", "list", "targets", cwd=tmp_path)
    assert {line.split()[0] for line in listed.splitlines()} == {path.stem for path in folder("targets").glob("*.toml")}


HINT = re.compile(r"install (?:-e )?\"(?P<path>.+)\[(?P<extra>[\w,]+)\]\"$")


def test_a_hint_of_the_installed_program(installed: Path, wheel: Path, tmp_path: Path) -> None:
    """It names the wheel and the environment that lack the extra."""
    command = [installed / "sssgen", "eval", "lobe_exp2", "--samples", "10", "--json"]
    (diagnostic,) = json.loads(run(*command, cwd=tmp_path, status=WRONG_INPUT))["diagnostics"]
    found = HINT.search(diagnostic["help"])
    assert found is not None
    assert (found["path"], found["extra"]) == (str(wheel), "numpy")
    assert diagnostic["help"].startswith(str(installed))


def test_the_doctor_of_the_installed_program(installed: Path, wheel: Path, tmp_path: Path) -> None:
    found = json.loads(run(installed / "sssgen", "doctor", "--json", cwd=tmp_path))
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    assert {row["name"] for row in found["extras"]} == set(project["optional-dependencies"]) - {"dev"}
    assert [row["name"] for row in found["extras"] if row["found"]] == []
    assert {"jinja2", "lark", "argcomplete"} == set(found["packages"])
    assert found["source"] == f"installed from {wheel}"
    assert {f'"{wheel}[{row["name"]}]"' in row["how"] for row in found["extras"]} == {True}


def pip_steps(text: str, wheel: Path) -> list[str]:
    """The shell blocks of a document that install the project with pip; `wheel` stands in for the project."""
    steps = []
    for block in re.findall(r"^```(?:sh|bash|console)\n(.*?)^```", text, re.MULTILINE | re.DOTALL):
        own = re.compile(rf"""(\binstall )(?:-e )?(["']?)(?:\.|(?:\./)?{DISTRIBUTION})(\[[\w,]+\])?\2(?=\s)""")
        replaced, count = own.subn(lambda match: f"{match[1]}'{wheel}{match[3] or ''}'", block)
        if count:
            lines = [line.removeprefix("$ ") for line in replaced.splitlines(keepends=True)]
            steps.append("".join(line for line in lines if not line.startswith(("git clone ", "cd "))))
    return steps


def test_the_pip_steps_of_a_document() -> None:
    text = "```sh\ngit clone x\ncd x\npip install '.[gl]'  # y\nsssgen\n```\n\n```sh\npip install moderngl\n```\n"
    assert pip_steps(text, Path("a.whl")) == ["pip install 'a.whl[gl]'  # y\nsssgen\n"]
    assert pip_steps(f"```sh\npip install './{DISTRIBUTION}[gl]' b\n```\n", Path("a.whl")) == [
        "pip install 'a.whl[gl]' b\n"
    ]
    text = f"```sh\n.venv/bin/pip install {DISTRIBUTION}\n```\n```sh\npip install -e .\n```\n"
    assert pip_steps(text, Path("a.whl")) == [".venv/bin/pip install 'a.whl'\n", "pip install 'a.whl'\n"]


@pytest.fixture
def empty(tmp_path: Path) -> tuple[Path, dict[str, str]]:
    """A folder, and variables with which the commands of an empty environment are found first."""
    venv.create(tmp_path / "environment", with_pip=True)
    path = os.pathsep.join([str(tmp_path / "environment" / "bin"), os.environ.get("PATH", "")])
    folder = tmp_path / "folder"
    folder.mkdir()
    return folder, {"PATH": path, "PIP_QUIET": "1"}


@pytest.mark.slow
@pytest.mark.parametrize(
    "document", ["README.md", "docs/install.md", "docs/preview.md", "docs/editors.md", "examples/ci/README.md"]
)
def test_the_pip_steps_work_in_an_empty_environment(
    document: str, wheel: Path, empty: tuple[Path, dict[str, str]]
) -> None:
    """In an empty folder, or in a copy of the example's folder."""
    folder, variables = empty
    if document.startswith("examples/"):
        shutil.copytree((ROOT / document).parent, folder, dirs_exist_ok=True)
    steps = pip_steps((ROOT / document).read_text(encoding="utf-8"), wheel)
    assert steps
    for step in steps:
        run("bash", "-euc", step, cwd=folder, **variables)


@pytest.mark.slow
def test_pip_finds_every_package_of_the_extras(wheel: Path, empty: tuple[Path, dict[str, str]]) -> None:
    """All together; wheels that `make setup` built are found in build/wheels."""
    folder, variables = empty
    extras = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]["optional-dependencies"]
    every = ",".join(extras)
    found = ("--find-links", ROOT / "build" / "wheels")
    run("bash", "-euc", 'pip install --dry-run "$@"', "pip", *found, f"{wheel}[{every}]", cwd=folder, **variables)


@pytest.mark.slow
def test_following_a_hint(wheel: Path, empty: tuple[Path, dict[str, str]]) -> None:
    folder, variables = empty
    run("bash", "-euc", f"pip install {shlex.quote(str(wheel))}", cwd=folder, **variables)
    evaluate = "sssgen eval lobe_exp2 --samples 10 --json"
    answer = run("bash", "-uc", evaluate, cwd=folder, status=WRONG_INPUT, **variables)
    hint = json.loads(answer)["diagnostics"][0]["help"]
    assert hint == f'pip install "{wheel}[numpy]"'
    run("bash", "-euc", f"{hint}; {evaluate}", cwd=folder, **variables)


def test_every_import_is_a_dependency() -> None:
    """Every module from outside that src/ imports is a dependency, or one of an extra."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    declared = str([project["dependencies"], project["optional-dependencies"]])
    outside: set[str] = set()
    for path in (ROOT / "src").rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Import):
                outside |= {name.name.split(".")[0] for name in node.names}
            elif isinstance(node, ast.ImportFrom) and node.level == 0:
                outside.add(str(node.module).split(".")[0])
    outside -= {*sys.stdlib_module_names, "sssgen"}
    assert {name for name in outside if name not in declared} == set()
