"""`sssgen help`: the list of commands, or the help of one."""

from __future__ import annotations

import contextlib
import io
from argparse import ArgumentParser, Namespace

from sssgen.cli.commands import COMMANDS, Overview, command_parser
from sssgen.cli.options import unknown_name
from sssgen.cli.output import OK, print_result


def add_options(parser: ArgumentParser) -> None:
    parser.epilog = "examples:\n  sssgen help\n  sssgen help emit\n  sssgen help bake thickness"
    parser.add_argument("COMMAND", nargs="*", help="a command, and for bake the kind of texture")


def run(arguments: Namespace) -> int:
    """Prints the help of the command; with `--json` the commands and their groups."""
    if not arguments.COMMAND:
        rows = [{"name": name, "group": command.group, "summary": command.help} for name, command in COMMANDS.items()]
        print_result(arguments.json, {"commands": rows}, Overview().format_help().rstrip("\n"))
        return OK
    name, *rest = arguments.COMMAND
    if name not in COMMANDS:
        raise unknown_name("command", name, COMMANDS)
    text = io.StringIO()
    with contextlib.redirect_stdout(text), contextlib.suppress(SystemExit):
        command_parser(name).parse_args([*rest, "--help"])
    facts = {"command": " ".join(arguments.COMMAND), "help": text.getvalue()}
    print_result(arguments.json, facts, text.getvalue().rstrip("\n"))
    return OK
