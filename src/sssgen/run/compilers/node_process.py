"""A script in node that stays alive and answers questions, each a line of JSON."""

from __future__ import annotations

import atexit
import contextlib
import json
import subprocess
from collections.abc import Sequence
from typing import Any

from sssgen.run.compilers.compiler_interface import CompilerMissing


class NodeProcess:
    """Answers begin with "@@", as packages print warnings there, too; the first one means that the script is ready."""

    def __init__(self, command: Sequence[str], package: str) -> None:
        """Raises CompilerMissing where the script does not start; `package` is what it loads."""
        self.command, self.package = command, package
        self.start()
        atexit.register(self.close)

    def start(self) -> None:
        """Starts the script. Raises CompilerMissing."""
        started: Any = subprocess.Popen(
            self.command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
            encoding="utf-8",
        )  # fmt: skip
        self.process = started
        try:
            self._answer()
        except EOFError:
            raise CompilerMissing(f"npm {self.package} does not load: {self.process.stderr.read().strip()}") from None

    def ask(self, question: object) -> Any:
        """The answer, of a new process if the last one ended. Raises EOFError or OSError where it ends now."""
        if self.process.poll() is not None:
            self.start()
        self.process.stdin.write(json.dumps(question) + "\n")
        self.process.stdin.flush()
        return self._answer()

    def close(self) -> None:
        """Ends the process."""
        with contextlib.suppress(OSError):
            self.process.stdin.close()
        self.process.wait(timeout=10)
        self.process.stdout.close()
        self.process.stderr.close()

    def _answer(self) -> Any:
        for line in self.process.stdout:
            if line.startswith("@@"):
                return json.loads(line[2:])
        raise EOFError
