"""The outcome of one check, for `sssgen ci` and the pytest plug-in."""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import Literal, NamedTuple

State = Literal["passed", "failed", "skipped"]


class Outcome(NamedTuple):
    """How a check ended: `message` is one line, `detail` any number of lines."""

    state: State
    message: str
    detail: str = ""

    @property
    def text(self) -> str:
        """The message and the detail."""
        return "\n".join(filter(None, (self.message, self.detail)))


def in_ci() -> bool:
    """Whether the variable CI is set: a missing program is then a failure, as nobody would notice a skipped check."""
    return os.environ.get("CI", "") not in ("", "0", "false")


def missing_part(part: str, instruction: str) -> Outcome:
    """The outcome where `part` is missing; `instruction` tells how to install it. Skipped; with CI set, failed."""
    return Outcome("failed" if in_ci() else "skipped", f"{part} is missing: {' '.join(instruction.split())}")


def beside(text: str, folders: Sequence[str]) -> str:
    """A path, or FILE:FUNCTION, in the first folder that has the file; unchanged if none has it."""
    file, colon, inner = text.rpartition(":")
    if not (colon and file.endswith((".sss", ".glsl"))):
        file, colon, inner = text, "", ""
    for folder in folders:
        if os.path.isfile(path := os.path.join(folder, file)):
            return f"{path}{colon}{inner}"
    return text
