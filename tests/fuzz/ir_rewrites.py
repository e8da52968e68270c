"""Rewrites of functions that keep their results, as a search for faults of what translates them.

Expressions are disguised (`x` → `x * 1.0`, `one ? x : 0`, `T[2](x, 0)[zero]`, `transpose(transpose(m))`), statements
are wrapped in control flow that runs once, loops are split in two, branches swapped, dead code is added, expressions
are moved into functions and variables, variables into a struct, and calls are replaced by the bodies of functions.
What holds is not known to compilers: it depends on the uniform of `known_answers`.
"""

from __future__ import annotations

from collections.abc import Iterator
from random import Random

from known_answers import SWITCHES
from sssgen.ir import nodes as ir
from sssgen.ir.intrinsics import BUILTINS
from sssgen.ir.transform import Transformer, rewrite, rewrite_block
from sssgen.ir.types import (
    BOOL,
    BY_NAME,
    INT,
    VOID,
    Array,
    Field,
    Matrix,
    Scalar,
    Struct,
    Type,
    Vector,
    kind_of,
)
from sssgen.ir.walk import operands, root, statements, subexpressions
from sssgen.passes.scopes import declared, fresh, outs_of, rename_locals, separate

AT = ir.NOWHERE
LARGEST = 400
"""Functions with more statements are only disguised."""


def switch(component: str) -> ir.Expr:
    """A component of the uniform: x is 0, y is 1, z is 2, w is 3."""
    return ir.Swizzle(INT, ir.Global(BY_NAME["ivec4"], SWITCHES, AT), component, AT)


def number(value: int) -> ir.Literal:
    return ir.Literal(INT, value, AT)


def condition(random: Random, holds: bool) -> ir.Expr:
    """A comparison that holds, or does not."""
    component, value = random.choice(tuple(zip("xyzw", range(4), strict=True)))
    other = value if holds else value + 1
    if random.random() < 0.3:
        return (
            ir.Binary(BOOL, "<", switch(component), number(other + holds), AT)
            if holds
            else ir.Binary(BOOL, ">", switch(component), number(other), AT)
        )
    return ir.Binary(BOOL, "==", switch(component), number(other), AT)


def zero(type_: Type) -> ir.Expr:
    """The value 0 of a type."""
    if isinstance(type_, Scalar):
        values = {"float": 0.0, "int": 0, "uint": 0, "bool": False}
        return ir.Literal(type_, values[type_.kind], AT)
    if isinstance(type_, Struct):
        return ir.Construct(type_, tuple([zero(field.type) for field in type_.fields]), AT)
    if isinstance(type_, Array):
        return ir.Construct(type_, tuple([zero(type_.element)] * type_.length), AT)
    return ir.Construct(type_, (zero(Scalar(kind_of(type_))),), AT)


def jumps(block: ir.Block) -> bool:
    """Whether a `break` or `continue` of an outer loop is in it."""
    for stmt in block:
        if isinstance(stmt, ir.Break | ir.Continue):
            return True
        if isinstance(stmt, ir.If) and (jumps(stmt.then) or jumps(stmt.otherwise)):
            return True
    return False


def is_pure(expr: ir.Expr) -> bool:
    """Whether it may be moved before its statement: no calls, derivatives or textures."""
    return not any(
        isinstance(part, ir.Call)
        or (isinstance(part, ir.Intrinsic) and BUILTINS[part.name].kind in ("fetch", "derivative"))
        for part in subexpressions(expr)
    )


