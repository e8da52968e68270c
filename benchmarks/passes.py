"""What each pass costs on the examples, as a ratio to walking the same module once and changing nothing.

python benchmarks/passes.py
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from time import perf_counter

from sssgen.passes.inline import inline

from sssgen.ir.nodes import Module
from sssgen.ir.transform import rewrite_module
from sssgen.ir.walk import all_expressions
from sssgen.material.material_loading import load_material
from sssgen.passes.fold import fold
from sssgen.passes.hoist import hoist
from sssgen.passes.names import rename
from sssgen.passes.prune import prune
from sssgen.passes.uniforms_to_parameters import uniforms_to_parameters
from sssgen.pipeline import compiler

EXAMPLES = Path(__file__).parent.parent / "examples"


def best(run: Callable[[], object], times: int = 50) -> float:
    """The shortest of several runs, in milliseconds."""
    found = float("inf")
    for _ in range(times):
        start = perf_counter()
        run()
        found = min(found, perf_counter() - start)
    return found * 1e3


def linked_module(path: Path) -> tuple[Module, list[str]]:
    """A material's module as the compiler hands it to `fold`, and the entries it hands to `prune`."""
    seen: dict[str, tuple[Module, list[str]]] = {}
    real_fold, real_prune = compiler.fold, compiler.prune
    modules: list[Module] = []

    def folding(module: Module, *args: object) -> Module:
        modules.append(module)
        return real_fold(module, *args)  # type: ignore[arg-type]

    def pruning(module: Module, roots: list[str]) -> Module:
        seen.setdefault("first", (modules[0], list(roots)))
        return real_prune(module, roots)

    compiler.fold, compiler.prune = folding, pruning  # type: ignore[assignment]
    try:
        compiler.compile(load_material(path), "glsl-330")
    finally:
        compiler.fold, compiler.prune = real_fold, real_prune
    return seen["first"]


def main() -> None:
    passes = ("fold", "prune", "hoist", "inline", "parameters", "names")
    print(f"{'':24}{'nodes':>7}{'walk ms':>9}" + "".join(f"{name:>12}" for name in passes))
    for path in sorted(path for path in EXAMPLES.glob("*/*.toml") if path.stem == path.parent.name):
        linked, roots = linked_module(path)
        module = prune(fold(linked), roots)
        nodes = sum(1 for function in module.functions for _ in all_expressions(function.body or ()))
        walk = best(lambda module=module: rewrite_module(module, lambda node: node))
        runs: tuple[Callable[[], object], ...] = (
            lambda module=module: fold(module),
            lambda module=module, roots=roots: prune(module, roots),
            lambda module=module, roots=roots: hoist(module, roots),
            lambda module=module: inline(module, lambda function: True),
            lambda module=module: uniforms_to_parameters(module),
            lambda module=module: rename(module, {"sample"}, lambda name: f"_{name}", True),
        )
        ratios = "".join(f"{best(run) / walk:11.1f}x" for run in runs)
        print(f"{path.stem:24}{nodes:7}{walk:9.2f}{ratios}")


if __name__ == "__main__":
    main()
