"""Counts the findings of `sssgen lint` in shaders of engines, by kind, without and with a preset, and its time.

    python benchmarks/bench_lint.py FILE... [--assume threejs] [--repeat 5]

The shaders are not part of this project: take them from a running page (`gl.getShaderSource`, docs/lint.md). The first
row of a file has every operation of every function as a root, as a library of functions has it; the second is a whole
shader; the third has the preset. The time is that of lint over that of reading and checking the same file.
"""

from __future__ import annotations

import argparse
import time
from collections import Counter
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path

from sssgen.analyse.lint.lint_findings import REPORTED, lint
from sssgen.ir.intrinsics import KINDS
from sssgen.lang.plain_glsl import load_glsl
from sssgen.pipeline.programs import plain_module, traced_sites


def counts(path: str, assumed: Sequence[str]) -> Counter[str]:
    """Findings by kind; `operations` are those with a domain that main() reaches."""
    report = lint(path, with_examples=False, kinds=tuple(KINDS), assumed=assumed)
    result: Counter[str] = Counter(finding.kind for finding in report.unproven())
    result["operations"] = len({id(finding.site) for finding in report.findings})
    return result


def library_counts(path: str) -> Counter[str]:
    """The same, where each function may be called with any arguments."""
    module = load_glsl(path).module
    sites, _ = traced_sites(module, called=plain_module(module)[2])
    result: Counter[str] = Counter(guard.kind for site in sites for guard in site.failures)
    result["operations"] = len(sites)
    return result


def seconds(action: Callable[[], object], repeat: int) -> float:
    """The least processor time of several runs."""
    times = []
    for _ in range(repeat):
        start = time.process_time()
        action()
        times.append(time.process_time() - start)
    return min(times)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("files", nargs="+", metavar="FILE")
    parser.add_argument("--assume", default="threejs", metavar="PRESET")
    parser.add_argument("--repeat", type=int, default=5)
    arguments = parser.parse_args()
    print(f"{'file':24} {'from':12} {'operations':>10} {'reported':>8}  {'  '.join(KINDS)}")
    for path in arguments.files:
        rows = (
            ("any function", library_counts(path)),
            ("main()", counts(path, ())),
            (arguments.assume, counts(path, (arguments.assume,))),
        )
        for name, counted in rows:
            reported = sum(counted[kind] for kind in REPORTED)
            numbers = "  ".join([f"{counted[kind]:{len(kind)}}" for kind in KINDS])
            print(f"{Path(path).name:24} {name:12} {counted['operations']:10} {reported:8}  {numbers}")
        reading = seconds(partial(load_glsl, path), arguments.repeat)
        linting = seconds(
            partial(lint, path, with_examples=False, assumed=(arguments.assume,)),
            arguments.repeat,
        )
        print(f"{Path(path).name:24} lint takes {linting / reading:.1f} times as long as reading and checking the file")


if __name__ == "__main__":
    main()
