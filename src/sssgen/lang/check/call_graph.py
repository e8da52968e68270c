"""The order of a file's functions by their calls: recursion, depth, and callees before callers."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping

from sssgen.ir import nodes as ir
from sssgen.ir.walk import callees
from sssgen.support.diagnostics import Reporter

MAX_CALL_DEPTH = 64
"""How deep calls may nest: shader compilers inline them all."""


Calls = Mapping[str, list[str]]
"""The keys of the functions that each function calls, by its key."""


def calls_in(functions: Mapping[str, ir.Function]) -> Calls:
    return {key: callees(function) for key, function in functions.items()}


def report_recursion(functions: Mapping[str, ir.Function], calls: Calls, reporter: Reporter) -> None:
    for cycle in _cycles(calls):
        names = " → ".join(key.split("(")[0] for key in cycle)
        message = f"recursion is not possible in a shader: {names}"
        reporter.error(functions[cycle[0]].span, message, "rewrite it as a loop")


def report_deep_calls(functions: Mapping[str, ir.Function], calls: Calls, reporter: Reporter) -> None:
    """Reports the first function whose calls nest too deep. Every function comes after its callees."""
    depth: dict[str, int] = {}
    for key, function in functions.items():
        depth[key] = 1 + max([depth.get(callee, 0) for callee in calls[key]], default=0)
        if depth[key] > MAX_CALL_DEPTH:
            message = f"{function.name} has calls that nest more than {MAX_CALL_DEPTH} deep"
            reporter.error(function.span, message, "merge some of the functions")
            return


def callees_first(
    functions: dict[str, ir.Function], calls: Calls, define: Callable[[ir.Function], ir.Function]
) -> dict[str, ir.Function]:
    """The functions with a body, each after its callees and otherwise in their order. They must not be recursive.

    `define` gives a body to a function that is called and has none.
    """
    for key in dict.fromkeys(callee for called in calls.values() for callee in called):
        if functions[key].body is None:
            functions[key] = define(functions[key])
    ordered: dict[str, ir.Function] = {}
    for start in functions:
        pending = [start]
        while pending:
            key = pending[-1]
            function = functions[key]
            missing = [callee for callee in calls[key] if callee not in ordered]
            if not missing:
                pending.pop()
                if function.body is not None:
                    ordered[key] = function
            pending += missing
    return ordered


def _cycles(calls: Calls) -> Iterator[list[str]]:
    """The cycles of calls, each as its keys, the first repeated at the end. Iterative, as call chains may be long."""
    done: set[str] = set()
    for start in calls:
        path: dict[str, None] = {}
        pending: list[Iterator[str]] = [iter((start,))]
        while pending:
            key = next(pending[-1], None)
            if key is None:
                pending.pop()
                if path:
                    done.add(path.popitem()[0])
            elif key in path:
                along = list(path)
                yield [*along[along.index(key) :], key]
            elif key in calls and key not in done:
                path[key] = None
                pending.append(iter(calls[key]))
