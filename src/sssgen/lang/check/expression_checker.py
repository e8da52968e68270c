"""Checks expressions: names, types, overloads and quantities, giving IR.

Where something is wrong, it is reported and an `Untyped` goes up, which nothing complains about a second
time.

The IR's expressions have no side effect. What an expression does besides giving its value (an assignment in it, a
step) goes into the `prelude`, the statements that run before it; operands that come before it in the source and that
it changes are kept in variables first.
"""

from __future__ import annotations

import operator
from collections.abc import Callable, Sequence
from typing import NamedTuple, TypeVar, get_args

from sssgen.ir import nodes as ir
from sssgen.ir.rules import FLOAT_MAX, element_type, operator_type, prefix_type, swizzle_type
from sssgen.ir.signatures import candidates
from sssgen.ir.types import (
    BOOL,
    BY_NAME,
    FLOAT,
    INT,
    UINT,
    Array,
    Sampler,
    Scalar,
    Struct,
    Type,
    Vector,
    Void,
    kind_of,
    spell,
)
from sssgen.lang import shadertoy
from sssgen.lang.check import quantities as q
from sssgen.lang.check.evaluation_order import depends, writes_of
from sssgen.lang.check.implicit_conversions import as_kind, common_kind, converts, wrapped
from sssgen.lang.check.name_scope import GlobalValue, Scopes, Signature
from sssgen.lang.check.wording import a_type, mixed_hint, type_hint, why_not
from sssgen.lang.syntax import tree as s
from sssgen.support.diagnostics import Reporter, did_you_mean


class Typed(NamedTuple):
    """A checked expression and the quantity it measures ('' for none)."""

    expr: ir.Expr
    quantity: str = ""


class Untyped(Exception):
    """Unwinds to the statement after an error has been reported."""


_T = TypeVar("_T")

_WHOLE: dict[str, Callable[[int, int], int]] = {
    "+": operator.add, "-": operator.sub, "*": operator.mul, "<<": operator.lshift, ">>": operator.rshift,
    "&": operator.and_, "|": operator.or_, "^": operator.xor, "/": lambda x, y: abs(x) // y * (1 if x >= 0 else -1),
    "%": lambda x, y: abs(x) % y * (1 if x >= 0 else -1),
}  # fmt: skip
"""The operators of constant whole numbers; a divisor is above 0, a shift at most 64."""

_SWIZZLES = ("xyzw", "rgba", "stpq")


