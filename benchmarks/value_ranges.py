"""Measures how the time of the range pass grows with nested calls: chains of functions, a library of noise functions.

python benchmarks/value_ranges.py
"""

from __future__ import annotations

from pathlib import Path
from time import process_time

from sssgen.ir.nodes import Module
from sssgen.lang.loader import load_file, load_text
from sssgen.passes.ranges.range_pass import RangeAnalysis

LEVELS = (8, 15, 30, 60)
"""The numbers of nested functions; the checker allows 64."""
NOISE = Path(__file__).parent / "noise_library.sss"


def chain_of_calls(levels: int) -> str:
    """Functions that each call the previous function twice, with different arguments."""
    functions = ["float f0(float x) { return sqrt(abs(x)) + x * 0.5; }"] + [
        f"float f{level}(float x) {{ float a = f{level - 1}(x * 0.5); float b = f{level - 1}(a + {level}.0);"
        " return x > 0.0 ? a - b : b / (1.0 + a * a); }"
        for level in range(1, levels + 1)
    ]
    return "\n".join(functions)


def measured(module: Module, rounds: int = 3) -> tuple[float, int]:
    """The shortest CPU time to analyse the last function, in seconds, and the number of interpreted functions."""
    shortest, count = float("inf"), 0
    for _ in range(rounds):
        start = process_time()
        analysis = RangeAnalysis(module)
        analysis.root(module.functions[-1].key)
        shortest = min(shortest, process_time() - start)
        count = sum(analysis.interpretations.values())
    return shortest, count


def main() -> None:
    print(f"{'program':16}{'seconds':>9}{'interpretations':>17}{'growth':>9}{'of levels':>11}")
    before: tuple[int, float] | None = None
    for levels in LEVELS:
        seconds, count = measured(load_text(chain_of_calls(levels), f"chain_{levels}.sss"))
        growth = f"{seconds / before[1]:8.1f}x{levels / before[0]:10.1f}x" if before else ""
        print(f"{f'{levels} levels':16}{seconds:9.3f}{count:17}{growth}")
        before = levels, seconds
    seconds, count = measured(load_file(NOISE))
    print(f"{'noise library':16}{seconds:9.3f}{count:17}")


if __name__ == "__main__":
    main()
