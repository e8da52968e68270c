"""The examples in the help of every command: each is a valid command line, and those that are quick run."""

from __future__ import annotations

import argparse
import re
import shlex
from collections.abc import Iterator
from pathlib import Path

import pytest

from command_line import WAX, Run
from sssgen.cli.commands import COMMANDS, Overview, command_parser
from sssgen.material import library

QUICK = {"emit", "list", "show", "new", "lint", "help", "bake voronoi", "bake normal"}
"""Commands whose examples run, in the order of the help, with the files below."""


def parsers() -> Iterator[argparse.ArgumentParser]:
    """The parsers of all commands, and of the kinds of a command."""
    yield Overview()
    for name in COMMANDS:
        parser = command_parser(name)
        yield parser
        for action in parser._actions:
            if isinstance(action, argparse._SubParsersAction):
                yield from action.choices.values()


def examples(parser: argparse.ArgumentParser) -> list[str]:
    return re.findall(r"^  (sssgen .*)$", parser.epilog or "", re.MULTILINE)


ALL = [example for parser in parsers() for example in examples(parser)]


def command_of(example: str) -> str:
    words = example.split()[1:]
    return " ".join(words[:2] if words[0] == "bake" else words[:1])


def test_every_command_has_an_example_of_itself() -> None:
    for parser in parsers():
        of_it = examples(parser)
        assert of_it, parser.prog
        assert all(example.startswith(f"{parser.prog} ") or example == parser.prog for example in of_it)
        assert all(example in re.sub(r" \\\n +", " ", parser.format_help()) for example in of_it)


@pytest.mark.parametrize("example", sorted(set(ALL)))
def test_an_example_is_a_valid_command_line(example: str) -> None:
    _, name, *rest = shlex.split(example)
    command_parser(name).parse_args(rest)


def test_quick_examples_run(run: Run) -> None:
    Path("wax.toml").write_text(WAX, encoding="utf-8")
    Path("mine.glsl").write_text("float halved(float x) { return 0.5 * x; }\n", encoding="utf-8")
    Path("mine.frag").write_text("in vec2 uv; out vec4 color; void main() { color = uv.xyxy; }\n", encoding="utf-8")
    Path("materials").mkdir()
    technique = Path(library.load("thinness_uniform").path).read_text(encoding="utf-8")
    Path("mine.sss").write_text(technique.replace("thinness_uniform", "mine"), encoding="utf-8")
    ran = [example for example in dict.fromkeys(ALL) if command_of(example) in QUICK]
    assert {command_of(example) for example in ran} == QUICK
    for example in ran:
        result = run(*shlex.split(example)[1:])
        assert (result.status, bool(result.out)) == (0, True), f"{example}\n{result.err}"
