"""The back ends that run an author's text and its translations, each in a process of its own."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from typing import NamedTuple

from sssgen.analyse.verify.verification_report import BACKENDS, TRANSLATIONS
from sssgen.run.backends import CompilerMissing
from sssgen.run.backends.backend_process import BackendProcess
from sssgen.support.diagnostics import failure

SECONDS = 30.0
"""The time limit of one function on one back end."""


def backends_of(target: str) -> tuple[str, ...]:
    """The back ends that run a target's text, the author's, and NumPy, a witness; '' for all. Raises SssgenError."""
    if not target:
        return tuple(BACKENDS.values())
    if target not in TRANSLATIONS:
        raise failure(f"--verify runs no text of the target '{target}'", f"choose from: {', '.join(TRANSLATIONS)}")
    return tuple(dict.fromkeys(["gl", "numpy", *TRANSLATIONS[target].values()]))


class Machines(NamedTuple):
    """The back ends, each in its own process; and why the others are missing, by name."""

    running: dict[str, BackendProcess]
    missing: dict[str, str]


@contextmanager
def start_machines(names: Sequence[str] = tuple(BACKENDS.values())) -> Iterator[Machines]:
    """The back ends of `verify`, or some of them; they end with the block. Raises SssgenError without OpenGL."""
    machines: dict[str, BackendProcess] = {}
    missing: dict[str, str] = {}

    def start(name: str) -> None:
        try:
            machines[name] = BackendProcess(name, SECONDS)
        except CompilerMissing as reason:
            missing[name] = str(reason)

    try:
        with ThreadPoolExecutor(len(names)) as pool:
            list(pool.map(start, names))
        if "gl" in missing:
            raise failure("OpenGL is missing: it runs the text as written", missing["gl"])
        yield Machines(machines, missing)
    finally:
        for machine in machines.values():
            machine.close()