class Rewriter(Transformer):
    """Rewrites the functions of a module; `strength` is the share of nodes that change."""

    def __init__(self, module: ir.Module, random: Random, strength: float) -> None:
        super().__init__()
        self.module, self.random, self.strength = module, random, strength
        self.by_key = {function.key: function for function in module.functions}
        self.outs = outs_of(module.functions)
        self.names = 0
        self.added: list[ir.Function] = []
        self.structs: list[ir.StructDecl] = []
        self.is_large = False

    def module_rewritten(self) -> ir.Module:
        functions: list[ir.Function] = []
        for function in self.module.functions:
            self.added = []
            new = self.function(function)
            functions += [*self.added, new]
        uniform = ir.Uniform(SWITCHES, BY_NAME["ivec4"], (0.0, 0.0, 0.0, 0.0), (), "", "", AT)
        return self.module._replace(
            functions=tuple(functions), structs=(*self.module.structs, *self.structs),
            uniforms=(*self.module.uniforms, uniform),
        )  # fmt: skip

    def chance(self, weight: float = 1.0) -> bool:
        return self.random.random() < weight * self.strength

    def name(self, word: str) -> str:
        self.names += 1
        return f"{word}_m{self.names}"

    def function(self, function: ir.Function) -> ir.Function:
        if function.body is None:
            return function
        self.is_large = len(list(statements(function.body))) > LARGEST
        written = super().function(function)
        if self.chance(2.0):
            written = self.with_packed_variables(written)
        return separate(written)

    # Expressions

    def expression(self, expr: ir.Expr) -> ir.Expr:
        if isinstance(expr, ir.Call):
            outs = self.outs.get(expr.function, ())
            args = [arg if place in outs else self.expression(arg) for place, arg in enumerate(expr.args)]
            new: ir.Expr = expr._replace(args=tuple(args))
        elif isinstance(expr, ir.Intrinsic):  # some arguments must stay constants
            new = expr._replace(
                args=tuple(
                    [arg if isinstance(arg, ir.Literal | ir.Construct) else self.expression(arg) for arg in expr.args]
                )
            )
        elif isinstance(expr, ir.Index | ir.Swizzle | ir.Member) and isinstance(root(expr), ir.Local | ir.Global):
            new = expr
        else:
            new = super().expression(expr)
        return self.disguised(new) if self.chance(0.35) else new

    def assign(self, stmt: ir.Assign) -> ir.Stmt | None:
        return stmt._replace(value=self.expression(stmt.value))

    def disguised(self, expr: ir.Expr) -> ir.Expr:
        """An expression with the same value."""
        type_, random = expr.type, self.random
        ways: list[ir.Expr] = []
        if isinstance(type_, Scalar | Vector | Matrix | Struct):
            yes, no = expr, self.any_value(type_)
            holds = random.random() < 0.5
            ways.append(ir.Select(type_, condition(random, holds), yes if holds else no, no if holds else yes, AT))
        if isinstance(type_, Scalar | Vector) and type_.kind != "bool":
            one = ir.Construct(Scalar(type_.kind), (switch("y"),), AT) if type_.kind != "int" else switch("y")
            nothing = ir.Construct(Scalar(type_.kind), (switch("x"),), AT) if type_.kind != "int" else switch("x")
            ways.append(ir.Binary(type_, "*", expr, one, AT))
            ways.append(ir.Binary(type_, "-", expr, nothing, AT))
            if type_.kind != "float":
                wide = nothing if isinstance(type_, Scalar) else ir.Construct(type_, (nothing,), AT)
                ways += [ir.Binary(type_, op, expr, wide, AT) for op in ("^", "|")]
            pair = Array(type_, 2)
            both = (expr, zero(type_))
            place = random.choice((0, 1))
            array = ir.Construct(pair, both if place == 0 else both[::-1], AT)
            ways.append(ir.Index(type_, array, switch("xy"[place]), AT))
        if type_ == BOOL:
            ways.append(ir.Binary(BOOL, "&&", expr, condition(random, True), AT))
            ways.append(ir.Binary(BOOL, "||", expr, condition(random, False), AT))
            ways.append(ir.Unary(BOOL, "!", ir.Unary(BOOL, "!", expr, AT), AT))
        if isinstance(type_, Vector):
            letters = "xyzw"[: type_.size]
            order = "".join(random.sample(letters, len(letters)))
            back = "".join([letters[order.index(letter)] for letter in letters])
            ways.append(ir.Swizzle(type_, ir.Swizzle(type_, expr, order, AT), back, AT))
        if isinstance(type_, Matrix):
            other = Matrix(type_.rows, type_.columns)
            ways.append(ir.Intrinsic(type_, "transpose", (ir.Intrinsic(other, "transpose", (expr,), AT),), AT))
        return random.choice(ways) if ways else expr

    def any_value(self, type_: Type) -> ir.Expr:
        """A variable of a type, or 0."""
        names = [name for name, at in self.scope.items() if at.type == type_ and not _is_unset(at)]
        return ir.Local(type_, self.random.choice(names), AT) if names and self.random.random() < 0.6 else zero(type_)

    # Statements

    def block(self, block: ir.Block) -> ir.Block:
        scope = self.scope.copy()
        stmts = list(super().block(block))
        if self.is_large:
            return tuple(stmts)
        stmts = [part for stmt in stmts for part in self.expanded(stmt)]
        if stmts and self.chance(2.0):
            first = self.random.randrange(len(stmts))
            last = self.random.randrange(first, len(stmts)) + 1
            if any(isinstance(stmt, ir.Declare) for stmt in stmts[first:last]):
                last = len(stmts)
            stmts[first:last] = self.once(tuple(stmts[first:last]))
        if self.chance(1.0):
            place = self.random.randrange(len(stmts) + 1)
            visible = {**scope, **{stmt.name: stmt for stmt in stmts[:place] if isinstance(stmt, ir.Declare)}}
            stmts.insert(place, self.dead(visible))
        return tuple(stmts)

    def once(self, body: ir.Block) -> ir.Block:
        """Control flow in which a block runs once."""
        shape = self.random.randrange(3 if jumps(body) else 7)
        if shape == 0:
            return (ir.If(condition(self.random, True), body, (), AT),)
        if shape == 1:
            return (ir.If(condition(self.random, False), (), body, AT),)
        if shape == 2:
            return (ir.If(condition(self.random, True), body, body, AT),)
        if shape == 3:
            return (ir.While(ir.Literal(BOOL, True, AT), (*body, ir.Break(AT)), AT),)
        name = self.name("once")
        counter = ir.Local(INT, name, AT)
        step = ir.Assign(counter, "+", number(1), AT)
        if shape == 4:
            init, limit = ir.Declare(name, INT, switch("x"), AT), switch("y")
        elif shape == 5:
            init, limit = ir.Declare(name, INT, switch("z"), AT), switch("w")
        else:
            skip = ir.If(ir.Binary(BOOL, "!=", counter, switch("y"), AT), (ir.Continue(AT),), (), AT)
            body = (skip, *body)
            init, limit = ir.Declare(name, INT, number(0), AT), switch("w")
        return (ir.For(init, ir.Binary(BOOL, "<", counter, limit, AT), step, body, AT),)

    def dead(self, scope: dict[str, ir.Declare | ir.Param]) -> ir.Stmt:
        """A branch that no lane takes."""
        body: list[ir.Stmt] = []
        names = [name for name, at in scope.items() if isinstance(at.type, Scalar | Vector) and not _is_in(at)]
        for name in self.random.sample(names, min(len(names), 2)):
            type_ = scope[name].type
            body.append(ir.Assign(ir.Local(type_, name, AT), "", zero(type_), AT))
        return ir.If(condition(self.random, False), tuple(body), (), AT)

    def branch(self, stmt: ir.If) -> ir.Stmt | None:
        new = super().branch(stmt)
        if isinstance(new, ir.If) and self.chance(1.5):
            return ir.If(ir.Unary(BOOL, "!", new.condition, AT), new.otherwise, new.then, AT)
        return new

    def expanded(self, stmt: ir.Stmt) -> ir.Block:
        """A statement, or what replaces it."""
        if isinstance(stmt, ir.For) and self.chance(2.0):
            return self.split(stmt)
        if isinstance(stmt, ir.Declare | ir.Assign | ir.Return) and stmt.value is not None and self.chance(1.0):
            if isinstance(stmt.value, ir.Call):
                return self.inlined(stmt, stmt.value)
            return self.outlined(stmt) if self.random.random() < 0.5 else self.hoisted(stmt)
        return (stmt,)

    def split(self, loop: ir.For) -> ir.Block:
        """Two loops that share the rounds."""
        body = list(statements(loop.body))
        if jumps(loop.body) or loop.condition is None or any(isinstance(stmt, ir.Return) for stmt in body):
            return (loop,)
        name, rounds = self.name("rounds"), ir.Local(INT, "", AT)
        rounds = rounds._replace(name=name)
        early = ir.Binary(BOOL, "<", rounds, switch(self.random.choice("xyzw")), AT)
        step = (loop.step,) if loop.step is not None else ()
        first = ir.While(
            ir.Binary(BOOL, "&&", loop.condition, early, AT),
            (*loop.body, *step, ir.Assign(rounds, "+", number(1), AT)), AT,
        )  # fmt: skip
        second = ir.While(loop.condition, (*loop.body, *step), AT)
        init = (loop.init,) if loop.init is not None else ()
        whole = (*init, ir.Declare(name, INT, number(0), AT), first, second)
        return (ir.If(condition(self.random, True), whole, (), AT),)  # a scope of its own

    def hoisted(self, stmt: ir.Declare | ir.Assign | ir.Return) -> ir.Block:
        """A part of the value in a variable of its own."""
        parts = [part for part in _certain(stmt.value) if is_pure(part) and not isinstance(part, ir.Literal)]
        if not parts or not is_pure(stmt.value) or not isinstance(stmt.value.type, Scalar | Vector | Matrix):
            return (stmt,)
        part = self.random.choice(parts)
        if not isinstance(part.type, Scalar | Vector | Matrix):
            return (stmt,)
        name = self.name("part")
        value = rewrite(stmt.value, lambda expr: ir.Local(expr.type, name, AT) if expr is part else expr)
        return (ir.Declare(name, part.type, part, AT), stmt._replace(value=value))

    def outlined(self, stmt: ir.Declare | ir.Assign | ir.Return) -> ir.Block:
        """The value computed by a function."""
        value = stmt.value
        if value is None or not is_pure(value) or any(isinstance(part.type, Array) for part in subexpressions(value)):
            return (stmt,)
        names = {part.name: part.type for part in subexpressions(value) if isinstance(part, ir.Local)}
        params = tuple([ir.Param(name, type_, "in", "", AT) for name, type_ in names.items()])
        function = ir.Function(self.name("outlined"), params, value.type, "", (ir.Return(value, AT),), "", AT)
        if self.random.random() < 0.5:
            out = ir.Param("outlined_result", value.type, "out", "", AT)
            body = (ir.Assign(ir.Local(value.type, out.name, AT), "", value, AT),)
            function = function._replace(params=(*params, out), result=VOID, body=body)
        self.added.append(function)
        args = tuple([ir.Local(type_, name, AT) for name, type_ in names.items()])
        if function.result != VOID:
            return (stmt._replace(value=ir.Call(value.type, function.key, args, AT)),)
        name = self.name("got")
        place = ir.Local(value.type, name, AT)
        call = ir.Evaluate(ir.Call(VOID, function.key, (*args, place), AT), AT)
        return (ir.Declare(name, value.type, None, AT), call, stmt._replace(value=place))

    def inlined(self, stmt: ir.Declare | ir.Assign | ir.Return, call: ir.Call) -> ir.Block:
        """The body of the function that it calls."""
        function = self.by_key.get(call.function)
        body = function.body if function is not None else None
        if function is None or not body or any(param.direction != "in" for param in function.params):
            return (stmt,)
        returns = [part for part in statements(body) if isinstance(part, ir.Return)]
        if len(returns) != 1 or body[-1] is not returns[0] or len(list(statements(body))) > 40:
            return (stmt,)
        if any(isinstance(part, ir.Discard) for part in statements(body)):
            return (stmt,)
        taken = {*self.scope, *declared(function)}
        new, _ = rename_locals(function, declared(function), lambda name, _: self.name(fresh(name, taken)))
        result = self.name("result")
        params = [ir.Declare(param.name, param.type, arg, AT) for param, arg in zip(new.params, call.args, strict=True)]
        inside = new.body or ()
        end = inside[-1]
        assert isinstance(end, ir.Return) and end.value is not None
        place = ir.Local(call.type, result, AT)
        whole = (*params, *inside[:-1], ir.Assign(place, "", end.value, AT))
        scope = ir.If(condition(self.random, True), whole, (), AT)
        return (ir.Declare(result, call.type, zero(call.type), AT), scope, stmt._replace(value=place))

    def with_packed_variables(self, function: ir.Function) -> ir.Function:
        """Some variables of the function's outermost block as members of a struct."""
        body = function.body or ()
        plain = [
            stmt for stmt in body if isinstance(stmt, ir.Declare) and isinstance(stmt.type, Scalar | Vector | Matrix)
        ]
        names = [stmt.name for stmt in plain]
        count = sum(isinstance(stmt, ir.Declare) for stmt in statements(body))
        if len(names) < 2 or len({*declared(function)}) < count + len(function.params):
            return function
        chosen = {stmt.name: stmt.type for stmt in self.random.sample(plain, min(3, len(plain)))}
        packed = self.name("packed")
        struct = Struct(self.name("Packed"), tuple([Field(name, type_) for name, type_ in chosen.items()]))
        whole = ir.Local(struct, packed, AT)
        self.structs.append(ir.StructDecl(struct, "", AT))

        def change(expr: ir.Expr) -> ir.Expr:
            if isinstance(expr, ir.Local) and expr.name in chosen:
                return ir.Member(expr.type, whole, expr.name, AT)
            return expr

        def restate(stmt: ir.Stmt) -> ir.Block | None:
            if isinstance(stmt, ir.Declare) and stmt.name in chosen:
                member = ir.Member(stmt.type, whole, stmt.name, AT)
                return (ir.Assign(member, "", stmt.value, AT),) if stmt.value is not None else ()
            return None

        new = rewrite_block(body, change, restate)
        return function._replace(body=(ir.Declare(packed, struct, zero(struct), AT), *new))


def _is_unset(at: ir.Declare | ir.Param) -> bool:
    return at.value is None if isinstance(at, ir.Declare) else at.direction == "out"


def _is_in(at: ir.Declare | ir.Param) -> bool:
    return isinstance(at, ir.Param) and at.direction == "in"


def _certain(expr: ir.Expr | None) -> Iterator[ir.Expr]:
    """The parts of an expression that are evaluated in any case."""
    if expr is None:
        return
    yield expr
    if isinstance(expr, ir.Select):
        yield from _certain(expr.condition)
    elif isinstance(expr, ir.Binary) and expr.op in ("&&", "||"):
        yield from _certain(expr.left)
    else:
        for part in operands(expr):
            yield from _certain(part)


def rewritten(module: ir.Module, random: Random) -> ir.Module:
    """The module with some of its code rewritten."""
    return Rewriter(module, random, random.choice((0.05, 0.1, 0.2))).module_rewritten()
