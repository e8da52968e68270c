"""Measures `sssgen transpile` on whole shaders of engines: translation, compilers, verification, CPU time.

    python benchmarks/bench_engine_shaders.py FOLDER [--verify SHARE] [--jobs 2] [--again]

FOLDER has a folder of NAME.vert and NAME.frag for each engine, as `engine_corpus/collect_shaders.py` writes them. Of
stages whose tokens after the preprocessor are equal, one counts. For each engine the table has the stages, how many are
translated to WGSL, and how many naga and Tint take; how many agree: main() was run by `--verify` on `--samples` inputs,
and no translation deviates by more than 1e-5; and the seconds of CPU for 80 kB of source. `--verify` is the share of
the stages that are run, evenly spaced, or 0. Results are kept in FOLDER/results.json: a second run continues, and with
`--again` repeats what failed. The most frequent problems follow, with a file each.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections import Counter
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from engine_stages import digest, translation, verification
from public_code import Pool, without_names
from sssgen.support.worker_process import LostError

SECONDS = 240.0
"""The time limit of a stage."""
SAMPLES = 64
REASONS = 30
SIZE = 80.0
"""Kilobytes of source, for which the table has the CPU time."""
BATCH = 24
"""The stages after which the results are stored."""


class Stage(NamedTuple):
    """One of the distinct stages."""

    engine: str
    path: Path
    key: str


def distinct(folder: Path, pool: Pool, results: dict[str, Any]) -> list[Stage]:
    """The stages of all engines, without those that have the tokens of an earlier one."""
    paths = sorted(path for path in folder.rglob("*") if path.suffix in (".vert", ".frag"))
    hashes = results.setdefault("hashes", {})
    states = [f"{path.relative_to(folder)} {path.stat().st_mtime_ns}" for path in paths]
    unread = [(state, path) for state, path in zip(states, paths, strict=True) if state not in hashes]
    answers = pool.ask(digest.__name__, [(path,) for _, path in unread])
    hashes |= {state: str(answer) for (state, _), answer in zip(unread, answers, strict=True)}
    stages: dict[str, Stage] = {}
    for state, path in zip(states, paths, strict=True):
        stages.setdefault(hashes[state], Stage(path.relative_to(folder).parts[0], path, hashes[state]))
    return list(stages.values())


def fill(name: str, arguments: Sequence[object], stages: Sequence[Stage], file: Path, inputs: Inputs) -> None:
    """Adds the results of one function for the stages that have none, in batches."""
    known = inputs.results.setdefault(name, {})
    missing = [stage for stage in stages if stage.key not in known or (inputs.again and "problem" in known[stage.key])]
    for start in range(0, len(missing), BATCH):
        part = missing[start : start + BATCH]
        answers = inputs.pool.ask(name, [(stage.path, *arguments) for stage in part])
        for stage, answer in zip(part, answers, strict=True):
            known[stage.key] = {"problem": f"the process {answer}"} if isinstance(answer, LostError) else answer
        file.write_text(json.dumps(inputs.results, indent=1), "utf-8")
        print(f"{name}: {start + len(part)} of {len(missing)}", file=sys.stderr)


class Inputs(NamedTuple):
    """What the steps share."""

    pool: Pool
    results: dict[str, Any]
    again: bool


def spaced(stages: Sequence[Stage], share: float) -> list[Stage]:
    """A share of the stages of each engine, evenly spaced."""
    chosen: list[Stage] = []
    for engine in dict.fromkeys(stage.engine for stage in stages):
        own = [stage for stage in stages if stage.engine == engine]
        chosen += [stage for index, stage in enumerate(own) if int((index + 1) * share) > int(index * share)]
    return chosen


def percent(good: int, count: int) -> str:
    return f"{good} of {count}, {100.0 * good / count:.1f} %" if count else "–"


def rows(stages: Sequence[Stage], results: dict[str, Any]) -> Iterator[str]:
    """The table in Markdown: one row for each engine, and one for all."""
    translations, verifications = results[translation.__name__], results.get(verification.__name__, {})
    yield "| | stages | translated | taken by naga and Tint | run and in agreement | s of CPU for 80 kB |"
    yield "|---|---|---|---|---|---|"
    for engine in [*dict.fromkeys(stage.engine for stage in stages), "all"]:
        own = [stage.key for stage in stages if engine in (stage.engine, "all")]
        done = [translations[key] for key in own if key in translations]
        verified = [verifications[key] for key in own if key in verifications]
        timed = [one for one in done if "seconds" in one]
        speed = SIZE * sum(one["seconds"] for one in timed) / (sum(one["kilobytes"] for one in timed) or 1.0)
        taken, agreeing = (sum("problem" not in one for one in part) for part in (done, verified))
        shares = [percent(part, len(of)) for part, of in ((len(timed), done), (taken, done), (agreeing, verified))]
        yield f"| {' | '.join([engine, str(len(done)), *shares, f'{speed:.2f}'])} |"


def problems(stages: Sequence[Stage], results: dict[str, Any], step: str, count: int) -> Iterator[str]:
    """The most frequent problems of a step, each with a file."""
    known = results.get(step, {})
    failed = [(stage, known[stage.key]["problem"]) for stage in stages if "problem" in known.get(stage.key, {})]
    counted = Counter(without_names(problem) for _, problem in failed)
    yield f"\n{step}: {len(failed)} stages have {len(counted)} problems"
    for reason, times in counted.most_common(count):
        stage, problem = next(pair for pair in failed if without_names(pair[1]) == reason)
        yield f"{times:6}  {reason}\n        {stage.path}: {problem.splitlines()[0][:200]}"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("FOLDER", nargs="?", type=Path, help="without a folder, nothing is measured")
    parser.add_argument("--engine", action="append", default=[])
    parser.add_argument("--verify", type=float, default=0.0, metavar="SHARE")
    parser.add_argument("--samples", type=int, default=SAMPLES)
    parser.add_argument("--share", type=float, default=1.0, help="of the stages that are translated")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--again", action="store_true")
    parser.add_argument("--reasons", type=int, default=REASONS)
    options = parser.parse_args()
    if options.FOLDER is None:
        return
    file = options.FOLDER / "results.json"
    results: dict[str, Any] = json.loads(file.read_text("utf-8")) if file.is_file() else {}
    pool = Pool(options.jobs, "engine_stages", SECONDS)
    try:
        inputs = Inputs(pool, results, options.again)
        stages = [
            stage
            for stage in distinct(options.FOLDER, pool, results)
            if not options.engine or stage.engine in options.engine
        ]
        fill(translation.__name__, (), spaced(stages, options.share), file, inputs)
        if options.verify:
            fill(verification.__name__, (options.samples,), spaced(stages, options.verify), file, inputs)
    finally:
        pool.close()
    for line in rows(stages, results):
        print(line)
    for step in (translation.__name__, verification.__name__):
        for line in problems(stages, results, step, options.reasons):
            print(line)


if __name__ == "__main__":
    main()
