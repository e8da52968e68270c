"""Work items in processes of this machine. A process that dies affects only its current item."""

from __future__ import annotations

import os
import queue
import threading
from collections.abc import Callable, Generator

from sssgen.lab.jobs.result_store import encoded
from sssgen.lab.jobs.work_items import Ended, Failure, Task, execute
from sssgen.support.worker_process import LostError, Process

TRIES = 3
"""The number of processes that an item may kill before it fails."""

SECONDS = 7 * 24 * 3600.0
"""The time limit of an item."""

THREADS = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1")
"""The processes' environment: they already use all cores, and one thread keeps the order of sums."""


def in_processes(tasks: list[Task], processes: int) -> Generator[Ended]:
    """Yields the tasks as they end, computed in `processes` processes; closing it ends these."""
    waiting: queue.SimpleQueue[Task] = queue.SimpleQueue()
    ended: queue.SimpleQueue[Ended | BaseException] = queue.SimpleQueue()
    for one in tasks:
        waiting.put(one)
    workers = [_Worker(waiting, ended) for _ in range(processes)]
    try:
        for worker in workers:
            worker.start()
        for _ in tasks:
            result = ended.get()
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

    def __init__(self, waiting: queue.SimpleQueue[Task], ended: queue.SimpleQueue[Ended | BaseException]) -> None:
        super().__init__(daemon=True)
        self.waiting, self.ended = waiting, ended
        self.process = Process(__name__, "", THREADS, SECONDS)
        self.stopped = False

    def run(self) -> None:
        """Runs until there are no more tasks, or it is stopped."""
        try:
            while not self.stopped:
                one = self.waiting.get_nowait()
                self.ended.put((one.key, self._result(one)))
        except queue.Empty:
            pass
        except BaseException as error:  # the run's own thread raises it
            self.ended.put(error)
        finally:
            self.process.close()

    def _result(self, one: Task) -> bytes:
        reason = ""
        for _ in range(TRIES):
            try:
                if self.stopped:
                    break
                result: bytes = self.process.ask(one)
                return result
            except LostError as error:
                reason = str(error)
        return encoded(Failure(one.name, f"its process {reason}, {TRIES} times in a row"))

    def end(self) -> None:
        """Kills the process, repeatedly, until the thread has ended."""
        while self.is_alive():
            if (running := self.process.process) is not None:
                running.kill()
            self.join(0.05)


def serve(name: str) -> tuple[int, Callable[[Task], bytes]]:
    """The process id, and the function that answers tasks with results."""
    return os.getpid(), execute
