"""How much public shader code `sssgen transpile` accepts, and how fast.

    python benchmarks/bench_transpile.py --kind library=FOLDER --kind scenes=FOLDER [--jobs 2] [--json FILE]
    python benchmarks/bench_transpile.py --speed

A file counts where glslang takes it (see `public_code`). It passes where it comes out in every target and every
compiler takes that: WGSL in naga and Tint, HLSL in glslang and DXC, GLSL in glslang. The table has the shares for each
kind; below it stand the commonest reasons, with names and numbers blanked out. `--naga` asks naga's own front end for
GLSL about the same files, preprocessed and freed from what Vulkan wants of uniforms; it has no combined samplers.
`--speed` times the stages on a text of our own (see `transpile_speed`). The code itself is none of this project's.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections import Counter
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from queue import Queue
from typing import Any, NamedTuple

from public_code import BATCHED, COMPILERS, Code, Made, accepted, blank, glslang, naga_glsl, preprocessed, read

from sssgen.support.worker_process import LostError, Process

SECONDS = 60.0
"""How long one file may take."""
REASONS = 10
READ = "read"
"""The name of the step before any target."""


class Verdict(NamedTuple):
    """What came of a file that counts."""

    kind: str
    path: Path
    problems: dict[str, str]
    """Target, or `read` → what is wrong; empty where it passes."""
    naga: str | None = None
    """What naga's own front end says; None where it was not asked."""


class Pool:
    """Processes that answer for files; one that crashes or hangs costs the answer for one file."""

    def __init__(self, jobs: int) -> None:
        self.free: Queue[Process] = Queue()
        self.all = [Process("public_code", "", seconds=SECONDS) for _ in range(jobs)]
        for one in self.all:
            self.free.put(one)
        self.threads = ThreadPoolExecutor(jobs)

    def ask(self, what: str, inputs: Sequence[tuple[object, ...]]) -> list[Any]:
        """The answers, in order; an item that ended its process has a LostError."""
        return list(self.threads.map(lambda one: self._ask((what, one)), inputs))

    def _ask(self, question: object) -> Any:
        process = self.free.get()
        try:
            return process.ask(question)
        except LostError as lost:
            return lost
        finally:
            self.free.put(process)

    def close(self) -> None:
        """Ends the processes."""
        for one in self.all:
            one.close()
        self.threads.shutdown()


def judged(
    kind: str, codes: Sequence[Code], folders: Sequence[Path], targets: Sequence[str], pool: Pool
) -> list[Verdict]:
    """The verdict on each file."""
    answers: list[dict[str, Made] | LostError] = pool.ask("made", [(code, folders, targets) for code in codes])
    reported = [{"": Made(None, f"the process {one}")} if isinstance(one, LostError) else one for one in answers]
    sources = [
        result.source
        for one in reported
        for target, result in one.items()
        if result.source is not None and ("glslang", target) in BATCHED
    ]
    messages = iter(glslang(sources))
    results = []
    for code, one in zip(codes, reported, strict=True):
        problems = {target or READ: result.problem for target, result in one.items() if result.problem}
        for target, result in one.items():
            if result.source is not None and ("glslang", target) in BATCHED and (message := next(messages)):
                problems.setdefault(target, f"glslang: {message}")
        results.append(Verdict(kind, code.path, problems))
    return results


def asked_naga(verdicts: Sequence[Verdict], folders: Sequence[Path], pool: Pool) -> list[Verdict]:
    """The verdicts with naga's messages for the unchanged files."""
    codes = [read(verdict.path, folders) for verdict in verdicts]
    texts = [(preprocessed(code), code.stage) for code in codes]
    answers = pool.ask(naga_glsl.__name__, texts)
    messages = [f"the process {one}" if isinstance(one, LostError) else str(one) for one in answers]
    return [verdict._replace(naga=one) for verdict, one in zip(verdicts, messages, strict=True)]


def files_of(folder: Path, endings: Sequence[str]) -> list[Path]:
    """The shaders below a folder, in order."""
    return sorted(path for path in folder.rglob("*") if path.suffix in endings and path.is_file())


