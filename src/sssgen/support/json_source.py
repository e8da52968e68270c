"""Parses JSON that users write; errors have their position."""

from __future__ import annotations

import json
from typing import Any

from sssgen.ir.spans import Span
from sssgen.support.diagnostics import Diagnostic, SssgenError, failure


def parse(text: str, file: str) -> Any:
    """The value of a JSON text; `file` is its name in messages. Raises SssgenError."""
    try:
        return json.loads(text)
    except json.JSONDecodeError as error:
        span = Span(file, error.lineno, error.colno, error.lineno, error.colno + 1)
        line = text.split("\n")[error.lineno - 1]
        raise SssgenError([Diagnostic("error", f"this is not JSON: {error.msg}", span, "", line)]) from None
    except RecursionError:
        raise failure("the lists are nested too deeply", file=file) from None
    except ValueError:  # Python refuses to convert thousands of digits
        raise failure("a number has thousands of digits", file=file) from None
