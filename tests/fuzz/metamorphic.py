"""Programs whose results are known without an interpreter of their own, on every target; it can be resumed.

    python tests/fuzz/metamorphic.py --programs 20000 --seed 1 --processes 2 [--glsl FOLDER …] [-o build/metamorphic]

- Programs that return their argument (`known_answers`).
- With `--glsl`, functions of the files of these folders with their code rewritten (`ir_rewrites`), such as those of
  LYGIA (github.com/patriciogonzalezvivo/lygia) and the samples of GraphicsFuzz (github.com/google/graphicsfuzz,
  shaders/src/main/glsl/samples). Of each function some programs are mutations of single nodes
  (`qualification/ir_mutations.py`), whose results an interpreter computes.

Batch N of seed S is always the same; there are as many as `--programs` takes. A batch that takes longer than `--limit`
is reported with the program that ran last, and the search goes on. Finished batches are in `done_SEED.jsonl` in the
folder of `-o`, and a second call with the same arguments continues; failing programs are beside it.
"""

from __future__ import annotations

import argparse
import json
import os
import sys
import threading
import time
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

ROOT = Path(__file__).parent.parent.parent
# a script finds the project's own modules: imports follow, which E402 would refuse
sys.path[:0] = [str(ROOT)] * (str(ROOT) not in sys.path)

from glsl_batches import TARGETS  # noqa: E402
from metamorphic_batches import BATCH, Job, Result, files_of  # noqa: E402
from sssgen.support.worker_process import LostError, Process  # noqa: E402

LIMIT = 600.0
"""The seconds of a batch."""
SPARE = 60.0
"""The seconds that a process has for the end of a batch, before it is killed with its back ends."""
MOST = 4
"""How many times as many batches as full ones would take are run: those of files without functions have no programs."""


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


class Search:
    """The batches of one call, which threads take and report."""

    def __init__(self, job: Job, programs: int, done: Path, minutes: float) -> None:
        self.job, self.programs, self.done, self.end = job, programs, done, time.monotonic() + 60.0 * minutes
        self.start = time.monotonic()
        self.results = results_in(done)
        self.running: set[int] = set()
        self.lock = threading.Lock()

    @property
    def count(self) -> int:
        """The programs that were run."""
        return sum(sum(result.programs.values()) for result in self.results.values())

    def next(self) -> Job | None:
        """The next batch; None where enough programs have been run, or run now."""
        with self.lock:
            most = MOST * -(-self.programs // BATCH)
            missing = (number for number in range(most) if number not in self.results and number not in self.running)
            number = next(missing, None)
            enough = self.count + BATCH * len(self.running) >= self.programs
            if enough or number is None or time.monotonic() > self.end:
                return None
            self.running.add(number)
            return self.job._replace(number=number)

    def finish(self, result: Result) -> None:
        """Stores what a batch has shown."""
        with self.lock:
            self.running.discard(result.number)
            self.results[result.number] = result
            with self.done.open("a", encoding="utf-8") as file:
                file.write(json.dumps(result._asdict()) + "\n")
            faults = [name for name in result.failures if is_fault(name)]
            if faults or len(self.results) % 10 == 0:
                seconds = time.monotonic() - self.start
                print(f"{self.count} of {self.programs} programs, {seconds:.0f} s {faults[:3]}", flush=True)

    def run(self) -> None:
        """Runs batches in a process, which is started again where one is lost."""
        process = Process("metamorphic_batches", "", seconds=self.job.limit + SPARE)
        try:
            while (job := self.next()) is not None:
                try:
                    result: Result = process.ask(job)
                except LostError as reason:
                    result = Result(job.number, {}, [f"batch tool lost: the process {reason}"], {})
                self.finish(result)
        finally:
            process.close()


def main(arguments: list[str] | None = None) -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--programs", type=int, default=1000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--processes", type=int, default=1)
    parser.add_argument("--minutes", type=float, default=float("inf"), help="starts no batch after this time")
    parser.add_argument("--limit", type=float, default=LIMIT, help="the seconds of a batch")
    parser.add_argument("--targets", default=",".join(TARGETS))
    parser.add_argument("--glsl", nargs="*", default=[], metavar="FOLDER", help="folders of GLSL to rewrite")
    parser.add_argument("-o", "--output", default="build/metamorphic")
    options = parser.parse_args(arguments)
    os.environ.setdefault("GALLIVM_PERF", "nopt")  # Mesa compiles faster than it would optimise for one drawing
    targets = tuple(options.targets.split(","))
    empty = [folder for folder in options.glsl if not files_of(folder)]
    if empty:
        parser.error(f"no GLSL files in {empty[0]}")
    done = Path(options.output, f"done_{options.seed}.jsonl")
    done.parent.mkdir(parents=True, exist_ok=True)
    job = Job(options.seed, 0, targets, tuple(options.glsl), options.output, options.limit)
    search = Search(job, options.programs, done, options.minutes)
    with ThreadPoolExecutor(options.processes) as pool:
        try:
            for future in [pool.submit(search.run) for _ in range(options.processes)]:
                future.result()
        finally:
            search.end = time.monotonic()  # after an error or Ctrl-C no thread begins another batch
    results = search.results
    lines = summary(results, targets)
    print("\n".join(lines))
    return 1 if any(is_fault(name) for result in results.values() for name in result.failures) else 0


if __name__ == "__main__":
    sys.exit(main())
