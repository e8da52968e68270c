"""Functions that the tests of the executor run as work items. Each writes a file for every time that it runs."""

from __future__ import annotations

import os
import signal
import time
import uuid
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from sssgen.lab.jobs.executor import run
from sssgen.lab.jobs.result_store import Store
from sssgen.lab.jobs.work_items import Item
from sssgen.support.diagnostics import failure


class Measured(NamedTuple):
    """With every kind of value that results contain."""

    name: str
    numbers: np.ndarray[Any, Any]
    told: dict[str, Any]


def note(folder: str, number: int) -> None:
    """Writes a file that records one run of the item."""
    Path(folder, f"{number}-{uuid.uuid4()}").touch()


def runs(folder: str | Path) -> list[int]:
    """The numbers of the items that ran, as often as they ran."""
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
    """As `measure`; from number GATE on it waits until `open_gate` is called."""
    note(folder, number)
    while number >= GATE and not Path(folder, "gate").exists():
        time.sleep(0.01)
    return _measured(number)


def open_gate(folder: Path) -> None:
    """Lets the items behind the gate run."""
    (folder / "gate").touch()


def echo(value: Any) -> Any:
    """What it was given."""
    return value, value


def die_first(folder: str, number: int) -> int:
    """Kills its process when it runs for the first time."""
    first = number not in runs(folder)
    note(folder, number)
    if first:
        os.kill(os.getpid(), signal.SIGKILL)
    return number


def die(folder: str, number: int) -> int:
    """Kills its process each time."""
    note(folder, number)
    os.kill(os.getpid(), signal.SIGKILL)
    return number


def fail(how: str) -> None:
    """Raises."""
    if how == "exit":
        raise SystemExit(3)
    raise failure("the scene has no light", "add one") if how == "said" else ValueError("no such thing")


def interrupted(number: int) -> int:
    """Stands for Ctrl-C at the third item."""
    if number == 2:
        raise KeyboardInterrupt
    return number


def items(folder: Path, count: int, name: str = "measure") -> list[Item]:
    """`count` items that call a function of this module."""
    return [Item(f"executor_items:{name}", (str(folder), number), f"item {number}") for number in range(count)]


def run_behind_gate(notes: str, store: str) -> None:
    """Twelve items, of which those from number GATE on wait, in two processes."""
    run(items(Path(notes), 12, "measure_behind_gate"), processes=2, store=Store(store))