def share(verdicts: Sequence[Verdict], target: str = "") -> str:
    """How many pass, or pass for one target."""
    good = sum(
        not verdict.problems if not target else not {READ, target} & verdict.problems.keys() for verdict in verdicts
    )
    return f"{good}/{len(verdicts)} {100.0 * good / max(1, len(verdicts)):.1f} %"


def report(verdicts: Sequence[Verdict], skipped: Counter[str], targets: Sequence[str], reasons: int) -> None:
    """Prints the shares and the commonest reasons."""
    kinds = list(dict.fromkeys(verdict.kind for verdict in verdicts))
    columns = ["passes", *targets, *(["naga's own"] if any(one.naga is not None for one in verdicts) else [])]
    print(f"{'':14}" + "".join(f"{column:>18}" for column in columns) + "   do not count")
    for kind in [*kinds, *(["all"] if len(kinds) > 1 else [])]:
        chosen = [one for one in verdicts if kind in (one.kind, "all")]
        cells = [share(chosen), *(share(chosen, target) for target in targets)]
        if len(columns) > len(cells):
            good = sum(one.naga == "" for one in chosen)
            cells.append(f"{good}/{len(chosen)} {100.0 * good / max(1, len(chosen)):.1f} %")
        left = sum(skipped.values()) if kind == "all" else skipped[kind]
        print(f"{kind:14}" + "".join(f"{cell:>18}" for cell in cells) + f"   {left}")
    counted = Counter(f"{step}: {blank(said)}" for one in verdicts for step, said in one.problems.items())
    examples = {f"{step}: {blank(said)}": one for one in verdicts for step, said in one.problems.items()}
    print(f"\nThe commonest of {len(counted)} reasons, and a file for each")
    for reason, count in counted.most_common(reasons):
        print(f"{count:6}  {reason}\n        {examples[reason].path}")


def as_json(verdicts: Sequence[Verdict], skipped: Counter[str]) -> dict[str, Any]:
    """Everything, for programs."""
    files = [
        {"kind": one.kind, "file": str(one.path), "problems": one.problems}
        | ({} if one.naga is None else {"naga": one.naga})
        for one in verdicts
    ]
    return {"files": files, "do_not_count": dict(skipped)}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("FOLDER", nargs="*", help="a kind of its own, called after the folder")
    parser.add_argument("--kind", action="append", default=[], metavar="NAME=FOLDER")
    parser.add_argument("--target", action="append", choices=COMPILERS, help="wgsl, hlsl, glsl-330 where none is named")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--ext", action="append", default=[], help=".glsl, .frag, .vert where none is named")
    parser.add_argument("--include-dir", action="append", default=[], type=Path)
    parser.add_argument("--every", type=int, default=1, help="only each Nth file")
    parser.add_argument("--reasons", type=int, default=REASONS)
    parser.add_argument("--naga", action="store_true")
    parser.add_argument("--json", type=Path)
    parser.add_argument("--speed", action="store_true")
    options = parser.parse_args()
    kinds = {Path(folder).name: Path(folder) for folder in options.FOLDER}
    kinds |= {name: Path(folder) for name, _, folder in (one.partition("=") for one in options.kind)}
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
    pool = Pool(inputs.jobs)
    try:
        for kind, folder in kinds.items():
            codes = [
                read(path, inputs.include_dir)
                for path in files_of(folder, inputs.ext or [".glsl", ".frag", ".vert"])[:: inputs.every]
            ]
            refusals = accepted(codes)
            counting = [code for code, refusal in zip(codes, refusals, strict=True) if not refusal]
            skipped[kind] = len(codes) - len(counting)
            result = judged(kind, counting, inputs.include_dir, targets, pool)
            verdicts += asked_naga(result, inputs.include_dir, pool) if inputs.naga else result
            print(f"{kind}: {len(codes)} files", file=sys.stderr)
    finally:
        pool.close()
    report(verdicts, skipped, targets, inputs.reasons)
    if inputs.json is not None:
        inputs.json.write_text(json.dumps(as_json(verdicts, skipped), indent=1), "utf-8")


if __name__ == "__main__":
    main()
