"""Checks what expressions do besides giving a value: assignments and steps, the comma, calls whose value is dropped.

Each becomes statements of the prelude, before the statement that the expression stands in (see `expressions`).
"""

from __future__ import annotations

from sssgen.ir import nodes as ir
from sssgen.ir.rules import operator_type
from sssgen.ir.types import BOOL, FLOAT, Matrix, Sampler, Scalar, Vector, kind_of
from sssgen.ir.walk import subexpressions
from sssgen.lang.check.evaluation_order import depends, root_name, writes_of
from sssgen.lang.check.expression_checker import ExpressionChecker, Typed
from sssgen.lang.check.implicit_conversions import as_kind, converts
from sssgen.lang.check.wording import a_type, mixed_hint
from sssgen.lang.syntax import tree as s


class AssignmentChecker(ExpressionChecker):
    """Checks the side effects of one file's expressions."""

    def _comma(self, comma: s.Comma) -> Typed:
        for part in comma.parts[:-1]:
            self.effect(part)
        return self.check(comma.parts[-1])

    def effect(self, expression: s.Expression) -> None:
        """Adds what an expression does to the prelude, and drops its value."""
        if isinstance(expression, s.Assignment):
            self.prelude.append(self.assign(expression))
        elif isinstance(expression, s.Comma):
            for part in expression.parts:
                self.effect(part)
        elif isinstance(expression, s.Conditional):
            condition = self.check_as(expression.condition, BOOL, "", "a condition")
            _, yes = self.apart(expression.yes, self.effect)
            _, no = self.apart(expression.no, self.effect)
            if yes or no:
                self.prelude.append(ir.If(condition, tuple(yes), tuple(no), expression.span))
        else:
            self.calls_of(self.check(expression).expr)

    def calls_of(self, value: ir.Expr) -> None:
        """Adds the calls in a value that is dropped to the prelude: they may do something besides giving it."""
        if isinstance(value, ir.Call):
            self.prelude.append(ir.Evaluate(value, value.span))
        elif any(isinstance(part, ir.Call) for part in subexpressions(value)):
            self.temporary("dropped", value)

    def _assignment(self, assignment: s.Assignment) -> Typed:
        """An assignment inside an expression."""
        made = self.assign(assignment)
        if assignment.after:
            name = root_name(made.target)
            before = self.temporary(f"{name}_before", made.target)
            self.prelude.append(made)
            return Typed(before)
        self.prelude.append(made)
        return Typed(made.target)

    def pinned(self, target: ir.Expr, value: ir.Expr, before: int) -> ir.Expr:
        """The place of an assignment as it is before its right side runs, which may change what an index is made of."""
        if not isinstance(target, ir.Index | ir.Swizzle | ir.Member):
            return target
        inner = self.pinned(target.value, value, before)
        if inner is not target.value:
            target = target._replace(value=inner)
        if not isinstance(target, ir.Index) or isinstance(target.index, ir.Literal):
            return target
        calls = [part for part in subexpressions(value) if isinstance(part, ir.Call)]
        written, called = writes_of(self.prelude[before:])
        written |= {root_name(arg) for call in calls for arg in self.out_args(call)}
        if not depends(target.index, written, called or bool(calls)):
            return target
        return target._replace(index=self.temporary("place", target.index, before))

    def out_args(self, call: ir.Call) -> list[ir.Expr]:
        """The arguments of a call that it writes to."""
        raise NotImplementedError

    def assign(self, assignment: s.Assignment) -> ir.Assign:
        """The statement of an assignment; what its two sides do is in the prelude."""
        target, span = self.check(assignment.target), assignment.span
        self.check_writable(target.expr, assignment.target.span)
        type_, op = target.expr.type, assignment.op
        if not op:
            assert assignment.value is not None
            before = len(self.prelude)
            whole = self.check_as(assignment.value, type_, target.quantity, "the assignment")
            return ir.Assign(self.pinned(target.expr, whole, before), op, whole, span)
        if assignment.value is not None:
            before = len(self.prelude)
            right = self.check(assignment.value)
            target = target._replace(expr=self.pinned(target.expr, right.expr, before))
        elif isinstance(type_, Scalar | Vector | Matrix) and type_.kind != "bool":
            number = FLOAT if type_.kind == "float" else Scalar(type_.kind)
            right = Typed(ir.Literal(number, 1.0 if number == FLOAT else 1, span))
        else:
            raise self.fail(span, f"'{op * 2}' is not defined for {a_type(type_)}")
        value = right.expr
        if self.plain and op not in ("<<", ">>") and operator_type(op, type_, value.type) != type_:
            value = as_kind(value, kind_of(type_)) if converts(value.type, type_, whole=False) else value
        if operator_type(op, type_, value.type) != type_:
            message = f"'{op}=' is not defined for {a_type(type_)} and {a_type(right.expr.type)}"
            raise self.fail(span, message, mixed_hint(target.expr, right.expr, op))
        if target.quantity or right.quantity:
            quantity = self.combined(op, target, right, span)
            if op not in ("*", "/") or not isinstance(value.type, Scalar):  # scaling in place keeps it
                self.require(target._replace(quantity=quantity), type_, target.quantity, span, "the assignment")
        return ir.Assign(target.expr, op, value, span)

    def check_writable(self, target: ir.Expr, span: ir.Span) -> None:
        """Reports unless `target` may be assigned to."""
        inner = target
        while isinstance(inner, ir.Swizzle | ir.Index | ir.Member):
            if isinstance(inner, ir.Swizzle) and len(set(inner.components)) != len(inner.components):
                raise self.fail(span, f"'.{inner.components}' names a component twice and cannot be assigned to")
            inner = inner.value
        if isinstance(inner, ir.Global) and self.globals[inner.name].writable:
            return
        if isinstance(inner, ir.Global) or isinstance(target.type, Sampler):
            name = inner.name if isinstance(inner, ir.Global | ir.Local) else "this"
            raise self.fail(span, f"'{name}' cannot be changed here; copy it to a local variable")
        if not isinstance(inner, ir.Local):
            raise self.fail(span, "this cannot be assigned to")
        if not self.scopes.visible[inner.name].writable:
            raise self.fail(span, f"'{inner.name}' is const and cannot be changed")
