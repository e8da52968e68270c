"""Ranges of calls of builtins: their domains, and their results."""

from __future__ import annotations

from collections.abc import Sequence

from sssgen.ir import nodes as ir
from sssgen.ir.formats import FLOAT32
from sssgen.ir.intervals import ANY, Range, rounded, widened
from sssgen.ir.intrinsics import BUILTINS, Builtin, Guard
from sssgen.ir.types import Matrix, kind_of
from sssgen.ir.vector_ranges import Value
from sssgen.passes.ranges.range_state import AnalysisState
from sssgen.passes.ranges.scalar_parts import hull_of, scalars
from sssgen.passes.ranges.sites import TEXEL, subnormal


class CallRanges(AnalysisState):
    """The part of the analysis for calls of builtins."""

    def builtin(self, node: ir.Intrinsic, args: tuple[Value, ...], as_texel: bool) -> Value:
        row = BUILTINS[node.name]
        kind = kind_of(node.type)
        args, guard = self.guard_arguments(node, row, args)
        if kind != "float" and (row.unbounded or row.reads_texels):
            return self.unknown(node.type)
        if row.reads_texels and args[0].texel is not None and not args[0].texel.finite and as_texel:
            limits = (args[0].texel.low, args[0].texel.high)
            self.note(node, "texel", True, TEXEL, (ANY,), limits)
        size = scalars(node.type)
        parts, length = self.result(row, args, size)
        if kind == "float" and row.componentwise and row.ulp > 0.0:
            parts = [self.with_error(row, part) for part in parts]
        if guard is not None:
            parts = [guard.result(self.format, part) for part in parts]
        return self.computed(node, parts, self.builtin_numbers(node, row, args, size), length)

    def result(self, row: Builtin, args: tuple[Value, ...], size: int) -> tuple[list[Range], Range]:
        """The ranges of the components of a builtin's result, not yet rounded, and of its length."""
        assert row.range is not None
        if not row.componentwise:
            parts, length = row.range(self.format, *args)
            return parts[:size], length
        return [row.range(self.format, *_component(args, index)) for index in range(size)], ANY

    def with_error(self, row: Builtin, exact: Range) -> Range:
        """A component of the result with the error that the table grants; no error crosses the row's exact bounds."""
        wide = exact
        if row.kind != "alu":  # of an alu builtin the range function has the rounding errors
            scale = self.format.epsilon / FLOAT32.epsilon
            wide = widened(exact, min(row.ulp * self.format.epsilon, 0.05), min(row.absolute * min(scale, 4.0), 1e-2))
        low, high = row.exact_bounds
        low = max(wide.low, low) if exact.low >= low else wide.low
        high = min(wide.high, high) if exact.high <= high else wide.high
        return Range(low, high, wide.gap)

    def builtin_numbers(self, node: ir.Intrinsic, row: Builtin, args: tuple[Value, ...], size: int) -> list[int]:
        if row.relation == "squares" and args[0].numbers == args[1].numbers:
            return [self.numbers.of("squares", *args[0].numbers)]
        if row.relation == "length":
            return [self.numbers.of("length", *args[0].numbers)]
        if row.reads_texels or row.kind == "derivative" or any(arg.texel is not None for arg in args):
            return [self.numbers.fresh() for _ in range(size)]
        if not row.componentwise or not args:
            flat = tuple([number for arg in args for number in arg.numbers])
            return [self.numbers.of(node.name, part, *flat) for part in range(size)]
        kind = kind_of(node.args[0].type)
        # the facts about min and max hold for integers too; the others may wrap
        name = node.name if kind == "float" or row.relation in ("min", "max") else f"{node.name} of {kind}"
        return [
            self.numbers.of(name, *[arg.numbers[index if len(arg.numbers) > 1 else 0] for arg in args])
            for index in range(size)
        ]

    def guard_arguments(
        self, node: ir.Intrinsic, row: Builtin, args: tuple[Value, ...]
    ) -> tuple[tuple[Value, ...], Guard | None]:
        """Checks a builtin's domain: the arguments after the guard that it needs, and that guard, if any."""
        guards = [guard for guard in row.guards if guard.replaces != "y" or len(args) > 1]  # atan may have one
        if not guards or kind_of(node.type) not in ("float", ""):
            return args, None
        if row.componentwise:
            seen = [hull_of(arg.parts) for arg in args]
            rows = [_component(args, index) for index in range(max(len(arg.parts) for arg in args))]
        else:
            rows = [[arg.length for arg in args]]
            seen = [
                hull_of(arg.parts) if isinstance(expr.type, Matrix) else arg.length
                for expr, arg in zip(node.args, args, strict=True)
            ]
        normal = [[self.flush(part) for part in ranges] for ranges in rows]
        failures = tuple([
            guard if not self.is_safe(guard, rows, args) else subnormal(guard)
            for guard in guards
            if not self.is_safe(guard, normal, args)
        ])  # fmt: skip
        needed = failures[0] if failures else None
        self.note(node, node.name, failures, needed or guards[-1], tuple(seen))
        if self.unguarded and needed is not None and needed.succeeds is not None:
            return (self.succeeded(args[0], needed.succeeds(self.format, args[0].length)), *args[1:]), None
        if needed is None or needed.argument is None:
            return args, needed
        index = "xyz".index(needed.replaces)
        parts = tuple([needed.argument(self.format, part) for part in args[index].parts])
        return (*args[:index], args[index]._replace(parts=parts), *args[index + 1 :]), needed

    def succeeded(self, value: Value, length: Range) -> Value:
        """An argument for which a call did not fail; what follows knows that, so that each cause is reported once."""
        self.state.facts.learn(self.numbers, self.numbers.of("length", *value.numbers), length)
        return value._replace(length=length)

    def is_safe(self, guard: Guard, rows: Sequence[Sequence[Range]], args: tuple[Value, ...]) -> bool:
        """Whether a guard is superfluous for all rows of arguments."""
        if guard.safe is None:
            return False
        if all(guard.safe(self.format, *ranges) for ranges in rows):
            return True
        return guard.ordered is not None and self.in_order(*[args[index] for index in guard.ordered])

    def flush(self, part: Range) -> Range:
        """A range on a GPU that makes subnormal numbers 0."""
        return rounded(part, self.format) if 0.0 < part.gap < self.format.tiny else part

    def in_order(self, x: Value, y: Value) -> bool:
        """Whether x is known to be no larger than y."""
        pairs = zip(x.numbers, y.numbers, strict=False)
        return all(self.state.facts.bound(self.numbers, m, n) <= 0.0 for m, n in pairs)


def _component(args: Sequence[Value], index: int) -> list[Range]:
    """One component of each argument; a scalar counts for all components, a texture has none."""
    return [arg.parts[index if len(arg.parts) > 1 else 0] if arg.parts else ANY for arg in args]
