"""Hypothesis strategies for well-typed IR.

`modules()` generates modules in the form of the checker's output, without redundant nodes (no constructor without an
effect, no sign before a literal), so that the source that `as_source` writes gives the same module again.
"""

from __future__ import annotations

from typing import NamedTuple, TypeVar

from hypothesis import strategies as st

from sssgen.ir import nodes as ir
from sssgen.ir.intrinsics import BUILTINS
from sssgen.ir.rules import element_type, operator_type, prefix_type
from sssgen.ir.signatures import instantiate, parse, resolve
from sssgen.ir.transform import rewrite
from sssgen.ir.types import (
    BOOL,
    FLOAT,
    INT,
    UINT,
    VOID,
    Array,
    Field,
    Matrix,
    Sampler,
    Scalar,
    Struct,
    Type,
    Vector,
    components,
    kind_of,
    vector_of,
)
from sssgen.lang.check.quantities import QUANTITIES

T = TypeVar("T")
NOWHERE = ir.NOWHERE
KINDS = ("float", "int", "uint", "bool")
PLAIN: list[Type] = [vector_of(kind, size) for kind in KINDS for size in (1, 2, 3, 4)]
PLAIN += [Matrix(size, size) for size in (2, 3, 4)]
_USUAL: list[Type] = [FLOAT, INT, Vector("float", 2)]
BINARY = ("+", "-", "*", "/", "%", "<<", ">>", "<", ">", "<=", ">=", "==", "!=", "&", "^", "|", "&&", "^^", "||")
ASSIGNED = ("+", "-", "*", "/", "%", "<<", ">>", "&", "|", "^")

floats32 = st.floats(width=32, allow_nan=False, allow_infinity=False)
# no \\ at the end of a line, where it would join the next line
_lines = st.text("ab \"\\'*é→\x00\x1b", max_size=8).map(lambda line: line.rstrip().rstrip("\\").rstrip())
docs = st.lists(_lines, max_size=3).map("\n".join).map(lambda doc: doc.strip("\n").rstrip())
spans = st.builds(
    ir.Span, st.sampled_from(["a.sss", "b c/d.sss", 'odd "name"\n']), *(st.integers(1, 9) for _ in range(4))
)


class Overload(NamedTuple):
    name: str
    types: tuple[Type, ...]


def _overloads() -> dict[Type, list[Overload]]:
    """The builtins by their result, without those that require constants."""
    results: dict[Type, dict[Overload, None]] = {}
    for name, row in BUILTINS.items():
        if row.constant:
            continue
        for signature in row.signatures:
            for size in (1, 2, 3, 4):
                _, *params = (instantiate(type_name, size) for type_name in parse(signature))
                types = tuple(param for param in params if param is not None)
                result = resolve(name, types)
                if result is not None and len(types) == len(params):
                    results.setdefault(result, {})[Overload(name, types)] = None
    return {result: list(overloads) for result, overloads in results.items()}


def _operations() -> dict[Type, list[tuple[str, Type, Type]]]:
    """The binary operators by their result."""
    results: dict[Type, list[tuple[str, Type, Type]]] = {}
    for left in PLAIN:
        for right in PLAIN:
            for op in BINARY:
                result = operator_type(op, left, right)
                if result is not None:
                    results.setdefault(result, []).append((op, left, right))
    return results


OVERLOADS, OPERATIONS = _overloads(), _operations()


def literals(kind: str) -> st.SearchStrategy[ir.Expr]:
    """Literals of one kind."""
    values: st.SearchStrategy[float] = {
        "float": floats32,
        "int": st.integers(-(2**31), 2**31 - 1),
        "uint": st.integers(0, 2**32 - 1),
        "bool": st.booleans(),
    }[kind]
    return values.map(lambda value: ir.Literal(Scalar(kind), value, NOWHERE))


@st.composite
def modules(draw: st.DrawFn) -> ir.Module:
    """A whole module without spans: structs, constants, uniforms, functions and slots."""
    return _Generator(draw).module()


