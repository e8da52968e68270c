"""The result of `sssgen transpile --verify`: a row for each function, as text and as JSON."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

import numpy as np

from sssgen.run.evaluate.deviation import GOAL

TRANSLATIONS: Mapping[str, Mapping[str, str]] = {
    "glsl-330": {"glsl": "gl"},
    "hlsl": {"hlsl": "hlsl"},
    "wgsl": {"wgsl": "webgpu"},
    "numpy": {"oracle": "numpy"},
    "tsl": {"tsl": "tsl", "tsl-gl2": "tsl-webgl2"},
}
"""Target → the names of its comparisons with the author's text, and the back end that runs each."""
EVERY = {name: backend for named in TRANSLATIONS.values() for name, backend in named.items()}
BACKENDS = {name: backend for name, backend in EVERY.items() if name not in TRANSLATIONS["tsl"]}
"""Those where no target is named."""


class Comparison(NamedTuple):
    """How far one translation is from the author's text."""

    deviation: float | None
    """The largest of the lanes that are not excluded; None where no lane is left, or where it did not run."""
    excluded: int = 0
    """The number of ill-conditioned lanes, where rounding explains the deviation."""
    at: str = ""
    """The place of the largest deviation, the value there, that of the author's text, and the inputs."""
    error: str = ""
    undecided: int = 0
    """The number of lanes that deviate, for which the time did not suffice to say whether rounding explains it."""
    driver: int = 0
    """The number of lanes in which the driver is at fault, and this translation agrees with the other witnesses."""
    against: tuple[str, ...] = ()
    """The witnesses that it disagrees with: the driver, and perhaps NumPy and the interpreter."""

    @property
    def ok(self) -> bool:
        """Whether it ran, and is within the goal, or no lane is left."""
        return not self.error and (self.deviation is None or self.deviation <= GOAL)

    @property
    def cell(self) -> str:
        """The deviation as text."""
        return "failed" if self.error else "–" if self.deviation is None else f"{self.deviation:.2g}"


class Coverage(NamedTuple):
    """Which branches of a function the inputs take."""

    reached: int = 0
    outcomes: int = 0
    """Each `if`, `?:` and loop counts twice."""
    never: tuple[str, ...] = ()
    """Such as `line 12 (else)`."""


class Finding(NamedTuple):
    """Lanes in which NumPy, the interpreter and translations agree against the driver."""

    driver: bool
    """Whether the driver is at fault; else sssgen's reading of the text is."""
    lanes: int
    at: str
    """The place, the driver's value, that of the others, and the inputs."""
    agreeing: tuple[str, ...]
    """Who agrees against the driver."""
    evidence: str
    """Why it is at fault, or is not."""

    @property
    def line(self) -> str:
        """The finding for people."""
        others = f"{', '.join(self.agreeing[:-1])} and {self.agreeing[-1]}"
        whose = "the driver is wrong" if self.driver else "the driver disagrees"
        count = f"{self.lanes} lane{'s' * (self.lanes != 1)}"
        return f"{whose} in {count}: {others} agree against it, {self.evidence}; {self.at}"

    def as_json(self) -> dict[str, Any]:
        """The finding for programs."""
        blamed = "driver" if self.driver else "reading"
        return {"blamed": blamed, "lanes": self.lanes, "at": self.at, "agree": list(self.agreeing)} | {
            "evidence": self.evidence
        }


class Row(NamedTuple):
    """The result for one function."""

    function: str
    """As `box(vec3,vec3)`."""
    line: int
    lanes: int = 0
    undefined: int = 0
    """The number of lanes in which GLSL leaves an operation undefined."""
    comparisons: Mapping[str, Comparison] = {}
    """By the keys of `EVERY`."""
    reason: str = ""
    """Why it was not run; '' where it was."""
    branches: Coverage = Coverage()
    asked: int = 0
    """The number of lanes that were asked for."""
    shortened: str = ""
    """Why not all inputs were tried; '' where they were."""
    complete: bool = True
    """False where the function was not run because the time was over."""
    finding: Finding | None = None
    """Lanes in which all others agree against the driver; None where there are none."""

    @property
    def undecided(self) -> int:
        """The largest number of lanes that a comparison left undecided."""
        return max([comparison.undecided for comparison in self.comparisons.values()], default=0)

    @property
    def partly(self) -> str:
        """What of its inputs was not verified; '' where nothing is left."""
        if not self.complete or self.reason or not (self.shortened or self.undecided):
            return ""
        tried = f"{self.lanes - self.undecided} of {max(self.asked, self.lanes)} inputs"
        undecided = f"{self.undecided} deviate, and there was no time to say whether rounding explains it"
        return "; ".join(
            [tried, *([self.shortened] if self.shortened else []), *([undecided] if self.undecided else [])]
        )

    @property
    def ok(self) -> bool:
        """Whether it ran, and every translation passes."""
        return not self.reason and all(comparison.ok for comparison in self.comparisons.values())

    def cells(self, names: list[str]) -> str:
        """The deviations of these translations, the number of lanes, and that of branches, as text."""
        cells = [self.comparisons[name].cell if name in self.comparisons else "" for name in names]
        excluded = [f"{self.undefined} undefined"] * bool(self.undefined)
        excluded += [
            f"{comparison.excluded} ill-conditioned in {name}"
            for name, comparison in self.comparisons.items()
            if comparison.excluded
        ]
        row = "".join([f"{cell:>9}" for cell in cells])
        lanes = f"{self.lanes}" + (f" but for {', '.join(excluded)}" if excluded else "")
        branches = f"; branches {self.branches.reached} of {self.branches.outcomes}" if self.branches.outcomes else ""
        return f"{row}   {lanes}{branches}"

    def as_json(self) -> dict[str, Any]:
        """The row for programs."""
        row: dict[str, Any] = {"function": self.function, "line": self.line, "ok": self.ok}
        if self.reason:
            return row | {"not_run": self.reason} | ({} if self.complete else {"reached": False})
        texts = {
            name: {
                "deviation": comparison.deviation
                if comparison.deviation is not None and np.isfinite(comparison.deviation)
                else None,
                "ok": comparison.ok,
                "excluded": comparison.excluded,
            }
            | ({"undecided": comparison.undecided} if comparison.undecided else {})
            | ({"at": comparison.at} if comparison.at else {})
            | ({"error": comparison.error} if comparison.error else {})
            | ({"driver": comparison.driver} if comparison.driver else {})
            | ({"against": list(comparison.against)} if comparison.against else {})
            for name, comparison in self.comparisons.items()
        }
        reached, outcomes, never = self.branches
        branches = {"outcomes": outcomes, "taken": reached, "never": list(never)}
        row |= {"lanes": self.lanes, "undefined": self.undefined, "branches": branches, "texts": texts}
        row |= {"finding": self.finding.as_json()} if self.finding is not None else {}
        return row | ({"partly": self.partly} if self.partly else {})


