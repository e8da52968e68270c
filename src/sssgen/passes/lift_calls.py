"""Makes each call that writes a separate statement, and makes calls report whether they discard.

Why: in Python a function returns what it writes, as in `d, normal = trace(p)`, so such a call cannot be
inside an expression. A function that may discard gets a last parameter `out bool discarded`; after its call
comes `if (discarded) discard;`. Place: before if-conversion, to which only these few forms of a call are
left: `x = f(…)`, `T x = f(…)` and `f(…)` alone, with variables for all out and inout arguments.
"""

from __future__ import annotations

from collections.abc import Mapping

from sssgen.ir import nodes as ir
from sssgen.ir.loops import break_unless
from sssgen.ir.transform import Transformer
from sssgen.ir.types import BOOL, Type
from sssgen.ir.walk import (
    callees,
    calls_of,
    expressions,
    operands,
    statements,
    subexpressions,
    with_operands,
    written_root,
)
from sssgen.passes.places import may_overlap
from sssgen.passes.scopes import claim, declared, qualified_name
from sssgen.passes.variable_effects import NONE, Effects

Functions = Mapping[str, ir.Function]

DISCARDED = "discarded"

_NOTHING: Mapping[str, Effects] = {}


def lift_calls(module: ir.Module) -> ir.Module:
    """The module with its writing calls as statements. Functions come after those that they call."""
    lifted: dict[str, ir.Function] = {}
    old: dict[str, ir.Function] = {}
    for function in module.functions:
        new = _announce_discard(function, old, {other.key for other in module.functions})
        old[function.key] = new
        lifted[new.key] = _Lifter(new, Calls(old)).run()
    return module._replace(functions=tuple(lifted.values()))


class Calls:
    """The effects of calls of a module's functions; `shared` has those on module variables."""

    def __init__(self, functions: Functions, shared: Mapping[str, Effects] = _NOTHING) -> None:
        self.functions, self.shared = functions, shared
        self.effects: dict[str, bool] = {}

    def change(self, key: str) -> bool:
        """Whether a function writes through its parameters, or a module variable."""
        changes = self.effects.get(key)
        if changes is None:
            by_parameter = any(param.direction != "in" for param in self.functions[key].params)
            changes = self.effects[key] = by_parameter or bool(self.shared.get(key, NONE).writes)
        return changes

    def changing(self, function: ir.Function) -> bool:
        """Whether any call in a function has an effect apart from its result."""
        return any(self.change(call.function) for call in calls_of(function.body or ()))

    def writing(self, expr: ir.Expr) -> bool:
        """Whether a call inside an expression has an effect apart from its result."""
        return any(type(part) is ir.Call and self.change(part.function) for part in subexpressions(expr))


def lift(function: ir.Function, calls: Calls) -> ir.Function:
    """One function with its writing calls as statements; discards are not changed."""
    return _Lifter(function, calls).run()


def order_conflicts(function: ir.Function, calls: Calls) -> list[ir.Stmt]:
    """The statements in which a writing call is inside a larger expression, or is passed one variable twice.

    Languages differ there in the order of evaluation, and in whether the right side of `&&` and both arms of a choice
    are always evaluated; and values that other passes compute before the statement would be computed too early. Some
    languages pass references to variables where others copy them.
    """
    lifter = _Lifter(function, calls)
    stmts = []
    for stmt in statements(function.body or ()):
        for expr in expressions(stmt):
            whole_statement = isinstance(expr, ir.Call) and not (isinstance(stmt, ir.Assign) and lifter.meets(stmt))
            inner = operands(expr) if whole_statement else (expr,)
            if any(map(lifter.writes, inner)) or (isinstance(expr, ir.Call) and lifter.overlaps(expr)):
                stmts.append(stmt)
    return stmts


