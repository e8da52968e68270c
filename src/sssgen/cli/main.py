"""The command line: parses the arguments, runs one command, and turns every error into a message.

The commands are in `commands.py`, the exit statuses in `output.py`.
"""

from __future__ import annotations

import contextlib
import os
import sys
import time
from collections.abc import Sequence

from sssgen.cli.commands import COMMANDS, Overview, command_module, command_parser
from sssgen.cli.output import BROKEN_PIPE, INTERNAL_ERROR, INTERRUPTED, WRONG_INPUT, report_errors
from sssgen.support.diagnostics import SssgenError, failure
from sssgen.support.extras import missing_package

LONG = 2.0
"""Seconds after which the time of a command is printed."""


def main(argv: Sequence[str] | None = None) -> int:
    """Runs a command line and returns the exit status. Raises nothing but SystemExit, for `--help` and `--version`."""
    if "_ARGCOMPLETE" in os.environ and argv is None:  # a shell asks what may follow
        from sssgen.cli.candidates import complete

        complete()
    words = list(sys.argv[1:] if argv is None else argv)
    if sys.stdout is None:  # the shell has closed it
        sys.stdout = open(os.devnull, "w", encoding="utf-8")  # noqa: SIM115 - until the process ends
    as_json = "--json" in words
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):  # a terminal that cannot show a character shows '?'
            stream.reconfigure(errors="replace")
    try:
        start = time.monotonic()
        status = _run(words)
        sys.stdout.flush()
        _print_time(time.monotonic() - start)
        return status
    except SssgenError as error:
        return _report(error, as_json, WRONG_INPUT)
    except BrokenPipeError:
        return _silence_output()
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
    name, rest = "help", []
    if words and words[0] in COMMANDS:
        name, *rest = words
    elif words and words[0].startswith("--") and words[0] not in ("--", "--help", "--version"):
        raise failure(f"unknown option '{words[0]}'", "options follow the command: sssgen COMMAND --json")
    elif words:
        name = str(Overview().parse_args(words).COMMAND)  # most end here: with the help, the version, or an error
    command = COMMANDS[name]
    arguments = command_parser(name).parse_args(rest)
    try:
        status = command_module(command).run(arguments)
    except ModuleNotFoundError as error:
        raise missing_package(error, command.extra) from None
    assert isinstance(status, int)
    return status


def _print_time(seconds: float) -> None:
    """Prints the time of a command that took long, if somebody watches."""
    if seconds >= LONG and sys.stderr is not None and sys.stderr.isatty():
        print(f"{seconds:.1f} s", file=sys.stderr)


def _report(error: SssgenError, as_json: bool, status: int) -> int:
    """Prints an error and returns the exit status; the reader may have closed the output."""
    try:
        report_errors(error.diagnostics, as_json)
        sys.stdout.flush()
    except BrokenPipeError:
        return _silence_output()
    return status


def _silence_output() -> int:
    """Redirects the output to nowhere, as Python would otherwise report the closed pipe when it ends."""
    with contextlib.suppress(OSError, ValueError):  # a stream without a file
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    return BROKEN_PIPE
