"""The files of the project itself: workflows, forms, the citation, and the checklist of a release."""

from __future__ import annotations

import itertools
import re
import shlex
import subprocess
from pathlib import Path
from typing import Any

import pytest

from folders import DOCS, ROOT
from sssgen.cli.commands import COMMANDS, command_parser
from sssgen.support.diagnostics import SssgenError
from sssgen.support.installation import DISTRIBUTION
from sssgen.version import VERSION

yaml = pytest.importorskip("yaml", reason="PyYAML is missing: pip install -e '.[dev]'")

GITHUB = ROOT / ".github"
MAKEFILE = (ROOT / "Makefile").read_text(encoding="utf-8")


def load(path: Path) -> Any:
    return yaml.safe_load(path.read_text(encoding="utf-8"))


def workflows() -> list[Path]:
    return [*(GITHUB / "workflows").glob("*.yml"), *(ROOT / "examples" / "ci").rglob("*.yml")]


def commands(text: str) -> list[list[str]]:
    """The words of each command line, without comments."""
    return [words for line in text.splitlines() if (words := shlex.split(line, comments=True))]


def check_command(words: list[str]) -> None:
    """Fails for a command that the project does not have."""
    program, *rest = words
    name = Path(program).name
    if name in ("python", "python3") and rest[0] == "-m":
        name, *rest = rest[1:]
    if name == "make":
        (target,) = [word for word in rest if "=" not in word]
        for variable in (word.partition("=")[0] for word in rest if "=" in word):
            assert f"$({variable})" in MAKEFILE, words
        assert re.search(rf"^{target}:", MAKEFILE, re.MULTILINE), words
        subprocess.run(["make", "--dry-run", *rest], cwd=ROOT, check=True, capture_output=True)
    elif name == "sssgen":
        if rest != ["--version"]:
            command_parser(rest[0]).parse_args(rest[1:])
    elif name == "pip":
        assert rest[0] == "install"
        assert {word for word in rest if word.startswith(("sssgen", "."))} <= {DISTRIBUTION, ".[numpy]"}, words
    elif name == "pytest":
        for word in rest:
            assert not word.startswith("tests/") or list((ROOT / word).glob("test_*.py")), word
    elif name == "twine":
        assert "twine" in MAKEFILE and program == "build/release/bin/twine" and rest == ["upload", "dist/*"]
    elif name == "git":
        assert rest[0] in ("diff", "tag", "push")
    else:
        assert name == "venv" and rest, words


@pytest.mark.parametrize(
    "line", ["make nothing", "make fuzz MINUTES=1", "sssgen nothing", "sssgen doctor --nothing",
             "pip install ./elsewhere", "python -m pytest tests/nothing", "twine upload dist/*", "nothing"],
)  # fmt: skip
def test_a_command_that_does_not_exist_is_found(line: str) -> None:
    with pytest.raises((AssertionError, SssgenError, KeyError)):
        check_command(shlex.split(line))


@pytest.mark.parametrize("path", workflows(), ids=lambda path: path.relative_to(ROOT).as_posix())
def test_a_workflow(path: Path) -> None:
    workflow = load(path)
    assert workflow["name"] and workflow["permissions"] == {"contents": "read"}
    assert workflow[True], "YAML reads `on` as true"
    for job in workflow["jobs"].values():
        assert job["timeout-minutes"] and job["runs-on"]
        for step in job["steps"]:
            assert ("run" in step) != ("uses" in step)
            assert re.fullmatch(r"actions/[\w-]+@v\d+", step.get("uses", "actions/x@v1"))


@pytest.mark.parametrize("path", sorted((GITHUB / "workflows").glob("*.yml")), ids=lambda path: path.name)
def test_the_commands_of_a_workflow_exist(path: Path) -> None:
    for job in load(path)["jobs"].values():
        matrix = job.get("strategy", {}).get("matrix", {})
        for values, step in itertools.product(itertools.product(*matrix.values()), job["steps"]):
            text = step.get("run", "")
            for name, value in zip(matrix, values, strict=True):
                text = text.replace(f"${{{{ matrix.{name} }}}}", value)
            for words in commands(text):
                check_command(words)


def test_the_workflows_cover_three_systems() -> None:
    jobs = load(GITHUB / "workflows" / "tests.yml")["jobs"]
    systems = [jobs["linux"]["runs-on"], *jobs["emit"]["strategy"]["matrix"]["os"]]
    assert [system.partition("-")[0] for system in systems] == ["ubuntu", "macos", "windows"]
    assert "make test" in [step.get("run") for step in jobs["linux"]["steps"]]
    assert jobs["emit"]["env"]["CI"] == "", "a compiler that is missing is no failure there"


@pytest.mark.parametrize("name", ["problem", "idea"])
def test_a_form(name: str) -> None:
    form = load(GITHUB / "ISSUE_TEMPLATE" / f"{name}.yml")
    assert form["name"] and form["description"]
    assert len({field["id"] for field in form["body"]}) == len(form["body"])
    assert all(field["type"] == "textarea" and field["attributes"]["label"] for field in form["body"])


def test_the_form_of_a_problem_asks_for_the_doctor() -> None:
    fields = {field["id"]: field for field in load(GITHUB / "ISSUE_TEMPLATE" / "problem.yml")["body"]}
    assert "`sssgen doctor`" in fields["doctor"]["attributes"]["label"]
    assert fields["doctor"]["validations"]["required"]
    assert "doctor" in COMMANDS


def test_the_citation() -> None:
    citation = load(ROOT / "CITATION.cff")
    assert citation["cff-version"] == "1.2.0"
    assert {"message", "title", "authors", "type", "license", "version"} <= citation.keys()
    assert citation["type"] == "software" and citation["license"] == "MIT"
    assert all("name" in author for author in citation["authors"])


def test_the_version_is_the_same_everywhere() -> None:
    assert re.fullmatch(r"\d+\.\d+\.\d+", VERSION)
    changelog = (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
    first = re.search(r"^## (.*)$", changelog, re.MULTILINE)
    assert first is not None
    assert re.fullmatch(rf"\[{re.escape(VERSION)}\] - (?:Unreleased|\d{{4}}-\d\d-\d\d)", first[1])
    assert load(ROOT / "CITATION.cff")["version"] == VERSION


def test_the_release_checklist_can_be_followed() -> None:
    text = (DOCS / "release.md").read_text(encoding="utf-8")
    blocks = re.findall(r"^ *```sh\n(.*?)^ *```$", text, re.MULTILINE | re.DOTALL)
    lines = [words for block in blocks for words in commands(block)]
    assert {words[0] for words in lines} >= {"make", "git", "build/release/bin/twine", "trial/bin/sssgen"}
    for words in lines:
        check_command(words)
    for file in re.findall(r"`([\w./]+\.(?:py|md|cff))`", text):
        assert (ROOT / file).is_file(), file
    numbers = re.findall(r"^(\d+)\. ", text, re.MULTILINE)
    assert numbers == [str(number + 1) for number in range(len(numbers))]
