"""The results of a stress run, as text, as Markdown and as JSON."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from sssgen.analyse.stress.dangerous_inputs import ROWS
from sssgen.analyse.stress.stress_run import Column, Fault, Row, Settings
from sssgen.run.backends import Array
from sssgen.run.evaluate.evaluation import Inputs
from sssgen.support.diagnostics import visible

SUFFIXES = (".json", ".md")
PASSED, FAILED = "ok", "FAIL"


class Report(NamedTuple):
    """A whole run."""

    settings: Settings
    devices: Mapping[str, str]
    """Back end → its device."""
    missing: Mapping[str, str]
    """Back end → how to get it."""
    rows: Sequence[Row]

    @property
    def ok(self) -> bool:
        """Whether there are no faults that count, and at least one back end ran."""
        return bool(self.devices) and bool(self.rows) and all(row.ok for row in self.rows)


def as_json(report: Report) -> dict[str, Any]:
    """The report as JSON."""
    settings = report.settings
    return {
        "ok": report.ok,
        "samples": settings.samples,
        "seed": settings.seed,
        "precision": "f16" if settings.half else "f32",
        "guards": settings.guards,
        "backends": [
            *({"name": name, "device": device} for name, device in report.devices.items()),
            *({"name": name, "missing": instruction} for name, instruction in report.missing.items()),
        ],
        "rows": [
            {"name": row.name, "inputs": row.inputs, "requires": row.requires, "elsewhere": row.elsewhere}
            for row in ROWS
            if not settings.rows or row.name in settings.rows
        ],
        "techniques": [_technique(row) for row in report.rows],
    }


def _technique(row: Row) -> dict[str, Any]:
    jumps = [
        {"input": jump.input, "output": jump.output, "size": jump.size, "inputs": _inputs(jump.inputs)}
        for jump in row.model_jumps
    ]
    return {
        "name": row.specimen.title,
        "technique": row.specimen.technique,
        "role": row.specimen.role,
        "baseline": row.specimen.baseline,
        "ok": row.ok,
        "model_jumps": jumps,
        "backends": [_column(column) for column in row.columns],
    }


def _column(column: Column) -> dict[str, Any]:
    return {
        "name": column.backend,
        "ok": column.ok,
        "error": column.error,
        "evaluations": column.evaluations,
        "seconds": round(column.seconds, 3),
        "deviation": column.deviation,
        "jump": column.jump,
        "faults": [_fault(fault) for fault in column.faults],
    }


def _fault(fault: Fault) -> dict[str, Any]:
    return {
        "trial": fault.trial,
        "kind": fault.kind,
        "output": fault.output,
        "counts": fault.counts,
        "lanes": fault.lanes,
        "of": fault.of,
        "got": _numbers(fault.actual),
        "inputs": _inputs(fault.inputs),
        "eval": fault.command,
    }


def _inputs(inputs: Inputs) -> dict[str, Any]:
    return {name: _numbers(np.moveaxis(value, -1, 0)[0]) for name, value in inputs.values.items()}


def _numbers(value: Array) -> Any:
    """Numbers for JSON; NaN and infinity, which JSON lacks, become strings."""
    if value.ndim:
        return [_numbers(element) for element in value]
    number = value.item()
    return str(number) if isinstance(number, float) and not np.isfinite(number) else number


def summary(report: Report) -> list[str]:
    """The run in a few lines: devices, what is missing, a line for each technique."""
    lines = [f"{name:10} {visible(device)}" for name, device in report.devices.items()]
    lines += [
        f"{name:10} not here: {visible(' '.join(instruction.split()))}" for name, instruction in report.missing.items()
    ]
    width = max((len(row.specimen.title) for row in report.rows), default=0)
    columns = list(report.devices)
    lines += ["", " ".join([" " * width, *(f"{name:>10}" for name in columns)])]
    for row in report.rows:
        cells = [f"{_cell(column):>10}" for column in row.columns]
        lines.append(" ".join([f"{row.specimen.title:{width}}", *cells, *_remark(row)]))
    return lines


def _cell(column: Column) -> str:
    return PASSED if column.ok else FAILED


def _remark(row: Row) -> list[str]:
    remarks = ["published baseline"] if row.specimen.baseline else []
    if row.model_jumps:
        remarks.append(f"the formula jumps along {', '.join(dict.fromkeys(jump.input for jump in row.model_jumps))}")
    return [f" {'; '.join(remarks)}"] if remarks else []


def faults(row: Row, beyond: bool = False) -> Iterator[str]:
    """The faults of one technique: those that count and, with `beyond`, those that do not.

    Faults that several back ends share are reported once, with the numbers and the command of the first of them.
    """
    for column in row.columns:
        if column.error:
            yield f"{row.specimen.title}: {column.backend}: {visible(column.error)}"
    by_kind: dict[tuple[str, str, str, bool], list[tuple[str, Fault]]] = {}
    for column in row.columns:
        for fault in column.faults:
            if fault.counts or beyond:
                key = (fault.trial, fault.kind, fault.output, fault.counts)
                by_kind.setdefault(key, []).append((column.backend, fault))
    for (trial, kind, output, counts), same_faults in by_kind.items():
        fault = same_faults[0][1]
        actual = np.array2string(fault.actual, precision=7, separator=", ")
        where = f"{output} is {actual} in {fault.lanes} of {fault.of}, on {', '.join(name for name, _ in same_faults)}"
        yield f"{row.specimen.title}: {trial}: {kind}: {where}{'' if counts else ', not counted'}"
        if command := next((fault.command for _, fault in same_faults if fault.command), ""):
            yield f"  {command}"


def total(report: Report) -> str:
    """The totals of the run."""
    columns = [column for row in report.rows for column in row.columns]
    seconds = sum(column.seconds for column in columns)
    count = sum(column.evaluations for column in columns)
    failed = sum(not row.ok for row in report.rows)
    beyond = sum(fault.lanes for column in columns for fault in column.faults if not fault.counts)
    rate = f", {count / seconds / 1e6:.1f} million a second" if seconds else ""
    techniques = f"{len(report.rows)} technique{'s' * (len(report.rows) != 1)}"
    return (
        f"{techniques}, {failed} failed; {count:,} evaluations in {seconds:.1f} s{rate}; "
        f"{beyond:,} faults beyond the contract; "
        f"seed {report.settings.seed}, {report.settings.samples:,} random inputs"
    )


def as_markdown(report: Report) -> str:
    """The report as a page."""
    lines = ["# Stress", "", total(report) + ".", "", "## Techniques", ""]
    lines += [f"| Technique | {' | '.join(report.devices)} | Deviation | Jump | Remarks |"]
    lines += ["|---" * (len(report.devices) + 4) + "|"]
    for row in report.rows:
        cells = [_cell(column) for column in row.columns]
        deviation = max((column.deviation for column in row.columns), default=0.0)
        jump = max((column.jump for column in row.columns), default=0.0)
        remark = " ".join(_remark(row)).strip()
        lines.append(f"| {row.specimen.title} | {' | '.join(cells)} | {deviation:.2g} | {jump:.2g} | {remark} |")
    lines += ["", "Deviation: the largest difference to float64 that rounding does not explain. Jump: the largest"]
    lines += ["change for a small step of an input where the oracle's own is small.", "", "## Back ends", ""]
    lines += [f"- {name}: {device}" for name, device in report.devices.items()]
    lines += [f"- {name}: not here: {' '.join(instruction.split())}" for name, instruction in report.missing.items()]
    fault_lines = [line for row in report.rows for line in faults(row, beyond=True)]
    lines += ["", "## Faults", "", *(["```text", *fault_lines, "```"] if fault_lines else ["None."])]
    lines += ["", "## Dangerous inputs", "", "| Row | Input | Asked |", "|---|---|---|"]
    lines += [f"| {row.name} | {row.inputs} | {row.requires} |".replace("|L|", "length of L") for row in ROWS]
    return "\n".join(lines) + "\n"