def reads_too_late(function: ir.Function, calls: Calls) -> bool:
    """Whether an operand reads a variable that a call to its right writes.

    Where a language evaluates calls from left to right, a driver may still read variables after all of them.
    """
    lifter = _Lifter(function, calls)
    return any(
        (isinstance(stmt, ir.Assign) and bool(stmt.op) and lifter.meets(stmt))
        or any(map(lifter.reads_late, expressions(stmt)))
        for stmt in statements(function.body or ())
    )


def out_arguments(call: ir.Expr, functions: Functions) -> list[str]:
    """The variables that a lifted call writes."""
    if not isinstance(call, ir.Call):
        return []
    params = functions[call.function].params
    return [arg.name for arg, param in zip(call.args, params, strict=True)
            if param.direction != "in" and isinstance(arg, ir.Local)]  # fmt: skip


def discards(function: ir.Function) -> bool:
    """Whether the last parameter of the function reports which lanes are discarded."""
    return bool(function.params) and function.params[-1].name == DISCARDED and function.params[-1].direction == "out"


def _announce_discard(function: ir.Function, functions: Functions, taken: set[str]) -> ir.Function:
    body = function.body or ()
    own = any(isinstance(stmt, ir.Discard) for stmt in statements(body))
    if not own and not any(discards(functions[key]) for key in callees(function) if key in functions):
        return function
    new = function._replace(params=(*function.params, ir.Param(DISCARDED, BOOL, "out", "", function.span)))
    while new.key in taken:
        new = new._replace(name=f"{new.name}_")
    return new


def _variables_in(expr: ir.Expr) -> list[str]:
    """The variables that an expression mentions."""
    return [qualified_name(part) for part in subexpressions(expr) if isinstance(part, ir.Local | ir.Global)]


