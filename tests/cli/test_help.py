"""The help: of the program and of each command, in columns that fit the terminal."""

from __future__ import annotations

import json
import subprocess
import sys

import pytest

from command_line import Run
from sssgen.cli import layout
from sssgen.cli import main as cli
from sssgen.cli.commands import COMMANDS, GROUPS, Overview, command_parser


@pytest.fixture(autouse=True)
def columns(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COLUMNS", "80")


@pytest.mark.parametrize("arguments", [["--help"], ["-h"], ["emit", "--help"], ["--version"]])
def test_help_and_version(arguments: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        cli.main(arguments)
    assert ended.value.code == 0
    assert capsys.readouterr().out.startswith(("usage: sssgen", "sssgen 0."))


def test_help_and_emit_start_light() -> None:
    """The modules that `--help` and reading a material import."""
    code = """
import sys, sssgen.cli.emit, sssgen.cli.main, sssgen.material.material_loading
try:
    sssgen.cli.main.main(["--help"])
except SystemExit:
    heavy = {"numpy", "lark", "jinja2", "json", "tomllib", "subprocess", "difflib", "argcomplete"}
    print(sorted(heavy & set(sys.modules)))
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.splitlines()[-1] == "[]"


@pytest.mark.parametrize("words", [[], ["help"]])
def test_without_a_command_the_help_is_printed(words: list[str], run: Run) -> None:
    assert run(*words) == (0, Overview().format_help(), "")


def test_the_overview_lists_every_command_once_in_its_group(run: Run) -> None:
    groups = run().out.partition("\n\n")[2].split("\n\n")
    for group, title in GROUPS.items():
        rows = next(rows for rows in groups if rows.startswith(f"{title}:\n")).splitlines()[1:]
        names = [row.split()[0] for row in rows if not row.startswith("   ")]
        assert names == [name for name, command in COMMANDS.items() if command.group == group]
        assert {len(row) - len(row.lstrip().partition(" ")[2].lstrip()) for row in rows if row[2] != " "} == {
            4 + max(map(len, COMMANDS))
        }
    assert {command.group for command in COMMANDS.values()} == GROUPS.keys()
    listed = json.loads(run("help", "--json").out)["commands"]
    assert [row["name"] for row in listed] == list(COMMANDS)


@pytest.mark.parametrize("name", COMMANDS)
def test_the_help_of_every_command(name: str, run: Run, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        cli.main([name, "--help"])
    assert ended.value.code == 0
    text = capsys.readouterr().out
    assert text.startswith(f"usage: sssgen {name} ")
    assert run("help", name) == (0, text, "")
    assert json.loads(run("help", name, "--json").out)["help"] == text


def test_help_of_a_kind_of_texture(run: Run) -> None:
    assert run("help", "bake", "thickness").out.startswith("usage: sssgen bake thickness ")


@pytest.mark.parametrize("columns", [60, 80, 200])
@pytest.mark.parametrize("name", ["", *COMMANDS])
def test_help_fits_the_terminal(name: str, columns: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COLUMNS", str(columns))
    text = command_parser(name).format_help() if name else Overview().format_help()
    limit = min(columns, layout.WIDEST)
    long = [line for line in text.splitlines() if len(line) > limit]
    assert all(len(line.split()) <= 2 for line in long), long  # a single name that is too long
    assert columns < 80 or not long


def test_a_long_example_is_continued_with_a_backslash(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COLUMNS", "50")
    text = command_parser("render").format_help()
    assert "  sssgen render --compare lantern.png \\\n      golden.png -o difference.png\n" in text


def test_option_names_are_not_broken() -> None:
    text = command_parser("render").format_help()
    assert "unity-urp" in text
    assert "-o, --output FILE " in text
