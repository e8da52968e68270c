"""What passes tell the user: errors for code that the target cannot express, and notes."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from sssgen.ir.nodes import Span


class Unsupported(Exception):
    """Something that the target cannot express, with its place; `more` are further errors of the same pass.

    `hint` says what to do.
    """

    def __init__(self, message: str, span: Span, more: Sequence[Unsupported] = (), hint: str = "") -> None:
        super().__init__(message)
        self.message, self.span, self.more, self.hint = message, span, tuple(more), hint


class MissingBuiltin(Unsupported):
    """A builtin that the target has neither as such nor by a polyfill."""

    def __init__(self, name: str, span: Span) -> None:
        super().__init__(f"this target has no {name}", span)


class Note(NamedTuple):
    """Something that the user should know although the shader works; `hint` says what to do."""

    message: str
    span: Span
    hint: str = ""