class _Lifter(Transformer):
    """Rewrites one function: values that must be computed before a statement are appended to `out` before it."""

    def __init__(self, function: ir.Function, calls: Calls) -> None:
        super().__init__()
        self.source = function
        self.calls = calls
        self.functions, self.shared = calls.functions, calls.shared
        self.names: set[str] = set()
        """All names of the function, once a new name is chosen."""

    def run(self) -> ir.Function:
        return self.function(self.source) if self.calls.changing(self.source) else self.source

    def writes(self, expr: ir.Expr | None) -> bool:
        """Whether a call inside the expression has an effect apart from its result."""
        return expr is not None and self.calls.writing(expr)

    def local(self, type: Type, name: str, span: ir.Span) -> ir.Local:
        self.names = self.names or set(declared(self.source))
        return ir.Local(type, claim(name, self.names), span)

    # Statements

    def declare(self, stmt: ir.Declare) -> ir.Stmt | None:
        if isinstance(stmt.value, ir.Call) and self.writes_itself(stmt.value):
            call, after = self.call(stmt.value)
            self.out += [stmt._replace(value=call), *after]
            return None
        return super().declare(stmt)

    def evaluate(self, stmt: ir.Evaluate) -> ir.Stmt | None:
        if isinstance(stmt.call, ir.Call) and self.writes_itself(stmt.call):
            call, after = self.call(stmt.call)
            self.out += [stmt._replace(call=call), *after]
            return None
        return stmt._replace(call=with_operands(stmt.call, tuple(self.in_order(operands(stmt.call)))))

    def assign(self, stmt: ir.Assign) -> ir.Stmt | None:
        value = stmt.value
        if not self.writes(value) and not self.writes(stmt.target):
            return stmt
        pinned = any(map(self.writes_of(value).__contains__, _variables_in(stmt.target)))
        target = self.expression(self.pin(stmt.target) if pinned else stmt.target)
        if stmt.op and self.meets(stmt):  # the old value is read before the calls change it
            value = ir.Binary(target.type, stmt.op, target, value, stmt.span)
            return ir.Assign(target, "", self.expression(value), stmt.span)
        direct = isinstance(target, ir.Local | ir.Global) and not stmt.op and not self.meets(stmt)
        if direct and isinstance(value, ir.Call) and self.writes_itself(value):
            call, after = self.call(value)
            self.out += [ir.Assign(target, "", call, stmt.span), *after]
            return None
        return ir.Assign(target, stmt.op, self.expression(value), stmt.span)

    def for_loop(self, stmt: ir.For) -> ir.Stmt | None:
        init = stmt.init
        if isinstance(init, ir.Declare | ir.Assign) and init.value is not None:
            init = init._replace(value=self.expression(init.value))
        condition, body = self.loop(stmt)
        return ir.For(init, condition, stmt.step, body, stmt.span)

    def while_loop(self, stmt: ir.While) -> ir.Stmt | None:
        condition, body = self.loop(stmt)
        assert condition is not None
        return ir.While(condition, body, stmt.span)

    def loop(self, loop: ir.For | ir.While) -> tuple[ir.Expr | None, ir.Block]:
        """Condition and body. A condition that writes moves into the body: `while (true) { if (!c) break; … }`."""
        body, condition = self.block(loop.body), loop.condition
        if condition is not None and self.writes(condition):
            body = (*self.block((break_unless(condition),)), *body)
            condition = ir.Literal(BOOL, True, condition.span)
        return condition, body

    # Expressions

    def writes_itself(self, call: ir.Call) -> bool:
        return self.calls.change(call.function)

    def places(self, call: ir.Call) -> list[ir.Expr]:
        """The out arguments of a call."""
        params = self.functions[call.function].params
        return [arg for arg, param in zip(call.args, params, strict=False) if param.direction != "in"]

    def out_variables(self, call: ir.Call) -> set[str]:
        """The variables that the out arguments of a call are parts of, the module's as `$name`."""
        return {qualified_name(place) for place in map(written_root, self.places(call)) if place is not None}

    def meet_each_other(self, call: ir.Call) -> bool:
        """Whether two out arguments of a call may share a component."""
        places = self.places(call)
        return any(may_overlap(place, earlier) for index, place in enumerate(places) for earlier in places[:index])

    def overlaps(self, call: ir.Call) -> bool:
        """Whether an out argument may be read or written in another way, too, during the call."""
        if not self.writes_itself(call):
            return False
        effect = self.shared.get(call.function, NONE)
        used = {f"${name}" for name in effect.reads | effect.writes}
        return self.meet_each_other(call) or not used.isdisjoint(self.out_variables(call) if used else ())

    def meets(self, stmt: ir.Assign) -> bool:
        """Whether an assignment's value also writes what the assignment writes."""
        target = written_root(stmt.target)
        return target is not None and qualified_name(target) in self.writes_of(stmt.value)

    def expression(self, expr: ir.Expr) -> ir.Expr:
        """The expression without its writing calls, which are executed before it."""
        if not self.writes(expr):
            return expr
        if isinstance(expr, ir.Select) and (self.writes(expr.yes) or self.writes(expr.no)):
            return self.choose(expr)
        if isinstance(expr, ir.Binary) and expr.op in ("&&", "||") and self.writes(expr.right):
            constant = ir.Literal(BOOL, expr.op == "||", expr.span)
            yes, no = (expr.right, constant) if expr.op == "&&" else (constant, expr.right)
            return self.choose(ir.Select(BOOL, expr.left, yes, no, expr.span))
        if isinstance(expr, ir.Call) and self.writes_itself(expr):
            call, after = self.call(expr)
            result = self.local(expr.type, self.functions[expr.function].name + "_value", expr.span)
            self.out += [ir.Declare(result.name, result.type, call, expr.span), *after]
            return result
        return with_operands(expr, tuple(self.in_order(operands(expr))))

    def writes_of(self, expr: ir.Expr) -> set[str]:
        """The variables that the calls in an expression change, the module's as `$name`."""
        names: set[str] = set()
        for part in subexpressions(expr) if self.writes(expr) else ():
            if isinstance(part, ir.Call):
                names.update(self.out_variables(part))
                names.update(map("${}".format, self.shared.get(part.function, NONE).writes))
        return names

    def reads_of(self, expr: ir.Expr) -> set[str]:
        """The variables that an expression and its calls read, the module's as `$name`."""
        names = set(_variables_in(expr))
        for part in subexpressions(expr):
            if isinstance(part, ir.Call):
                names.update(map("${}".format, self.shared.get(part.function, NONE).reads))
        return names

    def in_order(self, exprs: tuple[ir.Expr, ...]) -> list[ir.Expr]:
        """Expressions evaluated from left to right: a variable that a later one changes is read before."""
        return [self.read_before(expr, exprs[index + 1 :]) for index, expr in enumerate(exprs)]

    def read_before(self, expr: ir.Expr, others: tuple[ir.Expr, ...]) -> ir.Expr:
        """An expression's value, read before those that are evaluated later can change it."""
        later = {name for other in others if self.writes(other) for name in self.writes_of(other)}
        value = self.expression(expr)
        if later and later & self.reads_of(value):
            kept = self.local(value.type, "before", value.span)
            self.out.append(ir.Declare(kept.name, kept.type, value, value.span))
            value = kept
        return value

    def reads_late(self, expr: ir.Expr) -> bool:
        """Whether an operand inside the expression reads a variable that a call to its right writes."""
        if not self.writes(expr):
            return False
        parts = operands(expr)
        return any(
            self.reads_late(part)
            or not self.writes_of(part).isdisjoint(name for earlier in parts[:index] for name in _variables_in(earlier))
            for index, part in enumerate(parts)
        )

    def choose(self, select: ir.Select) -> ir.Expr:
        """A choice as an if, so that only the chosen arm's calls write."""
        chosen = self.local(select.type, "chosen", select.span)
        self.out.append(ir.Declare(chosen.name, chosen.type, None, select.span))
        yes, no = (ir.Assign(chosen, "", arm, arm.span) for arm in (select.yes, select.no))
        branch = self.branch(ir.If(select.condition, (yes,), (no,), select.span))
        assert branch is not None
        self.out.append(branch)
        return chosen

    def call(self, call: ir.Call) -> tuple[ir.Call, list[ir.Stmt]]:
        """A call with variables for its out arguments, and the statements to be executed after it."""
        function = self.functions[call.function]
        args: list[ir.Expr] = []
        copies: list[ir.Stmt] = []
        after: list[ir.Stmt] = []
        copied = self.meet_each_other(call)
        for index, (arg, param) in enumerate(zip(call.args, function.params, strict=False)):
            if param.direction == "in":
                arg = self.read_before(arg, call.args[index + 1 :])
            elif copied or not isinstance(arg, ir.Local):
                place = self.expression(self.pin(arg))
                arg = self.local(arg.type, param.name, arg.span)
                value = place if param.direction == "inout" else None
                copies.append(ir.Declare(arg.name, arg.type, value, arg.span))
                after.append(ir.Assign(place, "", arg, arg.span))
            args.append(arg)
        self.out += copies
        if discards(function) and len(args) < len(function.params):
            discarded = self.local(BOOL, DISCARDED, call.span)
            self.out.append(ir.Declare(discarded.name, BOOL, None, call.span))
            args.append(discarded)
            after.append(ir.If(discarded, (ir.Discard(call.span),), (), call.span))
        return ir.Call(call.type, function.key, tuple(args), call.span), after

    def pin(self, place: ir.Expr) -> ir.Expr:
        """A place to write to, with its indices computed now, as the call may change their values."""
        if isinstance(place, ir.Swizzle | ir.Member):
            return place._replace(value=self.pin(place.value))
        if isinstance(place, ir.Index):
            index = self.expression(place.index)
            if not isinstance(index, ir.Literal):
                copy = self.local(index.type, "place", index.span)
                self.out.append(ir.Declare(copy.name, copy.type, index, index.span))
                index = copy
            return place._replace(value=self.pin(place.value), index=index)
        return place
