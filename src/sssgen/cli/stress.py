"""`sssgen stress`: techniques on dangerous, boundary and random inputs, on several back ends."""

from __future__ import annotations

import json
import os
from argparse import ArgumentParser, Namespace
from collections.abc import Sequence
from typing import TYPE_CHECKING

from sssgen.cli.options import add_guards, add_output, add_seed, add_workers, check_samples
from sssgen.cli.output import CHECK_FAILED, OK, print_json, write_text
from sssgen.run.backend_registry import DEFAULT, HALF, SINGLE, backend_names, half_counterparts
from sssgen.support.diagnostics import failure
from sssgen.testing.outcome import in_ci

if TYPE_CHECKING:
    from sssgen.analyse.stress.stress_report import Report
    from sssgen.analyse.stress.stress_run import Settings
    from sssgen.analyse.stress.subject import Specimen

MAX_SAMPLES = 10**9


def add_options(parser: ArgumentParser) -> None:
    parser.epilog = (
        "examples:\n"
        "  sssgen stress lobe_normalized\n"
        "  sssgen stress wax.toml --backend gl,webgpu --samples 1000000 -o stress.md\n"
        "Without a name, it tests every technique of the library except the published baselines."
    )
    add = parser.add_argument
    add("NAME", nargs="*", help="a technique, a .sss file, a material's .toml file, or an example")
    add("--backend", "-b", metavar="NAME", help=f"one back end, several, or all (default: {','.join(DEFAULT)})")
    add("--samples", type=int, default=10_000, metavar="N", help="the number of random inputs (default: 10000)")
    add_seed(parser, "the seed of the random inputs")
    add(
        "--row",
        action="append",
        default=[],
        metavar="NAME",
        help="run only this row of the table of dangerous inputs; may be repeated",
    )
    add("--precision", choices=("f32", "f16"), help="f16 runs numpy and webgpu in half precision (default: f32)")
    add_guards(parser)
    add_output(parser, "REPORT", "a .md or .json file to write the report to")
    add_workers(parser)


def run(arguments: Namespace) -> int:
    """Runs the named techniques and prints their faults; returns 1 for a fault that counts."""
    from sssgen.analyse.stress import dangerous_inputs as dangerous
    from sssgen.analyse.stress import stress_report as report
    from sssgen.analyse.stress.stress_run import Settings
    from sssgen.analyse.stress.subject import specimens

    check_samples(arguments, MAX_SAMPLES)
    suffix = _suffix(arguments.output, report.SUFFIXES) if arguments.output else ""
    half = arguments.precision == "f16"
    rows = dangerous.check_rows(arguments.row)
    settings = Settings(arguments.samples, arguments.seed, arguments.guards, half, rows)
    names = _backends(arguments.backend or ("all" if half else ",".join(DEFAULT)), half)
    subjects = specimens(arguments.NAME)
    _check_rows(rows, subjects)
    if arguments.scheduler or arguments.processes is not None:
        from sssgen.analyse.stress.stress_items import run_stress

        results = run_stress(subjects, names, settings, arguments.scheduler, arguments.processes)
    else:
        results = _stress_each(subjects, names, settings)
    if arguments.output:
        _write(arguments.output, suffix, results)
    if arguments.json:
        print_json(report.as_json(results))
    else:
        _print(results, arguments.output)
    return OK if results.ok and not (in_ci() and results.missing) else CHECK_FAILED


def _check_rows(rows: Sequence[str], subjects: Sequence[Specimen]) -> None:
    """Raises SssgenError for a row without a trial for any of the subjects: it would silently pass."""
    from sssgen.analyse.stress import dangerous_inputs as dangerous

    hints = {row.name: row.elsewhere for row in dangerous.ROWS}
    for row in rows:
        if not any(True for subject in subjects for _ in dangerous.trials(subject, (row,))):
            raise failure(
                f"the row '{row}' applies to none of these", hints[row] or "omit --row to run all rows that apply"
            )


def _backends(text: str, half: bool) -> list[str]:
    """The named back ends. Raises SssgenError for unknown ones, and for those of the other precision."""
    names = list(SINGLE) if text == "all" else backend_names(text)
    if not half:
        wrong = [name for name in names if name in HALF]
        if wrong:
            raise failure(f"{wrong[0]} computes in half precision", "--precision f16 --backend numpy,webgpu")
        return names
    return list(HALF) if text == "all" else half_counterparts(names)


def _stress_each(subjects: list[Specimen], names: list[str], settings: Settings) -> Report:
    """Stresses one technique after the other, each on all back ends, with a progress bar."""
    from sssgen.analyse.stress.stress_report import Report
    from sssgen.analyse.stress.stress_run import Machines, stress
    from sssgen.support.progress import ProgressBar

    with Machines(names) as machines, ProgressBar() as progress:
        rows = []
        for index, specimen in enumerate(subjects):

            def report(task: str, done: int, index: int = index, title: str = specimen.title) -> None:
                progress(index + done / settings.samples, len(subjects), f"{title}: {task}")

            rows.append(stress(specimen, machines, settings, report))
        devices = {name: backend.device() for name, backend in machines.backends.items()}
    return Report(settings, devices, machines.missing, rows)


def _suffix(path: str, suffixes: tuple[str, ...]) -> str:
    """The report's suffix. Raises SssgenError now if the report cannot be written, not after the run."""
    suffix = os.path.splitext(path)[1].lower()
    if suffix not in suffixes:
        raise failure(f"a report cannot be a '{suffix}' file", f"use one of {', '.join(suffixes)}", path)
    folder = os.path.dirname(path) or "."
    exists = os.path.exists(folder)
    if os.path.isdir(path) or (exists and not (os.path.isdir(folder) and os.access(folder, os.W_OK))):
        raise failure("cannot write the report here", "choose a folder with write permission", path)
    return suffix


def _write(path: str, suffix: str, results: Report) -> None:
    """Writes the report atomically."""
    from sssgen.analyse.stress import stress_report as report

    text = report.as_markdown(results)
    if suffix == ".json":
        text = json.dumps(report.as_json(results), indent=2, ensure_ascii=False) + "\n"
    write_text(path, text)


def _print(results: Report, written: str | None) -> None:
    from sssgen.analyse.stress import stress_report as report

    for line in report.summary(results):
        print(line)
    faults = [line for row in results.rows for line in report.faults(row)]
    if faults:
        print()
    for line in faults:
        print(line)
    print(f"\n{report.total(results)}")
    if written:
        print(f"wrote {written}")
    if not results.devices:
        print("nothing was run: none of these back ends is available")
    elif results.missing and in_ci():
        print(f"with CI set a missing back end is a failure: {', '.join(results.missing)}")
