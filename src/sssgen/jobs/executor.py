"""Runs work items in this process, in processes of this machine, or on a Dask cluster; all give the same bytes.

    items = [Item("package.measurement:error_of", (technique, setting, scene), f"{technique} on {scene}") for ...]
    with ProgressBar() as progress:
        results = run(items, progress=progress)

Results are stored under a digest of the function, the arguments and the code, so that an interrupted run continues.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Generator, Sequence
from typing import Any

from sssgen.jobs.result_store import Store
from sssgen.jobs.work_items import EncodedResult, Failure, Item, Task, execute, task_of
from sssgen.support.value_bytes import decode

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
    not computed again, and equal items are computed once. An interrupt ends the workers; finished results stay stored.
    Raises SssgenError if the scheduler does not answer or is lost.
    """
    store = Store() if store is None else store
    tasks = [task_of(item) for item in items]
    by_key = {task.key: task for task in tasks}
    results: dict[str, Any] = {}

    def add_result(key: str, data: bytes) -> Any:
        results[key] = decode(data)
        progress(len(results), len(by_key), by_key[key].name)
        return results[key]

    for key in by_key:
        if (stored := store.get(key)) is not None:
            add_result(key, stored)
    computed = _compute([task for key, task in by_key.items() if key not in results], scheduler, processes)
    try:
        for key, data in computed:
            if not isinstance(add_result(key, data), Failure):
                store.put(key, data)
    finally:
        computed.close()
    return [_with_name(results[task.key], task.name) for task in tasks]


def _with_name(result: Any, name: str) -> Any:
    """The result; a failure, which equal items share, with the item's own name."""
    return result._replace(name=name) if isinstance(result, Failure) else result


def failures(results: Sequence[Any]) -> list[Failure]:
    """The failures among results."""
    return [result for result in results if isinstance(result, Failure)]


def _compute(tasks: list[Task], scheduler: str, processes: int | None) -> Generator[EncodedResult]:
    """Yields the tasks' results as they end, in any order. Closing it ends the workers."""
    if not tasks:
        return
    if scheduler:
        from sssgen.jobs.dask_cluster import on_cluster

        yield from on_cluster(tasks, scheduler)
    elif processes == 0:
        yield from ((task.key, execute(task)) for task in tasks)
    else:
        from sssgen.jobs.local_workers import in_processes

        yield from in_processes(tasks, min(processes or os.cpu_count() or 1, len(tasks)))
