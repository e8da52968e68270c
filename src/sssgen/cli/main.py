"""The command line: reads the arguments, runs one command, and turns whatever goes wrong into a message.

Exit status: 0 done · 1 a check failed · 2 wrong input · 70 an error of sssgen itself · 130 interrupted ·
141 the reader of the output went away.
"""

from __future__ import annotations

import contextlib
import importlib
import os
import sys
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from sssgen.support.diagnostics import SssgenError, failure

if TYPE_CHECKING:
    from argparse import ArgumentParser

OK, CHECK_FAILED, WRONG_INPUT, INTERNAL_ERROR, INTERRUPTED, BROKEN_PIPE = 0, 1, 2, 70, 130, 141


def main(argv: Sequence[str] | None = None) -> int:
    """Runs a command line; returns the exit status. Never raises."""
    given = list(sys.argv[1:] if argv is None else argv)
    if sys.stdout is None:  # closed by the shell: what is said goes nowhere
        sys.stdout = open(os.devnull, "w", encoding="utf-8")  # noqa: SIM115 - for as long as the process
    as_json = "--json" in given
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):  # a terminal that cannot show a character shows '?'
            stream.reconfigure(errors="replace")
    try:
        status = _run(given)
        sys.stdout.flush()
        return status
    except SssgenError as error:
        return _guarded(_report, error, as_json)
    except BrokenPipeError:
        return _pipe_closed()
    except KeyboardInterrupt:
        print("interrupted", file=sys.stderr)
        return INTERRUPTED
    except OSError as error:
        return _guarded(_report, failure(f"cannot write the output: {error.strerror or error}"), as_json)
    except Exception as error:
        if os.environ.get("SSSGEN_DEBUG"):
            import traceback

            traceback.print_exc()
        return _guarded(_report_internal, error, as_json)


def _run(given: list[str]) -> int:
    arguments = parser().parse_args(given)
    module = importlib.import_module(f"{__package__}.{arguments.module}")
    status = module.run(arguments)
    assert isinstance(status, int)
    return status


def parser() -> ArgumentParser:
    """The command line's grammar."""
    from sssgen.cli.arguments import parser as made

    return made()


def _guarded(report: Any, error: Exception, as_json: bool) -> int:
    """Reports an error to a reader who may have gone away."""
    try:
        status = report(error, as_json)
        sys.stdout.flush()
        return int(status)
    except BrokenPipeError:
        return _pipe_closed()


def _pipe_closed() -> int:
    """Keeps Python from complaining of the closed pipe when it ends."""
    with contextlib.suppress(OSError, ValueError):  # a stream without a file
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    return BROKEN_PIPE


def _report(error: SssgenError, as_json: bool) -> int:
    if as_json:
        print_json({"ok": False, "diagnostics": [found.as_json() for found in error.diagnostics]})
    else:
        print("\n\n".join(found.render() for found in error.diagnostics), file=sys.stderr)
        if len(error.diagnostics) > 1:
            print(f"\n{len(error.diagnostics)} errors", file=sys.stderr)
    return WRONG_INPUT


def _report_internal(error: Exception, as_json: bool) -> int:
    what = " ".join(f"{type(error).__name__} {error}".split())[:300]
    message = f"internal error: {what}: a fault of sssgen; please report it with the input that shows it"
    hint = "SSSGEN_DEBUG=1 shows where"
    if as_json:
        found = failure(message, hint).diagnostics[0]
        print_json({"ok": False, "diagnostics": [found.as_json()]})
    else:
        print(f"{message} ({hint})", file=sys.stderr)
    return INTERNAL_ERROR


def print_json(data: object) -> None:
    """A command's result for programs."""
    import json

    print(json.dumps(data, indent=2, ensure_ascii=False))
