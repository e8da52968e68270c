"""What came of one check, in the words that `sssgen ci` and the pytest plug-in share."""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import Literal, NamedTuple

State = Literal["passed", "failed", "skipped"]


class Outcome(NamedTuple):
    """A check's end: `told` is one line, `detail` is any number of them."""

    state: State
    told: str
    detail: str = ""

    @property
    def text(self) -> str:
        """All that there is to say."""
        return "\n".join(filter(None, (self.told, self.detail)))


def in_ci() -> bool:
    """Whether the variable CI is set: what is missing is then a failure, as nobody would see that it was skipped."""
    return os.environ.get("CI", "") not in ("", "0", "false")


def lacking(what: str, how: str) -> Outcome:
    """Something that a check needs is not here; `how` says how to get it. Skipped; with CI set, failed."""
    return Outcome("failed" if in_ci() else "skipped", f"{what} is missing: {' '.join(how.split())}")


def beside(text: str, folders: Sequence[str]) -> str:
    """A path, or FILE:FUNCTION, from the first of the folders that has the file; as it is where none has."""
    file, colon, inner = text.rpartition(":")
    if not (colon and file.endswith((".sss", ".glsl"))):
        file, colon, inner = text, "", ""
    for folder in folders:
        if os.path.isfile(path := os.path.join(folder, file)):
            return f"{path}{colon}{inner}"
    return text
