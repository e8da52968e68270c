"""The reference of the command line, from the parsers of the commands."""

from __future__ import annotations

import argparse
import os
import re

from markup import escaped, fenced, folded, table
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
    rows, inner = [], []
    for action in parser._actions:
        if isinstance(action, argparse._SubParsersAction):
            inner += list(dict.fromkeys(action.choices.values()))
        elif action.help != argparse.SUPPRESS and not isinstance(action, argparse._HelpAction):
            rows.append((_name(action), escaped(_help(parser, action))))
    if rows:
        lines += [*table(("Argument", "Meaning"), rows), ""]
    if parser.epilog:
        lines += [*fenced(folded(parser.epilog.strip("\n")), "text"), ""]
    for one in inner:
        lines += _command(one, f"{heading}#")
    return lines


def _name(action: argparse.Action) -> str:
    value = action.metavar or ("{" + ",".join(map(str, action.choices)) + "}" if action.choices else action.dest)
    shown = " ".join(value) if isinstance(value, tuple) else value
    if not action.option_strings:
        return f"`{shown}`"
    ending = "" if action.nargs == 0 else f" {shown}"
    return f"`{', '.join(action.option_strings)}{ending}`".replace("|", "\\|")


def _help(parser: argparse.ArgumentParser, action: argparse.Action) -> str:
    return parser._get_formatter()._expand_help(action) if action.help else ""
