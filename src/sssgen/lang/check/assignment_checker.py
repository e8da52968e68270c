"""Checks side effects of expressions: assignments, `++` and `--`, the comma, calls whose result is not used.

Each becomes statements of the prelude, before the statement that contains the expression (see expression_checker.py).
"""

from __future__ import annotations

from sssgen.ir import nodes as ir
from sssgen.ir.rules import operator_type
from sssgen.ir.types import BOOL, FLOAT, Matrix, Sampler, Scalar, Type, Vector, kind_of
from sssgen.ir.walk import subexpressions
from sssgen.lang.check.context import CheckContext, Typed
from sssgen.lang.check.evaluation_order import depends, root_name, writes_of
from sssgen.lang.check.expression_checker import ExpressionChecker
from sssgen.lang.check.implicit_conversions import as_kind, converts
from sssgen.lang.check.operator_checker import combined_quantity
from sssgen.lang.check.type_names import holds_array
from sssgen.lang.check.wording import a_type, mixed_hint
from sssgen.lang.syntax import tree as s


class AssignmentChecker:
    """Checks the side effects of one file's expressions."""

    def __init__(self, expressions: ExpressionChecker) -> None:
        self.context = expressions.context
        self.expressions = expressions
        expressions.methods[s.Assignment] = self.assignment
        expressions.methods[s.Comma] = self.comma

    def comma(self, comma: s.Comma) -> Typed:
        self.context.sequences += 1
        for part in comma.parts[:-1]:
            self.effect(part)
        return self.expressions.check(comma.parts[-1])

    def assignment(self, assignment: s.Assignment) -> Typed:
        """An assignment inside an expression."""
        function = self.context.function
        statement = self.assign(assignment)
        name, position = root_name(statement.target), len(function.prelude)
        value = self.expressions.fixed_place(statement.target, {name}, calls=False, start=position)
        statement = statement._replace(target=value)  # it is read again afterwards
        if assignment.after:
            value = function.temporary(f"{root_name(statement.target)}_before", statement.target)
        function.prelude.append(statement)
        return Typed(value)

    def effect(self, expression: s.Expression) -> Type:
        """Adds the side effects of an expression to the prelude; its value, of this type, is not used."""
        prelude = self.context.function.prelude
        if isinstance(expression, s.Assignment):
            statement = self.assign(expression)
            prelude.append(statement)
            return statement.target.type
        if isinstance(expression, s.Comma):
            return [self.effect(part) for part in expression.parts][-1]
        if isinstance(expression, s.Conditional):
            return self.branch(expression)
        self.expressions.dropped.add(id(expression))
        value = self.expressions.check(expression).expr
        self.calls_of(value)
        return value.type

    def branch(self, conditional: s.Conditional) -> Type:
        """Adds the side effects of `?:` to the prelude; its value, of this type, is not used."""
        context = self.context
        condition = self.expressions.check_as(conditional.condition, BOOL, "", "a condition")
        yes_type, yes = self.expressions.with_prelude(conditional.yes, self.effect)
        no_type, no = self.expressions.with_prelude(conditional.no, self.effect)
        if yes or no:
            context.function.prelude.append(ir.If(condition, tuple(yes), tuple(no), conditional.span))
        if yes_type != no_type and not (
            context.converts and (converts(yes_type, no_type) or converts(no_type, yes_type))
        ):
            message = f"the two arms differ: {a_type(yes_type)} and {a_type(no_type)}"
            raise context.fail(conditional.span, message, "write if and else")
        return no_type if converts(yes_type, no_type) else yes_type

    def calls_of(self, value: ir.Expr) -> None:
        """Adds the calls in an unused value to the prelude, as they may have side effects."""
        function = self.context.function
        if isinstance(value, ir.Call):
            function.prelude.append(ir.Evaluate(value, value.span))
        elif any(isinstance(part, ir.Call) for part in subexpressions(value)):
            function.temporary("dropped", value)

    def assign(self, assignment: s.Assignment) -> ir.Assign:
        """The statement of an assignment; the side effects of its two sides are in the prelude."""
        context, expressions = self.context, self.expressions
        target, span = expressions.check_place(assignment.target), assignment.span
        check_writable(context, target.expr, assignment.target.span)
        type_, op, start = target.expr.type, assignment.op, len(context.function.prelude)
        if not op:
            assert assignment.value is not None
            if context.es == 100 and holds_array(type_):
                message = f"GLSL ES 1.00 assigns no arrays, but this is {a_type(type_)}"
                raise context.fail(span, message, "assign each element")
            source = expressions.check_as(assignment.value, type_, target.quantity, "the assigned value")
            return ir.Assign(self.fixed_place(target.expr, source, start), op, source, span)
        if assignment.value is not None:
            right = expressions.check(assignment.value)
        elif isinstance(type_, Scalar | Vector | Matrix) and type_.kind != "bool":
            number = FLOAT if type_.kind == "float" else Scalar(type_.kind)
            right = Typed(ir.Literal(number, 1.0 if number == FLOAT else 1, span))
        else:
            raise context.fail(span, f"'{op * 2}' is not defined for {a_type(type_)}")
        before = len(context.function.prelude)
        target = target._replace(expr=self.fixed_place(target.expr, right.expr, start))
        start += len(context.function.prelude) - before
        value = right.expr
        if context.converts and op not in ("<<", ">>") and operator_type(op, type_, value.type) != type_:
            value = as_kind(value, kind_of(type_)) if converts(value.type, type_, whole=False) else value
        if operator_type(op, type_, value.type) != type_:
            message = f"'{op}=' is not defined for {a_type(type_)} and {a_type(right.expr.type)}"
            raise context.fail(span, message, mixed_hint(target.expr, right.expr, op))
        if target.quantity or right.quantity:
            quantity = combined_quantity(context, op, target, right, span)
            if op not in ("*", "/") or not isinstance(value.type, Scalar):  # scaling in place keeps the quantity
                scaled = target._replace(quantity=quantity)
                expressions.require(scaled, type_, target.quantity, span, "the assigned value")
        written, calls = writes_of(context.function.prelude[start:], context.out_arguments)
        if depends(target.expr, written, calls):  # the old value is read before the right side changes it
            old = context.function.temporary(f"{root_name(target.expr)}_before", target.expr, start)
            return ir.Assign(target.expr, "", ir.Binary(type_, op, old, value, span), span)
        return ir.Assign(target.expr, op, value, span)

    def fixed_place(self, target: ir.Expr, value: ir.Expr, start: int) -> ir.Expr:
        """The target of an assignment, with every index stored in a variable that evaluating the right side changes.

        The right side is `value` and the prelude from `start` on.
        """
        if not isinstance(target, ir.Index | ir.Swizzle | ir.Member):
            return target
        calls = [part for part in subexpressions(value) if isinstance(part, ir.Call)]
        written, has_calls = writes_of(self.context.function.prelude[start:], self.context.out_arguments)
        written |= {root_name(arg) for call in calls for arg in self.context.out_arguments(call)}
        return self.expressions.fixed_place(target, written, has_calls or bool(calls), start)


def check_writable(context: CheckContext, target: ir.Expr, span: ir.Span) -> None:
    """Reports a target that cannot be assigned to."""
    inner = target
    while isinstance(inner, ir.Swizzle | ir.Index | ir.Member):
        if isinstance(inner, ir.Swizzle) and len(set(inner.components)) != len(inner.components):
            raise context.fail(span, f"'.{inner.components}' names a component twice and cannot be assigned to")
        inner = inner.value
    if isinstance(inner, ir.Global) and context.globals[inner.name].writable:
        return
    if isinstance(inner, ir.Global) and getattr(context.variables.get(inner.name), "access", "") == "readonly":
        raise context.fail(span, "this cannot be assigned to: the storage buffer is readonly")
    if isinstance(inner, ir.Global) or isinstance(target.type, Sampler):
        name = inner.name if isinstance(inner, ir.Global | ir.Local) else "this"
        raise context.fail(span, f"'{name}' cannot be assigned to; copy it to a local variable")
    if not isinstance(inner, ir.Local):
        raise context.fail(span, "this cannot be assigned to")
    if not context.function.scopes.visible[inner.name].writable:
        raise context.fail(span, f"'{inner.name}' is const and cannot be assigned to")
