"""Measures the cost of each pass on the examples, as a ratio to one walk of the same module that changes nothing.

python benchmarks/passes.py [TARGET]
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from copy import copy
from pathlib import Path
from time import thread_time

from sssgen.ir.nodes import Module
from sssgen.ir.transform import rewrite_module
from sssgen.ir.walk import all_expressions
from sssgen.material.material_loading import load_material
from sssgen.pipeline.pass_list import MATERIAL, TARGET, run
from sssgen.pipeline.state import State
from sssgen.targets import registry

EXAMPLES = Path(__file__).parent.parent / "examples"


def best(work: Callable[[], object], times: int = 20) -> float:
    """The shortest of several runs, in milliseconds."""
    shortest = float("inf")
    for _ in range(times):
        start = thread_time()
        work()
        shortest = min(shortest, thread_time() - start)
    return shortest * 1e3


def main(target: str = "wgsl") -> None:
    passes = [*MATERIAL, *TARGET]
    print(f"{'':24}{'nodes':>7}{'walk ms':>9}" + "".join(f"{record.name[:11]:>12}" for record in passes))
    for path in sorted(path for path in EXAMPLES.glob("*/*.toml") if path.stem == path.parent.name):
        state = State(Module(), "shader", "auto", registry.load(target), material=load_material(path))
        cells = []
        for record in passes:
            skipped = record.when is not None and not record.when.holds(state)
            cells.append(0.0 if skipped else best(lambda record=record, state=state: run([record], copy(state))))
            run([record], state)
        nodes = sum(1 for function in state.module.functions for _ in all_expressions(function.body or ()))
        walk = best(lambda state=state: rewrite_module(state.module, lambda node: node))
        print(f"{path.stem:24}{nodes:7}{walk:9.2f}" + "".join(f"{cell / walk:11.1f}x" for cell in cells))


if __name__ == "__main__":
    main(*sys.argv[1:])
