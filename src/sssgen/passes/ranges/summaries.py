"""Summaries of functions: they bound how often the range pass interprets a function.

A function is interpreted at each call, with the ranges, value numbers and facts there, until it and the program have
used up their interpretations. After that a call reuses the function's summary: the result for ranges that contain the
arguments of several calls, without relations to other values. Its ranges become wider with each call that they do not
contain, up to all numbers. So the time of the pass is linear in the size of the program.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from typing import NamedTuple

from sssgen.ir import nodes as ir
from sssgen.ir.contracts import Assumed
from sssgen.ir.formats import FLOAT32, Format
from sssgen.ir.intervals import ANY, Range, clip
from sssgen.ir.vector_ranges import Value
from sssgen.passes.ranges.loop_ranges import LoopRanges
from sssgen.passes.ranges.range_state import State
from sssgen.passes.ranges.scalar_parts import innermost, scalar_kinds

OWN_INTERPRETATIONS = 8
"""How often each function is interpreted in any case."""
SHARED_INTERPRETATIONS = 1000
"""How many further interpretations all functions share, so that small programs have no summaries."""
WIDENINGS = 8
"""How often the ranges of a summary are widened before they are all numbers."""

Result = tuple[Value | None, list[Value]]
"""What a call results in: its value, and the parameters' values at its end."""


class Summary(NamedTuple):
    """A function interpreted for all calls whose arguments lie in certain ranges."""

    args: list[Value]
    result: Result
    widenings: int

    def covers(self, args: Sequence[Value]) -> bool:
        return all(
            arg.length.within(own.length) and all(a.within(b) for a, b in zip(arg.parts, own.parts, strict=True))
            for arg, own in zip(args, self.args, strict=True)
        )


class CallSummaries(LoopRanges):
    """The part of the analysis for calls of functions."""

    def __init__(
        self, module: ir.Module, format: Format = FLOAT32, chained: bool = True, assumed: Assumed | None = None,
        unguarded: bool = False,
    ) -> None:  # fmt: skip
        self.interpretations: Counter[str] = Counter()
        """A function's key → how often it was interpreted."""
        self.shared = SHARED_INTERPRETATIONS
        self.summaries: dict[object, Summary] = {}
        super().__init__(module, format, chained, assumed, unguarded)

    def enter(self, function: ir.Function, args: Sequence[Value]) -> Result:
        """The result of a call."""
        if self.interpretations[function.key] < OWN_INTERPRETATIONS:
            return self.interpret(function, args)
        if self.shared > 0:
            self.shared -= 1
            return self.interpret(function, args)
        result, ends = self.summary(function, args).result
        for name in self.changed.get(function.key, frozenset()) & self.state.env.keys():
            self.state.env[name] = self.unknown(innermost(self.variables[name[1:]].type))
        return None if result is None else self.without_relations(result), [self.without_relations(end) for end in ends]

    def summary(self, function: ir.Function, args: Sequence[Value]) -> Summary:
        """A function's summary, widened if it does not cover the arguments yet."""
        key = function.key, *[arg.texel for arg in args]
        summary = self.summaries.get(key)
        if summary is not None and summary.covers(args):
            return summary
        widenings = 0 if summary is None else summary.widenings + 1
        if summary is not None:
            args = [
                self.wider_value(scalar_kinds(param.type), old, arg, widenings) if arg.parts else arg
                for param, old, arg in zip(function.params, summary.args, args, strict=True)
            ]
        args = [self.without_relations(arg) for arg in args]
        outer = self.state
        self.state = State({}, self.assumed_facts.copy())
        result = self.interpret(function, args)
        self.state = outer
        self.summaries[key] = Summary(args, result, widenings)
        return self.summaries[key]

    def without_relations(self, value: Value) -> Value:
        """A value of the same ranges, of which no relation to other values is summary."""
        return value._replace(numbers=tuple([self.numbers.fresh() for _ in value.parts]))

    def wider_value(self, kinds: Sequence[str], old: Value, new: Value, widenings: int) -> Value:
        parts = [
            self.wider_range(a, b, self.limits(kind), widenings)
            for kind, a, b in zip(kinds, old.parts, new.parts, strict=True)
        ]
        return Value(tuple(parts), (), self.wider_range(old.length, new.length, ANY, widenings))

    def wider_range(self, old: Range, new: Range, limits: Range, widenings: int) -> Range:
        """A range that contains both, within the limits if both are."""
        wide = limits if widenings >= WIDENINGS else clip(self.wider(old, new, widenings), limits.low, limits.high)
        return wide.joined(old).joined(new)

    def interpret(self, function: ir.Function, args: Sequence[Value]) -> Result:
        """Interprets a function's body."""
        raise NotImplementedError
