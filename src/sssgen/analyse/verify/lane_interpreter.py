"""Runs checked IR on NumPy arrays, one lane per input, and records what only an interpreter can see.

- Lanes that meet an operation which GLSL leaves undefined (a shift by 32, a division by 0, an index out of range, a
  number that float32 cannot hold, …): implementations may differ there.
- The outcomes of branches and comparisons (`branch_outcomes`).
- Lanes whose loops take more than `ROUNDS` rounds, which would take long, or hang, elsewhere.

It computes with the functions of the NumPy runtime, in float64 or with `Rounded` numbers. Literals are rounded to
float32, as in every driver. Lanes are masked: a statement is executed while some lane is active. Where few lanes are
still in a loop, or take a branch with calls, these lanes are copied and run alone.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from contextlib import AbstractContextManager, nullcontext
from typing import Any

import numpy as np

from sssgen.analyse.verify.branch_edges import JUMPS, branch_distance
from sssgen.analyse.verify.branch_outcomes import CASES, Outcomes
from sssgen.analyse.verify.few_lanes import are_few, run_alone
from sssgen.analyse.verify.lane_program import Program
from sssgen.analyse.verify.lane_values import DTYPES, Value, is_readable, spread_to_quads, zero
from sssgen.ir import nodes as ir
from sssgen.ir.intrinsics import BUILTINS
from sssgen.ir.intrinsics.table import LARGEST
from sssgen.ir.rules import element_type
from sssgen.ir.types import VOID, Matrix, Scalar, Struct, Type, Vector, components, kind_of
from sssgen.ir.types import Array as ArrayType
from sssgen.run.backends import Array
from sssgen.run.backends import call_program as calls
from sssgen.targets import numpy_runtime as rt

ROUNDS = 5000
"""The most rounds of all loops together, without those that count from a constant to a constant."""
ALL_ROUNDS = 100_000
"""The most rounds of all loops together."""

# The interpreter has arrays and silences NumPy by itself: it calls what `silent` wraps, an attribute unknown to mypy.
_ARITHMETIC: dict[str, Callable[..., Value]] = {
    "+": np.add, "-": np.subtract, "*": np.multiply, "/": np.divide, "&": np.bitwise_and, "|": np.bitwise_or,
    "^": np.bitwise_xor, "<<": rt.shift_left, ">>": rt.shift_right, "%": rt.int_remainder.__wrapped__,  # type: ignore[attr-defined]
    "<": np.less, ">": np.greater, "<=": np.less_equal, ">=": np.greater_equal, "^^": np.logical_xor,
}  # fmt: skip
_INT_DIVIDE: Callable[..., Value] = rt.int_divide.__wrapped__  # type: ignore[attr-defined]
_UNARY: dict[str, Callable[..., Value]] = {"-": np.negative, "!": np.logical_not, "~": np.invert}
_COMPARISONS = frozenset({"<", ">", "<=", ">=", "==", "!="})
ONE_THREAD = 8192
"""The most numbers that a product of vectors adds in one thread; starting more takes longer than the sum."""


class Run:
    """One run of a function in all lanes."""

    def __init__(
        self, program: Program, lanes: int, uniforms: Mapping[str, Value], outcomes: Outcomes | None = None,
        exact_literals: bool = False, limit: int = ROUNDS,
    ) -> None:  # fmt: skip
        self.program, self.lanes, self.outcomes, self.exact_literals = program, lanes, outcomes, exact_literals
        self.limit = limit
        self.undefined = np.zeros(lanes, bool)
        self.faults = np.zeros(lanes)
        """How many operations of a lane were undefined."""
        self.endless = np.zeros(lanes, bool)
        self.stopped = np.zeros(lanes, bool)
        """Lanes that were discarded, or that take too long."""
        self.active = np.ones(lanes, bool)
        self.last_mask: Array | None = None
        self.last_is_full = False
        self.frame: dict[str, Value] = {}
        self.returned: Value = None
        self.loops: list[list[Array]] = []
        self.rounds = 0
        self.all_rounds = 0
        self.work = 0
        """The number of evaluated nodes."""
        self.values = dict(uniforms)
        self.literals: dict[int, Value] = {}
        with np.errstate(all="ignore"):
            for constant in program.module.constants:
                self.values[constant.name] = self.value(constant.value)
        for variable in program.module.variables:
            self.values[variable.name] = zero(variable.type)
        self.undefined[:] = False

    def result(self, key: str, arguments: Mapping[str, Value]) -> Value:
        """The result of a function without out parameters, 0 in discarded lanes."""
        function = self.program.functions[key]
        shape = calls.grid(self.lanes)
        with np.errstate(all="ignore"), rt.precision("float64"), rt.grid(shape.rows, shape.width):
            args = [self.number(arguments[param.name]) for param in function.params]
            value, _ = self.enter(function, args)
        if self.program.neighbours:
            self.undefined = spread_to_quads(self.undefined | self.endless, shape)
        value = np.broadcast_to(value, (*np.shape(value)[:-1], self.lanes))
        return np.where(self.stopped, np.zeros_like(value), value)

    def number(self, value: Value) -> Value:
        """A value as this run computes with it."""
        return value

    def of_lanes(self, chosen: Array) -> AbstractContextManager[None]:
        """While only the chosen lanes are run, which are numbers."""
        return nullcontext()

    def unwritten(self, type_: Type) -> Value:
        """What a variable has before it is written, which GLSL does not define."""
        return zero(type_)

    # Functions

    def enter(self, function: ir.Function, args: list[Value]) -> tuple[Value, dict[str, Value]]:
        """Calls a function; returns its result, and its variables at the end."""
        frame, returned, loops = self.frame, self.returned, self.loops
        self.frame, self.loops = {}, []
        inputs = iter(args)
        for param in function.params:
            self.frame[param.name] = self.unwritten(param.type) if param.direction == "out" else next(inputs)
        self.returned = self.unwritten(function.result) if function.result != VOID else None
        active = self.active
        self.block(function.body or (), active)
        self.active = active & ~self.stopped
        result, left = self.returned, self.frame
        self.frame, self.returned, self.loops = frame, returned, loops
        return result, left

    def call(self, call: ir.Call) -> Value:
        self.program.check()
        function = self.program.functions[call.function]
        pairs = list(zip(call.args, function.params, strict=True))
        args = [self.value(arg) for arg, param in pairs if param.direction != "out"]
        places = [(self.pin(arg), param.name) for arg, param in pairs if param.direction != "in"]
        result, left = self.enter(function, args)
        for place, name in places:
            self.store(place, left[name])
        return result

    # Statements

    def block(self, block: ir.Block, active: Array) -> Array:
        """The lanes that reach the end of a block."""
        for stmt in block:
            self.active = active
            left = self.statement(stmt, active)
            if left is not active and not left.any():
                return left
            active = left
        return active

    def statement(self, stmt: ir.Stmt, active: Array) -> Array:
        if isinstance(stmt, ir.Declare):
            self.frame[stmt.name] = self.unwritten(stmt.type) if stmt.value is None else self.value(stmt.value)
        elif isinstance(stmt, ir.Assign):
            place = self.pin(stmt.target)
            value = self.value(stmt.value)
            if stmt.op:
                value = self.operate(stmt, stmt.op, place.type, stmt.value.type, self.value(place), value)
            self.store(place, value)
        elif isinstance(stmt, ir.Evaluate):
            self.value(stmt.call)
        elif isinstance(stmt, ir.If):
            condition = self.condition(stmt.condition, stmt)
            active = self.active
            yes, no = active & condition, active & ~condition
            yes = self.branch(stmt, stmt.then, yes) if yes.any() else yes
            no = self.branch(stmt, stmt.otherwise, no) if no.any() else no
            return (yes | no) & ~self.stopped
        elif isinstance(stmt, ir.For):
            if stmt.init is not None:
                self.statement(stmt.init, active)
            return self.loop(stmt, stmt.condition, stmt.body, stmt.step, active)
        elif isinstance(stmt, ir.While):
            return self.loop(stmt, stmt.condition, stmt.body, None, active)
        elif isinstance(stmt, ir.Return):
            if stmt.value is not None:
                self.returned = self.choose(self.active, self.value(stmt.value), self.returned)
            return np.zeros_like(active)
        elif isinstance(stmt, ir.Discard):
            self.stopped = self.stopped | active
            return np.zeros_like(active)
        elif isinstance(stmt, ir.Break | ir.Continue):
            index = 0 if isinstance(stmt, ir.Break) else 1
            self.loops[-1][index] = self.loops[-1][index] | active
            return np.zeros_like(active)
        return active & ~self.stopped if self.stopped.any() else active

    def branch(self, stmt: ir.If, block: ir.Block, lanes: Array) -> Array:
        if id(stmt) in self.program.long_branches and not self.program.neighbours and are_few(lanes):
            return run_alone(self, lanes, lambda few: self.block(block, few))
        return self.block(block, lanes)

    def loop(
        self, loop: ir.Stmt, condition: ir.Expr | None, body: ir.Block, step: ir.Stmt | None, active: Array
    ) -> Array:
        left = np.zeros_like(active)
        counts = id(loop) in self.program.counted
        while True:
            if not self.program.neighbours and are_few(active):
                return left | run_alone(self, active, lambda few: self.loop(loop, condition, body, step, few))
            self.active = active
            if condition is not None:
                holds = self.condition(condition, loop)
                active = self.active
                left = left | active & ~holds
                active = active & holds
            if not active.any():
                return left & ~self.stopped
            self.program.check()
            self.all_rounds += 1
            self.rounds += not counts
            if self.rounds > self.limit or self.all_rounds > ALL_ROUNDS:
                self.endless = self.endless | active
                self.stopped = self.stopped | active
                return left & ~self.stopped
            self.loops.append([np.zeros_like(active), np.zeros_like(active)])
            through = self.block(body, active)
            breaks, continues = self.loops.pop()
            left = left | breaks
            active = (through | continues) & ~self.stopped
            if step is not None and active.any():
                self.active = active
                self.statement(step, active)

    def condition(self, expr: ir.Expr, node: object) -> Array:
        condition: Array = self.value(expr)
        if np.shape(condition) != (self.lanes,):
            condition = np.broadcast_to(condition, (self.lanes,))
        if self.outcomes is not None:
            self.outcomes.branch(node, condition, self.active)
        return condition

    def store(self, target: ir.Expr, value: Value) -> None:
        """Assigns to a variable or a part of one, in the active lanes."""
        if isinstance(target, ir.Local | ir.Global):
            variables = self.frame if isinstance(target, ir.Local) else self.values
            variables[target.name] = self.choose(self.active, value, variables[target.name])
            return
        assert isinstance(target, ir.Swizzle | ir.Index | ir.Member)
        whole = self.value(target.value)
        if isinstance(target, ir.Swizzle):
            new = rt.store_swizzle(whole, target.components, value)
        elif isinstance(target, ir.Index):
            new = rt.store_index(whole, self.value(target.index), value)
        else:
            new = whole.replace(**{target.field: value})
        self.store(target.value, new)

    def pin(self, place: ir.Expr) -> ir.Expr:
        """A place to write to with its indices as they are now."""
        if isinstance(place, ir.Index):
            return place._replace(value=self.pin(place.value), index=_FixedIndex(self.index(place)))  # type: ignore[arg-type]  # our own
        if isinstance(place, ir.Swizzle | ir.Member):
            return place._replace(value=self.pin(place.value))
        return place

    def choose(self, mask: Array, yes: Value, no: Value) -> Value:
        if mask is not self.last_mask:  # of a block of statements it is the same
            self.last_mask, self.last_is_full = mask, bool(mask.all())
        return yes if self.last_is_full else rt.select(mask, yes, no)

    # Expressions

    def value(self, expr: ir.Expr) -> Value:
        self.work += 1
        return self.number(_EVALUATE[type(expr)](self, expr))

    def literal(self, literal: ir.Literal) -> Value:
        value = self.literals.get(id(literal))
        if value is None:
            kind = kind_of(literal.type)
            number: Any = literal.value
            if kind == "float" and not self.exact_literals:
                number = np.float32(number)
            elif kind in ("int", "uint"):
                number = int(number) & 0xFFFFFFFF
                number = number - 2**32 if kind == "int" and number >= 2**31 else number
            value = self.literals[id(literal)] = np.full(1, number, DTYPES[kind])
        return value

    def local(self, expr: ir.Local) -> Value:
        return self.frame[expr.name]

    def variable(self, expr: ir.Global) -> Value:
        return self.values[expr.name]

    def unary(self, expr: ir.Unary) -> Value:
        return _UNARY[expr.op](self.value(expr.operand))

    def binary(self, expr: ir.Binary) -> Value:
        if expr.op in ("&&", "||"):
            left = self.condition(expr.left, expr)
            right = self.within(left if expr.op == "&&" else ~left, expr.right)
            if right is None:
                return left
            if self.outcomes is not None:
                self.outcomes.branch(
                    expr.right, np.broadcast_to(right, (self.lanes,)), self.active & (left == (expr.op == "&&"))
                )
            return left & right if expr.op == "&&" else left | right
        left, right = self.value(expr.left), self.value(expr.right)
        return self.operate(expr, expr.op, expr.left.type, expr.right.type, left, right)

    def within(self, mask: Array, expr: ir.Expr) -> Value:
        """The value of an expression that only these lanes evaluate; None where no lane does."""
        active = self.active
        self.active = active & mask
        value = self.value(expr) if self.active.any() else None
        self.active = active & ~self.stopped
        return value

    def operate(self, node: object, op: str, left_type: Type, right_type: Type, left: Value, right: Value) -> Value:
        if op in _COMPARISONS and isinstance(left, np.ndarray):
            left, right = self.compared(node, 0, left, right)
        if op in ("==", "!="):
            same = rt.equals(left, right)
            return same if op == "==" else ~same
        kind = kind_of(left_type)
        if kind == "float":
            if op == "*" and isinstance(left_type, Matrix) and not isinstance(right_type, Scalar):
                function: Any = rt.mat_mul if isinstance(right_type, Matrix) else rt.mat_vec
                return self.finite(function.__wrapped__(left, right))
            if op == "*" and isinstance(left_type, Vector) and isinstance(right_type, Matrix):
                vec_mat: Any = rt.vec_mat
                return self.finite(vec_mat.__wrapped__(left, right))
            result = _ARITHMETIC[op](left, right)
            return result if op in _COMPARISONS else self.finite(result)
        if op in ("<<", ">>"):
            self.require((right >= 0) & (right < 32))
        elif op in ("/", "%"):
            allowed = right != 0
            if kind == "int":
                allowed = allowed & ~((left == -(2**31)) & (right == -1))
            if op == "%" and kind == "int":
                allowed = allowed & (left >= 0) & (right >= 0)
            self.require(allowed)
            if op == "/":
                return _INT_DIVIDE(left, right)
        return _ARITHMETIC[op](left, right)

    def select(self, expr: ir.Select) -> Value:
        condition = self.condition(expr.condition, expr)
        yes, no = self.within(condition, expr.yes), self.within(~condition, expr.no)
        if yes is None or no is None:
            known = no if yes is None else yes
            return zero(expr.type) if known is None else known  # none where the condition has lost every lane
        return rt.select(condition, yes, no)

    def intrinsic(self, expr: ir.Intrinsic) -> Value:
        args = [self.value(arg) for arg in expr.args]
        name = expr.name
        row = BUILTINS[name]
        self.compare_inside(expr, args)
        if row.defined is not None and (name != "abs" or kind_of(expr.type) == "int"):
            self.require(np.asarray(row.defined(rt, *args)))
        if row.kind == "fetch" and len(args) > 1 and np.asarray(args[1]).dtype.kind == "f":
            self.require(is_readable(args[0], args[1]))
            if args[0].compare and name.startswith("textureGather"):
                self.require((args[2] >= 0.0) & (args[2] <= 1.0))  # only depths of fixed point clamp their references
        if row.kind == "derivative" and not self.active.all():
            self.require(np.zeros(1, bool))
        level = 1 if row.size_query else 2 if row.by_texel else 0
        if 0 < level < len(args):
            last = len(args[0].levels) - 1
            self.require((args[level] >= 0) & (args[level] <= last))
            args[level] = np.clip(args[level], 0, last)
        function: Any = getattr(rt, "not_" if name == "not" else name)
        args = self.read_from(row, args)
        result = self.on_side(expr, args, getattr(function, "__wrapped__", function)(*args))
        if isinstance(result, np.ndarray) and result.dtype.kind == "f":
            return self.inexact(row, args, self.finite(result.astype(np.float64, copy=False)))
        return np.asarray(result)

    def compared(self, node: object, comparison: int, left: Value, right: Value) -> tuple[Value, Value]:
        """Records a comparison, and returns what is compared."""
        if self.outcomes is not None:
            self.outcomes.comparison(node, comparison, left, right, self.active)
        return left, right

    def compare_inside(self, expr: ir.Intrinsic, args: list[Value]) -> None:
        """Records the comparisons inside a builtin; `args` become what is compared where its result jumps."""
        for comparison, (left, right) in enumerate(CASES.get(expr.name, ())):
            other = right if isinstance(right, float) else args[right]
            pair = self.compared(expr, comparison, args[left], other)
            if expr.name in JUMPS:
                args[left] = pair[0]
                if not isinstance(right, float):
                    args[right] = pair[1]

    def on_side(self, expr: ir.Intrinsic, args: list[Value], result: Value) -> Value:
        """The result of a builtin that branches on a number which it computes itself."""
        distance = branch_distance(expr.name, args) if self.outcomes is not None else None
        if distance is not None:
            self.compared(expr, 0, distance, 0.0)
        return result

    def read_from(self, row: Any, args: list[Value]) -> list[Value]:
        """The arguments of a builtin; those of a read from a texture may have an error."""
        return args

    def inexact(self, row: Any, args: list[Value], result: Value) -> Value:
        """The result of a builtin with its error."""
        return result

    def construct(self, expr: ir.Construct) -> Value:
        type_ = expr.type
        args = [self.value(arg) for arg in expr.args]
        if isinstance(type_, Struct):
            return rt.Record(**{field.name: arg for field, arg in zip(type_.fields, args, strict=True)})
        if isinstance(type_, ArrayType):
            return rt.array(*args)
        kind = kind_of(type_)
        args = [self.convert(kind, kind_of(arg.type), value) for arg, value in zip(expr.args, args, strict=True)]
        if isinstance(type_, Matrix):
            if len(args) > 1:
                return rt.mat(type_.columns, *args)
            shape = rt.resize if isinstance(expr.args[0].type, Matrix) else rt.diagonal
            return shape(type_.columns, args[0], type_.rows)
        size = components(type_)
        if len(args) > 1:
            return rt.vec(*args)[:size]
        given = expr.args[0].type
        if isinstance(given, Scalar):
            return rt.splat(size, args[0]) if size > 1 else args[0]
        if isinstance(given, Matrix):
            return args[0].reshape(-1, args[0].shape[-1])[: size if size > 1 else 1][slice(None) if size > 1 else 0]
        return args[0][0] if size == 1 else args[0][:size]

    def convert(self, kind: str, old: str, value: Value) -> Value:
        if kind == old:
            return value
        if old == "float" and kind in ("int", "uint"):
            value = np.asarray(value)
            low, high = (-(2.0**31) - 1.0, 2.0**31) if kind == "int" else (-1e-300, 2.0**32)
            self.require((value > low) & (value < high))
        if kind == "float":
            return np.asarray(value).astype(np.float64)
        return {"int": rt.to_int, "uint": rt.to_uint, "bool": rt.to_bool}[kind](value)

    def swizzle(self, expr: ir.Swizzle) -> Value:
        return rt.swizzle(self.value(expr.value), expr.components)

    def element(self, expr: ir.Index) -> Value:
        value = self.value(expr.value)
        return rt.index(value, self.index(expr))

    def index(self, expr: ir.Index) -> Value:
        place = self.value(expr.index)
        elements = element_type(expr.value.type)
        assert elements is not None
        if not isinstance(expr.index, ir.Literal | _FixedIndex):
            self.require((place >= 0) & (place < elements[1]))
        return place.astype(np.int64)

    def member(self, expr: ir.Member) -> Value:
        return getattr(self.value(expr.value), expr.field)

    # Undefined lanes

    def require(self, holds: Value) -> None:
        """Active lanes without this are undefined."""
        holds = np.asarray(holds)
        if not holds.all():
            lanes = holds.all(axis=tuple(range(holds.ndim - 1))) if holds.ndim > 1 else holds
            faulty = self.active & ~lanes
            self.undefined = self.undefined | faulty
            self.faults = self.faults + faulty

    def finite(self, value: Value) -> Value:
        """The result of an operation; the lanes where it is no finite float32 are undefined."""
        self.require_size(value, LARGEST)
        return value

    def require_size(self, value: Array, largest: float) -> None:
        """Active lanes with a number beyond the largest, or NaN, are undefined."""
        flat = value.reshape(-1)  # most values are small: their squares are added in a third of the time
        if flat.size > ONE_THREAD or not flat.dot(flat) <= largest * largest:
            self.require(np.abs(value) <= largest)


class _FixedIndex:
    """An index that is computed already."""

    __slots__ = ("value",)

    def __init__(self, value: Value) -> None:
        self.value = value


_EVALUATE: dict[type, Callable[[Any, Any], Value]] = {
    ir.Literal: Run.literal, ir.Local: Run.local, ir.Global: Run.variable, ir.Unary: Run.unary,
    ir.Binary: Run.binary, ir.Select: Run.select, ir.Call: Run.call, ir.Intrinsic: Run.intrinsic,
    ir.Construct: Run.construct, ir.Swizzle: Run.swizzle, ir.Index: Run.element, ir.Member: Run.member,
    _FixedIndex: lambda _, known: known.value,
}  # fmt: skip
