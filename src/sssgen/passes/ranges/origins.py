"""Why an operation is not proven safe: the definitions behind its operand, down to the input that its range comes from.

The trace keeps the range of every expression. The chain starts at the operand that leaves the domain. It goes to the
part that already fails, through definitions, calls and parameters; where no part fails, the operation itself has
widened the range, and the chain goes on to the widest part.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import NamedTuple

from sssgen.ir import nodes as ir
from sssgen.ir.contracts import Assumed
from sssgen.ir.formats import FLOAT32
from sssgen.ir.intervals import INF, Range
from sssgen.ir.intrinsics import BUILTINS, Guard
from sssgen.ir.types import Vector
from sssgen.ir.vector_ranges import Value
from sssgen.ir.walk import all_expressions, operands, statements, written_root
from sssgen.passes.ranges.range_pass import RangeAnalysis
from sssgen.passes.ranges.range_state import variable_key
from sssgen.passes.ranges.scalar_parts import hull_of
from sssgen.passes.ranges.sites import ELEMENT, WHOLE_NUMBER, Site

_BOUNDED = 1e3
"""How much larger than a result its operand is where the operation is a bound, such as a normalized vector's."""
LONGEST = 8
"""Steps of a chain."""


class Step(NamedTuple):
    """A place on the way from an input to an operation, and what is known there."""

    span: ir.Span
    what: str
    """`definition`, `parameter`, `uniform`, `input`, `constant`, `result`, `texel` or `operation`."""
    name: str
    """The variable, parameter, input or function; '' for an operation."""
    range: Range
    is_length: bool = False
    """Whether the range is that of a vector's length."""
    widens: bool = False
    """Whether the range begins to leave the domain here: no part of what is computed here does."""


def _is_length(node: ir.Expr, by_length: bool) -> bool:
    return by_length and isinstance(node.type, Vector)


def _is_name(node: ir.Expr | None) -> bool:
    """Whether an expression is a variable, or a part of one."""
    while isinstance(node, ir.Swizzle | ir.Index | ir.Member):
        node = node.value
    return isinstance(node, ir.Local | ir.Global)


class RangeTrace(RangeAnalysis):
    """The analysis, which keeps the range of each expression, joined over its visits."""

    def __init__(
        self, module: ir.Module, chained: bool = True, assumed: Assumed | None = None, unguarded: bool = False
    ) -> None:
        self.seen: dict[int, list[Value]] = {}
        """An expression's identity → its value at each visit."""
        super().__init__(module, FLOAT32, chained, assumed, unguarded)

    def expr(self, node: ir.Expr) -> Value:
        value = super().expr(node)
        values = self.seen.get(id(node))
        if values is None:
            self.seen[id(node)] = [value]
        elif values[-1] is not value:
            values.append(value)
        return value

    def range_of(self, node: ir.Expr, is_length: bool) -> Range | None:
        """The hull of an expression's values, or of their lengths; None where it was not visited or has no numbers."""
        values = self.seen.get(id(node), ())
        if not values or not values[0].parts:
            return None
        lengths = [value.length for value in values]
        if is_length and all(length.high < INF for length in lengths):
            return hull_of(tuple(lengths))
        return hull_of(tuple([part for value in values for part in value.parts]))


