"""The parser of arguments: errors as sssgen reports them, and help texts that fit the terminal."""

from __future__ import annotations

import argparse
import itertools
import re
from collections.abc import Iterator
from typing import Any, NoReturn

from sssgen.cli.layout import help_width, wrap
from sssgen.support.diagnostics import did_you_mean, failure


class Parser(argparse.ArgumentParser):
    """An `argparse` parser without abbreviations, whose errors are SssgenErrors with a hint."""

    def __init__(self, prog: str, description: str, epilog: str = "", **settings: Any) -> None:
        super().__init__(
            prog=prog,
            description=f"{description[0].upper()}{description[1:]}.",
            epilog=epilog,
            allow_abbrev=False,
            formatter_class=HelpFormatter,
            **settings,
        )

    def error(self, message: str) -> NoReturn:
        hint = f"see: {self.prog} --help"
        if match := re.match(r"argument ([^:]+): invalid choice: '?(.*?)'? \(choose from (.*)\)", message):
            argument, word, listed = match.groups()
            choices = re.findall(r"[\w-]+", listed)
            message = f"unknown {argument.lower()} '{word}'"
            hint = did_you_mean(word, choices) or f"choose from: {', '.join(choices)}"
            if f"--{word}" in self._option_string_actions:
                hint = f"it is an option: {self.prog} --{word}"
        elif match := re.match(r"argument (.+): invalid (int|float) value: (.*)", message, re.DOTALL):
            option = max(match[1].split("/"), key=len)
            message = f"{option}: expected a {'whole ' if match[2] == 'int' else ''}number, not {match[3]}"
        elif match := re.match(r"argument (?:\S+/)?(--[\w-]+): expected one argument", message):
            hint = f"write a value that begins with - as {match[1]}=VALUE"
        raise failure(message, hint)


class HelpFormatter(argparse.HelpFormatter):
    """Wraps help at the terminal's width.

    Names with hyphens are not broken. In a description or an epilog, lines that begin with spaces are commands.
    """

    def __init__(self, prog: str, **settings: Any) -> None:
        super().__init__(prog, **{"width": help_width(), **settings})

    def _split_lines(self, text: str, width: int) -> list[str]:
        return wrap(" ".join(text.split()), max(width, 1))

    def _fill_text(self, text: str, width: int, indent: str) -> str:
        if len(text) <= width and "\n" not in text:
            return text
        paragraphs = []
        for command, lines in _paragraphs(text):
            if command:
                paragraphs.append("\n".join(_command_lines(line, width) for line in lines))
            else:
                paragraphs.append("\n".join(wrap(" ".join(lines), width)))
        text = "\n\n".join(paragraphs)
        return re.sub(r"^(examples?:)\n\n", r"\1\n", text)

    def _format_action_invocation(self, action: argparse.Action) -> str:
        """`-o, --output DIR`: the short name first, and the value once."""
        if not action.option_strings:
            return super()._format_action_invocation(action)
        names = ", ".join(sorted(action.option_strings, key=len))
        if action.nargs == 0:
            return names
        return f"{names} {self._format_args(action, self._get_default_metavar_for_optional(action))}"


def _paragraphs(text: str) -> Iterator[tuple[bool, list[str]]]:
    """The parts of a text: lines that are commands, and lines that are not."""
    for command, lines in itertools.groupby(text.strip("\n").split("\n"), lambda line: line.startswith(" ")):
        yield command, list(lines)


def _command_lines(line: str, width: int) -> str:
    """A command, continued on further lines if it is too long, so that it can still be copied."""
    if len(line) <= width:
        return line
    return " \\\n".join(wrap(line, max(width - 2, 20), rest="      "))
