"""Why an operation is not proven safe: the definitions behind its operand, down to the input that its range comes from.

The trace keeps the range of every expression. The chain starts at the operand that leaves the domain. It goes to the
part that already fails, through definitions, calls and parameters; where no part fails, the operation itself has
widened the range, and the chain goes on to the widest part.
"""

from __future__ import annotations

import bisect
from collections.abc import Callable, Iterator
from typing import NamedTuple

from sssgen.ir import nodes as ir
from sssgen.ir.contracts import Assumed
from sssgen.ir.formats import FLOAT32
from sssgen.ir.intervals import INF, Range
from sssgen.ir.intrinsics import BUILTINS, Guard
from sssgen.ir.types import Array, Sampler, Struct, Type, Vector
from sssgen.ir.vector_ranges import Value, length_of
from sssgen.ir.walk import all_expressions, operands, statements, written_root
from sssgen.passes.ranges.range_pass import RangeAnalysis
from sssgen.passes.ranges.range_state import variable_key
from sssgen.passes.ranges.scalar_parts import field_at, hull_of
from sssgen.passes.ranges.sites import ELEMENT, WHOLE_NUMBER, Site

_BOUNDED = 1e3
"""How much larger than a result its operand is where the operation is a bound, such as a normalized vector's."""
_NEAREST = 64
"""Assignments to a variable that are looked at."""
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
    node: ir.Expr | None = None
    """What is computed there; None for a declaration."""


Path = tuple[str | int | None, ...]
"""The fields and elements that lead to a part of a value; None stands for any element."""


class Place(NamedTuple):
    """An expression, or a part of its value."""

    node: ir.Expr
    path: Path = ()

    @property
    def type(self) -> Type:
        """The type of the part."""
        type_ = self.node.type
        for step in self.path:
            if isinstance(type_, Struct):
                type_ = next(field.type for field in type_.fields if field.name == step)
            elif isinstance(type_, Array):
                type_ = type_.element
        return type_

    def is_length(self, by_length: bool) -> bool:
        """Whether its range is that of its length."""
        return by_length and isinstance(self.type, Vector)


class _Walk:
    """The way of a chain so far."""

    def __init__(self, by_length: bool, fails: Callable[[Range], bool]) -> None:
        self.by_length = by_length
        """Whether the range of a vector is that of its length."""
        self.fails: Callable[[Range], bool] | None = fails
        """Whether a range fails; None behind the operation that widens, where the widest part is followed."""
        self.steps: list[Step] = []


def _access(node: ir.Expr) -> Place:
    """The variable that an expression is a part of, if it is one, and the way from there."""
    path: list[str | int | None] = []
    while isinstance(node, ir.Swizzle | ir.Index | ir.Member):
        if isinstance(node, ir.Member):
            path.insert(0, node.field)
        elif isinstance(node, ir.Index):
            path.insert(0, int(node.index.value) if isinstance(node.index, ir.Literal) else None)
        node = node.value
    return Place(node, tuple(path))


def _part(value: ir.Expr, path: Path) -> Place:
    """A part of a value: the argument of the constructor that it is, where that is known."""
    while path and isinstance(value, ir.Construct) and isinstance(value.type, Struct | Array):
        index = path[0]
        if isinstance(value.type, Struct):
            index = [field.name for field in value.type.fields].index(str(index))
        if not isinstance(index, int) or index >= len(value.args):
            break
        value, path = value.args[index], path[1:]
    return Place(value, path)


def _is_direction(node: ir.Expr) -> bool:
    """Whether the size of an operand does not matter for a result."""
    return isinstance(node, ir.Intrinsic) and any(guard.succeeds is not None for guard in BUILTINS[node.name].guards)


def _overlap(first: Path, second: Path) -> bool:
    """Whether two parts of a variable have something in common."""
    return all(a == b or a is None or b is None for a, b in zip(first, second, strict=False))


def _part_text(name: str, path: Path) -> str:
    """A part of a variable, as the language writes it."""
    return name + "".join(
        [f".{step}" if isinstance(step, str) else "[…]" if step is None else f"[{step}]" for step in path]
    )


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
        self.keep(node, value)
        return value

    def operation(self, node: ir.Binary, left: Value, right: Value) -> Value:
        value = super().operation(node, left, right)
        self.keep(node, value)  # that of a compound assignment is no expression of its own
        return value

    def keep(self, node: ir.Expr, value: Value) -> None:
        """Keeps the value of an expression at this visit."""
        values = self.seen.get(id(node))
        if values is None:
            self.seen[id(node)] = [value]
        elif values[-1] is not value:
            values.append(value)

    def range_of(self, place: Place, by_length: bool) -> Range | None:
        """The hull of a place's values, or of their lengths; None where it was not visited or has no numbers."""
        values = self.seen.get(id(place.node), ())
        if not values or not values[0].parts:
            return None
        start, count, type_ = 0, len(values[0].parts), place.node.type
        for step in place.path:
            if isinstance(type_, Struct):
                first, count = field_at(type_, str(step))
                start, type_ = start + first, next(field.type for field in type_.fields if field.name == step)
            elif isinstance(type_, Array):
                type_ = type_.element
        whole = count == len(values[0].parts)
        parts = [value.parts[start : start + count] for value in values]
        lengths = [value.length if whole else length_of(own) for value, own in zip(values, parts, strict=True)]
        if place.is_length(by_length) and all(length.high < INF for length in lengths):
            return hull_of(tuple(lengths))
        return hull_of(tuple([part for own in parts for part in own]))


