"""Checks statements. What the IR has not is said in what it has: several declarations in a loop's head, `do`, `switch`.

An expression's side effects become statements before the one that it stands in (see `expressions`).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

from sssgen.ir import nodes as ir
from sssgen.ir.rules import element_type
from sssgen.ir.types import BOOL, FLOAT, INT, UINT, VOID, Array, Sampler, Scalar, Struct, Type, kind_of, spell
from sssgen.ir.walk import all_expressions, statements, subexpressions
from sssgen.lang.check.call_checker import CallChecker
from sssgen.lang.check.evaluation_order import depends, writes_of
from sssgen.lang.check.expression_checker import Untyped
from sssgen.lang.check.switch_cases import cases_of, leaves
from sssgen.lang.check.termination import ends, skips
from sssgen.lang.check.wording import a_type
from sssgen.lang.syntax import tree as s
from sssgen.support.diagnostics import Reporter


class StatementChecker(CallChecker):
    """Checks the statements of one file's functions; `result` is what the function at hand returns."""

    def __init__(self, reporter: Reporter, plain: bool = False) -> None:
        super().__init__(reporter, plain)
        self.result: tuple[Type, str] = (VOID, "")
        self.loops = 0
        self.faults = 0
        """How many statements were left out for their errors."""
        self.switches: list[ir.Local | None] = []
        """Of each switch around the statement, inside the innermost loop: the variable that says to go on with that
        loop's next round, where the switch is a loop of its own; None where it is none."""
        self.statement_methods: dict[type, Callable[[Any], list[ir.Stmt]]] = {
            kind: getattr(self, f"_{kind.__name__.lower()}")
            for kind in (
                s.Declaration, s.ExpressionStatement, s.IfStatement, s.ForStatement, s.WhileStatement, s.DoStatement,
                s.SwitchStatement, s.Label, s.Jump,
            )
        } | {s.Assignment: self._assignmentstatement}  # fmt: skip

    def block(self, compound: s.Compound, dissolve: bool = False) -> ir.Block:
        """Checks a block in a scope of its own; `dissolve`: its statements become those of the block around it."""
        self.scopes.push()
        result = self.statements(compound.statements)
        self.scopes.pop(dissolve)
        return result

    def statements(self, given: tuple[s.Statement, ...]) -> ir.Block:
        return tuple([stmt for statement in given for stmt in self.statement(statement)])

    def statement(self, statement: s.Statement) -> list[ir.Stmt]:
        """Checks one statement; a faulty one gives nothing and the next goes on."""
        if isinstance(statement, s.Compound):
            return list(self.block(statement, dissolve=True))
        outer, self.prelude = self.prelude, []
        try:
            result: list[ir.Stmt] = self.statement_methods[statement.__class__](statement)
            return [*self.prelude, *result] if self.prelude else result
        except Untyped:
            self.faults += 1
            if isinstance(statement, s.Declaration):
                self.declare_anyway(statement)
            return []
        finally:
            self.prelude = outer

    # Declarations

    def declare_anyway(self, declaration: s.Declaration) -> None:
        """After a faulty declaration, makes its names known so that their use is not reported too."""
        for declarator in declaration.declarators:
            try:
                type_, quantity = self.type_named(declaration.type)
                type_ = self.array_of(type_, declarator.lengths)
                faulty = type_ == VOID or isinstance(type_, Sampler)
            except Untyped:
                type_, quantity, faulty = FLOAT, "", True
            self.scopes.declare(declarator.name.text, type_, quantity, True, faulty)

    def _declaration(self, declaration: s.Declaration) -> list[ir.Stmt]:
        if declaration.type.struct is not None:
            self.local_struct(declaration.type.struct)
        if not declaration.declarators:
            return []
        type_, quantity = self.type_named(replace(declaration.type, lengths=()))
        if type_ == VOID or isinstance(type_, Sampler):
            raise self.fail(declaration.type.span, f"a variable cannot be {a_type(type_)}")
        const = "const" in declaration.qualifiers.words
        for declarator in declaration.declarators:
            name = declarator.name
            self.allowed(name)
            declared = self.declared_type(type_, declaration.type, declarator)
            value, whole = None, None
            if declarator.value is not None:
                value = self.check_as(declarator.value, declared, quantity, f"'{name.text}'")
                if const and declared in (INT, UINT):
                    whole = self.constant_int(declarator.value)
            elif const:
                raise self.fail(name.span, f"const '{name.text}' needs a value")
            variable = self.scopes.declare(name.text, declared, quantity, not const, value=whole)
            if variable is None:
                raise self.fail(name.span, f"'{name.text}' is already declared in this block")
            span = ir.Span(name.span.file, declaration.span.line, declaration.span.column, *name.span[3:])
            self.prelude.append(ir.Declare(variable.ir_name, declared, value, span))
        return []

    def declared_type(self, element: Type, type_: s.TypeName, declarator: s.Declarator) -> Type:
        """The type of one name of a declaration, whose element type is known."""
        lengths = (*declarator.lengths, *type_.lengths)
        if not lengths:
            return element
        items = items_of(declarator.value)
        if items is None and declarator.value is not None and isinstance(lengths[0], s.Unsized):
            value, _ = self.apart(declarator.value, self.check)
            items = value.expr.type.length if isinstance(value.expr.type, Array) else None
        return self.array_of(element, lengths, items)

    def local_struct(self, struct: s.StructSyntax) -> None:
        """A struct that a function declares for itself."""
        raise NotImplementedError

    def new_name(self, name: s.Name, functions: bool = False) -> str:
        """Reports a module-level name that is taken."""
        raise NotImplementedError

    def allowed(self, name: s.Name) -> None:
        """Reports a name that GLSL keeps for itself."""
        raise NotImplementedError

    # Simple statements

    def _assignmentstatement(self, assignment: s.Assignment) -> list[ir.Stmt]:
        return [self.assign(assignment)]

    def _expressionstatement(self, statement: s.ExpressionStatement) -> list[ir.Stmt]:
        value = statement.value
        if isinstance(value, s.Comma) or (self.plain and isinstance(value, s.Conditional)):
            self.effect(value)
            return []
        callee = value.callee if isinstance(value, s.CallOf) else None
        if isinstance(callee, s.Name) and callee.text == "assume" and "assume" not in self.functions:
            return self.assumption(value)
        call = self.check(value).expr
        if isinstance(call, ir.Call):
            return [ir.Evaluate(call, statement.span)]
        if self.plain:
            self.calls_of(call)
            return []
        raise self.fail(statement.span, "this computes a value and drops it", "assign it, or remove the statement")

    def assumption(self, call: s.Expression) -> list[ir.Stmt]:
        """`assume(condition);`"""
        assert isinstance(call, s.CallOf)
        if len(call.args) != 1:
            raise self.fail(call.span, "assume takes one condition", "write assume(x > 0.0);")
        condition = self.condition(call.args[0])
        if condition is not None and any(isinstance(part, ir.Call) for part in subexpressions(condition)):
            raise self.fail(call.span, "an assumption calls no function", "assume something of a variable's value")
        return [ir.Assume(condition, call.span)] if condition is not None else []

    def _ifstatement(self, statement: s.IfStatement) -> list[ir.Stmt]:
        condition = self.condition(statement.condition)
        then = self.body(statement.then)
        otherwise = self.body(statement.otherwise) if statement.otherwise is not None else ()
        return [ir.If(condition, then, otherwise, statement.span)] if condition is not None else []

    def _jump(self, jump: s.Jump) -> list[ir.Stmt]:
        if jump.kind == "return":
            type_, quantity = self.result
            if jump.value is None:
                if type_ != VOID:
                    raise self.fail(jump.span, f"this function returns {spell(type_)}", "write return value;")
                return [ir.Return(None, jump.span)]
            if type_ == VOID:
                value = self.check(jump.value).expr if self.plain else None
                if value is not None and value.type == VOID:  # return f();
                    self.calls_of(value)
                    return [ir.Return(None, jump.span)]
                raise self.fail(jump.span, "this function returns nothing")
            return [ir.Return(self.check_as(jump.value, type_, quantity, "the return"), jump.span)]
        if jump.kind == "discard":
            return [ir.Discard(jump.span)]
        if jump.kind == "break" and self.switches:
            return [ir.Break(jump.span)]
        if self.loops == 0:
            raise self.fail(jump.span, f"{jump.kind} stands outside a loop")
        if jump.kind == "break":
            return [ir.Break(jump.span)]
        around = [flag for flag in self.switches if flag is not None]
        if not around:
            return [ir.Continue(jump.span)]
        true = ir.Literal(BOOL, True, jump.span)
        return [*(ir.Assign(flag, "", true, jump.span) for flag in around), ir.Break(jump.span)]

    # Loops

    def _forstatement(self, statement: s.ForStatement) -> list[ir.Stmt]:
        errors = len(self.reporter.diagnostics)
        self.scopes.push()
        before = self.statement(statement.init) if statement.init is not None else []
        condition, tested = None, list[ir.Stmt]()
        if statement.condition is not None:
            condition, tested = self.apart(statement.condition, self.condition)
        steps = self.apart(statement.step, self.effect)[1] if statement.step is not None else []
        body = self.loop_body(statement.body)
        self.scopes.pop(dissolve=len(before) > 1, loop=True)
        if len(self.reporter.diagnostics) > errors:
            return []
        counted = (
            {part.name for part in subexpressions(condition) if isinstance(part, ir.Local)} if condition else set()
        )
        before, init = _split(before, counted)
        others, step = _split(steps, counted) if all(map(_is_plain, steps)) else (steps, None)
        if others:
            body = (*_before_continues(body, others), *others)
        span = statement.span
        if tested:
            assert condition is not None
            body, condition = (*tested, _leave_unless(condition), *body), None
        bounded = condition is not None and step is not None and ends(condition, (step,), body, self.out_args)
        if not self.plain and not bounded:
            raise self.fail(span, "this loop cannot be seen to end", _LOOP_HINT)
        return [*before, ir.For(init, condition, step, body, span)]

    def _whilestatement(self, statement: s.WhileStatement) -> list[ir.Stmt]:
        errors = len(self.reporter.diagnostics)
        if isinstance(statement.condition, s.Declaration):
            raise self.fail(statement.condition.span, "a condition declares nothing here", "declare it before the loop")
        condition, tested = self.apart(statement.condition, self.condition)
        body = self.loop_body(statement.body)
        if condition is None or len(self.reporter.diagnostics) > errors:
            return []
        span = statement.span
        if tested:
            body, condition = (*tested, _leave_unless(condition), *body), ir.Literal(BOOL, True, span)
        if not self.plain and (skips(body) or not ends(condition, body, (), self.out_args)):
            raise self.fail(span, "this loop cannot be seen to end", _LOOP_HINT)
        return [ir.While(condition, body, span)]

    def _dostatement(self, statement: s.DoStatement) -> list[ir.Stmt]:
        """`do body while (test);` is `while (true) { body; if (!test) break; }`, and so is each `continue` in it."""
        body = self.loop_body(statement.body)
        condition, tested = self.apart(statement.condition, self.condition)
        if condition is None:
            return []
        if not self.plain:
            hint = "write for (int i = 0; i < N; i++)"
            raise self.fail(statement.span, "this loop cannot be seen to end", hint)
        if isinstance(condition, ir.Literal):  # while (false): but once
            last = tested if condition.value else [*tested, ir.Break(condition.span)]
        else:
            last = [*tested, _leave_unless(condition)]
        body = (*_before_continues(body, last), *last)
        return [ir.While(ir.Literal(BOOL, True, statement.span), body, statement.span)]

    def condition(self, condition: s.Expression) -> ir.Expr | None:
        """A condition, or None once its error is reported: what it governs is checked all the same."""
        try:
            return self.check_as(condition, BOOL, "", "a condition")
        except Untyped:
            return None

    def loop_body(self, statement: s.Statement) -> ir.Block:
        outer, self.switches = self.switches, []
        self.loops += 1
        body = self.body(statement)
        self.loops -= 1
        self.switches = outer
        return body

    def out_args(self, call: ir.Call) -> list[ir.Expr]:
        """The arguments of a call that it writes to."""
        overloads = self.functions[call.function.split("(")[0]]
        directions = next(one.directions for one in overloads if one.key == call.function)
        return [arg for arg, direction in zip(call.args, directions, strict=True) if direction != "in"]

    def body(self, statement: s.Statement) -> ir.Block:
        if isinstance(statement, s.Compound):
            return self.block(statement)
        self.scopes.push()
        result = tuple(self.statement(statement))
        self.scopes.pop()
        return result

    # switch

    def _switchstatement(self, statement: s.SwitchStatement) -> list[ir.Stmt]:
        """A chain of ifs; one that is left from inside an if is a loop of one round, which can be left."""
        span = statement.span
        value = self.check(statement.value).expr
        if value.type not in (INT, UINT):
            raise self.fail(statement.value.span, f"a switch is over an int, but this is {a_type(value.type)}")
        cases = cases_of(self, statement)
        left = any(leaves(case.body) for case in cases)
        place = len(self.prelude)
        flag = self.temporary("goes_on", ir.Literal(BOOL, False, span)) if left and self.loops else None
        outer, self.switches = self.switches, [*self.switches, flag]
        bodies = [self.block(s.Compound(case.body, span, 0)) for case in cases]
        self.switches = outer
        written, calls = writes_of([stmt for body in bodies for stmt in body])
        if len(cases) > 1 and (not isinstance(value, ir.Local) or depends(value, written, calls)):
            value = self.temporary("selected", value, place)
        chain: ir.Block = ()
        for case, body in zip(reversed(cases), reversed(bodies), strict=True):
            test = self.is_case(value, case.labels)
            chain = body if test is None else (ir.If(test, body, chain, case.span),)
        if not left:
            return list(chain)
        once = self.temporary("once", ir.Literal(INT, 0, span))
        init = self.prelude.pop()
        test = ir.Binary(BOOL, "<", once, ir.Literal(INT, 1, span), span)
        step = ir.Assign(once, "+", ir.Literal(INT, 1, span), span)
        result: list[ir.Stmt] = [ir.For(init, test, step, chain, span)]
        if flag is not None and any(_sets(stmt, flag) for stmt in statements(chain)):
            result.append(ir.If(flag, (ir.Continue(span),), (), span))
        elif flag is not None:
            self.prelude = [stmt for stmt in self.prelude if getattr(stmt, "name", "") != flag.name]
        return result

    def is_case(self, value: ir.Expr, labels: tuple[s.Label, ...]) -> ir.Expr | None:
        """Whether a switch's value is one of these; None for the default."""
        test: ir.Expr | None = None
        for label in labels:
            if label.value is None:
                return None
            number = self.constant_int(label.value)
            if number is None:
                raise self.fail(label.value.span, "a case is a constant whole number")
            literal = ir.Literal(value.type, number & 0xFFFFFFFF if value.type == UINT else number, label.value.span)
            equal = ir.Binary(BOOL, "==", value, literal, label.span)
            test = equal if test is None else ir.Binary(BOOL, "||", test, equal, label.span)
        return test

    def _label(self, label: s.Label) -> list[ir.Stmt]:
        raise self.fail(label.span, "a case stands outside a switch")


