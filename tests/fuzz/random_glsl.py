"""Random plain GLSL on every target, compared with an interpreter that shares nothing with the compiler.

    python tests/fuzz/random_glsl.py --programs 50000 --seed 1 --processes 2 [--targets numpy,gl,gl-es,webgpu,hlsl]

Batch N of seed S is always the same; `--first N` continues a run. Each failing program is reduced and written to the
folder of `-o`, with the command that runs its batch again.
"""

from __future__ import annotations

import argparse
import multiprocessing
import os
import re
import sys
import time
from collections import Counter
from contextlib import suppress
from itertools import accumulate
from pathlib import Path
from random import Random
from typing import NamedTuple

from glsl_batches import TARGETS, Case, Failure, Runner
from glsl_programs import programs
from glsl_reduction import reduced
from glsl_tree import Program

TRIALS = 3000
"""The most programs that a reduction tries."""
BATCH = 16
"""The programs in one text."""
DEEPEST = 80
"""Programs with as many brackets inside each other are left out: the transpiler refuses them from 100 levels on."""
REDUCTIONS_PER_TITLE = 3
"""How many programs with the same fault are reduced and written."""


class Job(NamedTuple):
    """One batch."""

    seed: int
    number: int
    targets: tuple[str, ...]
    folder: str


class Outcome(NamedTuple):
    """What one batch has shown."""

    job: Job
    programs: int
    excused: Counter[str]
    """Programs that are not run, and lanes that are not compared, by reason."""
    failures: list[Failure]
    seconds: dict[str, float]


_runner: Runner | None = None
_failure_counts: Counter[str] = Counter()


def batch(seed: int, number: int) -> list[Case]:
    """The cases of a batch; without programs that the generator got wrong, which the interpreter cannot run."""
    cases = []
    for program in programs(Random(f"{seed}-{number}"), BATCH):
        with suppress(TypeError, KeyError, IndexError, RecursionError):
            case = Case(program)
            if nesting(case.text) < DEEPEST:
                cases.append(case)
    return cases


def nesting(text: str) -> int:
    """How deep the brackets of a text nest."""
    return max(accumulate((char in "([{") - (char in ")]}") for char in text))


def run(job: Job) -> Outcome:
    """Runs a batch in this process, whose back ends stay."""
    global _runner
    if _runner is None:
        sys.setrecursionlimit(30_000)
        _runner = Runner(job.targets)
    _runner.seconds.clear()
    cases = _runner.timed("generate and interpret", batch, job.seed, job.number)
    excused: Counter[str] = Counter({"programs that the interpreter refuses": BATCH - len(cases)})
    for case in cases:
        excused.update(case.reasons)
        excused["programs without results"] += not case.is_useful
    cases = [case for case in cases if case.is_useful]
    failures = []
    try:
        failures = _runner.failures(cases)
    except RecursionError:
        excused["batches that exhaust Python's stack in a comparison"] += 1
    excused["programs beyond the limit of nesting"] += sum(failure.kind == "limit" for _, failure in failures)
    failures = [(case, failure) for case, failure in failures if failure.kind != "limit"]
    for case, failure in failures:
        _failure_counts[title(failure)] += 1
        if job.folder and _failure_counts[title(failure)] <= REDUCTIONS_PER_TITLE:
            with suppress(RecursionError):  # Python's stack ends in copies of very deep programs
                _runner.timed("reduce", write, job, case, failure, _runner)
    return Outcome(job, len(cases), excused, [failure for _, failure in failures], dict(_runner.seconds))


def title(failure: Failure) -> str:
    """The kind of fault: messages without their numbers and names."""
    is_lane = failure.message.startswith("lane ")
    message = failure.cause if is_lane else re.sub(r"'[^']*'|`[^`]*`|\d+", "…", failure.message)[:80]
    return f"{failure.target} {failure.kind} {message}".strip()


def write(job: Job, case: Case, failure: Failure, runner: Runner) -> None:
    """Writes a reduced program."""
    small = Runner((failure.target,)) if failure.target in TARGETS else Runner(())
    small.backends = runner.backends
    last = [failure]
    trials = iter(range(TRIALS))

    def fails(program: Program) -> bool:
        if next(trials, None) is None:
            return False
        try:
            candidate = Case(program)
        except (KeyError, IndexError, AttributeError, TypeError, ValueError, RecursionError, AssertionError):
            return False
        if not candidate.is_useful:
            return False
        for _, candidate_failure in small.failures([candidate]):
            if title(candidate_failure) == title(failure):
                last[0] = candidate_failure
                return True
        return False

    program = reduced(case.program, fails)
    head = [
        title(failure), last[0].message.replace("\n", " "),
        f"python tests/fuzz/random_glsl.py --seed {job.seed} --first {job.number} --programs {BATCH}",
    ]  # fmt: skip
    name = re.sub(r"\W+", "_", title(failure))[:60]
    path = Path(job.folder, f"{name}_{job.seed}_{job.number}_{case.program.entry.rpartition('_')[2]}.glsl")
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text("".join(f"// {line}\n" for line in head) + Case(program).text, encoding="utf-8")


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--programs", type=int, default=1000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--first", type=int, default=0, metavar="BATCH")
    parser.add_argument("--processes", type=int, default=1)
    parser.add_argument("--targets", default=",".join(TARGETS))
    parser.add_argument("-o", "--output", default="build/random_glsl", help="the folder for failing programs")
    options = parser.parse_args()
    start = time.monotonic()
    targets = tuple(options.targets.split(","))
    numbers = range(options.first, options.first + -(-options.programs // BATCH))
    jobs = [Job(options.seed, number, targets, options.output) for number in numbers]
    count, excused, titles, kinds = 0, Counter[str](), Counter[str](), Counter[str]()
    seconds: dict[str, float] = {}
    os.environ.setdefault("GALLIVM_PERF", "nopt")  # Mesa compiles faster than it would optimise for one drawing
    context = multiprocessing.get_context("spawn")
    with context.Pool(options.processes) as pool:
        for done, outcome in enumerate(pool.imap_unordered(run, jobs), 1):
            count += outcome.programs
            excused += outcome.excused
            seconds = {
                name: seconds.get(name, 0.0) + outcome.seconds.get(name, 0.0) for name in seconds | outcome.seconds
            }
            kinds.update(failure.kind for failure in outcome.failures)
            titles.update(title(failure) for failure in outcome.failures)
            if done % 25 == 0:
                print(
                    f"batch {outcome.job.number}: {count} programs, {dict(kinds)}, {time.monotonic() - start:.0f} s",
                    flush=True,
                )
    for name, number in titles.most_common():
        print(f"{number:6} {name}")
    print("excused: " + ", ".join(f"{number} × {name}" for name, number in excused.most_common()))
    print("seconds of all processes: " + ", ".join(f"{name} {spent:.0f}" for name, spent in seconds.items()))
    print(
        f"{count} programs × {len(targets)} targets ({', '.join(targets)}): {kinds['wrong']} wrong numbers, "
        f"{kinds['invalid']} invalid texts, {kinds['refused']} refusals, {kinds['crash']} crashes, "
        f"{kinds['tool']} faults of the driver or spirv-cross, "
        f"{time.monotonic() - start:.0f} s"
    )
    return 1 if kinds.keys() - {"tool"} else 0


if __name__ == "__main__":
    sys.exit(main())
