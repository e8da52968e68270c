"""`sssgen stress` as work items, one per technique, in processes or on a Dask cluster.

The results are not stored: a stress test must run the driver.
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
"""The back ends of a worker run one item at a time."""


def spread(
    chosen: Sequence[Specimen],
    names: Sequence[str],
    settings: Settings,
    scheduler: str = "",
    processes: int | None = None,
) -> Report:
    """The report on the chosen techniques on the named back ends: as by one process, except for the times.

    Raises SssgenError if the scheduler does not answer, and for a technique that always kills its worker.
    """
    items = [Item(f"{__name__}:stressed", (one, tuple(names), settings), one.title) for one in chosen]
    with ProgressBar() as progress:
        results = run(items, scheduler, processes, Store(""), progress)
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
    """The row of one technique, the devices of this process's back ends, and the reasons why others are missing."""
    with _one:
        machines = _machines(names)
        row = stress(specimen, machines, settings)
        return row, {name: backend.device() for name, backend in machines.here.items()}, machines.missing


@functools.cache
def _machines(names: tuple[str, ...]) -> Machines:
    return Machines(names)  # closed with the process
