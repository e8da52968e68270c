"""A compiler in its own process, so that a crash or hang on one text affects no other."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from sssgen.run.compilers import CompilerMissing, Message, Source, get
from sssgen.support.worker_process import LostError, Process

SECONDS = 60.0
"""How long a compiler may take to start, and for one text; the slowest takes about one second."""


class Worker:
    """One compiler by its name. The process starts when it is first asked, and again after it was lost."""

    def __init__(self, name: str, environment: Mapping[str, str] | None = None, seconds: float = SECONDS) -> None:
        self.name = name
        self.process = Process(__name__, name, environment, seconds)

    def version(self) -> str:
        """Its name and version. Raises CompilerMissing, which states how to get it or why it does not start."""
        try:
            return str(self.process.start())
        except LostError as reason:
            raise CompilerMissing(f"{self.name} {reason} as it started") from None

    def check(self, source: Source) -> list[Message]:
        """The compiler's messages about `source`; a crash or a timeout is an error of the text."""
        try:
            messages: list[Message] = self.process.ask(source)
        except LostError as reason:
            return [Message("error", 0, 0, f"{self.name} {reason} on this text")]
        except Exception as error:  # the compiler's package may fail in any way
            return [Message("error", 0, 0, f"{self.name} failed: {type(error).__name__}: {error}")]
        return messages

    def close(self) -> None:
        """Ends the process and its children."""
        self.process.close()


def serve(name: str) -> tuple[str, Callable[[Source], list[Message]]]:
    """The compiler's version, and the function from texts to messages. Raises CompilerMissing."""
    compiler = get(name)
    return compiler.version(), compiler.check
