"""Measures how much public shader code `sssgen transpile` accepts, and its speed.

    python benchmarks/bench_transpile.py --kind library=FOLDER --kind scenes=FOLDER [--jobs 2] [--json FILE]
    python benchmarks/bench_transpile.py --speed

A file counts if glslang accepts it (see `public_code`). It passes if it can be emitted for every target and every
compiler accepts the result: naga and Tint for WGSL, glslang and DXC for HLSL, glslang for GLSL. The table shows the
share of files that pass, for each kind; the most frequent problems follow, without names and numbers. With `--naga`,
naga's own GLSL front end reads the same files, preprocessed and without the declarations that Vulkan does not accept;
it does not support combined samplers. `--speed` measures the stages on a generated text (see `transpile_speed`). The
public code is not part of this project.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import Any, NamedTuple

from public_code import (
    BATCHED,
    COMPILERS,
    READ,
    Code,
    Pool,
    TargetResult,
    file_errors,
    glslang,
    naga_glsl,
    preprocessed,
    read,
    target_results,
    without_names,
)
from sssgen.support.worker_process import LostError

SECONDS = 60.0
"""The time limit of a file."""
REASONS = 10


class Verdict(NamedTuple):
    """The result of a file that counts."""

    kind: str
    path: Path
    problems: dict[str, str]
    """Target, or `read` → the problem; empty if the file passes."""
    naga: str | None = None
    """The message of naga's own front end, '' if it accepts the file; None if it did not read the file."""


def verdicts_on(
    kind: str, codes: Sequence[Code], folders: Sequence[Path], targets: Sequence[str], pool: Pool
) -> list[Verdict]:
    """The verdict on each file."""
    answers: list[dict[str, TargetResult] | LostError] = pool.ask(
        target_results.__name__, [(code, folders, targets) for code in codes]
    )
    results = [
        {"": TargetResult(None, f"the process {answer}")} if isinstance(answer, LostError) else answer
        for answer in answers
    ]
    sources = [
        result.source
        for by_target in results
        for target, result in by_target.items()
        if result.source is not None and ("glslang", target) in BATCHED
    ]
    messages = iter(glslang(sources))
    verdicts = []
    for code, by_target in zip(codes, results, strict=True):
        problems = {target or READ: result.problem for target, result in by_target.items() if result.problem}
        for target, result in by_target.items():
            if result.source is not None and ("glslang", target) in BATCHED and (message := next(messages)):
                problems.setdefault(target, f"glslang: {message}")
        verdicts.append(Verdict(kind, code.path, problems))
    return verdicts


def with_naga_messages(verdicts: Sequence[Verdict], folders: Sequence[Path], pool: Pool) -> list[Verdict]:
    """The verdicts with the messages of naga's own front end."""
    codes = [read(verdict.path, folders) for verdict in verdicts]
    texts = [(preprocessed(code), code.stage) for code in codes]
    answers = pool.ask(naga_glsl.__name__, texts)
    messages = [f"the process {answer}" if isinstance(answer, LostError) else str(answer) for answer in answers]
    return [verdict._replace(naga=message) for verdict, message in zip(verdicts, messages, strict=True)]


def files_of(folder: Path, endings: Sequence[str]) -> list[Path]:
    """The shaders below a folder, in order."""
    return sorted(path for path in folder.rglob("*") if path.suffix in endings and path.is_file())


def share(verdicts: Sequence[Verdict], target: str = "") -> str:
    """The number and share of files that pass, for all targets or for one."""
    good = sum(
        not verdict.problems if not target else not {READ, target} & verdict.problems.keys() for verdict in verdicts
    )
    return f"{good}/{len(verdicts)} {100.0 * good / max(1, len(verdicts)):.1f} %"


