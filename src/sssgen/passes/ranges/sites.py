"""The operations of a program that may go wrong, and what the analysis found about each."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from typing import NamedTuple

from sssgen.ir import nodes as ir
from sssgen.ir.intervals import Range
from sssgen.ir.intrinsics import NONZERO, Guard
from sssgen.ir.walk import operands
from sssgen.passes.ranges.guard_report import GuardReport
from sssgen.support.paths import display_name

OVERFLOW = Guard(
    None, "overflow", "a number too large for its format", "clamp(x, -LARGEST, LARGEST)", "result", function="bounded"
)
"""For any sum or product; the guards of builtins are in the intrinsic table."""
TEXEL = Guard(
    None,
    "range",
    "a texel of a float texture that is no number",
    "mix(clamp(x, LOW, HIGH), genF(0.0), isnan(x))",
    "result",
    scalar="isnan(x) ? 0.0 : clamp(x, LOW, HIGH)",
    doc="A texel within its range; 0 in place of NaN.",
    function="valid_texel",
)
BOUNDS = Guard(None, "range", "a quantity beyond its range", "clamp(x, LOW, HIGH)", "result")
DIVISION = Guard(
    None, "division", "a division by 0", NONZERO, "y", doc="A divisor that is not 0, with the sign of `y`.",
    function="nonzero",
)  # fmt: skip
COUNT = Guard(None, "division", "a division by a count of 0", "max(y, 1.0)", "y", function="nonzero")
SIGNED_COUNT = COUNT._replace(text=NONZERO.replace("DIVISOR", "1.0"), doc=DIVISION.doc)
"""For a count that may be below 0."""
WHOLE_DIVISION = Guard(None, "division", "a division of integers by 0", "(y != 0 ? y : 1)", "y")
"""Only for authors: the texts of languages that do not define it are made safe by `legalise`."""
WHOLE_NUMBER = Guard(None, "undefined", "a float too large for an integer", "clamp(x, LOW, HIGH)", "x")
ELEMENT = Guard(None, "range", "an index beyond the elements", "clamp(y, 0, LAST)", "y")


@cache
def subnormal(guard: Guard) -> Guard:
    """The guard of an operation that fails for subnormal numbers alone: its result may be infinite."""
    return guard._replace(kind="overflow")


class Site(NamedTuple):
    """One operation with a domain."""

    node: ir.Expr
    operation: str
    """The operator or builtin, or `overflow`, `texel`, a quantity's name, `int`, `index`."""
    failures: tuple[Guard, ...]
    """The guards of what may fail there; none if the operation is proven safe."""
    guard: Guard
    """The guard that is inserted: that of the first failure."""
    args: tuple[Range, ...]
    """The ranges of the arguments (of each: the hull of all its components), or of the result."""
    limits: tuple[float, float] = (0.0, 0.0)
    """LOW and HIGH of the guard's text."""
    function: str = ""
    """The name of the function that it is in; '' for a constant of the module."""

    def joined(self, other: Site) -> Site:
        """The site in both contexts: the guard that either needs, the joined ranges."""
        args = tuple([a.joined(b) for a, b in zip(self.args, other.args, strict=True)])
        failures = self.failures
        if failures != other.failures:
            failures = tuple(dict.fromkeys((*failures, *other.failures)))
            if SIGNED_COUNT in failures:  # it is that of both signs
                failures = tuple([guard for guard in failures if guard is not COUNT])
        if self.proven != other.proven:
            worse = other if self.proven else self
        else:
            worse = min(self, other, key=lambda site: site.guard.replaces != "")
        if worse.guard is COUNT and args[1].low < 0.0:
            worse = worse._replace(guard=SIGNED_COUNT)
        return worse._replace(args=args, failures=failures)

    @property
    def proven(self) -> bool:
        """Whether nothing can fail there."""
        return not self.failures

    @property
    def place(self) -> str:
        """Its position, as `file:line:column`."""
        return self.place_in("")

    def place_in(self, folder: str) -> str:
        """The same, relative to a folder."""
        span = self.node.span
        return f"{display_name(span.file, folder)}:{span.line}:{span.column}"

    @property
    def range_text(self) -> str:
        """The ranges, for people."""
        if self.guard.replaces == "result" or not self.args:
            return f"{spell_range(self.args[0])}" if self.args and self.operation != "texel" else ""
        first = "xyz".index(self.guard.replaces) if self.guard is ELEMENT else 0  # only the index has a range
        rows = zip("xyz"[first:], self.args, operands(self.node)[first:], strict=False)
        return ", ".join(
            [f"{letter} in {spell_range(arg)}" for letter, arg, node in rows if not isinstance(node, ir.Literal)]
        )


def spell_range(range: Range) -> str:
    """A range, for people."""
    gap = f" but not within {range.gap:.4g} of 0" if range.gap and range.low < 0.0 < range.high else ""
    return f"{_number(range.low)}..{_number(range.high)}{gap}"


def _number(value: float) -> str:
    text = f"{value:.4g}"
    return f"{value:.7g}" if text in ("1", "-1") else text  # what is a little beyond 1 is not 1


def report(sites: Sequence[Site], guarded: Sequence[Site], folder: str) -> GuardReport:
    """The report on all sites and on those that have a guard, with places relative to a folder."""
    rows = [
        {
            "at": site.place_in(folder),
            "operation": site.operation,
            "reason": site.guard.problem,
            "found": site.range_text,
        }
        for site in guarded
    ]
    return GuardReport(sum(site.proven for site in sites), tuple(rows))
