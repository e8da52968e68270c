"""Checks expressions: names, types, overloads and quantities, giving IR.

Where something is wrong, it is reported and an `Untyped` goes up, which nothing complains about a second
time.
"""

from __future__ import annotations

from typing import NamedTuple

from ..diagnostics import Reporter, did_you_mean
from ..ir import nodes as ir
from ..ir.intrinsics import BUILTINS
from ..ir.rules import FLOAT_MAX, element_type, operator_type, prefix_type, swizzle_type
from ..ir.signatures import candidates, resolve
from ..ir.types import (
    BOOL,
    BY_NAME,
    FLOAT,
    INT,
    UINT,
    Array,
    Matrix,
    Sampler,
    Scalar,
    Struct,
    Type,
    Vector,
    Void,
    components,
    kind_of,
    spell,
    vector_of,
)
from . import quantities as q
from . import syntax as s
from .scope import GlobalValue, Scopes, Signature
from .wording import a_type, constructor_hint, declared, mixed_hint, overload_hint, type_hint


class Typed(NamedTuple):
    """A checked expression and the quantity it measures ('' for none)."""

    expr: ir.Expr
    quantity: str = ""


class Untyped(Exception):
    """Unwinds to the statement after an error has been reported."""


_SWIZZLES = ("xyzw", "rgba", "stpq")