_LOOP_HINT = "write for (int i = 0; i < N; i++) with N that the body does not change, and step the counter nowhere else"


def items_of(value: s.Expression | None) -> int | None:
    """How many items a value has by how it is written: the length of `float a[] = …`."""
    if isinstance(value, s.Listed):
        return len(value.items)
    if isinstance(value, s.CallOf) and isinstance(value.callee, s.TypeName) and value.callee.lengths:
        return len(value.args)
    return None


def zero(type_: Type, span: ir.Span) -> ir.Expr:
    """A value of the type that is all zeros."""
    if isinstance(type_, Struct):
        return ir.Construct(type_, tuple([zero(field.type, span) for field in type_.fields]), span)
    if isinstance(type_, Array):
        return ir.Construct(type_, (zero(type_.element, span),) * type_.length, span)
    kind = kind_of(type_)
    none: float | int = 0.0 if kind == "float" else 0
    number = ir.Literal(Scalar(kind), False if kind == "bool" else none, span)
    return number if element_type(type_) is None else ir.Construct(type_, (number,), span)


def _sets(stmt: ir.Stmt, flag: ir.Local) -> bool:
    return isinstance(stmt, ir.Assign) and isinstance(stmt.target, ir.Local) and stmt.target.name == flag.name


def _leave_unless(condition: ir.Expr) -> ir.Stmt:
    return ir.If(ir.Unary(BOOL, "!", condition, condition.span), (ir.Break(condition.span),), (), condition.span)