class ExpressionChecker:
    """Checks the expressions of one file; `scopes` is set for each function in turn.

    `plain`: the file is GLSL as people have it, where an int becomes a float by itself and loops end by themselves.
    """

    def __init__(self, reporter: Reporter, plain: bool = False) -> None:
        self.reporter = reporter
        self.plain = plain
        self.fallen = 0
        """How many statements the cases of the function at hand have, with those that they fall through to."""
        self.prelude: list[ir.Stmt] = []
        """What runs before the expression at hand."""
        self.structs: dict[str, Struct] = {}
        self.functions: dict[str, list[Signature]] = {}
        self.globals: dict[str, GlobalValue] = {}
        self.faulty: set[str] = set()
        """What was declared with an error, so that nothing more is said about its use."""
        self.instances: dict[str, dict[str, Typed]] = {}
        """The members of the blocks that have an instance name, by that name."""
        self.texture_arrays: dict[str, list[str]] = {}
        """The textures that stand for an array of them, by the array's name."""
        self.scopes = Scopes()
        self.methods = {kind: getattr(self, f"_{kind.__name__.lower()}") for kind in get_args(s.Expression)}

    def fail(self, span: ir.Span, message: str, hint: str = "") -> Untyped:
        self.reporter.error(span, message, hint)
        return Untyped()

    def unknown(self, span: ir.Span, what: str, name: str, known: list[str]) -> Untyped:
        """Reports a name that nothing has declared."""
        if name in self.faulty:
            return Untyped()
        hint = did_you_mean(name, known)
        if self.plain and name in shadertoy.UNIFORMS:
            hint = "it is Shadertoy's: write --entry shadertoy"
        return self.fail(span, f"unknown {what} '{name}'", hint)

    # Types

    def type_named(self, name: s.TypeName) -> tuple[Type, str]:
        """The type and quantity that a type name stands for."""
        type_: Type
        quantity = ""
        if name.name in BY_NAME:
            type_ = BY_NAME[name.name]
        elif name.name in self.structs:
            type_ = self.structs[name.name]
        elif name.name in q.QUANTITIES and not self.plain:
            type_, quantity = q.QUANTITIES[name.name], name.name
        elif self.plain and (why := why_not(name.name)):
            raise self.fail(name.span, f"'{name.name}' cannot be translated: {why}")
        else:
            raise self.unknown(name.span, "type", name.name, [*BY_NAME, *self.structs, *q.QUANTITIES])
        if name.lengths:
            return self.array_of(type_, name.lengths), ""
        return type_, quantity

    def array_of(self, element: Type, lengths: Sequence[s.Expression], items: int | None = None) -> Type:
        """`element` itself without a length, else an array of that constant length; `items` says it for `[]`."""
        if not lengths:
            return element
        if len(lengths) > 1 or isinstance(element, Array | Sampler | Void):
            of = f"there are no arrays of {'arrays' if len(lengths) > 1 else spell(element)}"
            raise self.fail(lengths[0].span, of)
        length = lengths[0]
        count = items if isinstance(length, s.Unsized) else self.constant_int(length)
        if count is None or not 1 <= count <= 65536:
            raise self.fail(length.span, "an array's length is a constant from 1 to 65536")
        return Array(element, count)

    def constant_int(self, expression: s.Expression) -> int | None:
        """The value of a constant integer expression, or None."""
        if isinstance(expression, s.Number) and not expression.is_float:
            return _integer(expression.text)
        if isinstance(expression, s.Name):
            local = self.scopes.find(expression.text)
            if local is not None:
                return local.value
            found = self.globals.get(expression.text)
            return found.value if found is not None else None
        if isinstance(expression, s.Prefix) and expression.op in "-+":
            value = self.constant_int(expression.operand)
            return -value if value is not None and expression.op == "-" else value
        if isinstance(expression, s.Infix) and expression.op in _WHOLE:
            left, right = self.constant_int(expression.left), self.constant_int(expression.right)
            if left is None or right is None or (expression.op in "/%<<>>" and not 0 < right < 2**31):
                return None
            return wrapped(_WHOLE[expression.op](left, min(right, 64) if expression.op in ("<<", ">>") else right))
        if isinstance(expression, s.CallOf) and isinstance(expression.callee, s.TypeName):
            whole = expression.callee.name in ("int", "uint") and len(expression.args) == 1
            return self.constant_int(expression.args[0]) if whole else None
        return None

    # Expressions

    def check(self, expression: s.Expression) -> Typed:
        """Checks an expression. Raises Untyped once its error is reported."""
        result: Typed = self.methods[expression.__class__](expression)
        return result

    def check_as(self, expression: s.Expression, type_: Type, quantity: str, what: str) -> ir.Expr:
        """Checks an expression that must have a type and a quantity."""
        if isinstance(expression, s.Listed):
            return self.listed_as(expression, type_, what)
        return self.require(self.check(expression), type_, quantity, expression.span, what)

    def require(self, typed: Typed, type_: Type, quantity: str, span: ir.Span, what: str) -> ir.Expr:
        """The expression as the type that is wanted; reports unless it fits."""
        expr = typed.expr
        if expr.type != type_:
            if not self.plain or not converts(expr.type, type_):
                message = f"{what} wants {a_type(type_)}, but this is {a_type(expr.type)}"
                raise self.fail(span, message, type_hint(expr, type_))
            expr = as_kind(expr, kind_of(type_))
        if quantity or typed.quantity:
            try:
                q.check_assignable(typed.quantity, quantity)
            except q.Mixup as mixup:
                raise self.fail(span, mixup.message, mixup.hint) from None
        return expr

    def listed_as(self, listed: s.Listed, type_: Type, what: str) -> ir.Expr:
        """`{…}` as the array, struct, matrix or vector that it stands for."""
        wanted: list[Type]
        if isinstance(type_, Struct):
            wanted = [field.type for field in type_.fields]
        else:
            found = element_type(type_)
            if found is None:
                raise self.fail(listed.span, f"{what} wants {a_type(type_)}, which is not made of parts")
            wanted = [found[0]] * found[1]
        if len(wanted) != len(listed.items):
            message = f"{what} wants {len(wanted)} parts for {a_type(type_)}, but gets {len(listed.items)}"
            raise self.fail(listed.span, message)
        parts = [self.check_as(item, part, "", what) for item, part in zip(listed.items, wanted, strict=True)]
        return ir.Construct(type_, tuple(parts), listed.span)

    def operands(self, parts: Sequence[s.Expression]) -> list[Typed]:
        """Checks expressions that are evaluated one after the other."""
        found: list[Typed] = []
        for part in parts:
            before = len(self.prelude)
            found.append(self.check(part))
            if len(self.prelude) > before:
                self.keep_earlier(found, before)
        return found

    def keep_earlier(self, found: list[Typed], before: int) -> None:
        """Keeps the values of all but the last of `found` that what was added to the prelude would change."""
        written, calls = writes_of(self.prelude[before:])
        for index, typed in enumerate(found[:-1]):
            if depends(typed.expr, written, calls):
                kept = self.temporary("before", typed.expr, before)
                found[index] = Typed(kept, typed.quantity)
                before += 1

    def temporary(
        self, name: str, value: ir.Expr | None, place: int | None = None, type_: Type | None = None
    ) -> ir.Local:
        """A new variable of about this name with this value, declared in the prelude."""
        made = type_ if type_ is not None else value.type if value is not None else FLOAT
        span = value.span if value is not None else ir.NOWHERE
        label, count = name, 2
        while self.scopes.find(label) is not None or (variable := self.scopes.declare(label, made, "", True)) is None:
            label, count = f"{name}_{count}", count + 1
        declared = ir.Declare(variable.ir_name, made, value, span)
        self.prelude.insert(len(self.prelude) if place is None else place, declared)
        return ir.Local(made, variable.ir_name, span)

    def apart(self, expression: s.Expression, check: Callable[[s.Expression], _T]) -> tuple[_T, list[ir.Stmt]]:
        """What `check` gives for an expression, and what runs before that alone."""
        outer, self.prelude = self.prelude, []
        try:
            return check(expression), self.prelude
        finally:
            self.prelude = outer

    def _number(self, number: s.Number) -> Typed:
        if number.is_float:
            value = float(number.text.rstrip("fFlL"))
            if value > FLOAT_MAX:
                raise self.fail(number.span, f"{number.text} does not fit in a float")
            return Typed(ir.Literal(FLOAT, value, number.span))
        unsigned, whole = number.text[-1] in "uU", _integer(number.text)
        if whole is None:
            hint = "what begins with 0 is octal: leave the 0 out"
            raise self.fail(number.span, f"{number.text} is no octal number", hint)
        if whole > 0xFFFFFFFF or (whole > 0x7FFFFFFF and not unsigned and number.text[:2] not in ("0x", "0X")):
            shown = number.text if len(number.text) <= 40 else f"{number.text[:40]}…"
            raise self.fail(number.span, f"{shown} does not fit in {'a uint' if unsigned else 'an int'}")
        return Typed(ir.Literal(UINT if unsigned else INT, whole if unsigned else wrapped(whole), number.span))

    def _boolean(self, boolean: s.Boolean) -> Typed:
        return Typed(ir.Literal(BOOL, boolean.value, boolean.span))

    def _name(self, name: s.Name) -> Typed:
        variable = self.scopes.find(name.text)
        if variable is not None:
            if variable.faulty:
                raise Untyped
            return Typed(ir.Local(variable.type, variable.ir_name, name.span), variable.quantity)
        value = self.globals.get(name.text) or self.builtin_variable(name)
        if value is not None:
            if value.constant and name.text.startswith("gl_"):
                return Typed(ir.Literal(INT, value.value or 0, name.span))
            return Typed(ir.Global(value.type, name.text, name.span), value.quantity)
        if name.text in self.instances:
            raise self.fail(name.span, f"'{name.text}' is a block; name one of its members")
        if name.text in self.functions or candidates(name.text):
            raise self.fail(name.span, f"'{name.text}' is a function; call it with (…)")
        raise self.unknown(name.span, "name", name.text, [*self.scopes.names(), *self.globals])

    def builtin_variable(self, name: s.Name) -> GlobalValue | None:
        """What a name such as gl_FragCoord stands for."""
        return None

    def _typename(self, name: s.TypeName) -> Typed:
        raise self.fail(name.span, f"'{name.name}' is a type; make a value of it with (…)")

    def _unsized(self, unsized: s.Unsized) -> Typed:
        raise self.fail(unsized.span, "an index is missing between the brackets")

    def _listed(self, listed: s.Listed) -> Typed:
        raise self.fail(listed.span, "{…} stands only as the value of a declaration")

    def _prefix(self, prefix: s.Prefix) -> Typed:
        if prefix.op == "-" and isinstance(prefix.operand, s.Number):
            if prefix.operand.text == "2147483648":
                return Typed(ir.Literal(INT, -2147483648, prefix.span))
            literal = self._number(prefix.operand).expr
            if isinstance(literal, ir.Literal) and literal.type != UINT:
                value = -literal.value if literal.type == FLOAT else wrapped(-int(literal.value))
                return Typed(ir.Literal(literal.type, value, prefix.span))
        typed = self.check(prefix.operand)
        type_ = typed.expr.type
        if prefix_type(prefix.op.replace("+", "-"), type_) is None:
            hint = "for a bool vector, use not(…)" if prefix.op == "!" and kind_of(type_) == "bool" else ""
            raise self.fail(prefix.span, f"'{prefix.op}' is not defined for {a_type(type_)}", hint)
        if prefix.op == "+":
            return Typed(typed.expr, "" if typed.quantity.endswith("_position") else typed.quantity)
        keeps = prefix.op == "-" and typed.quantity.endswith("_direction")
        return Typed(ir.Unary(type_, prefix.op, typed.expr, prefix.span), typed.quantity if keeps else "")

    def _infix(self, infix: s.Infix) -> Typed:
        left = self.check(infix.left)
        before = len(self.prelude)
        right = self.check(infix.right)
        if len(self.prelude) > before:
            if infix.op in ("&&", "||"):
                return self.short_circuit(infix, left, right, before)
            pair = [left, right]
            self.keep_earlier(pair, before)
            left = pair[0]
        one, other = left.expr, right.expr
        type_ = operator_type(infix.op, one.type, other.type)
        if type_ is None and self.plain and infix.op not in ("<<", ">>"):
            one, other = common_kind(one, other)
            type_ = operator_type(infix.op, one.type, other.type)
        if type_ is None:
            raise self.fail(
                infix.span,
                f"'{infix.op}' is not defined for {a_type(left.expr.type)} and {a_type(right.expr.type)}",
                mixed_hint(left.expr, right.expr, infix.op),
            )
        quantity = self.combined(infix.op, left, right, infix.span) if left.quantity or right.quantity else ""
        return Typed(ir.Binary(type_, infix.op, one, other, infix.span), quantity)

    def short_circuit(self, infix: s.Infix, left: Typed, right: Typed, before: int) -> Typed:
        """`left && right` whose right side does something, which it does only where the left one asks for it."""
        inner = self.prelude[before:]
        del self.prelude[before:]
        for typed, part in ((left, infix.left), (right, infix.right)):
            self.require(typed, BOOL, "", part.span, f"'{infix.op}'")
        both = self.temporary("both" if infix.op == "&&" else "either", left.expr)
        condition: ir.Expr = both if infix.op == "&&" else ir.Unary(BOOL, "!", both, infix.span)
        then = (*inner, ir.Assign(both, "", right.expr, infix.span))
        self.prelude.append(ir.If(condition, then, (), infix.span))
        return Typed(both)

    def combined(self, op: str, left: Typed, right: Typed, span: ir.Span) -> str:
        """The quantity of `left op right`."""
        scaling = isinstance(left.expr.type, Scalar) or isinstance(right.expr.type, Scalar)
        try:
            return q.of_operator(op, left.quantity, right.quantity, scaling)
        except q.Mixup as mixup:
            raise self.fail(span, mixup.message, mixup.hint) from None

    def _conditional(self, conditional: s.Conditional) -> Typed:
        condition = self.check_as(conditional.condition, BOOL, "", "a condition")
        yes, before_yes = self.apart(conditional.yes, self.check)
        no, before_no = self.apart(conditional.no, self.check)
        if yes.expr.type != no.expr.type and self.plain:
            one, other = common_kind(yes.expr, no.expr)
            yes, no = yes._replace(expr=one), no._replace(expr=other)
        if yes.expr.type != no.expr.type:
            raise self.fail(
                conditional.span,
                f"the two arms differ: {a_type(yes.expr.type)} and {a_type(no.expr.type)}",
                mixed_hint(yes.expr, no.expr),
            )
        if isinstance(yes.expr.type, Sampler | Void):
            raise self.fail(conditional.span, f"'?:' cannot choose {a_type(yes.expr.type)}")
        if yes.quantity and no.quantity and yes.quantity != no.quantity:
            message = f"the two arms differ: {q.words(yes.quantity)} and {q.words(no.quantity)}"
            raise self.fail(conditional.span, message, q.conversion(no.quantity, yes.quantity))
        quantity = yes.quantity if yes.quantity == no.quantity else ""
        if before_yes or before_no:
            span = conditional.span
            chosen = self.temporary("chosen", None, type_=yes.expr.type)
            then: ir.Block = (*before_yes, ir.Assign(chosen, "", yes.expr, span))
            otherwise: ir.Block = (*before_no, ir.Assign(chosen, "", no.expr, span))
            self.prelude.append(ir.If(condition, then, otherwise, span))
            return Typed(chosen, quantity)
        return Typed(ir.Select(yes.expr.type, condition, yes.expr, no.expr, conditional.span), quantity)

    def _indexof(self, index: s.IndexOf) -> Typed:
        if isinstance(index.value, s.Name) and index.value.text in self.texture_arrays:
            return self.texture_of(index.value, index)
        value, position = self.operands((index.value, index.index))
        if position.expr.type not in (INT, UINT):
            raise self.fail(index.index.span, f"an index is an int, but this is {a_type(position.expr.type)}")
        type_ = value.expr.type
        found = element_type(type_)
        if found is None:
            raise self.fail(index.span, f"{a_type(type_)} has no elements to index")
        result, length = found
        constant = self.constant_int(index.index)
        if constant is not None and not 0 <= constant < length:
            raise self.fail(index.index.span, f"index {constant} is outside {spell(type_)}: 0 to {length - 1}")
        quantity = value.quantity if isinstance(type_, Array) else ""
        return Typed(ir.Index(result, value.expr, position.expr, index.span), quantity)

    def texture_of(self, name: s.Name, index: s.IndexOf) -> Typed:
        """One texture of an array of them, which are textures of their own."""
        found = self.texture_arrays[name.text]
        place = self.constant_int(index.index)
        if place is None or not 0 <= place < len(found):
            message = f"a texture of '{name.text}' is chosen by a constant from 0 to {len(found) - 1}"
            raise self.fail(index.index.span, message, "WebGPU has no arrays of textures: write the cases out")
        value = self.globals[found[place]]
        return Typed(ir.Global(value.type, found[place], index.span), value.quantity)

    def _memberof(self, member: s.MemberOf) -> Typed:
        if isinstance(member.value, s.Name) and member.value.text in self.instances:
            block, label = member.value.text, member.name
            if self.scopes.find(block) is None:
                if label.text not in self.instances[block]:
                    hint = did_you_mean(label.text, self.instances[block])
                    raise self.fail(label.span, f"block '{block}' has no member '{label.text}'", hint)
                found = self.instances[block][label.text]
                return found._replace(expr=found.expr._replace(span=member.span))
        value = self.check(member.value)
        type_, name = value.expr.type, member.name.text
        if isinstance(type_, Struct):
            for field in type_.fields:
                if field.name == name:
                    return Typed(ir.Member(field.type, value.expr, name, member.span), field.quantity)
            known = [field.name for field in type_.fields]
            raise self.fail(
                member.name.span, f"struct '{type_.name}' has no member '{name}'", did_you_mean(name, known)
            )
        if isinstance(type_, Scalar) and self.plain and name in ("x", "r", "s"):
            return value
        if not isinstance(type_, Vector):
            raise self.fail(member.name.span, f"{a_type(type_)} has no member '{name}'")
        for letters in _SWIZZLES:
            parts = name.translate(str.maketrans(letters, "xyzw")) if set(name) <= set(letters) else ""
            result = swizzle_type(type_, parts)
            if result is not None:
                quantity = q.channel_of(value.quantity) if len(parts) == 1 else ""
                return Typed(ir.Swizzle(result, value.expr, parts, member.span), quantity)
        letters = _SWIZZLES[0][: type_.size]
        raise self.fail(member.name.span, f"'{name}' is no swizzle of {a_type(type_)}", f"its components are {letters}")


def _integer(text: str) -> int | None:
    """The value of an integer as written; None for what is meant as octal and is not. Absurdly long ones are cut."""
    digits = text.rstrip("uU")[:40]
    if digits[:2] in ("0x", "0X"):
        return int(digits, 16)
    if len(digits) > 1 and digits[0] == "0":
        return int(digits, 8) if set(digits) <= set("01234567") else None
    return int(digits)