@st.composite
def placed_modules(draw: st.DrawFn) -> ir.Module:
    """A module with spans."""
    return placed(draw(modules()), draw(st.lists(spans, min_size=1, max_size=5)))


def placed(module: ir.Module, choices: list[ir.Span]) -> ir.Module:
    """The module with these spans assigned to its nodes; some nodes get none."""
    count = 0

    def deal(node: T) -> T:
        nonlocal count
        count += 1
        span = (*choices, NOWHERE)[count % (len(choices) + 1)]
        return node._replace(span=span)  # type: ignore[attr-defined,no-any-return]

    def restate(stmt: ir.Stmt) -> ir.Stmt:
        changes: dict[str, object] = {}
        for name, value in stmt._asdict().items():
            if name in ("then", "otherwise", "body"):
                changes[name] = tuple(map(restate, value))
            elif name in ("init", "step") and value is not None:
                changes[name] = restate(value)
            elif name in ("target", "value", "call", "condition") and value is not None:
                changes[name] = rewrite(value, deal)
        return deal(stmt._replace(**changes))  # type: ignore[arg-type]

    def function(old: ir.Function) -> ir.Function:
        body = tuple(map(restate, old.body)) if old.body is not None else None
        return deal(old._replace(params=tuple(map(deal, old.params)), body=body))

    return ir.Module(
        tuple(map(deal, module.structs)),
        tuple(deal(constant._replace(value=rewrite(constant.value, deal))) for constant in module.constants),
        tuple(map(deal, module.uniforms)),
        tuple(map(function, module.functions)),
    )


