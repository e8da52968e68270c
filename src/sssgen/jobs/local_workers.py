"""Work items in processes of this machine. A process that dies affects only its current item.

`ProcessPoolExecutor` loses all its items when one process dies, and a local Dask cluster would make the extra `cluster`
a requirement of every bake. So each thread of a pool gives its items to a process of `support.worker_process`.
"""

from __future__ import annotations

import os
import queue
import threading
from collections.abc import Callable, Generator
from concurrent.futures import Future, ThreadPoolExecutor, as_completed, wait

from sssgen.jobs.work_items import EncodedResult, Failure, Task, execute
from sssgen.support.value_bytes import encode
from sssgen.support.worker_process import LostError, Process

TRIES = 3
"""The number of processes that an item may kill before it fails."""

SECONDS = 7 * 24 * 3600.0
"""The time limit of an item."""

THREADS = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1")
"""The processes' environment: one thread each, because they use all cores already, and to keep the order of sums."""


def in_processes(tasks: list[Task], processes: int) -> Generator[EncodedResult]:
    """Yields the tasks' results as they end, computed in `processes` processes; closing it ends these."""
    workers = [Process(__name__, "", THREADS, SECONDS) for _ in range(processes)]
    idle: queue.SimpleQueue[Process] = queue.SimpleQueue()
    for worker in workers:
        idle.put(worker)
    end, pool = threading.Event(), ThreadPoolExecutor(processes)
    futures: dict[Future[bytes], str] = {}
    try:
        for task in tasks:
            futures[pool.submit(_result, task, idle, end)] = task.key
        for future in as_completed(futures):
            yield futures[future], future.result()
    finally:
        end.set()
        pool.shutdown(wait=False, cancel_futures=True)
        while running := [future for future in futures if future.running()]:
            for worker in workers:
                if (process := worker.process) is not None:
                    process.kill()
            wait(running, 0.05)  # a thread may be about to start its process
        for worker in workers:
            worker.close()


def _result(task: Task, idle: queue.SimpleQueue[Process], end: threading.Event) -> bytes:
    """The encoded result of a task from an idle process, or a Failure of it."""
    worker, reason = idle.get(), ""
    try:
        for _ in range(TRIES):
            if end.is_set():
                break
            try:
                result: bytes = worker.ask(task)
                return result
            except LostError as error:
                reason = str(error)
    finally:
        idle.put(worker)
    return encode(Failure(task.name, f"its process {reason}, {TRIES} times in a row"))


def serve(name: str) -> tuple[int, Callable[[Task], bytes]]:
    """The process id, and the function that answers tasks with results."""
    return os.getpid(), execute