class ExpressionChecker:
    """Checks the expressions of one file; `scopes` is set for each function in turn."""

    def __init__(self, reporter: Reporter) -> None:
        self.reporter = reporter
        self.structs: dict[str, Struct] = {}
        self.functions: dict[str, list[Signature]] = {}
        self.globals: dict[str, GlobalValue] = {}
        self.faulty: set[str] = set()
        """What was declared with an error, so that nothing more is said about its use."""
        self.scopes = Scopes()

    def fail(self, span: ir.Span, message: str, hint: str = "") -> Untyped:
        self.reporter.error(span, message, hint)
        return Untyped()

    def unknown(self, span: ir.Span, what: str, name: str, known: list[str]) -> Untyped:
        """Reports a name that nothing has declared."""
        if name in self.faulty:
            return Untyped()
        return self.fail(span, f"unknown {what} '{name}'", did_you_mean(name, known))

    # Types

    def type_named(self, name: s.TypeName) -> tuple[Type, str]:
        """The type and quantity that a type name stands for."""
        type_: Type
        quantity = ""
        if name.name in BY_NAME:
            type_ = BY_NAME[name.name]
        elif name.name in self.structs:
            type_ = self.structs[name.name]
        elif name.name in q.QUANTITIES:
            type_, quantity = q.QUANTITIES[name.name], name.name
        else:
            raise self.unknown(name.span, "type", name.name, [*BY_NAME, *self.structs, *q.QUANTITIES])
        if name.length is not None:
            return self.array_of(type_, name.length), ""
        return type_, quantity

    def array_of(self, element: Type, length: s.Expression | None) -> Type:
        """`element` itself without a length, else an array of that constant length."""
        if length is None:
            return element
        count = self.constant_int(length)
        if count is None or not 1 <= count <= 65536:
            raise self.fail(length.span, "an array's length is a constant from 1 to 65536")
        if isinstance(element, Array | Sampler | Void):
            raise self.fail(length.span, f"there are no arrays of {spell(element)}")
        return Array(element, count)

    def constant_int(self, expression: s.Expression) -> int | None:
        """The value of a constant integer expression, or None."""
        if isinstance(expression, s.Number) and not expression.is_float:
            return _integer(expression.text)
        if isinstance(expression, s.Name):
            found = self.globals.get(expression.text)
            return found.value if found is not None and self.scopes.find(expression.text) is None else None
        if isinstance(expression, s.Prefix) and expression.op == "-":
            value = self.constant_int(expression.operand)
            return -value if value is not None else None
        if isinstance(expression, s.Infix) and expression.op in ("+", "-", "*"):
            left, right = self.constant_int(expression.left), self.constant_int(expression.right)
            if left is None or right is None:
                return None
            return {"+": left + right, "-": left - right, "*": left * right}[expression.op]
        return None

    # Expressions

    def check(self, expression: s.Expression) -> Typed:
        """Checks an expression. Raises Untyped once its error is reported."""
        method = getattr(self, f"_{type(expression).__name__.lower()}")
        result: Typed = method(expression)
        return result

    def check_as(self, expression: s.Expression, type_: Type, quantity: str, what: str) -> ir.Expr:
        """Checks an expression that must have a type and a quantity."""
        typed = self.check(expression)
        self.require(typed, type_, quantity, expression.span, what)
        return typed.expr

    def require(self, typed: Typed, type_: Type, quantity: str, span: ir.Span, what: str) -> None:
        """Reports unless `typed` fits."""
        if typed.expr.type != type_:
            raise self.fail(
                span,
                f"{what} wants {a_type(type_)}, but this is {a_type(typed.expr.type)}",
                type_hint(typed.expr, type_),
            )
        try:
            q.check_assignable(typed.quantity, quantity)
        except q.Mixup as mixup:
            raise self.fail(span, mixup.message, mixup.hint) from None

    def _number(self, number: s.Number) -> Typed:
        if number.is_float:
            value = float(number.text.rstrip("fF"))
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
        return Typed(ir.Literal(UINT if unsigned else INT, whole if unsigned else _wrapped(whole), number.span))

    def _boolean(self, boolean: s.Boolean) -> Typed:
        return Typed(ir.Literal(BOOL, boolean.value, boolean.span))

    def _name(self, name: s.Name) -> Typed:
        variable = self.scopes.find(name.text)
        if variable is not None:
            if variable.faulty:
                raise Untyped
            return Typed(ir.Local(variable.type, variable.ir_name, name.span), variable.quantity)
        value = self.globals.get(name.text)
        if value is not None:
            return Typed(ir.Global(value.type, name.text, name.span), value.quantity)
        if name.text in self.functions or candidates(name.text):
            raise self.fail(name.span, f"'{name.text}' is a function; call it with (…)")
        raise self.unknown(name.span, "name", name.text, [*self.scopes.names(), *self.globals])

    def _prefix(self, prefix: s.Prefix) -> Typed:
        if prefix.op == "-" and isinstance(prefix.operand, s.Number):
            if prefix.operand.text == "2147483648":
                return Typed(ir.Literal(INT, -2147483648, prefix.span))
            literal = self._number(prefix.operand).expr
            if isinstance(literal, ir.Literal) and literal.type != UINT:
                value = -literal.value if literal.type == FLOAT else _wrapped(-int(literal.value))
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
        left, right = self.check(infix.left), self.check(infix.right)
        type_ = operator_type(infix.op, left.expr.type, right.expr.type)
        if type_ is None:
            raise self.fail(
                infix.span,
                f"'{infix.op}' is not defined for {a_type(left.expr.type)} and {a_type(right.expr.type)}",
                mixed_hint(left.expr, right.expr, infix.op),
            )
        quantity = self.combined(infix.op, left, right, infix.span)
        return Typed(ir.Binary(type_, infix.op, left.expr, right.expr, infix.span), quantity)

    def combined(self, op: str, left: Typed, right: Typed, span: ir.Span) -> str:
        """The quantity of `left op right`."""
        scaling = isinstance(left.expr.type, Scalar) or isinstance(right.expr.type, Scalar)
        try:
            return q.of_operator(op, left.quantity, right.quantity, scaling)
        except q.Mixup as mixup:
            raise self.fail(span, mixup.message, mixup.hint) from None

    def _conditional(self, conditional: s.Conditional) -> Typed:
        condition = self.check_as(conditional.condition, BOOL, "", "a condition")
        yes, no = self.check(conditional.yes), self.check(conditional.no)
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
        return Typed(ir.Select(yes.expr.type, condition, yes.expr, no.expr, conditional.span), quantity)

    def _indexof(self, index: s.IndexOf) -> Typed:
        value = self.check(index.value)
        position = self.check(index.index)
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

    def _memberof(self, member: s.MemberOf) -> Typed:
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

    # Calls

    def _callof(self, call: s.CallOf) -> Typed:
        callee = call.callee
        args = [self.check(arg) for arg in call.args]
        if isinstance(callee, s.TypeName):
            type_, quantity = self.type_named(callee)
            return self.construct(type_, quantity, args, call)
        name = callee.text
        if name in self.functions:
            return self.call_function(name, args, call)
        types = [arg.expr.type for arg in args]
        if candidates(name):
            return self.call_intrinsic(name, args, types, call)
        if name in self.structs:
            return self.construct(self.structs[name], "", args, call)
        if name in q.QUANTITIES:
            return self.construct(q.QUANTITIES[name], name, args, call)
        known = [*self.functions, *self.structs, *q.QUANTITIES, *BUILTINS]
        raise self.unknown(callee.span, "function", name, known)

    def call_function(self, name: str, args: list[Typed], call: s.CallOf) -> Typed:
        """A call of one of the file's own functions; overloads are told apart by exact types."""
        overloads = self.functions[name]
        types = tuple(arg.expr.type for arg in args)
        chosen = next((overload for overload in overloads if overload.types == types), None)
        if chosen is None:
            if name in self.faulty:
                raise Untyped
            if len(overloads) == 1:
                chosen = overloads[0]
                if len(chosen.types) != len(args):
                    count, given = len(chosen.types), len(args)
                    message = f"{name} takes {count} argument{'s' if count != 1 else ''}, but gets {given}"
                    raise self.fail(call.span, message, f"it is declared as {declared(name, chosen)}")
            else:
                listed = ", ".join(declared(name, overload) for overload in overloads)
                shown = ", ".join(map(spell, types))
                raise self.fail(call.span, f"no overload of {name} takes ({shown})", f"there are: {listed}")
        for index, (arg, written) in enumerate(zip(args, call.args, strict=True)):
            direction, quantity = chosen.directions[index], chosen.quantities[index]
            what = f"argument {index + 1} ('{chosen.names[index]}') of {name}"
            if direction == "out" and arg.expr.type == chosen.types[index]:
                pass  # its value is not read; its quantity is checked on the way out
            else:
                self.require(arg, chosen.types[index], quantity, written.span, what)
            if direction != "in":
                self.check_writable(arg.expr, written.span)
                if arg.quantity and quantity != arg.quantity:
                    message = f"{what} gives {q.words(quantity)}, but the variable holds {q.words(arg.quantity)}"
                    raise self.fail(written.span, message, q.conversion(quantity, arg.quantity))
        return Typed(ir.Call(chosen.result, chosen.key, tuple(arg.expr for arg in args), call.span), chosen.quantity)

    def call_intrinsic(self, name: str, args: list[Typed], types: list[Type], call: s.CallOf) -> Typed:
        result = resolve(name, types)
        if result is None:
            given = ", ".join(map(spell, types))
            raise self.fail(
                call.span,
                f"no overload of {name} takes ({given})",
                overload_hint(name, [arg.expr for arg in args]),
            )
        try:
            if isinstance(types[0], Sampler):
                quantity = q.texel_of(args[0].quantity)
                if len(args) > 1 and args[1].quantity == "uv_direction":
                    message = f"a texture is read at a position, but this is {q.words(args[1].quantity)}"
                    raise q.Mixup(message, q.conversion(args[1].quantity, "uv_position"))
            else:
                quantity = q.of_intrinsic(name, [arg.quantity for arg in args])
        except q.Mixup as mixup:
            raise self.fail(call.span, mixup.message, mixup.hint) from None
        return Typed(ir.Intrinsic(result, name, tuple(arg.expr for arg in args), call.span), quantity)

    def construct(self, type_: Type, quantity: str, args: list[Typed], call: s.CallOf) -> Typed:
        """A constructor, with every argument brought to the type's own kind."""
        if quantity and len(args) == 1:
            try:
                q.check_constructible(args[0].quantity, quantity)
            except q.Mixup as mixup:
                raise self.fail(call.span, mixup.message, mixup.hint) from None
        values = tuple(arg.expr for arg in args)
        wrong = self.constructor_error(type_, args, call)
        if wrong:
            raise self.fail(call.span, wrong, constructor_hint(type_))
        if isinstance(type_, Array):
            held = {arg.quantity for arg in args}
            return Typed(ir.Construct(type_, values, call.span), held.pop() if len(held) == 1 else "")
        kind, given = kind_of(type_), values[0].type
        if isinstance(type_, Scalar) and isinstance(values[0], ir.Literal):
            return Typed(self.literal_as(values[0], type_, call.span), quantity)
        if isinstance(given, Vector) and len(values) == 1 and components(given) > components(type_):
            letters = "xyzw"[: components(type_)]
            values = (ir.Swizzle(vector_of(given.kind, len(letters)), values[0], letters, call.span),)
        if kind and not (len(values) == 1 and components(values[0].type) == components(type_)):
            values = tuple(self.to_kind(value, kind) for value in values)
        if len(values) == 1 and values[0].type == type_:
            return Typed(values[0], quantity)
        return Typed(ir.Construct(type_, values, call.span), quantity)

    def to_kind(self, value: ir.Expr, kind: str) -> ir.Expr:
        """`value` with its components converted to `kind`."""
        if kind_of(value.type) == kind:
            return value
        if isinstance(value, ir.Literal):
            return self.literal_as(value, Scalar(kind), value.span)
        return ir.Construct(vector_of(kind, components(value.type)), (value,), value.span)

    def literal_as(self, literal: ir.Literal, type_: Scalar, span: ir.Span) -> ir.Literal:
        """A literal converted: an int and a uint keep their bits, a float is cut towards zero."""
        value = literal.value
        if type_ == FLOAT:
            return ir.Literal(type_, float(value), span)
        if type_ == BOOL:
            return ir.Literal(type_, bool(value), span)
        whole = int(value)
        low, high = (0, 2**32) if type_ == UINT else (-(2**31), 2**31)
        if literal.type == FLOAT and not low <= whole < high:
            raise self.fail(span, f"{value:g} does not fit in {a_type(type_)}")
        return ir.Literal(type_, whole & 0xFFFFFFFF if type_ == UINT else _wrapped(whole), span)

    def constructor_error(self, type_: Type, args: list[Typed], call: s.CallOf) -> str:
        """What is wrong with a constructor's arguments, or ''."""
        types = [arg.expr.type for arg in args]
        name = spell(type_)
        if isinstance(type_, Struct | Array):
            fields = type_.fields if isinstance(type_, Struct) else ()
            wanted = [field.type for field in fields] if fields else [type_.element] * type_.length  # type: ignore[union-attr]
            if types != wanted:
                return f"{name}(…) wants ({', '.join(map(spell, wanted))}), but gets ({', '.join(map(spell, types))})"
            for arg, field, written in zip(args, fields, call.args, strict=False):
                self.require(arg, field.type, field.quantity, written.span, f"member '{field.name}'")
            return ""
        if isinstance(type_, Sampler | Void):
            return f"a {name} cannot be constructed"
        if not types or any(not kind_of(given) for given in types):
            return f"{name}(…) cannot be made from ({', '.join(map(spell, types))})"
        if len(types) == 1:
            given = types[0]
            if isinstance(type_, Matrix):
                fits = isinstance(given, Scalar | Matrix)
            else:
                fits = isinstance(given, Scalar) or components(given) >= components(type_)
                fits = fits and not isinstance(given, Matrix)
            return "" if fits else f"{name}(…) cannot be made from {a_type(given)}"
        if isinstance(type_, Scalar) or any(isinstance(given, Matrix) for given in types):
            return f"{name}(…) cannot be made from ({', '.join(map(spell, types))})"
        count = sum(components(given) for given in types)
        if count != components(type_):
            return f"{name}(…) wants {components(type_)} components, but gets {count}"
        return ""

    def check_writable(self, target: ir.Expr, span: ir.Span) -> None:
        """Reports unless `target` may be assigned to."""
        inner = target
        while isinstance(inner, ir.Swizzle | ir.Index | ir.Member):
            if isinstance(inner, ir.Swizzle) and len(set(inner.components)) != len(inner.components):
                raise self.fail(span, f"'.{inner.components}' names a component twice and cannot be assigned to")
            inner = inner.value
        if isinstance(inner, ir.Global) or isinstance(target.type, Sampler):
            name = inner.name if isinstance(inner, ir.Global | ir.Local) else "this"
            raise self.fail(span, f"'{name}' cannot be changed here; copy it to a local variable")
        if not isinstance(inner, ir.Local):
            raise self.fail(span, "this cannot be assigned to")
        if not self.scopes.visible[inner.name].writable:
            raise self.fail(span, f"'{inner.name}' is const and cannot be changed")


def _integer(text: str) -> int | None:
    """The value of an integer as written; None for what is meant as octal and is not. Absurdly long ones are cut."""
    digits = text.rstrip("uU")[:40]
    if digits[:2] in ("0x", "0X"):
        return int(digits, 16)
    if len(digits) > 1 and digits[0] == "0":
        return int(digits, 8) if set(digits) <= set("01234567") else None
    return int(digits)


def _wrapped(value: int) -> int:
    """An integer brought into the range of an int, as its 32 bits read."""
    return (value + 2**31) % 2**32 - 2**31
