"""`sssgen stress`: techniques on dangerous, boundary and random inputs, on several back ends."""

from __future__ import annotations

import json
import os
from argparse import ArgumentParser, Namespace
from collections.abc import Sequence
from typing import TYPE_CHECKING

from sssgen.cli.options import add_guards, add_seed, add_workers
from sssgen.cli.output import CHECK_FAILED, OK, print_json
from sssgen.harness.backend_registry import DEFAULT, HALF, SINGLE, chosen, in_half
from sssgen.harness.testing.outcome import in_ci
from sssgen.support.diagnostics import failure
from sssgen.support.file_writer import write_files

if TYPE_CHECKING:
    from sssgen.harness.stress.stress_report import Report
    from sssgen.harness.stress.stress_run import Settings
    from sssgen.harness.stress.subject import Specimen

MOST_SAMPLES = 10**9


def add_options(parser: ArgumentParser) -> None:
    parser.epilog = (
        "examples:\n"
        "  sssgen stress lobe_normalized\n"
        "  sssgen stress wax.toml --backend gl,webgpu --samples 1000000 -o stress.md\n"
        "Without a name: every technique of the library but its published baselines."
    )
    add = parser.add_argument
    add("NAME", nargs="*", help="a technique, a .sss file, a material's .toml file, or an example")
    add("--backend", "-b", metavar="NAME", help=f"default: {','.join(DEFAULT)}; one, several, or all")
    add("--samples", type=int, default=10_000, metavar="N", help="the number of random inputs (default: 10000)")
    add_seed(parser, "their seed")
    add(
        "--row",
        action="append",
        default=[],
        metavar="NAME",
        help="only this row of the table of dangerous inputs; repeatable",
    )
    add("--precision", choices=("f32", "f16"), help="f16: numpy and webgpu in half precision (default: f32)")
    add_guards(parser)
    add("-o", "--output", metavar="REPORT", help="a .md or .json file to write the report to")
    add_workers(parser)


def run(arguments: Namespace) -> int:
    """Runs the named techniques and prints their faults; returns 1 for a fault that counts."""
    from sssgen.harness.stress import dangerous_inputs as dangerous
    from sssgen.harness.stress import stress_report as report
    from sssgen.harness.stress.stress_run import Settings
    from sssgen.harness.stress.subject import specimens

    if not 1 <= arguments.samples <= MOST_SAMPLES:
        raise failure(f"--samples {arguments.samples} is not a number of samples", f"from 1 to {MOST_SAMPLES}")
    if arguments.seed < 0:
        raise failure(f"--seed {arguments.seed} is below 0")
    suffix = _suffix(arguments.output, report.SUFFIXES) if arguments.output else ""
    half = arguments.precision == "f16"
    rows = dangerous.chosen(arguments.row)
    settings = Settings(arguments.samples, arguments.seed, arguments.guards, half, rows)
    names = _backends(arguments.backend or ("all" if half else ",".join(DEFAULT)), half)
    named = specimens(arguments.NAME)
    _check_rows(rows, named)
    if arguments.scheduler or arguments.processes is not None:
        from sssgen.lab.jobs.stress_items import spread

        made = spread(named, names, settings, arguments.scheduler, arguments.processes)
    else:
        made = _stressed(named, names, settings)
    if arguments.output:
        _write(arguments.output, suffix, made)
    if arguments.json:
        print_json(report.as_json(made))
    else:
        _print(made, arguments.output)
    return OK if made.ok and not (in_ci() and made.missing) else CHECK_FAILED


def _check_rows(rows: Sequence[str], named: Sequence[Specimen]) -> None:
    """Raises SssgenError for a row without a trial for any of the subjects: it would silently pass."""
    from sssgen.harness.stress import dangerous_inputs as dangerous

    told = {row.name: row.elsewhere for row in dangerous.ROWS}
    for row in rows:
        if not any(True for one in named for _ in dangerous.trials(one, (row,))):
            raise failure(f"the row '{row}' concerns none of these", told[row] or "leave --row out for all that do")


def _backends(given: str, half: bool) -> list[str]:
    """The back ends that are meant. Raises SssgenError for unknown ones, and ones of the other precision."""
    names = list(SINGLE) if given == "all" else chosen(given)
    if not half:
        wrong = [name for name in names if name in HALF]
        if wrong:
            raise failure(f"{wrong[0]} computes in half precision", "--precision f16 --backend numpy,webgpu")
        return names
    return list(HALF) if given == "all" else in_half(names)


def _stressed(chosen: list[Specimen], names: list[str], settings: Settings) -> Report:
    """Stresses one technique after the other, each on all back ends, with a progress bar."""
    from sssgen.harness.stress.stress_report import Report
    from sssgen.harness.stress.stress_run import Machines, stress
    from sssgen.support.progress import ProgressBar

    with Machines(names) as machines, ProgressBar() as progress:
        rows = []
        for index, specimen in enumerate(chosen):

            def report(what: str, done: int, index: int = index, title: str = specimen.title) -> None:
                progress(index + done / settings.samples, len(chosen), f"{title}: {what}")

            rows.append(stress(specimen, machines, settings, report))
        devices = {name: backend.device() for name, backend in machines.here.items()}
    return Report(settings, devices, machines.missing, rows)


def _suffix(path: str, known: tuple[str, ...]) -> str:
    """The report's suffix. Raises SssgenError now if the report cannot be written, not after the run."""
    suffix = os.path.splitext(path)[1].lower()
    if suffix not in known:
        raise failure(f"a report is no '{suffix}' file", f"it is one of {', '.join(known)}", path)
    folder = os.path.dirname(path) or "."
    there = os.path.exists(folder)
    if os.path.isdir(path) or (there and not (os.path.isdir(folder) and os.access(folder, os.W_OK))):
        raise failure("cannot write the report here", "name a file in a folder that you may write to", path)
    return suffix


def _write(path: str, suffix: str, made: Report) -> None:
    """Writes the report atomically."""
    from sssgen.harness.stress import stress_report as report

    text = report.as_markdown(made)
    if suffix == ".json":
        text = json.dumps(report.as_json(made), indent=2, ensure_ascii=False) + "\n"
    folder, name = os.path.split(path)
    write_files(folder or ".", {name: text})


def _print(made: Report, written: str | None) -> None:
    from sssgen.harness.stress import stress_report as report

    for line in report.summary(made):
        print(line)
    told = [line for row in made.rows for line in report.faults(row)]
    if told:
        print()
    for line in told:
        print(line)
    print(f"\n{report.total(made)}")
    if written:
        print(f"wrote {written}")
    if not made.devices:
        print("nothing was run: none of these back ends is here")
    elif made.missing and in_ci():
        print(f"with CI set a missing back end is a failure: {', '.join(made.missing)}")
