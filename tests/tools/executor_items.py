"""Functions that the tests of the executor run as work items. Each run writes a file."""

from __future__ import annotations

import os
import signal
import time
import uuid
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from sssgen.jobs.executor import run
from sssgen.jobs.result_store import Store
from sssgen.jobs.work_items import Item
from sssgen.support.diagnostics import failure


class Measured(NamedTuple):
    """A result with values of every kind."""

    name: str
    numbers: np.ndarray[Any, Any]
    details: dict[str, Any]


def note(folder: str, number: int) -> None:
    """Writes a file that records one run of the item."""
    Path(folder, f"{number}-{uuid.uuid4()}").touch()


def runs(folder: str | Path) -> list[int]:
    """The numbers of the items that ran, repeated for each run."""
    return sorted(int(path.name.partition("-")[0]) for path in Path(folder).glob("*-*"))


def measure(folder: str, number: int) -> Measured:
    """Numbers from a seed, some of them the same object twice, and an array that is not in C order."""
    note(folder, number)
    return _measured(number)


def _measured(number: int) -> Measured:
    numbers = np.random.default_rng(number).normal(size=(3, 4))
    label = f"item {number}"
    return Measured(label, numbers.T @ numbers, {"label": label, "mean": float(numbers.mean()), "rows": numbers.T})


GATE = 5
"""The items before the gate."""


def measure_behind_gate(folder: str, number: int) -> Measured:
    """Calls `measure`; from number GATE on, it waits for `open_gate` first."""
    note(folder, number)
    while number >= GATE and not Path(folder, "gate").exists():
        time.sleep(0.01)
    return _measured(number)


def open_gate(folder: Path) -> None:
    """Starts the items behind the gate."""
    (folder / "gate").touch()


def echo(value: Any) -> Any:
    """Returns its arguments."""
    return value, value


def die_first(folder: str, number: int) -> int:
    """Kills its process in the first run."""
    first = number not in runs(folder)
    note(folder, number)
    if first:
        os.kill(os.getpid(), signal.SIGKILL)
    return number


def die(folder: str, number: int) -> int:
    """Kills its process in each run."""
    note(folder, number)
    os.kill(os.getpid(), signal.SIGKILL)
    return number


def fail(how: str) -> None:
    """Raises an exception."""
    if how == "exit":
        raise SystemExit(3)
    raise failure("the scene has no light", "add one") if how == "said" else ValueError("no such thing")


def interrupted(number: int) -> int:
    """Imitates Ctrl-C at the third item."""
    if number == 2:
        raise KeyboardInterrupt
    return number


def items(folder: Path, count: int, name: str = "measure") -> list[Item]:
    """`count` items that call a function of this module."""
    return [Item(f"executor_items:{name}", (str(folder), number), f"item {number}") for number in range(count)]


def run_behind_gate(notes: str, store: str) -> None:
    """Runs twelve items in two processes; those from number GATE on wait."""
    run(items(Path(notes), 12, "measure_behind_gate"), processes=2, store=Store(store))