def _is_plain(stmt: ir.Stmt) -> bool:
    """Whether a step can stand in a loop's head: an assignment that calls nothing."""
    return isinstance(stmt, ir.Assign) and not any(isinstance(part, ir.Call) for part in all_expressions((stmt,)))


def _split(found: list[ir.Stmt], counted: set[str]) -> tuple[list[ir.Stmt], ir.Stmt | None]:
    """Of what a loop's head does, what goes elsewhere and what stays in the head: that of the counter, or the last.

    The counter's goes last only where the others neither read nor write what it writes, or the other way round.
    """
    simple = [stmt for stmt in found if isinstance(stmt, ir.Declare | ir.Assign | ir.Evaluate)]
    if not simple:
        return found, None
    for stmt in simple:
        others = [other for other in found if other is not stmt]
        apart = not any(_touched(stmt) & _mentions(other) or _touched(other) & _mentions(stmt) for other in others)
        if apart and _touched(stmt) & counted:
            return others, stmt
    if found[-1] in simple:
        return found[:-1], found[-1]
    return found, None


def _touched(stmt: ir.Stmt) -> set[str]:
    """The variables that a statement writes."""
    if isinstance(stmt, ir.Declare):
        return {stmt.name}
    return writes_of([stmt])[0]


def _mentions(stmt: ir.Stmt) -> set[str]:
    """The variables that a statement reads or writes."""
    names = {part.name for part in all_expressions((stmt,)) if isinstance(part, ir.Local | ir.Global)}
    return names | _touched(stmt)


def _before_continues(body: ir.Block, added: list[ir.Stmt]) -> ir.Block:
    """A loop's body with statements before each `continue` that goes on with it, or instead of it if they leave."""
    result: list[ir.Stmt] = []
    for stmt in body:
        if isinstance(stmt, ir.Continue):
            result += added
            if added and isinstance(added[-1], ir.Break):
                continue
        elif isinstance(stmt, ir.If):
            then, otherwise = _before_continues(stmt.then, added), _before_continues(stmt.otherwise, added)
            stmt = stmt._replace(then=then, otherwise=otherwise)
        result.append(stmt)
    return tuple(result)