class Origins:
    """The chains behind the sites of one analysis."""

    def __init__(self, module: ir.Module, trace: RangeTrace) -> None:
        self.trace = trace
        self.uniforms = {uniform.name: uniform for uniform in module.uniforms}
        self.inputs = {variable.name: variable for variable in module.variables if variable.storage == "in"}
        self.functions = {function.key: function for function in module.functions}
        self.owner: dict[int, str] = {}
        """The key of the function that an expression is in."""
        self.definitions: dict[tuple[str, str], list[ir.Expr]] = {}
        """A function and the key of a variable → what is assigned to it there."""
        self.calls: dict[str, list[ir.Call]] = {}
        for function in module.functions:
            if trace.interpretations[function.key]:
                self._read(function)

    def _read(self, function: ir.Function) -> None:
        key = function.key
        for expr in all_expressions(function.body or ()):
            self.owner[id(expr)] = key
            if isinstance(expr, ir.Call):
                self.calls.setdefault(expr.function, []).append(expr)
        for stmt in statements(function.body or ()):
            if isinstance(stmt, ir.Declare) and stmt.value is not None:
                self.definitions.setdefault((key, stmt.name), []).append(stmt.value)
            elif isinstance(stmt, ir.Assign) and (name := variable_key(stmt.target)) is not None:
                value: ir.Expr = stmt.value
                compound = self.trace.compounds.get(id(stmt))
                if compound is not None:
                    self.owner[id(compound)] = key
                    value = compound
                owner = "" if name.startswith("@") else key
                self.definitions.setdefault((owner, name), []).append(value)

    def chain(self, site: Site, guard: Guard) -> list[Step]:
        """The steps behind a site's failure, from the operation on."""
        start, fails = self._operand(site, guard)
        if start is None:
            return []
        steps: list[Step] = []
        visited: set[int] = set()
        node: ir.Expr | None = start
        by_length = isinstance(site.node, ir.Intrinsic) and not BUILTINS[site.node.name].componentwise
        widest = False
        while node is not None and id(node) not in visited and len(steps) < LONGEST:
            visited.add(id(node))
            own = self._range(node, by_length)
            if own is None:
                break
            parts = self._parts(node)
            if isinstance(node, ir.Local | ir.Global):
                node, step = self._behind(node, own, by_length, fails if not widest else None)
                if step is not None and not (step.what in ("argument", "definition") and _is_name(node)):
                    steps.append(step)
                continue
            if isinstance(node, ir.Call):
                function = self.functions[node.function]
                returned = [
                    stmt.value for stmt in statements(function.body or ()) if isinstance(stmt, ir.Return) and stmt.value
                ]
                node = self._worst(returned, by_length, None if widest else fails)
                if node is not None:
                    steps.append(
                        Step(
                            node.span,
                            "result",
                            function.name,
                            self._range(node, by_length) or own,
                            _is_length(node, by_length),
                        )
                    )
                continue
            if not parts:
                if isinstance(node, ir.Intrinsic):
                    steps.append(Step(node.span, "texel" if BUILTINS[node.name].reads_texels else "operation", "", own))
                break
            failing = [] if widest else self._failing(node, parts, by_length, fails)
            through = isinstance(node, ir.Swizzle | ir.Index | ir.Member | ir.Construct | ir.Select)
            if not failing and not widest and not through:
                steps.append(Step(node.span, "operation", "", own, _is_length(node, by_length), widens=True))
                widest, by_length = True, False
            node = self._worst(failing or parts, by_length, None)
            part = self._range(node, by_length) if widest and node is not None else None
            if (
                part is not None and part.size > _BOUNDED * own.size
            ):  # the operation is a bound: it does not come from there
                break
        return steps

    def _operand(self, site: Site, guard: Guard) -> tuple[ir.Expr | None, Callable[[Range], bool]]:
        """The operand to blame for a failure, and whether a range of it fails."""
        args = operands(site.node)
        ranges = site.args
        if site.operation == "overflow" or guard.replaces == "result":
            return site.node, lambda range: range.size > 1e18
        if guard in (ELEMENT, WHOLE_NUMBER):
            low, high = site.limits
            return args["xyz".index(guard.replaces)], lambda range: range.low < low or range.high > high
        if guard.safe is None or not isinstance(site.node, ir.Intrinsic):
            index = "xyz".index(guard.replaces) if guard.replaces in ("x", "y", "z") else 0
            return args[index] if args else None, lambda range: range.has_zero()
        candidates = range(len(args)) if not guard.replaces else ["xyz".index(guard.replaces)]
        open_ones = [index for index in candidates if not isinstance(args[index], ir.Literal)]
        index = max(open_ones or candidates, key=lambda at: ranges[at].size - (at == 2) * 1e300)
        safe = guard.safe

        def fails(range: Range) -> bool:
            return not safe(FLOAT32, *[range if at == index else other for at, other in enumerate(ranges)])

        return args[index], fails

    def _range(self, node: ir.Expr, by_length: bool) -> Range | None:
        return self.trace.range_of(node, _is_length(node, by_length))

    def _fails(self, node: ir.Expr, by_length: bool, fails: Callable[[Range], bool]) -> bool:
        own = self._range(node, by_length)
        return own is not None and not isinstance(node, ir.Literal) and fails(own)

    def _failing(
        self, node: ir.Expr, parts: list[ir.Expr], by_length: bool, fails: Callable[[Range], bool]
    ) -> list[ir.Expr]:
        """The parts that are outside of the domain by themselves: of a sum, only if the rest of it may be 0."""
        if not isinstance(node, ir.Binary) or node.op not in ("+", "-"):
            return [part for part in parts if self._fails(part, by_length, fails)]
        failing: list[ir.Expr] = []
        for part, rest in ((node.left, node.right), (node.right, node.left)):
            own, other = self._range(part, by_length), self._range(rest, by_length)
            if own is None or other is None or other.gap > 0.0 or isinstance(part, ir.Literal):
                continue
            negated = node.op == "-" and part is node.right and not _is_length(part, by_length)
            if fails(-own if negated else own):
                failing.append(part)
        return failing

    def _parts(self, node: ir.Expr) -> list[ir.Expr]:
        if isinstance(node, ir.Select):
            return [node.yes, node.no]
        if isinstance(node, ir.Index):
            return [node.value]
        parts = [part for part in operands(node) if not isinstance(part, ir.Literal)]
        return [part for part in parts if self._range(part, False) is not None]

    def _worst(self, nodes: list[ir.Expr], by_length: bool, fails: Callable[[Range], bool] | None) -> ir.Expr | None:
        """The node whose range fails, else the one with the widest range."""
        ranges = [(node, own) for node in nodes if (own := self._range(node, by_length)) is not None]
        failing = [pair for pair in ranges if fails is not None and fails(pair[1])]
        return max(failing or ranges, key=lambda pair: pair[1].high - pair[1].low, default=(None, None))[0]

    def _behind(
        self, node: ir.Local | ir.Global, own: Range, by_length: bool, fails: Callable[[Range], bool] | None
    ) -> tuple[ir.Expr | None, Step | None]:
        """What a variable is defined by, or the input that it is."""
        owner = self.owner.get(id(node), "")
        if isinstance(node, ir.Global) and node.name in self.uniforms:
            return None, Step(self.uniforms[node.name].span, "uniform", node.name, own, _is_length(node, by_length))
        if isinstance(node, ir.Global) and node.name in self.inputs:
            return None, Step(self.inputs[node.name].span, "input", node.name, own, _is_length(node, by_length))
        key = variable_key(node) or ""
        defined = self.definitions.get(("" if isinstance(node, ir.Global) else owner, key), [])
        before = [value for value in defined if value.span[1:3] < node.span[1:3]] or defined
        function = self.functions.get(owner)
        position = next((at for at, param in enumerate(function.params) if param.name == key), -1) if function else -1
        if (
            function is not None
            and position >= 0
            and not any(self._reaches(value, fails, by_length) for value in before)
        ):
            param = function.params[position]
            arguments = [call.args[position] for call in self.calls.get(owner, ()) if id(call) in self.trace.seen]
            argument = self._worst(arguments, by_length, fails) if arguments else None
            span = param.span if argument is None else argument.span
            length = _is_length(node, by_length)
            if argument is None:
                return None, Step(span, "parameter", param.name, own, length)
            return argument, Step(span, "argument", f"{param.name} of {function.name}", own, length)
        written = [*before, *self._outs(owner, key)]
        value = self._worst(written, by_length, fails)
        if value is None:
            return None, None
        return value, Step(
            value.span,
            "definition",
            key.lstrip("@"),
            self._range(value, by_length) or own,
            _is_length(value, by_length),
        )

    def _reaches(self, value: ir.Expr, fails: Callable[[Range], bool] | None, by_length: bool) -> bool:
        own = self._range(value, by_length)
        return own is not None and (fails is None or fails(own))

    def _outs(self, owner: str, key: str) -> Iterator[ir.Expr]:
        """What functions that a function calls assign to a variable of it, as their out parameter."""
        for callee, calls in self.calls.items():
            for call in calls:
                if self.owner.get(id(call)) != owner:
                    continue
                for param, arg in zip(self.functions[callee].params, call.args, strict=True):
                    variable = written_root(arg) if param.direction != "in" else None
                    if variable is not None and variable_key(variable) == key:
                        yield from self.definitions.get((callee, param.name), [])
