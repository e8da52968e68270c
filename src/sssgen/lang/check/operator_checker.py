"""Checks operators: prefix, infix and `?:`."""

from __future__ import annotations

from sssgen.ir import nodes as ir
from sssgen.ir.rules import operator_type, prefix_type
from sssgen.ir.types import BOOL, FLOAT, INT, UINT, Sampler, Scalar, Void, kind_of
from sssgen.lang.check import quantities as q
from sssgen.lang.check.context import CheckContext, Typed
from sssgen.lang.check.expression_checker import ExpressionChecker
from sssgen.lang.check.implicit_conversions import common_kind, wrapped
from sssgen.lang.check.type_names import holds_array
from sssgen.lang.check.wording import a_type, mixed_hint
from sssgen.lang.syntax import tree as s


class OperatorChecker:
    """Checks the operators of one file."""

    def __init__(self, expressions: ExpressionChecker) -> None:
        self.context = expressions.context
        self.expressions = expressions
        expressions.methods[s.Prefix] = self.prefix
        expressions.methods[s.Infix] = self.infix
        expressions.methods[s.Conditional] = self.conditional

    def prefix(self, prefix: s.Prefix) -> Typed:
        if prefix.op == "-" and isinstance(prefix.operand, s.Number):
            if prefix.operand.text == "2147483648":
                return Typed(ir.Literal(INT, -2147483648, prefix.span))
            literal = self.expressions.number(prefix.operand).expr
            if isinstance(literal, ir.Literal) and literal.type != UINT:
                value = -literal.value if literal.type == FLOAT else wrapped(-int(literal.value))
                return Typed(ir.Literal(literal.type, value, prefix.span))
        typed = self.expressions.check(prefix.operand)
        type_ = typed.expr.type
        if prefix_type(prefix.op.replace("+", "-"), type_) is None:
            hint = "for a bool vector, use not(…)" if prefix.op == "!" and kind_of(type_) == "bool" else ""
            raise self.context.fail(prefix.span, f"'{prefix.op}' is not defined for {a_type(type_)}", hint)
        if prefix.op == "+":
            return Typed(typed.expr, "" if typed.quantity.endswith("_position") else typed.quantity)
        keeps = prefix.op == "-" and typed.quantity.endswith("_direction")
        return Typed(ir.Unary(type_, prefix.op, typed.expr, prefix.span), typed.quantity if keeps else "")

    def infix(self, infix: s.Infix) -> Typed:
        check, function = self.expressions.check, self.context.function
        left = check(infix.left)
        before = len(function.prelude)
        right = check(infix.right)
        if len(function.prelude) > before:
            if infix.op in ("&&", "||"):
                return self.short_circuit(infix, left, right, before)
            pair = [left, right]
            self.expressions.store_earlier(pair, before)
            left = pair[0]
        one, other = left.expr, right.expr
        type_ = operator_type(infix.op, one.type, other.type)
        if type_ is None and self.context.converts and infix.op not in ("<<", ">>"):
            one, other = common_kind(one, other)
            type_ = operator_type(infix.op, one.type, other.type)
        if type_ is None:
            raise self.context.fail(
                infix.span,
                f"'{infix.op}' is not defined for {a_type(left.expr.type)} and {a_type(right.expr.type)}",
                mixed_hint(left.expr, right.expr, infix.op),
            )
        if self.context.es == 100 and infix.op in ("==", "!=") and holds_array(one.type):
            message = f"GLSL ES 1.00 compares no arrays, but this is {a_type(one.type)}"
            raise self.context.fail(infix.span, message, "compare each element")
        quantity = ""
        if left.quantity or right.quantity:
            quantity = combined_quantity(self.context, infix.op, left, right, infix.span)
        return Typed(ir.Binary(type_, infix.op, one, other, infix.span), quantity)

    def short_circuit(self, infix: s.Infix, left: Typed, right: Typed, start: int) -> Typed:
        """`left && right` or `left || right` where the right side has side effects: the prelude from `start` on."""
        function = self.context.function
        inner = function.prelude[start:]
        del function.prelude[start:]
        for typed, part in ((left, infix.left), (right, infix.right)):
            self.expressions.require(typed, BOOL, "", part.span, f"an operand of '{infix.op}'")
        result = function.temporary("both" if infix.op == "&&" else "either", left.expr)
        condition: ir.Expr = result if infix.op == "&&" else ir.Unary(BOOL, "!", result, infix.span)
        then = (*inner, ir.Assign(result, "", right.expr, infix.span))
        function.prelude.append(ir.If(condition, then, (), infix.span))
        return Typed(result)

    def conditional(self, conditional: s.Conditional) -> Typed:
        condition = self.expressions.check_as(conditional.condition, BOOL, "", "a condition")
        yes, before_yes = self.expressions.with_prelude(conditional.yes, self.expressions.check)
        no, before_no = self.expressions.with_prelude(conditional.no, self.expressions.check)
        if yes.expr.type != no.expr.type:
            one, other = common_kind(yes.expr, no.expr) if self.context.converts else (yes.expr, no.expr)
            if one.type != other.type:
                raise self.context.fail(
                    conditional.span,
                    f"the two arms differ: {a_type(yes.expr.type)} and {a_type(no.expr.type)}",
                    mixed_hint(yes.expr, no.expr),
                )
            yes, no = yes._replace(expr=one), no._replace(expr=other)
        if isinstance(yes.expr.type, Sampler | Void):
            raise self.context.fail(conditional.span, f"'?:' cannot select {a_type(yes.expr.type)}")
        if yes.quantity and no.quantity and yes.quantity != no.quantity:
            message = f"the two arms differ: {q.words(yes.quantity)} and {q.words(no.quantity)}"
            raise self.context.fail(conditional.span, message, q.conversion(no.quantity, yes.quantity))
        quantity = yes.quantity if yes.quantity == no.quantity else ""
        if before_yes or before_no:
            span, function = conditional.span, self.context.function
            chosen = function.temporary("chosen", None, type_=yes.expr.type)
            then: ir.Block = (*before_yes, ir.Assign(chosen, "", yes.expr, span))
            otherwise: ir.Block = (*before_no, ir.Assign(chosen, "", no.expr, span))
            function.prelude.append(ir.If(condition, then, otherwise, span))
            return Typed(chosen, quantity)
        return Typed(ir.Select(yes.expr.type, condition, yes.expr, no.expr, conditional.span), quantity)


def combined_quantity(context: CheckContext, op: str, left: Typed, right: Typed, span: ir.Span) -> str:
    """The quantity of `left op right`."""
    scaling = isinstance(left.expr.type, Scalar) or isinstance(right.expr.type, Scalar)
    try:
        return q.of_operator(op, left.quantity, right.quantity, scaling)
    except q.Mixup as mixup:
        raise context.fail(span, mixup.message, mixup.hint) from None