class _Generator:
    """Draws the parts of one module, and tracks the scope."""

    def __init__(self, draw: st.DrawFn) -> None:
        self.draw = draw
        self.structs: list[Struct] = []
        self.globals: list[ir.Global] = []
        self.functions: list[ir.Function] = []
        self.scopes: list[list[ir.Local]] = []
        self.read_only: set[str] = set()
        """Loop counters and quantities, which are never assigned."""
        self.constant = False
        self.result: Type = VOID
        self.names = 0

    def pick(self, choices: list[T]) -> T:
        return self.draw(st.sampled_from(choices))

    def chance(self, count: int) -> bool:
        return self.draw(st.integers(1, count)) == count

    def repetitions(self, fewest: int, most: int) -> range:
        return range(self.draw(st.integers(fewest, most)))

    def name(self, letter: str) -> str:
        self.names += 1
        return f"{letter}{self.names}"

    def quantity(self, type_: Type) -> str:
        fitting = [name for name, plain in QUANTITIES.items() if plain == type_]
        return self.pick(fitting) if fitting and self.chance(4) else ""

    def type(self) -> Type:
        if self.structs and self.chance(6):
            return self.pick(self.structs)
        plain = self.pick(PLAIN)
        return Array(plain, self.draw(st.integers(1, 3))) if self.chance(8) else plain

    # Declarations

    def module(self) -> ir.Module:
        structs = [self.struct() for _ in self.repetitions(0, 2)]
        self.constant = True
        constants = [self.module_constant() for _ in self.repetitions(0, 2)]
        self.constant = False
        uniforms = [self.uniform() for _ in self.repetitions(1, 4)]
        for _ in self.repetitions(1, 4):
            function = self.function()
            if all(function.key != other.key for other in self.functions):
                self.functions.append(function)
        return ir.Module(tuple(structs), tuple(constants), tuple(uniforms), tuple(self.functions))

    def struct(self) -> ir.StructDecl:
        types = [self.type() for _ in self.repetitions(1, 3)]
        fields = tuple(Field(self.name("m"), type_, self.quantity(type_)) for type_ in types)
        self.structs.append(Struct(self.name("S"), fields))
        return ir.StructDecl(self.structs[-1], self.draw(docs), NOWHERE)

    def module_constant(self) -> ir.Constant:
        type_ = self.pick(PLAIN)
        constant = ir.Constant(self.name("K"), type_, self.expr(type_, 2), NOWHERE)
        self.globals.append(ir.Global(type_, constant.name, NOWHERE))
        return constant

    def uniform(self) -> ir.Uniform:
        hints: list[tuple[str, tuple[float | str, ...]]] = []
        default: tuple[float, ...] = ()
        type_: Type
        if self.chance(3):
            type_, quantity = Sampler(self.pick(["2D", "3D", "Cube"])), ""
            hints += [("default_white", ())] if self.chance(2) else []
        else:
            type_ = self.pick(PLAIN)
            type_ = Array(type_, 2) if self.chance(8) else type_
            quantity = self.quantity(type_)
            kind = kind_of(type_.element if isinstance(type_, Array) else type_)
            values = [self.draw(literals(kind)) for _ in range(components(type_))]
            default = tuple(float(literal.value) for literal in values if isinstance(literal, ir.Literal))
            if kind != "bool" and kind_of(type_) and max(map(abs, default)) < 1e6 and self.chance(2):
                hints.append(("hint_range", (min(default) - 1.0, max(default) + 0.5)))
        if self.chance(3):
            hints.append(("alias", ("other", "an → other\\")))
        uniform = ir.Uniform(self.name("u"), type_, default, tuple(hints), quantity, self.draw(docs), NOWHERE)
        self.globals.append(ir.Global(type_, uniform.name, NOWHERE))
        return uniform

    def function(self) -> ir.Function:
        params: list[ir.Param] = []
        for _ in self.repetitions(0, 3):
            type_ = self.type() if self.chance(2) else self.pick(_USUAL)
            direction = self.pick(["in", "in", "in", "out", "inout"])
            quantity = self.quantity(type_) if direction == "in" else ""
            params.append(ir.Param(self.name("p"), type_, direction, quantity, NOWHERE))
        self.scopes = [[ir.Local(param.type, param.name, NOWHERE) for param in params]]
        self.read_only = {param.name for param in params if param.quantity}
        self.result = VOID if self.chance(4) else self.type()
        quantity = self.quantity(self.result)
        body: ir.Block | None = None
        if not self.chance(5):
            body = self.block(3, False)
            if self.result != VOID:
                body += (ir.Return(self.expr(self.result, 3), NOWHERE),)
        name = self.pick(["f", "g", "h"])
        return ir.Function(name, tuple(params), self.result, quantity, body, self.draw(docs), NOWHERE)

    # Statements

    def block(self, depth: int, loop: bool) -> ir.Block:
        self.scopes.append([])
        block = tuple(stmt for _ in self.repetitions(1, 4) for stmt in self.stmt(depth, loop))
        self.scopes.pop()
        return block

    def stmt(self, depth: int, loop: bool) -> ir.Block:
        choices = ["declare", "declare", "assign", "assign", "evaluate", "leave"]
        kind = self.pick(choices + (["if", "for", "while"] if depth else []))
        if kind == "declare":
            type_ = self.type()
            value = None if self.chance(6) else self.expr(type_, depth)
            return (self.declare(self.name("x"), type_, value),)
        if kind == "assign":
            return self.assign(depth)
        if kind == "evaluate":
            calls = [call for function in self.functions if (call := self.call(function, 1)) is not None]
            return (ir.Evaluate(self.pick(calls), NOWHERE),) if calls else ()
        if kind == "if":
            condition = self.expr(BOOL, depth)
            otherwise = self.block(depth - 1, loop) if self.chance(2) else ()
            return (ir.If(condition, self.block(depth - 1, loop), otherwise, NOWHERE),)
        if kind in ("for", "while"):
            return self.loop(depth - 1, kind == "for")
        if loop and self.chance(2):
            return (ir.Break(NOWHERE),)
        if self.chance(4):
            return (ir.Discard(NOWHERE),)
        value = self.expr(self.result, 1) if self.result != VOID else None
        return (ir.Return(value, NOWHERE),)

    def declare(self, name: str, type_: Type, value: ir.Expr | None) -> ir.Declare:
        self.scopes[-1].append(ir.Local(type_, name, NOWHERE))
        return ir.Declare(name, type_, value, NOWHERE)

    def loop(self, depth: int, is_for: bool) -> ir.Block:
        type_ = self.pick([INT, UINT])
        counter = ir.Local(type_, self.name("i"), NOWHERE)
        start, stop, step = (ir.Literal(type_, value, NOWHERE) for value in (0, 4, 1))
        condition = ir.Binary(BOOL, "<", counter, stop, NOWHERE)
        next_round = ir.Assign(counter, "+", step, NOWHERE)
        self.read_only.add(counter.name)
        outer = self.declare(counter.name, type_, start)
        body = self.block(depth, True)
        if is_for:
            self.scopes[-1].pop()
            body += (ir.Continue(NOWHERE),) if self.chance(4) else ()
            return (ir.For(outer, condition, next_round, body, NOWHERE),)
        return (outer, ir.While(condition, (*body, next_round), NOWHERE))

    def targets(self, type_: Type | None = None) -> list[ir.Expr]:
        """Possible targets of an assignment: variables, and their parts."""
        results: list[ir.Expr] = []
        for local in self.locals():
            if local.name in self.read_only:
                continue
            results.append(local)
            if isinstance(local.type, Vector):
                results.append(ir.Swizzle(vector_of(local.type.kind, 2), local, "yx", NOWHERE))
            if isinstance(local.type, Struct):
                plain = [field for field in local.type.fields if not field.quantity]
                results += [ir.Member(field.type, local, field.name, NOWHERE) for field in plain]
            element = element_type(local.type)
            if element is not None:
                index = ir.Literal(INT, element[1] - 1, NOWHERE)
                results.append(ir.Index(element[0], local, index, NOWHERE))
        return [target for target in results if type_ in (None, target.type)]

    def assign(self, depth: int) -> ir.Block:
        targets = self.targets()
        if not targets:
            return ()
        target = self.pick(targets)
        operators = [
            (op, right) for op in ASSIGNED for right in PLAIN if operator_type(op, target.type, right) == target.type
        ]
        op, type_ = self.pick(operators) if operators and self.chance(2) else ("", target.type)
        return (ir.Assign(target, op, self.expr(type_, depth), NOWHERE),)

    # Expressions

    def locals(self) -> list[ir.Local]:
        return [local for scope in self.scopes for local in scope] if not self.constant else []

    def expr(self, type_: Type, depth: int) -> ir.Expr:
        """An expression of a type, with a depth of at most `depth` operators if the type allows it."""
        table: list[ir.Expr] = [*self.locals(), *self.globals]
        named = [variable for variable in table if variable.type == type_]
        if named and self.chance(2):
            return self.pick(named)
        makers = [self.operation, self.builtin, self.select, self.part, self.prefix, self.called]
        result = self.pick(makers)(type_, depth - 1) if depth > 0 and self.chance(2) else None
        return result if result is not None else self.constructed(type_, depth)

    def constructed(self, type_: Type, depth: int) -> ir.Expr:
        """A literal or a constructor."""
        if isinstance(type_, Scalar):
            if depth > 0 and self.chance(3):
                other = Scalar(self.pick([kind for kind in KINDS if kind != type_.kind]))
                inner = self.expr(other, depth - 1)
                if not isinstance(inner, ir.Literal):  # the checker converts literals
                    return ir.Construct(type_, (inner,), NOWHERE)
            return self.draw(literals(type_.kind))
        return ir.Construct(type_, tuple(self.expr(part, depth - 1) for part in self.parts(type_)), NOWHERE)

    def parts(self, type_: Type) -> list[Type]:
        """The types of a constructor's arguments."""
        if isinstance(type_, Struct):
            return [field.type for field in type_.fields]
        if isinstance(type_, Array):
            return [type_.element] * type_.length
        kind = Scalar(kind_of(type_))
        if isinstance(type_, Matrix):
            columns, other = type_.columns, self.pick([size for size in (2, 3, 4) if size != type_.columns])
            column = Vector("float", type_.rows)
            return self.pick([[kind], [column] * columns, [kind] * components(type_), [Matrix(other, other)]])
        assert isinstance(type_, Vector)
        converted = Vector(self.pick([other for other in KINDS if other != type_.kind]), type_.size)
        split: list[Type] = [kind, vector_of(type_.kind, type_.size - 1)]
        return self.pick([[kind], [kind] * type_.size, [converted], split])

    def operation(self, type_: Type, depth: int) -> ir.Expr | None:
        if type_ not in OPERATIONS:
            return None
        op, left, right = self.pick(OPERATIONS[type_])
        return ir.Binary(type_, op, self.expr(left, depth), self.expr(right, depth), NOWHERE)

    def prefix(self, type_: Type, depth: int) -> ir.Expr | None:
        ops = [op for op in "-!~" if prefix_type(op, type_) is not None]
        operand = self.expr(type_, depth) if ops else None
        if operand is None or isinstance(operand, ir.Literal):  # the checker folds the sign of a literal
            return None
        return ir.Unary(type_, self.pick(ops), operand, NOWHERE)

    def select(self, type_: Type, depth: int) -> ir.Expr:
        yes, no = self.expr(type_, depth), self.expr(type_, depth)
        return ir.Select(type_, self.expr(BOOL, depth), yes, no, NOWHERE)

    def builtin(self, type_: Type, depth: int) -> ir.Expr | None:
        if type_ not in OVERLOADS:
            return None
        overload = self.pick(OVERLOADS[type_])
        if self.constant and BUILTINS[overload.name].kind in ("fetch", "derivative"):
            return None
        args: list[ir.Expr] = []
        for param in overload.types:
            samplers = [sampler for sampler in self.globals if sampler.type == param]
            if isinstance(param, Sampler):
                if not samplers:
                    return None
                args.append(self.pick(samplers))
            else:
                args.append(self.expr(param, depth))
        return ir.Intrinsic(type_, overload.name, tuple(args), NOWHERE)

    def part(self, type_: Type, depth: int) -> ir.Expr | None:
        """A swizzle, an index or a member."""
        fields = [(struct, field) for struct in self.structs for field in struct.fields if field.type == type_]
        if fields and self.chance(2):
            struct, field = self.pick(fields)
            return ir.Member(type_, self.expr(struct, depth), field.name, NOWHERE)
        if isinstance(type_, Scalar | Vector) and self.chance(2):
            size = self.draw(st.integers(2, 4))
            letters = "".join(self.pick(list("xyzw"[:size])) for _ in range(components(type_)))
            return ir.Swizzle(type_, self.expr(Vector(type_.kind, size), depth), letters, NOWHERE)
        if not isinstance(type_, Scalar | Vector | Matrix):
            return None
        whole: Type = Array(type_, 2)
        if isinstance(type_, Scalar) and self.chance(2):
            whole = Vector(type_.kind, 2)
        counters = [local for local in self.locals() if local.type in (INT, UINT)]
        index: ir.Expr = ir.Literal(self.pick([INT, UINT]), self.draw(st.integers(0, 1)), NOWHERE)
        index = self.pick(counters) if counters and self.chance(2) else index
        return ir.Index(type_, self.expr(whole, depth), index, NOWHERE)

    def called(self, type_: Type, depth: int) -> ir.Expr | None:
        fitting = [function for function in self.functions if function.result == type_]
        return self.call(self.pick(fitting), depth) if fitting else None

    def call(self, function: ir.Function, depth: int) -> ir.Expr | None:
        args: list[ir.Expr] = []
        if self.constant:
            return None
        for param in function.params:
            if param.direction == "in":
                args.append(self.expr(param.type, depth))
            else:
                targets = self.targets(param.type)
                if not targets:
                    return None
                args.append(self.pick(targets))
        return ir.Call(function.result, function.key, tuple(args), NOWHERE)
