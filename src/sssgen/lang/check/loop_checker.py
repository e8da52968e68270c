"""Checks loops. IR loops have one declaration and one step in their head and no `do`; the rest becomes statements."""

from __future__ import annotations

from sssgen.ir import nodes as ir
from sssgen.ir.loops import at_every_end, break_unless
from sssgen.ir.types import BOOL, INT
from sssgen.ir.walk import all_expressions, subexpressions
from sssgen.lang.check.context import AlreadyReported, FunctionContext
from sssgen.lang.check.evaluation_order import writes_of
from sssgen.lang.check.statement_checker import StatementChecker
from sssgen.lang.check.termination import ends, skips
from sssgen.lang.syntax import tree as s

_LOOP_HINT = (
    "write for (int i = 0; i < N; i++) with a body that changes neither i nor N; with i <= N or a larger step, N needs "
    "a limit, such as min(N, 64): behind the last integer i begins again at the first"
)


class LoopChecker:
    """Checks the loops of one file."""

    def __init__(self, statements: StatementChecker) -> None:
        self.context = statements.context
        self.expressions = statements.expressions
        self.statements = statements
        statements.methods[s.ForStatement] = self.for_
        statements.methods[s.WhileStatement] = self.while_
        statements.methods[s.DoStatement] = self.do

    def for_(self, statement: s.ForStatement) -> list[ir.Stmt]:
        context, scopes, span = self.context, self.context.function.scopes, statement.span
        errors = len(context.reporter.diagnostics)
        scopes.push()
        before = self.statements.statement(statement.init) if statement.init is not None else []
        condition, tested = None, list[ir.Stmt]()
        if statement.condition is not None:
            condition, tested = self.condition(statement.condition)
        steps: list[ir.Stmt] = []
        if statement.step is not None:
            _, steps = self.expressions.with_prelude(statement.step, self.statements.assignments.effect)
        self.check_head(statement.body)
        body = self.loop_body(statement.body)
        scopes.pop(dissolve=len(before) > 1, loop=True)
        if len(context.reporter.diagnostics) > errors:
            return []
        counters = (
            {part.name for part in subexpressions(condition) if isinstance(part, ir.Local)} if condition else set()
        )
        before, init = _split(before, counters)
        in_head = all(map(_fits_in_head, steps)) and not isinstance(statement.condition, s.Declaration)
        others, step = _split(steps, counters) if in_head else (steps, None)
        if others:
            body = at_every_end(body, others)
        if tested:
            assert condition is not None
            body, condition = (*tested, break_unless(condition), *body), None
        if not context.plain and (
            condition is None
            or step is None
            or not ends(condition, (step,), body, context.out_arguments, context.extent)
        ):
            raise context.fail(span, "this loop cannot be proven to end", _LOOP_HINT)
        return [*before, ir.For(init, condition, step, body, span)]

    def while_(self, statement: s.WhileStatement) -> list[ir.Stmt]:
        context, scopes, span = self.context, self.context.function.scopes, statement.span
        errors = len(context.reporter.diagnostics)
        scopes.push()
        condition, tested = self.condition(statement.condition)
        body = self.loop_body(statement.body)
        scopes.pop()
        if condition is None or len(context.reporter.diagnostics) > errors:
            return []
        if tested:
            body, condition = (*tested, break_unless(condition), *body), ir.Literal(BOOL, True, span)
        if not context.plain and (skips(body) or not ends(condition, body, (), context.out_arguments, context.extent)):
            raise context.fail(span, "this loop cannot be proven to end", _LOOP_HINT)
        return [ir.While(condition, body, span)]

    def condition(self, condition: s.Expression | s.Declaration) -> tuple[ir.Expr | None, list[ir.Stmt]]:
        """The condition of a loop, and the statements before each test: the variable that it declares, too."""
        if isinstance(condition, s.Declaration):
            return self.expressions.with_prelude(condition, self.declared)
        return self.expressions.with_prelude(condition, self.statements.condition)

    def declared(self, declaration: s.Declaration) -> ir.Expr | None:
        """The value of the variable that a condition declares."""
        first, *others = declaration.declarators or (None,)
        if first is None or first.value is None or others:
            raise self.context.fail(declaration.span, "a condition declares one variable, which needs a value")
        try:
            self.statements.declaration(declaration)
        except AlreadyReported:
            self.statements.declare_faulty(declaration)
            return None
        return self.statements.condition(first.name)

    def do(self, statement: s.DoStatement) -> list[ir.Stmt]:
        """`do body while (test);` is `while (true) { body; if (!test) break; }`; each `continue` tests first, too.

        `do body while (false);` is the body, or a loop of one iteration where the body leaves it.
        """
        function, span = self.context.function, statement.span
        scopes = function.scopes
        scopes.push()  # the condition's variables are in the scope of the body in the IR
        body = self.loop_body(statement.body, dissolve=True)
        condition, tested = self.expressions.with_prelude(statement.condition, self.statements.condition)
        is_once = isinstance(condition, ir.Literal) and not condition.value
        is_block = is_once and not skips(body, (ir.Break, ir.Continue))
        scopes.pop(dissolve=is_block)
        if condition is None:
            return []
        if not self.context.plain:
            hint = "write for (int i = 0; i < N; i++)"
            raise self.context.fail(span, "this loop cannot be proven to end", hint)
        if is_block:
            return [*body, *tested]
        if is_once:
            return [once(function, at_every_end(body, tested), span)]
        last = tested if isinstance(condition, ir.Literal) else [*tested, break_unless(condition)]
        return [ir.While(ir.Literal(BOOL, True, span), at_every_end(body, last), span)]

    def check_head(self, body: s.Statement) -> None:
        """Reports a variable of a loop's head that the body declares again: in GLSL ES both are one scope."""
        head = self.context.function.scopes.stack[-1]
        for statement in body.statements if self.context.es and isinstance(body, s.Compound) else ():
            for declarator in statement.declarators if isinstance(statement, s.Declaration) else ():
                name = declarator.name
                if name.text in head:
                    message = f"'{name.text}' is already declared in the head of this loop"
                    self.context.reporter.error(name.span, message, "choose another name")

    def loop_body(self, statement: s.Statement, dissolve: bool = False) -> ir.Block:
        function = self.context.function
        outer, function.switches = function.switches, []
        function.loop_depth += 1
        body = self.statements.body(statement, dissolve)
        function.loop_depth -= 1
        function.switches = outer
        return body


