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

__all__ = ["Failure", "Item", "Progress", "completed", "failures", "run"]

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
    results: list[Any] = [None] * len(items)
    for number, result in completed(items, scheduler, processes, store, progress):
        results[number] = result
    return results


def completed(
    items: Sequence[Item],
    scheduler: str = "",
    processes: int | None = None,
    store: Store | None = None,
    progress: Progress = lambda *_: None,
) -> Generator[tuple[int, Any]]:
    """Yields the index and the result of each item as it ends: stored ones at once, others in about their order.

    Closing it ends the workers, and no further item is computed. Otherwise as `run`.
    """
    store = Store() if store is None else store
    tasks = [task_of(item) for item in items]
    places: dict[str, list[int]] = {}
    for number, task in enumerate(tasks):
        places.setdefault(task.key, []).append(number)
    done: set[str] = set()

    def ended(key: str, data: bytes) -> Generator[tuple[int, Any]]:
        result = decode(data)
        done.add(key)
        progress(len(done), len(places), tasks[places[key][0]].name)
        if key not in stored and not isinstance(result, Failure):
            store.put(key, data)
        for number in places[key]:
            yield number, _with_name(result, tasks[number].name)

    stored = {key: data for key in places if (data := store.get(key)) is not None}
    for key, data in stored.items():
        yield from ended(key, data)
    first = {key: tasks[numbers[0]] for key, numbers in places.items()}
    computed = _compute([task for key, task in first.items() if key not in stored], scheduler, processes)
    try:
        for key, data in computed:
            yield from ended(key, data)
    finally:
        computed.close()


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
