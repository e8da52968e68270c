"""Work items on a Dask cluster (https://distributed.dask.org); it reassigns the items of a lost worker.

    dask scheduler
    dask worker tcp://HOST:8786 --nthreads 1 --nworkers 8

One thread per worker: a graphics context belongs to the thread that created it.
"""

from __future__ import annotations

import contextlib
import logging
from collections.abc import Generator, Iterator
from typing import Any

from sssgen.jobs.work_items import EncodedResult, Failure, Task, execute
from sssgen.support.diagnostics import failure
from sssgen.support.extras import need
from sssgen.support.value_bytes import encode

SECONDS = 5
"""The timeout for the scheduler's answer."""
WORKERS_SECONDS = 30
"""The timeout for its first worker."""


def on_cluster(tasks: list[Task], address: str) -> Generator[EncodedResult]:
    """Yields the tasks' results as they end; closing it cancels the rest. Raises SssgenError without a cluster."""
    distributed = need("distributed", extra="cluster")
    with _client(distributed, address) as client:
        futures = {client.submit(execute, task, key=f"sssgen-{task.key}"): task for task in tasks}
        completed = distributed.as_completed(list(futures), loop=client.loop, with_results=True, raise_errors=False)
        for future, result in completed:
            task = futures.pop(future)
            if future.status == "cancelled":
                raise failure(f"the Dask scheduler at {address} was lost", "finished results are stored: run it again")
            if future.status == "error":
                result = encode(Failure(task.name, _message(result)))
            yield task.key, result


def _message(error: Any) -> str:
    """The message of an error of the cluster: its workers died repeatedly, or cannot import the function."""
    exception = error[1] if isinstance(error, tuple) else error
    return f"{type(exception).__name__}: {exception}"


@contextlib.contextmanager
def _client(distributed: Any, address: str) -> Iterator[Any]:
    logs = [logging.getLogger(name) for name in ("distributed", "distributed.client")]
    levels = [log.level for log in logs]
    for log in logs:
        log.setLevel(logging.CRITICAL)  # its messages about lost workers do not help the user
    try:
        with _connection(distributed, address) as client:
            yield client
    finally:
        for log, level in zip(logs, levels, strict=True):
            log.setLevel(level)


@contextlib.contextmanager
def _connection(distributed: Any, address: str) -> Iterator[Any]:
    try:
        client = distributed.Client(address, timeout=SECONDS, set_as_default=False)
    except (OSError, ValueError, TypeError) as error:
        hint = "start one with `dask scheduler`, and give its address, as tcp://HOST:8786"
        raise failure(f"no Dask scheduler answers at {address}: {error}", hint) from None
    try:
        try:
            client.wait_for_workers(1, timeout=WORKERS_SECONDS)
        except TimeoutError:
            hint = f"dask worker {address} --nthreads 1"
            raise failure(f"the Dask scheduler at {address} has no workers", hint) from None
        yield client
    finally:
        client.close()
