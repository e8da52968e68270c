"""The reference of the command line, from the parsers of the commands."""

from __future__ import annotations

import argparse
import os
import re

from markup import escaped, fenced, folded
from sssgen.cli.commands import COMMANDS, GROUPS, command_parser

PAGE = "docs/reference/commands.md"
WIDTH = "90"


def page() -> str:
    """Every command with its arguments, in the groups of `sssgen help`."""
    os.environ["COLUMNS"] = WIDTH  # argparse wraps to it
    lines = ["# Commands", "", "Made from the commands' own help: `sssgen help COMMAND` prints the same.", ""]
    lines += ["Exit status of every command: 0 done, 1 a check failed, 2 wrong input.", ""]
    for group, title in GROUPS.items():
        lines += [f"## {title[0].upper()}{title[1:]}", ""]
        for name, command in COMMANDS.items():
            if command.group == group:
                lines += _command(command_parser(name), "###")
    return "\n".join(lines)


def _command(parser: argparse.ArgumentParser, heading: str) -> list[str]:
    usage = re.sub(rf"^(usage: |{' ' * len('usage: ')})", "", parser.format_usage().strip("\n"), flags=re.MULTILINE)
    lines = [f"{heading} {parser.prog}", "", escaped(parser.description or ""), "", *fenced(usage, "text"), ""]
    options, inner = [], []
    for action in parser._actions:
        if isinstance(action, argparse._SubParsersAction):
            inner += list(dict.fromkeys(action.choices.values()))
        elif action.help != argparse.SUPPRESS and not isinstance(action, argparse._HelpAction):
            options += [f".. option:: {_name(action)}", "", f"   {_as_rst(_help(parser, action))}", ""]
    if options:
        lines += ["```{eval-rst}", f".. program:: {parser.prog}", "", *options, "```", ""]
    if parser.epilog:
        lines += [*fenced(folded(parser.epilog.strip("\n")), "text"), ""]
    for one in inner:
        lines += _command(one, f"{heading}#")
    return lines


def _name(action: argparse.Action) -> str:
    """An option with its value, as Sphinx takes it: it becomes a place that the search leads to."""
    value = action.metavar or ("{" + ",".join(map(str, action.choices)) + "}" if action.choices else action.dest)
    shown = " ".join(value) if isinstance(value, tuple) else value
    if not action.option_strings:
        return shown
    ending = "" if action.nargs == 0 else f" {shown}"
    return ", ".join(f"{option}{ending}" for option in action.option_strings)


def _as_rst(text: str) -> str:
    """Plain text in which nothing is markup but `code`."""
    pieces = re.split(r"(`[^`]*`)", " ".join(text.split()))
    return "".join(piece if piece.startswith("`") else re.sub(r"([\\*_|:])", r"\\\1", piece) for piece in pieces)


def _help(parser: argparse.ArgumentParser, action: argparse.Action) -> str:
    return parser._get_formatter()._expand_help(action) if action.help else ""
