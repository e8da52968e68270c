"""The result of `sssgen transpile --verify` for a compute shader, as text and as JSON."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

import numpy as np

from sssgen.run.evaluate.deviation import GOAL

_SHOWN = 4
"""How many places that depend on the order are listed."""


class Difference(NamedTuple):
    """How far the buffers of one translation are from those of the author's text."""

    deviation: float | None = None
    """The largest of all numbers that are compared; infinite where an integer differs."""
    at: str = ""
    """Its place, the value there, and that of the author's text."""
    error: str = ""
    """Why it did not run."""

    @property
    def ok(self) -> bool:
        return not self.error and self.deviation is not None and self.deviation <= GOAL


class ComputeReport(NamedTuple):
    """The result of all rounds."""

    groups: tuple[int, int, int]
    size: tuple[int, ...]
    """Of a workgroup."""
    rounds: int = 0
    """The number of rounds that were compared."""
    numbers: int = 0
    """In all written buffers of these rounds."""
    ordered: int = 0
    """The numbers that are not compared, as they depend on the order of the invocations."""
    order_places: tuple[str, ...] = ()
    undefined: int = 0
    """The number of rounds that are not compared, as something is undefined in them."""
    faults: tuple[str, ...] = ()
    """What is undefined in these rounds."""
    differences: Mapping[str, Difference] = {}
    """By translation."""
    reason: str = ""
    """Why nothing was compared; '' where something was."""
    missing: Mapping[str, str] = {}
    devices: Mapping[str, str] = {}
    """Back end → its compiler, driver, version and device."""

    @property
    def ok(self) -> bool:
        """Whether something was compared, and every translation agrees."""
        return not self.reason and all(difference.ok for difference in self.differences.values())

    def as_json(self) -> dict[str, Any]:
        """The report for programs."""
        texts = {
            name: {"deviation": each.deviation if each.deviation is not None and np.isfinite(each.deviation) else None}
            | {"ok": each.ok}
            | ({"at": each.at} if each.at else {})
            | ({"error": each.error} if each.error else {})
            for name, each in self.differences.items()
        }
        row: dict[str, Any] = {"goal": GOAL, "workgroups": list(self.groups), "workgroup_size": list(self.size)}
        row |= {"rounds": self.rounds, "numbers": self.numbers, "order_dependent": self.ordered}
        row |= {"order_dependent_places": list(self.order_places), "undefined_rounds": self.undefined}
        row |= {"undefined": list(self.faults), "texts": texts, "missing": dict(self.missing)}
        row |= {"devices": dict(self.devices)}
        return row | ({"not_run": self.reason} if self.reason else {})

    def lines(self) -> Iterator[str]:
        """The report as lines of text."""
        run = f"{' × '.join(map(str, self.groups))} workgroups of {' × '.join(map(str, self.size))}"
        if self.reason:
            yield f"not compared: {self.reason}"
        else:
            cells = [
                f"{name} {'failed' if each.error else f'{each.deviation:.2g}'}"
                for name, each in self.differences.items()
            ]
            kept = self.numbers - self.ordered
            yield f"largest deviation of {kept} numbers in the buffers (goal: {GOAL:g}): {', '.join(cells)}"
        yield f"    {run}, {self.rounds} rounds"
        for name, each in self.differences.items():
            if each.error:
                yield f"    {name} does not run: {each.error}"
            elif not each.ok:
                yield f"    {name} {each.at}"
        if self.ordered:
            places = ", ".join(self.order_places[:_SHOWN]) + (", …" if len(self.order_places) > _SHOWN else "")
            yield f"    not compared: {self.ordered} numbers depend on the order of the invocations ({places})"
        if self.undefined and not self.reason:
            faults = "; ".join(self.faults)
            yield f"    not compared: {self.undefined} rounds, in which GLSL leaves the result undefined: {faults}"
        if self.devices:
            yield f"ran on: {'; '.join([f'{name}: {device}' for name, device in self.devices.items()])}"
        for name, instruction in self.missing.items():
            yield f"{name} is missing: {instruction}"
