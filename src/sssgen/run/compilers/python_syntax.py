"""The text of the numpy target, compiled by Python itself and not run."""

from __future__ import annotations

import platform

from sssgen.run.compilers.compiler_interface import Compiler, Message, Source


class Python(Compiler):
    """Compiles and does not run."""

    name = "python"

    def version(self) -> str:
        return f"Python {platform.python_version()}"

    def check(self, source: Source) -> list[Message]:
        try:
            compile(source.text, source.name, "exec")
        except SyntaxError as error:
            return [Message("error", error.lineno or 0, error.offset or 0, error.msg)]
        return []


def find() -> Python:
    """Always there."""
    return Python()
