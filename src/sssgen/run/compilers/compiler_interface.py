"""The interface of all compilers: sources, messages, and the error for a missing compiler."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass, replace
from typing import Literal

Stage = Literal["vertex", "fragment", "compute", "library"]
Severity = Literal["error", "warning", "info"]


@dataclass(frozen=True)
class Source:
    """One shader text as a compiler sees it.

    `language` is a target's name ("glsl-330", "hlsl", …). Stage "library" means functions without
    an entry: each compiler calls them from an additional entry, appended so that line numbers stay true.
    `companion` is the text of the other stage, which the GL driver links with it, so that a mismatch is an error; or of
    the file that the text includes.
    """

    text: str
    language: str
    stage: Stage = "fragment"
    entry: str = "main"
    name: str = "shader"
    companion: str = ""

    def with_text(self, text: str) -> Source:
        """The same source with another text."""
        return replace(self, text=text)


@dataclass(frozen=True)
class Message:
    """One message of a compiler. Line and column count from 1; 0 where the compiler does not state them.

    `file` is the compiler's name of the file with the place; '': the text itself.
    """

    severity: Severity
    line: int
    column: int
    text: str
    file: str = ""

    def __str__(self) -> str:
        place = f"{self.line}:{self.column}: " if self.column else f"{self.line}: " if self.line else ""
        return f"{place}{self.severity}: {self.text}"


class CompilerMissing(Exception):
    """Raised by a family's `find()` where the compiler is missing; the text states how to get it."""


class Compiler(ABC):
    """A compiler that this project did not write, ready to check text."""

    name: str

    @abstractmethod
    def version(self) -> str:
        """The compiler's name and version, for reports."""

    @abstractmethod
    def check(self, source: Source) -> list[Message]:
        """Compile and report. No message of severity "error" means that the text compiled."""


def errors(messages: list[Message]) -> list[Message]:
    """Only the errors."""
    return [m for m in messages if m.severity == "error"]