class Report(NamedTuple):
    """The rows of all functions, in the order of the text."""

    rows: list[Row]
    missing: dict[str, str]
    """Missing back end → how to install it."""
    backends: tuple[str, ...] = tuple(BACKENDS.values())
    """The back ends that were asked for."""

    width: int = 0
    """The number of characters of the longest function."""
    interrupted: bool = False
    devices: Mapping[str, str] = {}
    """Back end → its compiler, driver, version and device."""

    @property
    def driver_findings(self) -> list[str]:
        """The functions in which the driver is wrong."""
        return [row.function for row in self.rows if row.finding is not None and row.finding.driver]

    @property
    def ok(self) -> bool:
        """Whether a function ran, all that ran pass, and the time was enough to reach all of them."""
        executed_rows = [row for row in self.rows if not row.reason]
        return bool(executed_rows) and all(row.ok for row in executed_rows) and all(row.complete for row in self.rows)

    def as_json(self) -> dict[str, Any]:
        """The report for programs."""
        complete = all(row.complete and not row.partly for row in self.rows)
        rows = [row.as_json() for row in self.rows]
        facts = {"missing": self.missing, "devices": dict(self.devices), "driver_findings": self.driver_findings}
        return {"goal": GOAL, "complete": complete, "functions": rows, **facts}

    @property
    def available(self) -> list[str]:
        """The translations whose back ends are here."""
        return [name for name, backend in EVERY.items() if backend in self.backends and backend not in self.missing]

    def lines(self) -> Iterator[str]:
        """The report as lines of text: the largest deviations from the author's text, and the excluded lanes."""
        yield self.head()
        for row in self.rows:
            yield from self.row_lines(row)
        yield from self.last_lines()

    def first_cell(self, text: str) -> str:
        """A text in the width of the first column."""
        width = max([self.width, len("largest deviation"), *(len(row.function) for row in self.rows)])
        return f"{text:{width}}"

    def head(self) -> str:
        """The first line."""
        columns = "".join([f"{name:>9}" for name in self.available])
        return f"{self.first_cell('largest deviation')}{columns}   of lanes (goal: {GOAL:g})"

    def row_lines(self, row: Row) -> Iterator[str]:
        """The lines of one function."""
        cells = f"  not run: {row.reason}" if row.reason else row.cells(self.available)
        yield self.first_cell(row.function) + cells
        for name, comparison in row.comparisons.items():
            if comparison.error:
                yield f"    {name} does not run: {comparison.error}"
            elif not comparison.ok and not row.reason:
                yield f"    {name} {comparison.at}{_against(comparison.against)}"
        if row.finding is not None:
            yield f"    {row.finding.line}"
        if row.branches.never:
            yield f"    never taken: {', '.join(row.branches.never)}"
        if row.partly:
            yield f"    partly verified: {row.partly}"

    def last_lines(self) -> Iterator[str]:
        """Where it ran, faults of the driver, and what is missing: back ends, functions, inputs."""
        if self.devices:
            yield f"ran on: {'; '.join([f'{name}: {device}' for name, device in self.devices.items()])}"
        if self.driver_findings:
            yield f"the driver is wrong, not the translation: {', '.join(self.driver_findings)}"
        for name, instruction in self.missing.items():
            yield f"{name} is missing: {instruction}"
        partly = [row.function for row in self.rows if row.partly]
        unreached = [row.function for row in self.rows if not row.complete]
        if partly:
            yield f"partly verified: {', '.join(partly)}"
        if unreached:
            yield f"not reached: {', '.join(unreached)}"
        if (partly or unreached) and not self.interrupted:
            yield "more time: --seconds N for the file, --function-seconds N for each function; 0 is no limit"


def _against(witnesses: tuple[str, ...]) -> str:
    """Which of the witnesses disagree with a translation, beside the driver."""
    others = {"driver": "the author's text in the driver", "oracle": "NumPy", "interpreter": "the interpreter"}
    return f"; it disagrees with {' and '.join([others[name] for name in witnesses])}" if witnesses[1:] else ""
