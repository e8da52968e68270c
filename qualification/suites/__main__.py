"""Runs outside suites: python -m qualification.suites FOLDER [--suites NAME,...] [--every N] [--write].

FOLDER has the repositories, each under its own name: FOLDER/VK-GL-CTS. Without `--suites` those suites run that it has.
An interrupted run continues where it stopped. `--every N` runs each N-th case, `--write` writes docs/suites.md.
"""

from __future__ import annotations

import argparse
import datetime
import os
import sys
from pathlib import Path

from qualification.suites.machines import devices
from qualification.suites.outcomes import Result
from qualification.suites.page import page, table
from qualification.suites.sources import SUITES, Suite
from sssgen.jobs.executor import Failure, Item, run
from sssgen.support.diagnostics import did_you_mean, failure
from sssgen.support.file_writer import write_files
from sssgen.support.progress import ProgressBar

BATCH = 25
"""Cases that one work item runs."""
DOCS = Path(__file__).parents[2] / "docs"


def main() -> int:
    options = argparse.ArgumentParser(prog="python -m qualification.suites", description=__doc__)
    options.add_argument("folder", type=Path, metavar="FOLDER")
    options.add_argument("--suites", type=lambda text: [name for name in text.split(",") if name], metavar="NAME,...")
    options.add_argument("--every", type=int, default=1, metavar="N")
    options.add_argument("--processes", type=int, default=os.cpu_count())
    options.add_argument("--write", action="store_true")
    arguments = options.parse_args()
    lacking = {name: text for name, suite in SUITES.items() if (text := missing(suite, arguments.folder))}
    for name in arguments.suites or lacking:
        if name in lacking or name not in SUITES:
            print(f"{name}: {lacking.get(name) or did_you_mean(name, SUITES) or 'there is no such suite'}", flush=True)
    results: dict[str, list[Result]] = {}
    for name in [name for name in arguments.suites or SUITES if name in SUITES and name not in lacking]:
        results[name] = results_of(name, arguments.folder, arguments.every, arguments.processes)
        print(table({name: results[name]}), flush=True)
    if arguments.write and results:
        today = datetime.date.today().isoformat()
        write_files(str(DOCS), {"suites.md": page(results, today, arguments.every, devices())})
    return 0 if results else 1


def missing(suite: Suite, folder: Path) -> str:
    """What a folder lacks of a suite; '' where it has all of it."""
    root = folder / suite.repository.rpartition("/")[2]
    part = next((part for part in suite.folders if not (root / part).is_dir()), None)
    return f"{root / part} is missing: it is a folder of https://github.com/{suite.repository}" if part else ""


def results_of(name: str, folder: Path, every: int, processes: int) -> list[Result]:
    """The results of a suite that the folder has."""
    suite = SUITES[name]
    root = folder / suite.repository.rpartition("/")[2]
    cases = list(suite.cases(root))[::every]
    batches = [tuple(cases[start : start + BATCH]) for start in range(0, len(cases), BATCH)]
    items = [Item(suite.runner, (batch,), f"{name}: {batch[0].name}") for batch in batches]
    with ProgressBar() as progress:
        outcomes = run(items, processes=processes, progress=progress)
    results: list[Result] = []
    for batch, outcome in zip(batches, outcomes, strict=True):
        if isinstance(outcome, Failure):
            raise failure(f"{batch[0].name} to {batch[-1].name}: {outcome.message}", outcome.hint)
        results += outcome
    return results


if __name__ == "__main__":
    sys.exit(main())