def report(verdicts: Sequence[Verdict], skipped: Counter[str], targets: Sequence[str], reasons: int) -> None:
    """Prints the shares and the most frequent problems."""
    kinds = list(dict.fromkeys(verdict.kind for verdict in verdicts))
    columns = ["passes", *targets, *(["naga's own"] if any(verdict.naga is not None for verdict in verdicts) else [])]
    print(f"{'':14}" + "".join(f"{column:>18}" for column in columns) + "   do not count")
    for kind in [*kinds, *(["all"] if len(kinds) > 1 else [])]:
        chosen = [verdict for verdict in verdicts if kind in (verdict.kind, "all")]
        cells = [share(chosen), *(share(chosen, target) for target in targets)]
        if len(columns) > len(cells):
            good = sum(verdict.naga == "" for verdict in chosen)
            cells.append(f"{good}/{len(chosen)} {100.0 * good / max(1, len(chosen)):.1f} %")
        uncounted = sum(skipped.values()) if kind == "all" else skipped[kind]
        print(f"{kind:14}" + "".join(f"{cell:>18}" for cell in cells) + f"   {uncounted}")
    counted = Counter(
        f"{step}: {without_names(problem)}" for verdict in verdicts for step, problem in verdict.problems.items()
    )
    examples = {
        f"{step}: {without_names(problem)}": verdict
        for verdict in verdicts
        for step, problem in verdict.problems.items()
    }
    print(f"\nThe most frequent of {len(counted)} problems, each with a file")
    for reason, count in counted.most_common(reasons):
        print(f"{count:6}  {reason}\n        {examples[reason].path}")


def as_json(verdicts: Sequence[Verdict], skipped: Counter[str]) -> dict[str, Any]:
    """All results, for JSON."""
    files = [
        {"kind": verdict.kind, "file": str(verdict.path), "problems": verdict.problems}
        | ({} if verdict.naga is None else {"naga": verdict.naga})
        for verdict in verdicts
    ]
    return {"files": files, "do_not_count": dict(skipped)}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("FOLDER", nargs="*", help="a folder of shaders; its name is its kind")
    parser.add_argument("--kind", action="append", default=[], metavar="NAME=FOLDER")
    parser.add_argument("--target", action="append", choices=COMPILERS, help="default: wgsl, hlsl, glsl-330")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--ext", action="append", default=[], help="default: .glsl, .frag, .vert")
    parser.add_argument("--include-dir", action="append", default=[], type=Path)
    parser.add_argument("--every", type=int, default=1, help="read only every Nth file")
    parser.add_argument("--reasons", type=int, default=REASONS)
    parser.add_argument("--naga", action="store_true")
    parser.add_argument("--json", type=Path)
    parser.add_argument("--speed", action="store_true")
    options = parser.parse_args()
    kinds = {Path(folder).name: Path(folder) for folder in options.FOLDER}
    kinds |= {name: Path(folder) for name, _, folder in (option.partition("=") for option in options.kind)}
    targets = options.target or ["wgsl", "hlsl", "glsl-330"]
    if options.speed:
        from transpile_speed import report as speed

        speed(targets)
    if kinds:
        measure(kinds, targets, options)


def measure(kinds: dict[str, Path], targets: Sequence[str], inputs: argparse.Namespace) -> None:
    """Judges all files and prints the results."""
    skipped: Counter[str] = Counter()
    verdicts: list[Verdict] = []
    pool = Pool(inputs.jobs, "public_code", SECONDS)
    try:
        for kind, folder in kinds.items():
            codes = [
                read(path, inputs.include_dir)
                for path in files_of(folder, inputs.ext or [".glsl", ".frag", ".vert"])[:: inputs.every]
            ]
            refusals = file_errors(codes)
            counting = [code for code, refusal in zip(codes, refusals, strict=True) if not refusal]
            skipped[kind] = len(codes) - len(counting)
            result = verdicts_on(kind, counting, inputs.include_dir, targets, pool)
            verdicts += with_naga_messages(result, inputs.include_dir, pool) if inputs.naga else result
            print(f"{kind}: {len(codes)} files", file=sys.stderr)
    finally:
        pool.close()
    report(verdicts, skipped, targets, inputs.reasons)
    if inputs.json is not None:
        inputs.json.write_text(json.dumps(as_json(verdicts, skipped), indent=1), "utf-8")


if __name__ == "__main__":
    main()