class Origins:
    """The chains behind the sites of one analysis."""

    def __init__(self, module: ir.Module, trace: RangeTrace) -> None:
        self.trace = trace
        self.uniforms = {uniform.name: uniform for uniform in module.uniforms}
        self.inputs = {variable.name: variable for variable in module.variables if variable.storage == "in"}
        self.functions = {function.key: function for function in module.functions}
        self.owner: dict[int, str] = {}
        """The key of the function that an expression is in."""
        self.definitions: dict[tuple[str, str], list[tuple[Path, ir.Expr]]] = {}
        """A function and the key of a variable → what is assigned to its parts there."""
        self.calls: dict[str, list[ir.Call]] = {}
        for function in module.functions:
            if trace.interpretations[function.key]:
                self._add_function(function)

    def _add_function(self, function: ir.Function) -> None:
        key = function.key
        for expr in all_expressions(function.body or ()):
            self.owner[id(expr)] = key
            if isinstance(expr, ir.Call):
                self.calls.setdefault(expr.function, []).append(expr)
        for stmt in statements(function.body or ()):
            if isinstance(stmt, ir.Declare) and stmt.value is not None:
                self.definitions.setdefault((key, stmt.name), []).append(((), stmt.value))
            elif isinstance(stmt, ir.Assign) and (name := variable_key(stmt.target)) is not None:
                value: ir.Expr = stmt.value
                compound = self.trace.compounds.get(id(stmt))
                if compound is not None:
                    self.owner[id(compound)] = key
                    value = compound
                owner = "" if name.startswith("@") else key
                self.definitions.setdefault((owner, name), []).append((_access(stmt.target).path, value))

    def chain(self, site: Site, guard: Guard) -> list[Step]:
        """The steps behind a site's failure, from the operation on."""
        start, fails = self._operand(site, guard)
        place = None if start is None else Place(start)
        walk = _Walk(isinstance(site.node, ir.Intrinsic) and not BUILTINS[site.node.name].componentwise, fails)
        visited: set[tuple[int, Path]] = set()
        while place is not None and (id(place.node), place.path) not in visited and len(walk.steps) < LONGEST:
            visited.add((id(place.node), place.path))
            own = self.trace.range_of(place, walk.by_length)
            if own is None:
                break
            variable = _access(place.node)
            if isinstance(variable.node, ir.Local | ir.Global):
                variable = Place(variable.node, (*variable.path, *place.path))
                place = self._through_variable(walk, place, variable, own)
            elif isinstance(place.node, ir.Call):
                place = self._through_call(walk, place.node, place.path, own)
            else:
                place = self._through_operation(walk, place, own)
        return walk.steps

    def _through_variable(self, walk: _Walk, place: Place, variable: Place, own: Range) -> Place | None:
        length = place.is_length(walk.by_length)
        behind, step = self._source(variable, own, length, walk.by_length, walk.fails)
        is_name = behind is not None and isinstance(_access(behind.node).node, ir.Local | ir.Global)
        if step is not None and not (step.what in ("argument", "definition") and is_name):
            walk.steps.append(step)
        return behind

    def _through_call(self, walk: _Walk, call: ir.Call, path: Path, own: Range) -> Place | None:
        function = self.functions[call.function]
        returned = [
            _part(stmt.value, path)
            for stmt in statements(function.body or ())
            if isinstance(stmt, ir.Return) and stmt.value
        ]
        place = self._worst(returned, walk.by_length, walk.fails)
        if place is not None:
            own = self.trace.range_of(place, walk.by_length) or own
            length = place.is_length(walk.by_length)
            walk.steps.append(Step(place.node.span, "result", function.name, own, length, node=place.node))
        return place

    def _through_operation(self, walk: _Walk, place: Place, own: Range) -> Place | None:
        """The part that fails, or the widest one; None where the range is not from the parts."""
        node = place.node
        parts = self._parts(node)
        if not parts:
            if isinstance(node, ir.Intrinsic):
                what = "texel" if BUILTINS[node.name].reads_texels else "operation"
                walk.steps.append(Step(node.span, what, "", own, node=node))
            return None
        failing = self._failing(node, parts, walk.by_length, walk.fails) if walk.fails is not None else []
        through = isinstance(node, ir.Swizzle | ir.Index | ir.Member | ir.Construct | ir.Select)
        if not failing and walk.fails is not None and not through:
            length = place.is_length(walk.by_length)
            walk.steps.append(Step(node.span, "operation", "", own, length, widens=True, node=node))
            walk.by_length, walk.fails = False, None
        behind = self._worst([Place(part) for part in failing or parts], walk.by_length, None)
        part = self.trace.range_of(behind, walk.by_length) if walk.fails is None and behind is not None else None
        is_bound = part is not None and (part.size > _BOUNDED * own.size or _is_direction(node))
        return None if is_bound else behind

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
        return self.trace.range_of(Place(node), by_length)

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
            negated = node.op == "-" and part is node.right and not Place(part).is_length(by_length)
            if fails(-own if negated else own):
                failing.append(part)
        return failing

    def _parts(self, node: ir.Expr) -> list[ir.Expr]:
        if isinstance(node, ir.Select):
            return [node.yes, node.no]
        if isinstance(node, ir.Index):
            return [node.value]
        if isinstance(node, ir.Intrinsic) and any(isinstance(arg.type, Sampler) for arg in node.args):
            return []  # what a texture has does not come from its coordinates
        parts = [part for part in operands(node) if not isinstance(part, ir.Literal)]
        return [part for part in parts if self._range(part, False) is not None]

    def _worst(
        self, places: list[Place], by_length: bool, fails: Callable[[Range], bool] | None
    ) -> Place | None:  # fmt: skip
        """The place whose range fails, else the one with the widest range."""
        ranges = [(place, own) for place in places if (own := self.trace.range_of(place, by_length)) is not None]
        failing = [pair for pair in ranges if fails is not None and fails(pair[1])]
        return max(failing or ranges, key=lambda pair: pair[1].high - pair[1].low, default=(None, None))[0]

    def _source(
        self, variable: Place, own: Range, is_length: bool, by_length: bool, fails: Callable[[Range], bool] | None
    ) -> tuple[Place | None, Step | None]:
        """What a part of a variable is defined by, or the input that it is."""
        node, path = variable
        assert isinstance(node, ir.Local | ir.Global)
        owner = self.owner.get(id(node), "")
        for inputs, what in ((self.uniforms, "uniform"), (self.inputs, "input")):
            if isinstance(node, ir.Global) and node.name in inputs:
                return None, Step(inputs[node.name].span, what, _part_text(node.name, path), own, is_length)
        key = variable_key(node) or ""
        before = list(self._assignments("" if isinstance(node, ir.Global) else owner, key, path, node.span))
        function = self.functions.get(owner)
        position = next((at for at, param in enumerate(function.params) if param.name == key), -1) if function else -1
        if (
            function is not None
            and position >= 0
            and not any(self._reaches(value, fails, by_length) for value in before)
        ):
            param = function.params[position]
            calls = [call for call in self.calls.get(owner, ()) if id(call) in self.trace.seen]
            argument = self._worst([Place(call.args[position], path) for call in calls], by_length, fails)
            name = _part_text(param.name, path)
            if argument is None:
                return None, Step(param.span, "parameter", name, own, is_length)
            span = argument.node.span
            return argument, Step(span, "argument", f"{name} of {function.name}", own, is_length, node=argument.node)
        value = self._worst([*before, *self._outs(owner, key, path)], by_length, fails)
        if value is None:
            return None, None
        own = self.trace.range_of(value, by_length) or own
        name = _part_text(key.lstrip("@"), path[: max(len(path) - len(value.path), 0)])
        is_length = value.is_length(by_length)
        return value, Step(value.node.span, "definition", name, own, is_length, node=value.node)

    def _assignments(self, owner: str, key: str, path: Path, use: ir.Span | None = None) -> Iterator[Place]:
        """What is assigned to a part of a variable, or to what contains it or is in it: before its use, if anything is.

        Of many assignments, those nearest to the use.
        """
        defined = self.definitions.get((owner, key), [])
        end = 0 if use is None else bisect.bisect_right(defined, use[1:3], key=lambda each: each[1].span[3:5])
        for target, value in defined[max(end - _NEAREST, 0) : end] or defined[:_NEAREST]:
            if _overlap(target, path):
                yield _part(value, path[len(target) :])

    def _reaches(self, value: Place, fails: Callable[[Range], bool] | None, by_length: bool) -> bool:
        own = self.trace.range_of(value, by_length)
        return own is not None and (fails is None or fails(own))

    def _outs(self, owner: str, key: str, path: Path) -> Iterator[Place]:
        """What functions that a function calls assign to a variable of it, as their out parameter."""
        for callee, calls in self.calls.items():
            for call in calls:
                if self.owner.get(id(call)) != owner:
                    continue
                for param, arg in zip(self.functions[callee].params, call.args, strict=True):
                    variable = written_root(arg) if param.direction != "in" else None
                    target = _access(arg).path
                    if variable is not None and variable_key(variable) == key and _overlap(target, path):
                        yield from self._assignments(callee, param.name, path[len(target) :])
