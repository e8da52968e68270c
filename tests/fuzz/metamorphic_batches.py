"""A batch of programs whose results are known: it is generated, run on the targets, and compared (`metamorphic.py`).

A process runs one batch after the other, and its back ends stay. A batch that takes too long ends with what it ran last
as `tool timeout`, and the back ends start again.
"""

from __future__ import annotations

import contextlib
import os
import re
import signal
import sys
from collections import Counter
from collections.abc import Callable, Iterator
from pathlib import Path
from random import Random
from types import FrameType
from typing import NamedTuple

from glsl_batches import Failure
from metamorphic_bases import Base, base_from, mutated_case, rewritten_case, same_case
from metamorphic_cases import KnownCase, MetamorphicRunner, known_case
from sssgen.support.diagnostics import SssgenError

BATCH = 32
"""The programs in one text."""
MUTATIONS = 0.1
"""The share of mutations among the programs of a function."""
SHARE_KNOWN = 0.4
"""The share of batches of known answers where there are folders."""
ENDINGS = (".glsl", ".frag", ".fs")
PICKS = 20
"""How many files are tried for a function."""


class TimeOver(BaseException):
    """A batch takes too long; no `except Exception` on the way catches it."""


class Job(NamedTuple):
    """One batch."""

    seed: int
    number: int
    targets: tuple[str, ...]
    folders: tuple[str, ...]
    output: str
    limit: float
    """The most seconds."""


class Result(NamedTuple):
    """What a batch has shown; it is stored as JSON."""

    number: int
    programs: dict[str, int]
    """By kind."""
    failures: list[str]
    """Their titles."""
    seconds: dict[str, float]


_files: dict[str, list[Path]] = {}


def files_of(folder: str) -> list[Path]:
    """The GLSL files of a folder, in a fixed order."""
    if folder not in _files:
        _files[folder] = sorted(path for path in Path(folder).rglob("*") if path.suffix in ENDINGS)
    return _files[folder]


def batch(seed: int, number: int, folders: tuple[str, ...], size: int = BATCH) -> list[KnownCase]:
    """The programs of a batch."""
    random = Random(f"{seed}-{number}")
    if not folders or random.random() < SHARE_KNOWN:
        return [known_case(random, index) for index in range(size)]
    for _ in range(PICKS):
        folder = random.choice(folders)
        base = base_from(random.choice(files_of(folder)), Path(folder), random)
        if base is not None:
            return cases_of(base, random, size)
    return []


def cases_of(base: Base, random: Random, size: int) -> list[KnownCase]:
    """The base itself, its rewrites and mutations."""
    cases = [same_case(base, 0)]
    for number in range(1, size):
        mutates = random.random() < MUTATIONS
        case = mutated_case(base, random, number) if mutates else rewritten_case(base, random, number)
        cases += [case] if case is not None else []
    return cases


def title(case: KnownCase, failure: Failure) -> str:
    """The kind of fault: messages without their numbers and names."""
    message = "" if failure.message.startswith("lane ") else failure.message
    message = re.sub(r"'[^']*'|`[^`]*`|\d+", "…", message)[:100]
    return f"{failure.target} {failure.kind} {case.kind} {failure.cause} {message}".strip()


@contextlib.contextmanager
def ended_after(seconds: float) -> Iterator[None]:
    """What is inside raises TimeOver after this time, also where it waits for another process."""

    def end(_: int, __: FrameType | None) -> None:
        raise TimeOver

    if not hasattr(signal, "setitimer"):
        yield
        return
    handler = signal.signal(signal.SIGALRM, end)
    timer = signal.setitimer(signal.ITIMER_REAL, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, *timer)
        signal.signal(signal.SIGALRM, handler)


class Worker:
    """What stays from one batch to the next."""

    def __init__(self) -> None:
        self.runner: MetamorphicRunner | None = None

    def run(self, job: Job) -> Result:
        """Runs a batch in this process."""
        if self.runner is None:
            self.runner = MetamorphicRunner(job.targets)
        runner = self.runner
        runner.seconds.clear()
        runner.running = None
        cases: list[KnownCase] = []
        try:
            with ended_after(job.limit):
                cases = runner.timed("generate", batch, job.seed, job.number, job.folders)
                titles = judged(runner, job, cases)
        except TimeOver:
            runner.close()
            self.runner = None
            titles = [late(runner, job)]
        except SssgenError as error:  # a rewrite that the printer of GLSL refuses
            titles = [f"generate refused {error.diagnostics[0].message}"]
        except Exception as error:
            titles = [f"{'run' if cases else 'generate'} crash {type(error).__name__}: {error}"]
        seconds = {name: round(spent, 2) for name, spent in runner.seconds.items()}
        return Result(job.number, dict(Counter(case.kind for case in cases)), titles, seconds)


def judged(runner: MetamorphicRunner, job: Job, cases: list[KnownCase]) -> list[str]:
    """The titles of the failures of a batch, which are written."""
    titles = []
    failures = runner.confirmed(cases)
    wrong_bases = {failure.target for case, failure in failures if case.kind == "base"}
    for case, failure in failures:
        inherited = case.kind == "rewrite" and failure.target in wrong_bases and failure.kind == "wrong"
        name = f"base {title(case, failure)}" if inherited else title(case, failure)
        titles.append(name)
        if job.output and not inherited:
            write(job, case, failure, name, runner.head)
    return titles


def late(runner: MetamorphicRunner, job: Job) -> str:
    """The title of a batch that took too long; the programs that ran last are written."""
    if runner.running is None:
        return "generate tool timeout"
    target, cases = runner.running
    failure = Failure(target, "tool", f"the batch did not end within {job.limit:g} seconds", "timeout")
    if job.output:
        for case in cases:
            write(job, case, failure, title(cases[0], failure), runner.head)
    return f"{target} tool batch timeout"


def write(job: Job, case: KnownCase, failure: Failure, name: str, head: str) -> None:
    """Writes a failing program."""
    path = Path(
        job.output, f"{re.sub(r'[^A-Za-z0-9]+', '_', name)[:60]}_{job.seed}_{job.number}_{case.program.entry}.glsl"
    )
    path.parent.mkdir(parents=True, exist_ok=True)
    lines = [name, case.origin, *failure.message.split("\n"), f"batch {job.number} of seed {job.seed}"]
    path.write_text("".join(f"// {line}\n" for line in lines) + head + case.text, encoding="utf-8")


def serve(_: str) -> tuple[int, Callable[[Job], Result]]:
    """The id of this process, and its function from batches to their results."""
    sys.setrecursionlimit(30_000)
    return os.getpid(), Worker().run
