"""Runs work items: here, in processes of this machine, or on a Dask cluster, with the same results to the byte.

    items = [Item("sssgen.lab.chart.charting:measured", (technique, setting, scene), f"{technique} on {scene}") for ...]
    with ProgressBar() as progress:
        results = run(items, progress=progress)

Results are stored under a digest of the function, the arguments and the code, so that an interrupted run continues.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Generator, Sequence
from typing import Any

from sssgen.lab.jobs.result_store import Store, decoded
from sssgen.lab.jobs.work_items import Ended, Failure, Item, Task, execute, task

__all__ = ["Failure", "Item", "Progress", "failures", "run"]

Progress = Callable[[int, int, str], None]
"""Called as each item ends: number of finished items, number of all items, name."""


def run(
    items: Sequence[Item],
    scheduler: str = "",
    processes: int | None = None,
    store: Store | None = None,
    progress: Progress = lambda *_: None,
) -> list[Any]:
    """The items' results, in order; a Failure for each item that raised an exception or always killed its worker.

    They are computed by the Dask cluster whose scheduler has the address `scheduler` (`tcp://HOST:8786`); without one,
    in `processes` processes of this machine (by default one per core), or with 0 in this process. Stored results are
    not computed again, and equal items are computed once. An interrupt ends the workers and keeps finished results.
    Raises SssgenError if the scheduler does not answer or is lost.
    """
    store = Store() if store is None else store
    tasks = [task(item) for item in items]
    wanted = {one.key: one for one in tasks}
    results: dict[str, Any] = {}

    def take(key: str, data: bytes) -> Any:
        results[key] = decoded(data)
        progress(len(results), len(wanted), wanted[key].name)
        return results[key]

    for key in wanted:
        if (kept := store.get(key)) is not None:
            take(key, kept)
    ended = _ended([one for one in wanted.values() if one.key not in results], scheduler, processes)
    try:
        for key, data in ended:
            if not isinstance(take(key, data), Failure):
                store.put(key, data)
    finally:
        ended.close()
    return [_named(results[one.key], one) for one in tasks]


def _named(result: Any, one: Task) -> Any:
    return result._replace(name=one.name) if isinstance(result, Failure) else result


def failures(results: Sequence[Any]) -> list[Failure]:
    """The failures among results."""
    return [result for result in results if isinstance(result, Failure)]


def _ended(tasks: list[Task], scheduler: str, processes: int | None) -> Generator[Ended]:
    """Yields the tasks as they end, in any order. Closing it ends the workers."""
    if not tasks:
        return
    if scheduler:
        from sssgen.lab.jobs.dask_cluster import on_cluster

        yield from on_cluster(tasks, scheduler)
    elif processes == 0:
        yield from ((one.key, execute(one)) for one in tasks)
    else:
        from sssgen.lab.jobs.local_workers import in_processes

        yield from in_processes(tasks, min(processes or os.cpu_count() or 1, len(tasks)))
