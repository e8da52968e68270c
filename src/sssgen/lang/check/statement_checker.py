"""Checks statements: declarations, expressions, branches and jumps; gives IR.

The side effects of an expression become statements before the statement that contains it (see expression_checker.py).
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from sssgen.ir import nodes as ir
from sssgen.ir.types import (
    BOOL,
    FLOAT,
    VOID,
    Sampler,
    Scalar,
    Vector,
    components,
    kind_of,
    vector_of,
)
from sssgen.ir.walk import subexpressions
from sssgen.lang.check.assignment_checker import AssignmentChecker
from sssgen.lang.check.constant_values import constant_value, is_constant
from sssgen.lang.check.context import AlreadyReported
from sssgen.lang.check.declared_names import check_not_reserved, declare_struct
from sssgen.lang.check.memory_checker import stored_directly
from sssgen.lang.check.type_names import array_type, check_sequences, named_element, named_type, names_type
from sssgen.lang.check.wording import a_type
from sssgen.lang.syntax import tree as s

_ORDERS = ("<", "<=", ">", ">=")


class StatementChecker:
    """Checks the statements of one file's functions.

    `methods` has a function for each class of statement. The checkers of loops and switches add theirs.
    """

    def __init__(self, assignments: AssignmentChecker) -> None:
        self.context = assignments.context
        self.expressions = assignments.expressions
        self.assignments = assignments
        self.methods: dict[type, Callable[[Any], list[ir.Stmt]]] = {
            s.Declaration: self.declaration,
            s.Assignment: self.assignment,
            s.ExpressionStatement: self.expression,
            s.IfStatement: self.if_,
            s.Jump: self.jump,
        }

    def block(self, compound: s.Compound, dissolve: bool = False) -> ir.Block:
        """Checks a block in its own scope; `dissolve`: its statements become those of the enclosing block."""
        scopes = self.context.function.scopes
        scopes.push()
        result = self.statements(compound.statements)
        scopes.pop(dissolve)
        return result

    def statements(self, statements: tuple[s.Statement, ...]) -> ir.Block:
        return tuple([stmt for statement in statements for stmt in self.statement(statement)])

    def statement(self, statement: s.Statement) -> list[ir.Stmt]:
        """Checks one statement; a faulty one gives nothing, and checking continues after it."""
        if isinstance(statement, s.Compound):
            return list(self.block(statement, dissolve=True))
        function = self.context.function
        outer, function.prelude = function.prelude, []
        try:
            result: list[ir.Stmt] = self.methods[statement.__class__](statement)
            return stored_directly([*function.prelude, *result], function.scopes) if function.prelude else result
        except AlreadyReported:
            function.has_faults = True
            if isinstance(statement, s.Declaration):
                self.declare_faulty(statement)
            return []
        finally:
            function.prelude = outer

    def body(self, statement: s.Statement, dissolve: bool = False) -> ir.Block:
        """Checks the body of a branch or loop in its own scope; `dissolve` as in `block`."""
        if isinstance(statement, s.Compound):
            return self.block(statement, dissolve)
        scopes = self.context.function.scopes
        scopes.push()
        result = tuple(self.statement(statement))
        scopes.pop(dissolve)
        return result

    def condition(self, condition: s.Expression) -> ir.Expr | None:
        """A condition; None once its error is reported, so that the statements that depend on it are still checked."""
        try:
            return self.expressions.check_as(condition, BOOL, "", "a condition")
        except AlreadyReported:
            return None

    # Declarations

    def declare_faulty(self, declaration: s.Declaration) -> None:
        """Declares the names of a faulty declaration, so that their uses are not reported too."""
        context = self.context
        for declarator in declaration.declarators:
            try:
                type_, quantity = named_type(context, declaration.type)
                type_ = array_type(context, type_, declarator.lengths)
                faulty = type_ == VOID or isinstance(type_, Sampler)
            except AlreadyReported:
                type_, quantity, faulty = FLOAT, "", True
            context.function.scopes.declare(declarator.name.text, type_, quantity, True, faulty)

    def declaration(self, declaration: s.Declaration) -> list[ir.Stmt]:
        context, function = self.context, self.context.function
        if declaration.type.struct is not None:
            declare_struct(context, declaration.type.struct, local=True)
        if not declaration.declarators:
            return []
        type_, quantity = named_element(context, declaration.type)
        if type_ == VOID or isinstance(type_, Sampler):
            raise context.fail(declaration.type.span, f"a variable cannot be {a_type(type_)}")
        const = "const" in declaration.qualifiers.keywords
        for declarator in declaration.declarators:
            name = declarator.name
            check_not_reserved(context, name)
            declared = self.expressions.declared_type(type_, declaration.type, declarator)
            value, constant = None, None
            if declarator.value is not None:
                sequences = context.sequences
                value = self.expressions.check_as(declarator.value, declared, quantity, f"'{name.text}'")
                if const:
                    check_sequences(context, sequences, declarator.value.span)
                    constant = constant_value(context, value)
                    if context.es and not is_constant(context, value):
                        message = f"the value of const '{name.text}' is not constant, as GLSL ES requires"
                        raise context.fail(declarator.value.span, message, "leave const out")
            elif const:
                raise context.fail(name.span, f"const '{name.text}' needs a value")
            variable = function.scopes.declare(name.text, declared, quantity, not const, value=constant, constant=const)
            if variable is None:
                raise context.fail(name.span, f"'{name.text}' is already declared in this block")
            span = ir.Span(name.span.file, declaration.span.line, declaration.span.column, *name.span[3:])
            function.prelude.append(ir.Declare(variable.ir_name, declared, value, span))
        return []

    # Simple statements

    def assignment(self, assignment: s.Assignment) -> list[ir.Stmt]:
        return [self.assignments.assign(assignment)]

    def expression(self, statement: s.ExpressionStatement) -> list[ir.Stmt]:
        plain, value = self.context.plain, statement.value
        if plain and isinstance(value, s.TypeName):  # a declaration of nothing, `float;`
            return []
        if plain and isinstance(value, s.Name) and names_type(self.context, value.text):  # `Light;`
            return []
        if isinstance(value, s.Comma) or (plain and isinstance(value, s.Conditional)):
            self.assignments.effect(value)
            return []
        callee = value.callee if isinstance(value, s.CallOf) else None
        if isinstance(callee, s.Name) and callee.text == "assume" and "assume" not in self.context.functions:
            return self.assumption(value)
        self.expressions.dropped.add(id(value))
        call = self.expressions.check(value).expr
        if isinstance(call, ir.Call):
            return [ir.Evaluate(call, statement.span)]
        if plain:
            self.assignments.calls_of(call)
            return []
        raise self.context.fail(
            statement.span, "the value of this expression is not used", "assign it, or remove the statement"
        )

    def assumption(self, call: s.Expression) -> list[ir.Stmt]:
        """`assume(condition);`"""
        assert isinstance(call, s.CallOf)
        if len(call.args) != 1:
            raise self.context.fail(call.span, "assume takes one condition", "write assume(x > 0.0);")
        conditions = self.conditions(call.args[0])
        if any(isinstance(part, ir.Call) for condition in conditions for part in subexpressions(condition)):
            hint = "store its result in a variable, and assume a condition on that"
            raise self.context.fail(call.span, "an assumption cannot call a function", hint)
        return [ir.Assume(condition, call.span) for condition in conditions]

    def conditions(self, condition: s.Expression) -> list[ir.Expr]:
        """What an assumption states: `a <= b <= c` is two comparisons, and one of a vector is one of each component."""
        if isinstance(condition, s.Infix) and condition.op == "&&":
            return [*self.conditions(condition.left), *self.conditions(condition.right)]
        if isinstance(condition, s.Infix) and condition.op in _ORDERS:
            left, first = condition.left, []
            if isinstance(left, s.Infix) and left.op in _ORDERS:
                first, left = self.conditions(left), left.right
            sides = [self.expressions.check(side).expr for side in (left, condition.right)]
            floats = any(kind_of(side.type) == "float" for side in sides)
            sides = [_as_float(side) if floats else side for side in sides]
            size = max(components(side.type) for side in sides)
            if all(isinstance(side.type, Scalar | Vector) and components(side.type) in (1, size) for side in sides):
                parts = [[_part(side, index) for side in sides] for index in range(size)]
                return first + [ir.Binary(BOOL, condition.op, a, b, condition.span) for a, b in parts]
        checked = self.condition(condition)
        return [checked] if checked is not None else []

    def if_(self, statement: s.IfStatement) -> list[ir.Stmt]:
        condition = self.condition(statement.condition)
        then = self.body(statement.then)
        otherwise = self.body(statement.otherwise) if statement.otherwise is not None else ()
        return [ir.If(condition, then, otherwise, statement.span)] if condition is not None else []

    # Jumps

    def jump(self, jump: s.Jump) -> list[ir.Stmt]:
        function, span = self.context.function, jump.span
        if jump.kind == "return":
            return self.return_(jump)
        if jump.kind == "discard":
            if self.context.language.vertex or self.context.language.compute:
                raise self.context.fail(span, "discard belongs to fragment shaders")
            return [ir.Discard(span)]
        if jump.kind == "break" and function.switches:
            return [ir.Break(span)]
        if function.loop_depth == 0:
            raise self.context.fail(span, f"{jump.kind} must be inside a loop")
        if jump.kind == "break":
            return [ir.Break(span)]
        flags = [flag for flag in function.switches if flag is not None]
        if not flags:
            return [ir.Continue(span)]
        true = ir.Literal(BOOL, True, span)
        return [*(ir.Assign(flag, "", true, span) for flag in flags), ir.Break(span)]

    def return_(self, jump: s.Jump) -> list[ir.Stmt]:
        context, type_ = self.context, self.context.function.result
        if jump.value is None:
            if type_ != VOID:
                raise context.fail(jump.span, f"this function must return {a_type(type_)}", "write return value;")
            return [ir.Return(None, jump.span)]
        if type_ == VOID:
            value = self.expressions.check(jump.value).expr if context.plain else None
            if value is not None and value.type == VOID:  # return f();
                self.assignments.calls_of(value)
                return [ir.Return(None, jump.span)]
            raise context.fail(jump.span, "this function is void and cannot return a value")
        value = self.expressions.check_as(jump.value, type_, context.function.quantity, "the returned value")
        return [ir.Return(value, jump.span)]


def _as_float(expr: ir.Expr) -> ir.Expr:
    """A number as a float, as no version of GLSL converts it in an assumption."""
    if kind_of(expr.type) not in ("int", "uint"):
        return expr
    return ir.Construct(vector_of("float", components(expr.type)), (expr,), expr.span)


def _part(expr: ir.Expr, index: int) -> ir.Expr:
    """A component of a vector, or a number itself."""
    if isinstance(expr.type, Scalar):
        return expr
    return ir.Swizzle(Scalar(kind_of(expr.type)), expr, "xyzw"[index], expr.span)