def once(function: FunctionContext, body: ir.Block, span: ir.Span) -> ir.For:
    """A loop of one iteration, which the body can leave at any place."""
    counter = function.temporary("once", ir.Literal(INT, 0, span), before=body)
    init = function.prelude.pop()
    test = ir.Binary(BOOL, "<", counter, ir.Literal(INT, 1, span), span)
    return ir.For(init, test, ir.Assign(counter, "+", ir.Literal(INT, 1, span), span), body, span)


def _fits_in_head(stmt: ir.Stmt) -> bool:
    """Whether a step may be the step of an IR loop: an assignment without calls."""
    return isinstance(stmt, ir.Assign) and not any(isinstance(part, ir.Call) for part in all_expressions((stmt,)))


def _split(statements: list[ir.Stmt], counters: set[str]) -> tuple[list[ir.Stmt], ir.Stmt | None]:
    """Of the statements of a loop's head, those to move elsewhere and the one that stays.

    The one that stays writes a counter and does not depend on the others, nor they on it; otherwise it is the last.
    """
    simple = [stmt for stmt in statements if isinstance(stmt, ir.Declare | ir.Assign | ir.Evaluate)]
    if not simple:
        return statements, None
    for stmt in simple:
        others = [other for other in statements if other is not stmt]
        if _writes(stmt) & counters and not any(_conflict(stmt, other) for other in others):
            return others, stmt
    if statements[-1] in simple:
        return statements[:-1], statements[-1]
    return statements, None


def _conflict(one: ir.Stmt, other: ir.Stmt) -> bool:
    """Whether the order of two statements matters. A call may read and write any module variable."""
    if _writes(one) & _uses(other) or _writes(other) & _uses(one):
        return True
    kinds = [{type(part) for part in all_expressions((stmt,))} & {ir.Call, ir.Global} for stmt in (one, other)]
    return all(kinds) and ir.Call in kinds[0] | kinds[1]


def _writes(stmt: ir.Stmt) -> set[str]:
    """The variables that a statement writes."""
    if isinstance(stmt, ir.Declare):
        return {stmt.name}
    return writes_of([stmt], lambda call: call.args)[0]


def _uses(stmt: ir.Stmt) -> set[str]:
    """The variables that a statement reads or writes."""
    names = {part.name for part in all_expressions((stmt,)) if isinstance(part, ir.Local | ir.Global)}
    return names | _writes(stmt)
