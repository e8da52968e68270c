"""Programs whose results are known without an interpreter of their own, on every target; it can be resumed.

    python tests/fuzz/metamorphic.py --programs 20000 --seed 1 --processes 2 [--glsl FOLDER …] [-o build/metamorphic]

- Programs that return their argument (`known_answers`).
- With `--glsl`, functions of the files of these folders with their code rewritten (`ir_rewrites`), such as those of
  LYGIA (github.com/patriciogonzalezvivo/lygia) and the samples of GraphicsFuzz (github.com/google/graphicsfuzz,
  shaders/src/main/glsl/samples). Of each function some programs are mutations of single nodes
  (`qualification/ir_mutations.py`), whose results an interpreter computes.

Batch N of seed S is always the same. Finished batches are in `done_SEED.jsonl` in the folder of `-o`, and a second call
with the same arguments continues; failing programs are beside it.
"""

from __future__ import annotations

import argparse
import json
import multiprocessing
import os
import re
import sys
import time
from collections import Counter
from pathlib import Path
from random import Random
from typing import Any, NamedTuple

ROOT = Path(__file__).parent.parent.parent
# a script finds the project's own modules: imports follow, which E402 would refuse
sys.path[:0] = [str(ROOT)] * (str(ROOT) not in sys.path)

from glsl_batches import TARGETS, Failure  # noqa: E402
from metamorphic_bases import Base, base_from, mutated_case, rewritten_case, same_case  # noqa: E402
from metamorphic_cases import KnownCase, MetamorphicRunner, known_case  # noqa: E402
from sssgen.support.diagnostics import SssgenError  # noqa: E402

BATCH = 32
"""The programs in one text."""
MUTATIONS = 0.1
"""The share of mutations among the programs of a function."""
SHARE_KNOWN = 0.4
"""The share of batches of known answers where there are folders."""
ENDINGS = (".glsl", ".frag", ".fs")
PICKS = 20
"""How many files are tried for a function."""


class Job(NamedTuple):
    """One batch."""

    seed: int
    number: int
    targets: tuple[str, ...]
    folders: tuple[str, ...]
    output: str


class Result(NamedTuple):
    """What a batch has shown; it is stored as JSON."""

    number: int
    programs: dict[str, int]
    """By kind."""
    failures: list[str]
    """Their titles."""
    seconds: dict[str, float]


_runner: MetamorphicRunner | None = None
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


def run(job: Job) -> Result:
    """Runs a batch in this process, whose back ends stay."""
    global _runner
    if _runner is None:
        sys.setrecursionlimit(30_000)
        _runner = MetamorphicRunner(job.targets)
    _runner.seconds.clear()
    titles: list[str] = []
    try:
        cases = _runner.timed("generate", batch, job.seed, job.number, job.folders)
    except SssgenError as error:  # a rewrite that the printer of GLSL refuses
        return Result(job.number, {}, [f"generate refused {error.diagnostics[0].message}"], dict(_runner.seconds))
    except Exception as error:
        return Result(job.number, {}, [f"generate crash {type(error).__name__}: {error}"], dict(_runner.seconds))
    failures = _runner.confirmed(cases)
    wrong_bases = {failure.target for case, failure in failures if case.kind == "base"}
    for case, failure in failures:
        inherited = case.kind == "rewrite" and failure.target in wrong_bases and failure.kind == "wrong"
        name = f"base {title(case, failure)}" if inherited else title(case, failure)
        titles.append(name)
        if job.output and not inherited:
            write(job, case, failure, name)
    counts = Counter(case.kind for case in cases)
    return Result(job.number, dict(counts), titles, {name: round(spent, 2) for name, spent in _runner.seconds.items()})


def write(job: Job, case: KnownCase, failure: Failure, name: str) -> None:
    """Writes a failing program."""
    path = Path(
        job.output, f"{re.sub(r'[^A-Za-z0-9]+', '_', name)[:60]}_{job.seed}_{job.number}_{case.program.entry}.glsl"
    )
    path.parent.mkdir(parents=True, exist_ok=True)
    lines = [name, case.origin, *failure.message.split("\n"), f"batch {job.number} of seed {job.seed}"]
    path.write_text("".join(f"// {line}\n" for line in lines) + _runner_head() + case.text, encoding="utf-8")


def _runner_head() -> str:
    return _runner.head if _runner is not None else ""


def is_fault(name: str) -> bool:
    """Whether a title is that of a fault of sssgen: not one of a driver or tool, of a base as it is, or of an invalid
    mutation."""
    if name.startswith("front end refused mutation"):  # such as a constant index outside of an array
        return False
    return " tool " not in name and not name.startswith("base ") and " base" not in name


def results_in(path: Path) -> dict[int, Result]:
    """The finished batches of a run, by their number."""
    lines = path.read_text("utf-8").splitlines() if path.is_file() else []
    results = [Result(**json.loads(line)) for line in lines]
    return {result.number: result for result in results}


def summary(results: dict[int, Result], targets: tuple[str, ...]) -> list[str]:
    """The report of a run."""
    programs: Counter[str] = Counter()
    titles: Counter[str] = Counter()
    seconds: Counter[str] = Counter()
    for result in results.values():
        programs.update(result.programs)
        titles.update(result.failures)
        seconds.update(result.seconds)
    lines = [f"{count:6} {name}" for name, count in titles.most_common()]
    kinds = ", ".join(f"{count} × {kind}" for kind, count in programs.most_common())
    faults = sum(count for name, count in titles.items() if is_fault(name))
    lines.append("seconds: " + ", ".join(f"{name} {spent:.0f}" for name, spent in seconds.most_common()))
    lines.append(
        f"{programs.total()} programs ({kinds}) × {len(targets)} targets ({', '.join(targets)}): {faults} faults"
    )
    return lines


def main(arguments: list[str] | None = None) -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--programs", type=int, default=1000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--processes", type=int, default=1)
    parser.add_argument("--minutes", type=float, default=float("inf"), help="starts no batch after this time")
    parser.add_argument("--targets", default=",".join(TARGETS))
    parser.add_argument("--glsl", nargs="*", default=[], metavar="FOLDER", help="folders of GLSL to rewrite")
    parser.add_argument("-o", "--output", default="build/metamorphic")
    options = parser.parse_args(arguments)
    start = time.monotonic()
    os.environ.setdefault("GALLIVM_PERF", "nopt")  # Mesa compiles faster than it would optimise for one drawing
    targets = tuple(options.targets.split(","))
    done = Path(options.output, f"done_{options.seed}.jsonl")
    done.parent.mkdir(parents=True, exist_ok=True)
    results = results_in(done)
    count = -(-options.programs // BATCH)
    jobs = [
        Job(options.seed, number, targets, tuple(options.glsl), options.output)
        for number in range(count)
        if number not in results
    ]
    context: Any = multiprocessing.get_context("spawn")
    with context.Pool(options.processes) as pool, done.open("a", encoding="utf-8") as file:
        for result in pool.imap_unordered(run, jobs):
            results[result.number] = result
            file.write(json.dumps(result._asdict()) + "\n")
            file.flush()
            faults = [name for name in result.failures if is_fault(name)]
            if faults or len(results) % 10 == 0:
                print(f"{len(results)} of {count} batches, {time.monotonic() - start:.0f} s {faults[:3]}", flush=True)
            if time.monotonic() - start > 60.0 * options.minutes:
                pool.terminate()
                break
    lines = summary(results, targets)
    print("\n".join(lines))
    return 1 if any(is_fault(name) for result in results.values() for name in result.failures) else 0


if __name__ == "__main__":
    sys.exit(main())
