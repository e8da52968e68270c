"""What `sssgen transpile --verify` found: a row for each function, for people and for programs."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

import numpy as np

from sssgen.harness.evaluate.deviation import GOAL

BACKENDS = {"glsl": "gl", "hlsl": "hlsl", "wgsl": "webgpu", "oracle": "numpy"}
"""What is compared with the author's text, and the back end that runs it."""


class Found(NamedTuple):
    """How far one text is from the author's."""

    deviation: float | None
    """The largest, of the lanes that are not left out; None where none is left, or where it did not run."""
    blurred: int = 0
    """Lanes that are left out, as the deviation there is no more than rounding explains."""
    at: str = ""
    """Where, what came, and what the author's text gives."""
    error: str = ""
    inexact: tuple[str, ...] = ()
    """The function's builtins that drivers may give with errors beyond the goal, where another driver computes."""
    limit: float = GOAL
    """How far it may be: the goal, or what such builtins explain."""

    @property
    def close(self) -> bool:
        """Whether it is within the goal, as far as there are lanes to tell by."""
        return self.deviation is None or self.deviation <= GOAL

    @property
    def ok(self) -> bool:
        """Whether nothing speaks against it; where no lane is left, nothing speaks for it either."""
        return not self.error and (self.deviation is None or self.deviation <= self.limit)

    @property
    def cell(self) -> str:
        """The deviation for people."""
        return "failed" if self.error else "–" if self.deviation is None else f"{self.deviation:.2g}"


class Row(NamedTuple):
    """What came of one function."""

    function: str
    """As `box(vec3,vec3)`."""
    line: int
    lanes: int = 0
    undefined: int = 0
    """Lanes that are left out, as the author's text or the oracle gives infinity or NaN."""
    found: Mapping[str, Found] = {}
    """By the keys of `BACKENDS`."""
    reason: str = ""
    """Why it was not run; '' where it was."""

    @property
    def ok(self) -> bool:
        """Whether it ran, and every text agrees within the goal, as far as there are lanes to tell by."""
        return not self.reason and all(found.ok for found in self.found.values())

    def cells(self, names: list[str]) -> str:
        """The deviations of these, and the lanes, for people."""
        told = "".join([f"{self.found[name].cell if name in self.found else '':>9}" for name in names])
        left = [f"{self.undefined} undefined"] * bool(self.undefined)
        left += [f"{one.blurred} that rounding decides in {name}" for name, one in self.found.items() if one.blurred]
        return f"{told}   {self.lanes}" + (f" but for {', '.join(left)}" if left else "")

    def as_json(self) -> dict[str, Any]:
        """The row for programs."""
        told: dict[str, Any] = {"function": self.function, "line": self.line, "ok": self.ok}
        if self.reason:
            return told | {"not_run": self.reason}
        found = {
            name: {
                "deviation": one.deviation if one.deviation is not None and np.isfinite(one.deviation) else None,
                "ok": one.ok,
                "blurred": one.blurred,
            }
            | ({"at": one.at} if one.at else {})
            | ({"error": one.error} if one.error else {})
            for name, one in self.found.items()
        }
        return told | {"lanes": self.lanes, "undefined": self.undefined, "texts": found}


class Report(NamedTuple):
    """A run: the rows in the order of the text."""

    rows: list[Row]
    missing: dict[str, str]
    """Back end → how to get it."""

    @property
    def ok(self) -> bool:
        """Whether something ran, and all that ran agrees."""
        ran = [row for row in self.rows if not row.reason]
        return bool(ran) and all(row.ok for row in ran)

    def as_json(self) -> dict[str, Any]:
        """The report for programs."""
        return {"goal": GOAL, "functions": [row.as_json() for row in self.rows], "missing": self.missing}

    def lines(self) -> Iterator[str]:
        """The report for people: the largest deviations from the author's text, and what they leave out."""
        here = [name for name, backend in BACKENDS.items() if backend not in self.missing]
        width = max([len("largest deviation"), *(len(row.function) for row in self.rows)])
        yield (
            f"{'largest deviation':{width}}"
            + "".join([f"{name:>9}" for name in here])
            + f"   of lanes (goal: {GOAL:g})"
        )
        for row in self.rows:
            yield f"{row.function:{width}}" + (f"  not run: {row.reason}" if row.reason else row.cells(here))
            for name, found in row.found.items():
                if found.error:
                    yield f"    {name} does not run: {found.error}"
                elif not found.close and not row.reason:
                    inexact = f" (drivers give {', '.join(found.inexact)} roughly)" if found.ok else ""
                    yield f"    {name} {found.at}{inexact}"
        for name, how in self.missing.items():
            yield f"{name} is missing: {how}"
