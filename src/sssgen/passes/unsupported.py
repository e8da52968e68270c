"""The errors of a pass for code that the target cannot express."""

from __future__ import annotations

from collections.abc import Sequence

from sssgen.ir.nodes import Span


class Unsupported(Exception):
    """Something that the target cannot express, with its place; `more` are further errors of the same pass."""

    def __init__(self, message: str, span: Span, more: Sequence[Unsupported] = ()) -> None:
        super().__init__(message)
        self.message, self.span, self.more = message, span, tuple(more)


class MissingBuiltin(Unsupported):
    """A builtin that the target has neither as such nor by a polyfill."""

    def __init__(self, name: str, span: Span) -> None:
        super().__init__(f"this target has no {name}", span)
