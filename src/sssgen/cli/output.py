"""The output of commands: exit statuses, JSON, warnings."""

from __future__ import annotations

import sys
from collections.abc import Iterable

from sssgen.support.diagnostics import Diagnostic

OK, CHECK_FAILED, WRONG_INPUT, INTERNAL_ERROR, INTERRUPTED, BROKEN_PIPE = 0, 1, 2, 70, 130, 141
"""Exit statuses: done, a check failed, wrong input, a bug of sssgen, Ctrl-C, the reader closed the output."""


def print_json(data: object) -> None:
    """Prints a command's result for programs."""
    import json

    print(json.dumps(data, indent=2, ensure_ascii=False))


def print_warnings(warnings: Iterable[Diagnostic]) -> None:
    """Prints warnings to the standard error stream, so that they are not part of the result."""
    for warning in warnings:
        print(f"{warning.render()}\n", file=sys.stderr)
