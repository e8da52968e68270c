"""Ranges of calls of builtins: their domains, and their results."""

from __future__ import annotations

from collections.abc import Callable

from sssgen.ir import nodes as ir
from sssgen.ir.formats import FLOAT32
from sssgen.ir.intervals import ANY, INF, Range, clip, rounded, widened
from sssgen.ir.intrinsics import BUILTINS
from sssgen.ir.types import kind_of
from sssgen.passes.ranges import builtin_ranges
from sssgen.passes.ranges.range_state import Known
from sssgen.passes.ranges.scalar_parts import hull_of, scalars
from sssgen.passes.ranges.sites import TEXEL
from sssgen.passes.ranges.vector_ranges import Value

FETCHES = frozenset(name for name, row in BUILTINS.items() if row.range == "whole: texels(x)")
"""What gives texels."""


class Builtins(Known):
    """The builtins' part of the analysis."""

    def builtin(self, node: ir.Intrinsic, args: tuple[Value, ...], as_texel: bool) -> Value:
        row = BUILTINS[node.name]
        args, needed = self.guarded(node, args)
        size = scalars(node.type)
        parts, length = builtin_ranges.result(node.name, args, size, self.format)
        if kind_of(node.type) != "float" and (not row.range or node.name in FETCHES):
            return self.unknown(node.type)
        if node.name in FETCHES and args[0].texel is not None and not args[0].texel.finite and as_texel:
            limits = (args[0].texel.low, args[0].texel.high)
            self.note(node, "texel", False, TEXEL, (ANY,), limits)
        if kind_of(node.type) == "float" and not row.range.startswith("whole:") and row.ulp > 0.0:
            scale = self.format.epsilon / FLOAT32.epsilon
            exact = row.kind == "alu"
            absolute = 0.0 if exact else min(row.absolute * min(scale, 4.0), 1e-2)
            relative = row.ulp * self.format.epsilon if not exact else 0.0
            parts = [self.kept(widened(part, min(relative, 0.05), absolute), part, node.name) for part in parts]
        if needed and node.name == "pow":  # its guard's own limit
            top = 2.0**self.format.exponent
            parts = [Range(min(part.low, 0.99 * top), min(part.high, 1.01 * top)) for part in parts]
        elif needed and node.name not in ("mod", "fmod"):  # what a guard lets through is finite, but for a quotient
            parts = [clip(part, -self.format.largest, self.format.largest) for part in parts]
        return self.computed(node, parts, self.builtin_numbers(node, args, size), length)

    def kept(self, wide: Range, part: Range, name: str) -> Range:
        """What no error takes away: the values at 0 and 1 are exact on every device, and roots never below 0."""
        if name in ("log", "log2"):
            return Range(
                max(wide.low, 0.0) if part.low >= 0.0 else wide.low,
                min(wide.high, 0.0) if part.high <= 0.0 else wide.high,
            )
        if name in ("exp", "exp2") and part.high <= 1.0:
            wide = Range(wide.low, min(wide.high, 1.0), wide.gap)
        if name in ("sqrt", "exp", "exp2", "pow", "inversesqrt", "length", "distance") and wide.low < 0.0 <= part.low:
            return Range(0.0, wide.high, wide.gap)
        return wide

    def builtin_numbers(self, node: ir.Intrinsic, args: tuple[Value, ...], size: int) -> list[int]:
        whole = BUILTINS[node.name].range.startswith("whole:") or not args
        if node.name == "dot" and args[0].numbers == args[1].numbers:
            return [self.numbers.of("squares", *args[0].numbers)]
        if node.name == "length":
            return [self.numbers.of("length", *args[0].numbers)]
        if (
            node.name in FETCHES
            or any(arg.texel is not None for arg in args)
            or BUILTINS[node.name].kind == "derivative"
        ):
            return [self.numbers.fresh() for _ in range(size)]
        if whole:
            flat = tuple([n for arg in args for n in arg.numbers])
            return [self.numbers.of(node.name, part, *flat) for part in range(size)]
        kind = kind_of(node.args[0].type)
        # what facts say of min and max holds for integers too; the others may wrap
        name = node.name if kind == "float" or node.name in ("min", "max") else f"{node.name} of {kind}"
        return [
            self.numbers.of(name, *[arg.numbers[index if len(arg.numbers) > 1 else 0] for arg in args])
            for index in range(size)
        ]

    def guarded(self, node: ir.Intrinsic, args: tuple[Value, ...]) -> tuple[tuple[Value, ...], bool]:
        """Checks a builtin's domain; the arguments as its guard leaves them, and whether it needs one."""
        row = BUILTINS[node.name]
        guards = [guard for guard in row.guards if guard.replaces != "y" or len(args) > 1]  # atan may have one
        if not guards or kind_of(node.type) not in ("float", ""):
            return args, False
        whole = row.range.startswith("whole:")
        seen = [arg.length if whole else hull_of(arg.parts) for arg in args]
        needed = None
        lanes = range(1 if whole else max(len(arg.parts) for arg in args))
        rows = [seen if whole else [arg.parts[at if len(arg.parts) > 1 else 0] for arg in args] for at in lanes]
        ordered = self.ordering(args)
        for guard in guards:
            checks = [
                builtin_ranges.evaluated(guard.needs, self.format, [self.flushed(part) for part in one], ordered)
                for one in rows
            ]
            if not all(checks):
                needed = guard
                break
        self.note(node, node.name, needed is None, needed or guards[-1], tuple(seen))
        return (args, False) if needed is None else (self.as_guarded(node.name, args), True)

    def flushed(self, part: Range) -> Range:
        """A range as a GPU may have it, which makes subnormal numbers 0."""
        return rounded(part, self.format) if 0.0 < part.gap < self.format.tiny else part

    def as_guarded(self, name: str, args: tuple[Value, ...]) -> tuple[Value, ...]:
        if name in ("mod", "fmod"):
            divisor = args[1]
            parts = tuple([Range(part.low, part.high, max(part.gap, self.format.divisor)) for part in divisor.parts])
            return (args[0], divisor._replace(parts=parts))
        limits = {
            "exp": (-INF, 0.69 * self.format.exponent), "exp2": (-INF, self.format.exponent),
            "sinh": (-0.6 * self.format.exponent, 0.6 * self.format.exponent),
            "cosh": (-0.6 * self.format.exponent, 0.6 * self.format.exponent),
            "acosh": (1.0, 0.5 * self.format.largest**0.5),
        }.get(name)  # fmt: skip
        if limits is None:
            return args
        return (args[0]._replace(parts=tuple([clip(part, *limits) for part in args[0].parts])), *args[1:])

    def ordering(self, args: tuple[Value, ...]) -> Callable[[Range, Range], bool]:
        """Whether the second argument is known to be no larger than the third, for clamp."""

        def ordered(_y: Range, _z: Range) -> bool:
            facts = self.state.facts
            pairs = zip(args[1].numbers, args[2].numbers, strict=False)
            return all(facts.bound(self.numbers, m, n) <= 0.0 for m, n in pairs)

        return ordered
