"""The output of commands: exit statuses, JSON, warnings, colours."""

from __future__ import annotations

import os
import re
import sys
from collections.abc import Iterable, Mapping, Sequence

from sssgen.support.diagnostics import Diagnostic

OK, CHECK_FAILED, WRONG_INPUT, INTERNAL_ERROR, INTERRUPTED, BROKEN_PIPE = 0, 1, 2, 70, 130, 141
"""Exit statuses: done, a check failed, wrong input, a bug of sssgen, Ctrl-C, the reader closed the output."""


def print_json(data: object) -> None:
    """Prints a command's result for programs."""
    import json

    print(json.dumps(data, indent=2, ensure_ascii=False))


def print_result(as_json: bool, facts: Mapping[str, object], text: str, ok: bool = True) -> None:
    """Prints a command's result: its facts for programs, or its text for people."""
    if as_json:
        print_json({"ok": ok, **facts})
    else:
        print(text)


def write_text(path: str, text: str) -> None:
    """Writes a file, whole or not at all. Raises SssgenError where the system refuses."""
    from sssgen.support.file_writer import write_files

    folder, name = os.path.split(path)
    write_files(folder or ".", {name: text})


def failure_report(errors: Iterable[Diagnostic]) -> dict[str, object]:
    """The JSON report of a command that failed."""
    return {"ok": False, "diagnostics": [error.as_json() for error in errors]}


def print_errors(errors: Sequence[Diagnostic]) -> None:
    """Prints errors to the standard error stream, and how many there are."""
    print("\n\n".join(paint(error.render()) for error in errors), file=sys.stderr)
    if len(errors) > 1:
        print(f"\n{len(errors)} errors", file=sys.stderr)


def report_errors(errors: Sequence[Diagnostic], as_json: bool) -> None:
    """Prints errors, for people or as a command's result for programs."""
    if as_json:
        print_json(failure_report(errors))
    else:
        print_errors(errors)


def print_warnings(warnings: Iterable[Diagnostic]) -> None:
    """Prints warnings to the standard error stream, so that they are not part of the result."""
    for warning in warnings:
        print(f"{paint(warning.render())}\n", file=sys.stderr)


_COLOURS = {"error": "1;31", "warning": "1;33", "help": "1;36"}
"""The word that begins a line of a diagnostic → its colour."""


def paint(text: str) -> str:
    """A diagnostic's text for the standard error stream: error, warning and help are coloured on a terminal."""
    if not _shows_colours():
        return text
    words = re.compile(rf"^( *)({'|'.join(_COLOURS)}):", re.MULTILINE)
    return words.sub(lambda match: f"{match[1]}\033[{_COLOURS[match[2]]}m{match[2]}:\033[0m", text)


def _shows_colours() -> bool:
    """Whether it is a terminal with colours, and the user has not switched them off (https://no-color.org)."""
    if os.environ.get("NO_COLOR") or os.environ.get("TERM") == "dumb" or not sys.stderr.isatty():
        return False
    return sys.platform != "win32" or "WT_SESSION" in os.environ  # older consoles of Windows print the codes
