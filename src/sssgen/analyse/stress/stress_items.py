"""`sssgen stress` as work items, one per technique, in processes or on a Dask cluster.

The results are not stored: a stress test must run the driver.
"""

from __future__ import annotations

import functools
import threading
from collections.abc import Sequence

from sssgen.analyse.stress.stress_report import Report
from sssgen.analyse.stress.stress_run import Machines, Row, Settings, stress
from sssgen.analyse.stress.subject import Specimen
from sssgen.jobs.executor import Item, failures, run
from sssgen.jobs.result_store import Store
from sssgen.support.diagnostics import Diagnostic, SssgenError
from sssgen.support.progress import ProgressBar

_running = threading.Lock()
"""The back ends of a worker run one item at a time."""


def run_stress(
    specimens: Sequence[Specimen],
    names: Sequence[str],
    settings: Settings,
    scheduler: str = "",
    processes: int | None = None,
) -> Report:
    """The report on techniques on the named back ends: the same as from one process, except for the times.

    Raises SssgenError if the scheduler does not answer, and for a technique that always kills its worker.
    """
    items = [
        Item(f"{__name__}:stress_item", (specimen, tuple(names), settings), specimen.title) for specimen in specimens
    ]
    with ProgressBar() as progress:
        results = run(items, scheduler, processes, Store(""), progress)
    if failed := failures(results):
        raise SssgenError(
            [Diagnostic("error", f"{failure.name}: {failure.message}", hint=failure.hint) for failure in failed]
        )
    devices: dict[str, str] = {}
    missing: dict[str, str] = {}
    for _, worker_devices, worker_missing in results:
        devices |= worker_devices
        missing |= worker_missing
    return Report(settings, devices, missing, [row for row, *_ in results])


def stress_item(
    specimen: Specimen, names: tuple[str, ...], settings: Settings
) -> tuple[Row, dict[str, str], dict[str, str]]:
    """The row of one technique, the devices of this process's back ends, and the reasons why back ends are missing."""
    with _running:
        machines = _machines(names)
        row = stress(specimen, machines, settings)
        return row, {name: backend.device() for name, backend in machines.backends.items()}, machines.missing


@functools.cache
def _machines(names: tuple[str, ...]) -> Machines:
    return Machines(names)  # closed with the process
