"""Value ranges: interprets a program over ranges and finds which operations with a domain can go wrong.

The analysis is sound under the rounding of the format: every value of a run lies in its range if the inputs are within
their contracts (`ir.contracts`), and if each unsafe operation is guarded or does not occur; after such an operation the
analysis continues with the range behind its guard. Functions are interpreted at each call, with the ranges there, or
by a summary in large programs (`summaries`).
Place: after `hoist`, when the program is the one that every target gets; before `parameters`, which removes the
uniforms' hints.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Sequence
from typing import NamedTuple, cast

from sssgen.ir import contracts
from sssgen.ir import nodes as ir
from sssgen.ir.contracts import Assumed
from sssgen.ir.formats import FLOAT32, Format
from sssgen.ir.intervals import Range, clip, rounded
from sssgen.ir.types import VOID, Array, Struct, Type, Vector, kind_of
from sssgen.ir.vector_ranges import Contract, Value
from sssgen.ir.walk import root
from sssgen.passes.ranges.range_state import Frame, State, global_key, variable_key
from sssgen.passes.ranges.scalar_parts import field_at, hull_of, innermost, scalars
from sssgen.passes.ranges.sites import BOUNDS, Site
from sssgen.passes.ranges.summaries import CallSummaries, Result
from sssgen.passes.stage.stage_interface import ENTRY


def _has_difference(left: Type, right: Type) -> bool:
    """Whether a vector, or its first components, minus another one is a vector of floats."""
    vectors = isinstance(left, Vector) and isinstance(right, Vector)
    return vectors and kind_of(left) == kind_of(right) == "float" and scalars(left) >= scalars(right)


class Findings(NamedTuple):
    """The result of the analysis."""

    sites: list[Site]
    """Every operation with a domain that was reached, in the order of the first visit."""
    compounds: dict[int, ir.Binary]
    """The operations of compound assignments, by the identity of the statement."""


def analyse(
    module: ir.Module, roots: Iterable[str], format: Format = FLOAT32, chained: bool = True,
    assumed: Assumed | None = None, unguarded: bool = False,
) -> Findings:  # fmt: skip
    """Interprets the functions with the keys `roots`, their parameters within their contracts or what is assumed."""
    analysis = RangeAnalysis(module, format, chained, assumed, unguarded)
    for key in roots:
        analysis.root(key)
    return Findings(list(analysis.sites.values()), analysis.compounds)


class RangeAnalysis(CallSummaries):
    """The complete analysis: adds functions and statements."""

    def __init__(
        self, module: ir.Module, format: Format = FLOAT32, chained: bool = True, assumed: Assumed | None = None,
        unguarded: bool = False,
    ) -> None:  # fmt: skip
        super().__init__(module, format, chained, assumed, unguarded)
        self.variable_keys = frozenset(map(global_key, self.variables))
        if assumed is not None:
            self.assume_differences(module, assumed)

    def assume_differences(self, module: ir.Module, assumed: Assumed) -> None:
        """Learns what is assumed of a uniform minus an input, such as the way from a point to the camera."""
        inputs = [variable for variable in module.variables if variable.storage == "in"]
        for uniform, variable in itertools.product(module.uniforms, inputs):
            if not _has_difference(uniform.type, variable.type):
                continue
            assumption = assumed("difference", f"{uniform.name} - {variable.name}", variable.type)
            if assumption is None:
                continue
            left, right = self.globals[uniform.name], self.globals[variable.name]
            for first, second in ((left, right), (right, left)):
                rows = zip(first.parts, first.numbers, second.parts, second.numbers, strict=False)
                numbers = [
                    self.numbers.sum("-", m, n, "float", self.slack(a, b, a - b, "float")) for a, m, b, n in rows
                ]
                length = self.numbers.of("length", *numbers)
                self.assumed_facts.learn(self.numbers, length, Range(assumption.shortest, assumption.longest))

    # Functions

    def root(self, key: str) -> None:
        """Interprets a function whose parameters are within their contracts."""
        function = self.functions[key]
        if function.body is None:
            return
        self.state = State({}, self.assumed_facts.copy())
        if key == ENTRY:  # what else is called from outside may find them changed
            for variable in self.variables.values():
                if global_key(variable.name) in self.memories:
                    continue
                value = self.expr(variable.value) if variable.value is not None else self.unknown(variable.type)
                self.state.env[global_key(variable.name)] = value
        args = [
            self.unknown(param.type) if param.direction == "out" else self.outside(param) for param in function.params
        ]
        self.enter(function, args)

    def outside(self, param: ir.Param) -> Value:
        """What a caller outside of the module may pass; of a struct, in each of its fields."""
        inner = innermost(param.type)
        if not isinstance(inner, Struct):
            contract = contracts.from_outside(param._replace(type=inner), self.format, self.chained)
            return self.input(inner, contract, "parameter", param.name)
        return self.assemble([
            self.outside(ir.Param(field.name, field.type, "in", field.quantity, param.span)) for field in inner.fields
        ])  # fmt: skip

    def interpret(self, function: ir.Function, args: Sequence[Value]) -> Result:
        self.interpretations[function.key] += 1
        outer, loops, self.loops = self.state, self.loops, []
        env = {key: value for key, value in outer.env.items() if key in self.variable_keys}
        env |= {param.name: arg for param, arg in zip(function.params, args, strict=True)}
        frame = Frame(function, [])
        self.frames.append(frame)
        end = self.block(function.body or (), State(env, outer.facts.copy()))
        if end is not None:
            frame.returned.append((end, None))
        self.frames.pop()
        self.loops = loops
        if not frame.returned:  # every path ends in a discard
            self.state = outer
            return (None if function.result == VOID else self.unknown(function.result)), list(args)
        state, result = frame.returned[0]
        for other, value in frame.returned[1:]:
            if result is not None and value is not None:
                result = self.joined(result, value, state.facts, other.facts)
            state = self.join(state, other)
        changed = {key: value for key, value in state.env.items() if key in self.variable_keys}
        self.state = State(outer.env | changed if changed else outer.env, state.facts)
        if result is None and function.result != VOID:
            result = self.unknown(function.result)
        return result, [state.env.get(param.name, arg) for param, arg in zip(function.params, args, strict=True)]

    def call(self, node: ir.Call) -> Value:
        function = self.functions[node.function]
        args, before = [], []
        for param, arg in zip(function.params, node.args, strict=True):
            variable = variable_key(arg) if param.direction == "inout" else None
            args.append(self.unknown(param.type) if param.direction == "out" else self.expr(arg))
            before.append((variable, self.state.env.get(variable)) if variable is not None else None)
        for index, evaluated in enumerate(before):
            # a call in a later argument may have written the variable, and the callee gets what is in it then
            if evaluated is not None and self.state.env.get(evaluated[0]) is not evaluated[1]:
                facts = self.state.facts
                args[index] = self.joined(args[index], self.expr(node.args[index]), facts, facts)
        # the call may write an index that a target uses
        written = [
            self.places(arg) if param.direction != "in" and variable_key(arg) is not None else None
            for param, arg in zip(function.params, node.args, strict=True)
        ]
        result, ends = self.enter(function, args) if function.body is not None else (None, args)
        for places, arg, end in zip(written, node.args, ends, strict=True):
            if places is not None:
                self.store(arg, self.value(end.parts, end.numbers, end.length), places)
        return result if result is not None else (Value((), ()) if node.type == VOID else self.unknown(node.type))

    # Statements

    def block(self, block: ir.Block, state: State | None) -> State | None:
        """The state at a block's end; None if that is unreachable."""
        for stmt in block:
            if state is None:
                return None
            self.state = state
            state = self.statement(stmt)
        return state

    def statement(self, stmt: ir.Stmt) -> State | None:
        if isinstance(stmt, ir.Declare):
            value = self.expr(stmt.value) if stmt.value is not None else self.unknown(stmt.type)
            self.state.env[stmt.name] = value
        elif isinstance(stmt, ir.Assign):
            self.assign(stmt)
        elif isinstance(stmt, ir.Evaluate):
            self.expr(stmt.call)
        elif isinstance(stmt, ir.Assume):
            self.learn(self.expr(stmt.condition).numbers[0], True)
        elif isinstance(stmt, ir.Return):
            result = self.returned(stmt.value) if stmt.value is not None else None
            self.frames[-1].returned.append((self.state, result))
            return None
        elif isinstance(stmt, ir.If):
            return self.branch(stmt)
        elif isinstance(stmt, ir.For | ir.While):
            return self.loop(stmt)
        elif isinstance(stmt, ir.Break):
            self.loops[-1].break_states.append(self.state)
            return None
        elif isinstance(stmt, ir.Continue):
            self.loops[-1].continued.append(self.state)
            return None
        elif isinstance(stmt, ir.Discard):
            return None
        elif isinstance(stmt, ir.MemoryOperation):
            self.memory_operation(stmt)
        return self.state

    def memory_operation(self, stmt: ir.MemoryOperation) -> None:
        """An atomic, whose old value may be any; or the length of a buffer."""
        for place in stmt.args[:1]:
            self.places(place)
        for value in stmt.args[1:]:
            self.expr(value)
        if stmt.result is not None:
            result = self.unknown(stmt.result.type)
            if not stmt.args[1:]:
                result = self.value((Range(0.0, self.limits("int").high),), result.numbers)
            self.store(stmt.result, result)

    def returned(self, expr: ir.Expr) -> Value:
        """A function's result: a quantity is kept in its range."""
        value = self.expr(expr)
        quantity = self.frames[-1].function.quantity
        contract = contracts.of_result(quantity, None, self.format) if kind_of(expr.type) == "float" else None
        return value if contract is None else self.keep_contract(expr, value, quantity, contract)

    def assign(self, stmt: ir.Assign) -> None:
        value = self.expr(stmt.value)
        node: ir.Expr = stmt.value
        variable = root(stmt.target)
        if stmt.op:
            key = cast(str, variable_key(stmt.target))
            whole = isinstance(stmt.target, ir.Local | ir.Global) and key not in self.memories
            if stmt.op in ("+", "-") and whole and self.loops:
                self.add(key, stmt, value)
            node = self.compound_of(stmt)
            value = self.operation(node, self.expr(stmt.target), value)
        param = self.out_param(variable) if kind_of(node.type) == "float" else None
        contract = self.output_contract(param) if param is not None else None
        if param is not None and contract is not None:
            value = self.keep_contract(node, value, param.quantity or param.name, contract)
        self.store(stmt.target, value)

    def out_param(self, variable: ir.Local | None) -> ir.Param | None:
        """The out parameter that a variable is, if any."""
        if variable is None or not self.frames:
            return None
        params = self.frames[-1].function.params
        return next((param for param in params if param.name == variable.name and param.direction != "in"), None)

    def output_contract(self, param: ir.Param) -> Contract | None:
        """The contract that an out parameter is kept to."""
        return contracts.of_result(param.quantity, param if self.chained else None, self.format)

    def compound_of(self, stmt: ir.Assign) -> ir.Binary:
        """The operation of `target op= value`, the same node each time."""
        operation = self.compounds.get(id(stmt))
        if operation is None:
            operation = ir.Binary(stmt.target.type, stmt.op, stmt.target, stmt.value, stmt.span)
            self.compounds[id(stmt)] = operation
        return operation

    def keep_contract(self, node: ir.Expr, value: Value, operation: str, contract: Contract) -> Value:
        """A value that others rely on, kept within its contract."""
        limits = (contract.low, min(contract.high, 1.0) if contract.high == contracts.ONE else contract.high)
        inside = all(part.low >= contract.low and part.high <= contract.high for part in value.parts)
        self.note(node, operation, not inside, BOUNDS, (hull_of(value.parts),), limits)
        if inside:
            return value
        parts = tuple([rounded(clip(part, contract.low, contract.high), self.format) for part in value.parts])
        return self.value(parts, tuple([self.numbers.fresh() for _ in parts]))

    def branch(self, stmt: ir.If) -> State | None:
        condition = self.expr(stmt.condition)
        truth_range = condition.parts[0]
        start = self.state
        ways: list[State | None] = []
        for truth, block in ((True, stmt.then), (False, stmt.otherwise)):
            if (truth_range.high == 0.0 and truth) or (truth_range.low == 1.0 and not truth):
                continue
            self.state = start.copy()
            self.learn(condition.numbers[0], truth)
            ways.append(self.block(block, self.state))
        return self.join_all(ways)

    # Stores

    def store(self, target: ir.Expr, value: Value, places: tuple[list[int], bool] | None = None) -> None:
        """Writes to a variable or a part of one; `places` is the result of `places`, if it is known already."""
        key = variable_key(target)
        if key in self.memories:
            self.places(target)  # its indices
        if key is None or key not in self.state.env:
            return
        if isinstance(target, ir.Local | ir.Global):
            self.state.env[key] = value
            return
        old = self.state.env[key]
        indices, sure = places or self.places(target)
        if 1 < len(value.parts) < 5 and value.length.low > 0.0 and sure:
            self.state.facts.learn(self.numbers, self.numbers.of("length", *value.numbers), value.length)
        parts, numbers = list(old.parts), list(old.numbers)
        for index, place in enumerate(indices):
            part, number = value.parts[index % len(value.parts)], value.numbers[index % len(value.numbers)]
            parts[place] = part if sure else part.joined(parts[place])
            numbers[place] = number if sure else self.numbers.fresh()
        self.state.env[key] = self.value(tuple(parts), tuple(numbers))

    def places(self, target: ir.Expr) -> tuple[list[int], bool]:
        """Which scalars of its variable a target is, and whether it certainly is all of these and no others."""
        if isinstance(target, ir.Local | ir.Global):
            return list(range(scalars(target.type))), True
        assert isinstance(target, ir.Swizzle | ir.Member | ir.Index)
        inner, sure = self.places(target.value)
        if isinstance(target, ir.Swizzle):
            chosen = ["xyzw".index(letter) for letter in target.components]
        elif isinstance(target, ir.Member):
            start, count = field_at(cast(Struct, target.value.type), target.field)
            chosen = list(range(start, start + count))
        else:
            index = self.expr(target.index).parts[0]
            if self.unguarded:  # where guards are inserted, no index of a store is changed
                self.check_index(target, index)
            if isinstance(target.value.type, Array):
                return inner, False
            size, count = scalars(target.type), scalars(target.value.type)
            if index.low != index.high or not 0 <= index.low < count // size:
                return inner, False
            chosen = list(range(int(index.low) * size, (int(index.low) + 1) * size))
        # an unknown column has as many candidates as the matrix has columns
        width = scalars(target.value.type)
        return [inner[base + at] for base in range(0, len(inner), width) for at in chosen], sure
