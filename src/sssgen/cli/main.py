"""The command line: parses the arguments, runs one command, and turns every error into a message.

Only the module of the command that is called is imported. The exit statuses are in `output.py`.
"""

from __future__ import annotations

import contextlib
import importlib
import os
import sys
from collections.abc import Sequence
from typing import Any, NamedTuple

from sssgen.cli.options import Parser, add_json
from sssgen.cli.output import BROKEN_PIPE, INTERNAL_ERROR, INTERRUPTED, WRONG_INPUT, print_json
from sssgen.support.diagnostics import SssgenError, failure
from sssgen.support.extras import missing_package
from sssgen.version import VERSION


class Command(NamedTuple):
    """A command. Its module has `add_options(parser)`, and `run(arguments)` which returns the exit status."""

    module: str
    help: str
    extra: str = "numpy"
    """The extra of the distribution that installs the packages that the command needs."""


COMMANDS = {
    "list": Command("listing", "list the techniques, targets or example materials"),
    "show": Command("show", "show a technique: what it computes, its parameters, its source"),
    "emit": Command("emit", "write the shaders of materials"),
    "check": Command("check", "compile shaders with the compilers of this machine"),
    "transpile": Command("transpile", "translate plain GLSL, functions or whole shaders, to a target's language"),
    "lint": Command("lint", "report operations that may fail in techniques, materials and plain GLSL"),
    "eval": Command("eval", "evaluate a technique on arrays of inputs, on one back end, or on all against the oracle"),
    "stress": Command("stress", "run techniques on dangerous, boundary and random inputs, on several back ends"),
    "render": Command("render", "render a scene, or compare two pictures", "render"),
    "ci": Command("ci", "check a folder: compile its materials, compare its scenes with golden pictures", "render"),
    "chart": Command("chart", "chart error against cost of every technique and published baseline", "chart"),
    "pick": Command("pick", "pick the cheapest chain of techniques that is good enough for a scene", "chart"),
    "fit": Command("fit", "fit the parameters of techniques to a scene's medium", "chart"),
    "bake": Command("bake", "bake textures: distances, thickness, depth, cells, normals", "bake"),
    "new": Command("new", "write a commented material to start from"),
}


def main(argv: Sequence[str] | None = None) -> int:
    """Runs a command line and returns the exit status. Raises nothing but SystemExit, for `--help` and `--version`."""
    words = list(sys.argv[1:] if argv is None else argv)
    if sys.stdout is None:  # the shell has closed it
        sys.stdout = open(os.devnull, "w", encoding="utf-8")  # noqa: SIM115 - until the process ends
    as_json = "--json" in words
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):  # a terminal that cannot show a character shows '?'
            stream.reconfigure(errors="replace")
    try:
        status = _run(words)
        sys.stdout.flush()
        return status
    except SssgenError as error:
        return _report(error, as_json, WRONG_INPUT)
    except BrokenPipeError:
        return _pipe_closed()
    except KeyboardInterrupt:
        print("interrupted", file=sys.stderr)
        return INTERRUPTED
    except OSError as error:
        return _report(failure(f"cannot write the output: {error.strerror or error}"), as_json, WRONG_INPUT)
    except Exception as error:
        if os.environ.get("SSSGEN_DEBUG"):
            import traceback

            traceback.print_exc()
        text = " ".join(f"{type(error).__name__} {error}".split())[:300]
        hint = "this is a bug of sssgen: report it with the input; SSSGEN_DEBUG=1 shows the traceback"
        return _report(failure(f"internal error: {text}", hint), as_json, INTERNAL_ERROR)


def _run(words: list[str]) -> int:
    name, rest = (words[0], words[1:]) if words and words[0] in COMMANDS else (_named_command(words), [])
    command = COMMANDS[name]
    arguments = command_parser(name).parse_args(rest)
    try:
        status = _module(command).run(arguments)
    except ModuleNotFoundError as error:
        raise missing_package(error, command.extra) from None
    assert isinstance(status, int)
    return status


def _module(command: Command) -> Any:
    return importlib.import_module(f"{__package__}.{command.module}")


def command_parser(name: str) -> Parser:
    """The parser of one command's arguments."""
    command = COMMANDS[name]
    parser = Parser(f"sssgen {name}", command.help)
    add_json(parser)
    _module(command).add_options(parser)
    return parser


def _named_command(words: list[str]) -> str:
    """The command of arguments that do not begin with one. Most end here: with the help, the version, or an error."""
    parser = Parser(
        "sssgen",
        "generates shaders for translucent and parallax materials from one description",
        "Exit status: 0 done, 1 a check failed, 2 wrong input.\nHelp on a command: sssgen COMMAND --help",
    )
    parser.add_argument("--version", action="version", version=f"sssgen {VERSION}", help="show the version")
    commands = parser.add_subparsers(metavar="COMMAND", dest="COMMAND", required=True)
    for name, command in COMMANDS.items():
        commands.add_parser(name, help=command.help, description=command.help, add_help=False)
    return str(parser.parse_args(words).COMMAND)


def _report(error: SssgenError, as_json: bool, status: int) -> int:
    """Prints an error and returns the exit status; the reader may have closed the output."""
    try:
        if as_json:
            print_json({"ok": False, "diagnostics": [diagnostic.as_json() for diagnostic in error.diagnostics]})
        else:
            print("\n\n".join(diagnostic.render() for diagnostic in error.diagnostics), file=sys.stderr)
            if len(error.diagnostics) > 1:
                print(f"\n{len(error.diagnostics)} errors", file=sys.stderr)
        sys.stdout.flush()
    except BrokenPipeError:
        return _pipe_closed()
    return status


def _pipe_closed() -> int:
    """Redirects the output to nowhere, as Python would otherwise report the closed pipe when it ends."""
    with contextlib.suppress(OSError, ValueError):  # a stream without a file
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    return BROKEN_PIPE
