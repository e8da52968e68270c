"""Work items in processes of this machine. A process that dies affects only its current item."""

from __future__ import annotations

import os
import queue
import threading
from collections.abc import Callable, Generator

from sssgen.lab.jobs.work_items import EncodedResult, Failure, Task, execute
from sssgen.support.value_bytes import encoded
from sssgen.support.worker_process import LostError, Process

TRIES = 3
"""The number of processes that an item may kill before it fails."""

SECONDS = 7 * 24 * 3600.0
"""The time limit of an item."""

THREADS = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1")
"""The processes' environment: one thread each, because they use all cores already, and to keep the order of sums."""


def in_processes(tasks: list[Task], processes: int) -> Generator[EncodedResult]:
    """Yields the tasks' results as they end, computed in `processes` processes; closing it ends these."""
    waiting: queue.SimpleQueue[Task] = queue.SimpleQueue()
    results: queue.SimpleQueue[EncodedResult | BaseException] = queue.SimpleQueue()
    for task in tasks:
        waiting.put(task)
    workers = [_Worker(waiting, results) for _ in range(processes)]
    try:
        for worker in workers:
            worker.start()
        for _ in tasks:
            result = results.get()
            if isinstance(result, BaseException):
                raise result
            yield result
    finally:
        for worker in workers:
            worker.stopped = True
        for worker in workers:
            worker.end()


class _Worker(threading.Thread):
    """A thread that gives tasks to its own process, one at a time, and queues the results."""

    def __init__(
        self, waiting: queue.SimpleQueue[Task], results: queue.SimpleQueue[EncodedResult | BaseException]
    ) -> None:
        super().__init__(daemon=True)
        self.waiting, self.results = waiting, results
        self.process = Process(__name__, "", THREADS, SECONDS)
        self.stopped = False

    def run(self) -> None:
        """Runs until there are no more tasks, or it is stopped."""
        try:
            while not self.stopped:
                task = self.waiting.get_nowait()
                self.results.put((task.key, self._result(task)))
        except queue.Empty:
            pass
        except BaseException as error:  # the thread of the run raises it again
            self.results.put(error)
        finally:
            self.process.close()

    def _result(self, task: Task) -> bytes:
        reason = ""
        for _ in range(TRIES):
            try:
                if self.stopped:
                    break
                result: bytes = self.process.ask(task)
                return result
            except LostError as error:
                reason = str(error)
        return encoded(Failure(task.name, f"its process {reason}, {TRIES} times in a row"))

    def end(self) -> None:
        """Kills the process, repeatedly, until the thread has results."""
        while self.is_alive():
            if (running := self.process.process) is not None:
                running.kill()
            self.join(0.05)


def serve(name: str) -> tuple[int, Callable[[Task], bytes]]:
    """The process id, and the function that answers tasks with results."""
    return os.getpid(), execute
