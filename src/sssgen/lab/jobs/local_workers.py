"""Work items in processes of this machine. A process that dies takes down the item that it had, and no other."""

from __future__ import annotations

import os
import queue
import threading
from collections.abc import Callable, Generator

from sssgen.lab.jobs.result_store import encoded
from sssgen.lab.jobs.work_items import Ended, Failure, Task, execute
from sssgen.support.worker_process import LostError, Process

TRIES = 3
"""How often an item is given to a process before it counts as what kills them."""

SECONDS = 7 * 24 * 3600.0
"""How long one item may take."""

THREADS = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1")
"""For the processes' environment: they fill the cores already, and sums keep their order."""


def in_processes(tasks: list[Task], processes: int) -> Generator[Ended]:
    """The tasks as they end, computed in so many processes; to close it ends these."""
    waiting: queue.SimpleQueue[Task] = queue.SimpleQueue()
    ended: queue.SimpleQueue[Ended | BaseException] = queue.SimpleQueue()
    for one in tasks:
        waiting.put(one)
    workers = [_Worker(waiting, ended) for _ in range(processes)]
    try:
        for worker in workers:
            worker.start()
        for _ in tasks:
            found = ended.get()
            if isinstance(found, BaseException):
                raise found
            yield found
    finally:
        for worker in workers:
            worker.stopped = True
        for worker in workers:
            worker.end()


class _Worker(threading.Thread):
    """Gives tasks to a process of its own, one at a time, and puts what comes of them where it is waited for."""

    def __init__(self, waiting: queue.SimpleQueue[Task], ended: queue.SimpleQueue[Ended | BaseException]) -> None:
        super().__init__(daemon=True)
        self.waiting, self.ended = waiting, ended
        self.process = Process(__name__, "", THREADS, SECONDS)
        self.stopped = False

    def run(self) -> None:
        """Until there is no more to do, or it is stopped."""
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
        told = ""
        for _ in range(TRIES):
            try:
                if self.stopped:
                    break
                found: bytes = self.process.ask(one)
                return found
            except LostError as reason:
                told = str(reason)
        return encoded(Failure(one.name, f"its process {told}, {TRIES} times in a row"))

    def end(self) -> None:
        """Ends the thread and its process, whatever it does; again until it has seen it."""
        while self.is_alive():
            if (running := self.process.process) is not None:
                running.kill()
            self.join(0.05)


def serve(name: str) -> tuple[int, Callable[[Task], bytes]]:
    """The process's number, and what answers tasks with results."""
    return os.getpid(), execute
