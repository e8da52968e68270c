"""`sssgen stress` as work items, one for each technique: in processes, or on a Dask cluster.

The results are not kept: whoever stresses a driver wants it to be run.
"""

from __future__ import annotations

import functools
import threading
from collections.abc import Sequence

from sssgen.harness.stress.stress_report import Report
from sssgen.harness.stress.stress_run import Machines, Row, Settings, stress
from sssgen.harness.stress.subject import Specimen
from sssgen.lab.jobs.executor import Item, failures, run
from sssgen.lab.jobs.result_store import Store
from sssgen.support.diagnostics import Diagnostic, SssgenError
from sssgen.support.progress import ProgressBar

_one = threading.Lock()
"""A worker's back ends answer one question at a time."""


def spread(
    chosen: Sequence[Specimen],
    names: Sequence[str],
    settings: Settings,
    scheduler: str = "",
    processes: int | None = None,
) -> Report:
    """The report on what is chosen, on the back ends named: as one process makes it, but for the times.

    Raises SssgenError where the scheduler does not answer, and for a technique whose worker dies each time.
    """
    items = [Item(f"{__name__}:stressed", (one, tuple(names), settings), one.title) for one in chosen]
    with ProgressBar() as told:
        results = run(items, scheduler, processes, Store(""), told)
    if failed := failures(results):
        raise SssgenError([Diagnostic("error", f"{one.name}: {one.message}") for one in failed])
    devices: dict[str, str] = {}
    missing: dict[str, str] = {}
    for _, here, lacking in results:
        devices |= here
        missing |= lacking
    return Report(settings, devices, missing, [row for row, *_ in results])


def stressed(
    specimen: Specimen, names: tuple[str, ...], settings: Settings
) -> tuple[Row, dict[str, str], dict[str, str]]:
    """One technique; with it, what the back ends of this process are, and why others are missing."""
    with _one:
        machines = _machines(names)
        row = stress(specimen, machines, settings)
        return row, {name: backend.device() for name, backend in machines.here.items()}, machines.missing


@functools.cache
def _machines(names: tuple[str, ...]) -> Machines:
    return Machines(names)  # they end with the process
