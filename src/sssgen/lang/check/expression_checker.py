"""Checks expressions: names, types, overloads and quantities; gives IR.

An error is reported once, and AlreadyReported unwinds from it.

The IR's expressions have no side effects. The side effects of an expression (an assignment in it, a step) go into the
function's `prelude`, the statements that run before it. Operands that are evaluated earlier, and that these statements
change, are stored in variables first.
"""

from __future__ import annotations

from collections.abc import Callable, Container, Sequence
from typing import Any, TypeVar

from sssgen.ir import nodes as ir
from sssgen.ir.constant_expressions import literal, zero
from sssgen.ir.intrinsics import BUILTINS
from sssgen.ir.rules import FLOAT_MAX, element_type
from sssgen.ir.types import BOOL, FLOAT, INT, UINT, Struct, Type, kind_of, spell, unnested
from sssgen.ir.walk import subexpressions
from sssgen.lang.check import quantities as q
from sssgen.lang.check.builtin_variables import builtin_variable
from sssgen.lang.check.constant_values import integer_value
from sssgen.lang.check.context import AlreadyReported, CheckContext, Typed
from sssgen.lang.check.evaluation_order import depends, root_name, writes_of
from sssgen.lang.check.implicit_conversions import as_kind, converts, wrapped
from sssgen.lang.check.type_names import array_type
from sssgen.lang.check.wording import a_type, type_hint
from sssgen.lang.syntax import tree as s

_S = TypeVar("_S")
_T = TypeVar("_T")
_VALUES = {s.Assignment: "an assignment", s.Comma: "','", s.Conditional: "'?:'"}
"""Expressions that are never places → their names in messages."""


class ExpressionChecker:
    """Checks the expressions of one file.

    `methods` has a function for each class of expression. Names and literals are checked here; the checkers of
    operators, members, assignments and calls add theirs.
    """

    def __init__(self, context: CheckContext) -> None:
        self.context = context
        context.check_expression = self.check
        self.dropped: set[int] = set()
        """The ids of the calls whose results are not used."""
        self.places: set[int] = set()
        """The ids of the accesses in places that are written to."""
        self.methods: dict[type, Callable[[Any], Typed]] = {
            s.Name: self.name,
            s.Number: self.number,
            s.Boolean: self.boolean,
            s.TypeName: self.type_name,
            s.Unsized: self.unsized,
            s.Listed: self.listed,
        }

    def check(self, expression: s.Expression) -> Typed:
        """Checks an expression. Raises AlreadyReported once its error is reported."""
        result: Typed = self.methods[expression.__class__](expression)
        return result

    def check_as(self, expression: s.Expression, type_: Type, quantity: str, what: str) -> ir.Expr:
        """Checks an expression that must have this type and quantity; `what` names it in messages."""
        if isinstance(expression, s.Listed) and not expression.items and not self.context.es:
            return zero(type_, expression.span)
        if isinstance(expression, s.Listed):
            return self.listed_as(expression, type_, what)
        return self.require(self.check(expression), type_, quantity, expression.span, what)

    def require(self, typed: Typed, type_: Type, quantity: str, span: ir.Span, what: str) -> ir.Expr:
        """The expression as a value of this type, converted where GLSL does so; reports where it does not fit."""
        expr = typed.expr
        if expr.type != type_:
            if not self.context.converts or not converts(expr.type, type_):
                message = f"{what} must be {a_type(type_)}, but this is {a_type(expr.type)}"
                raise self.context.fail(span, message, type_hint(expr, type_))
            expr = as_kind(expr, kind_of(type_))
        if quantity or typed.quantity:
            try:
                q.check_assignable(typed.quantity, quantity)
            except q.Mixup as mixup:
                raise self.context.fail(span, mixup.message, mixup.hint) from None
        return expr

    def listed_as(self, listed: s.Listed, type_: Type, what: str) -> ir.Expr:
        """`{…}` as a value of an array, struct, matrix or vector type."""
        if self.context.es:
            raise self.context.fail(listed.span, "GLSL ES has no values in braces", f"write {spell(type_)}(…)")
        types: list[Type]
        if isinstance(type_, Struct):
            types = [field.type for field in type_.fields]
        else:
            element = element_type(type_)
            if element is None:
                raise self.context.fail(listed.span, f"{what} must be {a_type(type_)}, which is not a list of values")
            types = [element[0]] * element[1]
        if len(types) != len(listed.items):
            message = f"{what} needs {len(types)} values for {a_type(type_)}, but {len(listed.items)} are listed"
            raise self.context.fail(listed.span, message)
        values = list[Typed]()
        for item, part in zip(listed.items, types, strict=True):
            if isinstance(item, s.Listed) and not item.items:
                hint = "list the values of each part, or write {} for the whole value"
                raise self.context.fail(item.span, "{} is no value of a part", hint)
            before = len(self.context.function.prelude)
            values.append(Typed(self.check_as(item, part, "", what)))
            if len(self.context.function.prelude) > before:
                self.store_earlier(values, before)
        return ir.Construct(type_, tuple([value.expr for value in values]), listed.span)

    def check_place(self, expression: s.Expression) -> Typed:
        """Checks an expression that is written to: what its indices change is no copy of the variable."""
        part = expression
        while isinstance(part, s.IndexOf | s.MemberOf):
            self.places.add(id(part))
            part = part.value
        for kind, words in _VALUES.items():
            if isinstance(part, kind):
                message = f"the value of {words} cannot be assigned to"
                raise self.context.fail(part.span, message, "write two statements")
        return self.check(expression)

    def operands(self, parts: Sequence[s.Expression], outs: Container[int] = ()) -> list[Typed]:
        """Checks expressions that are evaluated in this order; those at the positions `outs` are places to write to."""
        function, values = self.context.function, list[Typed]()
        for index, part in enumerate(parts):
            before = len(function.prelude)
            values.append(self.check_place(part) if index in outs else self.check(part))
            if len(function.prelude) > before:
                self.store_earlier(values, before, outs)
        return values

    def store_earlier(self, values: list[Typed], start: int, outs: Container[int] = ()) -> None:
        """Stores those of the values in variables that the prelude from `start` on would change; not the last value.

        Of the places at the positions `outs` only the indices are stored.
        """
        function = self.context.function
        written, calls = writes_of(function.prelude[start:], self.context.out_arguments)
        later: list[tuple[set[str], bool]] = []
        for typed in reversed(values[:-1]):  # a call that is stored is executed before what is to its left is read
            later.append((written, calls))
            for part in subexpressions(typed.expr):
                if isinstance(part, ir.Call):
                    written, calls = written | set(map(root_name, self.context.out_arguments(part))), True
        for index, typed in enumerate(values[:-1]):
            count, (written, calls) = len(function.prelude), later[-1 - index]
            if index in outs:
                values[index] = typed._replace(expr=self.fixed_place(typed.expr, written, calls, start))
            elif depends(typed.expr, written, calls):
                values[index] = Typed(function.temporary("before", typed.expr, start), typed.quantity)
            start += len(function.prelude) - count

    def fix_outs(self, args: list[Typed], outs: Sequence[int]) -> None:
        """Stores the indices of the places at the positions `outs` that the call itself may change.

        They are evaluated once, before the call; drivers evaluate them again when the values are copied out.
        """
        prelude = self.context.function.prelude
        written = {root_name(args[index].expr) for index in outs}
        for index in outs:
            before = len(prelude)
            place = self.fixed_place(args[index].expr, written, calls=True, start=before)
            if len(prelude) > before:
                args[index] = args[index]._replace(expr=place)
                evaluated = args[: index + 1]
                self.store_earlier(evaluated, before, outs)
                args[: index + 1] = evaluated

    def fixed_place(self, target: ir.Expr, written: set[str], calls: bool, start: int) -> ir.Expr:
        """A place to write to, with every index stored in a variable that later statements change.

        `written` and `calls` are the effects of those statements, which begin at `start` in the prelude.
        """
        if not isinstance(target, ir.Index | ir.Swizzle | ir.Member):
            return target
        inner = self.fixed_place(target.value, written, calls, start)
        if inner is not target.value:
            target = target._replace(value=inner)
        if isinstance(target, ir.Index) and depends(target.index, written, calls):
            return target._replace(index=self.context.function.temporary("place", target.index, start))
        return target

    def with_prelude(self, expression: _S, check: Callable[[_S], _T]) -> tuple[_T, list[ir.Stmt]]:
        """The result of `check` for an expression, and the prelude of this expression alone."""
        function = self.context.function
        outer, function.prelude = function.prelude, []
        try:
            return check(expression), function.prelude
        finally:
            function.prelude = outer

    def declared_type(self, element: Type, type_: s.TypeName, declarator: s.Declarator) -> Type:
        """The type of one name of a declaration whose element type is known."""
        lengths = (*declarator.lengths, *type_.lengths)
        if not lengths:
            return element
        items = _item_counts(declarator.value)
        if declarator.value is None and isinstance(lengths[0], s.Unsized) and self.context.plain:
            items = [self.context.length_by_use(declarator.name)]
        unsized = [index for index, length in enumerate(lengths) if isinstance(length, s.Unsized)]
        if declarator.value is not None and unsized and unsized[-1] >= len(items):
            value, _ = self.with_prelude(declarator.value, self.check)
            items = unnested(value.expr.type)[1]
        return array_type(self.context, element, lengths, items)

    def number(self, number: s.Number) -> Typed:
        if number.is_float:
            real = float(number.text.rstrip("fFlL"))
            if real > FLOAT_MAX and self.context.plain:  # GLSL: infinity
                one, zero = (ir.Literal(FLOAT, value, number.span) for value in (1.0, 0.0))
                return Typed(ir.Binary(FLOAT, "/", one, zero, number.span))
            if real > FLOAT_MAX:
                raise self.context.fail(number.span, f"{number.text} does not fit in a float")
            return Typed(ir.Literal(FLOAT, real, number.span))
        unsigned, value = number.text[-1] in "uU", integer_value(number.text)
        if value is None:
            hint = "a number that begins with 0 is octal: remove the 0"
            raise self.context.fail(number.span, f"{number.text} is not an octal number", hint)
        # GLSL takes the bits of an int that is too large; in a technique a decimal number like that is a mistake
        by_bits = unsigned or self.context.plain or number.text[:2] in ("0x", "0X")
        if value > (0xFFFFFFFF if by_bits else 0x7FFFFFFF):
            shown = number.text if len(number.text) <= 40 else f"{number.text[:40]}…"
            raise self.context.fail(number.span, f"{shown} does not fit in {'a uint' if unsigned else 'an int'}")
        return Typed(ir.Literal(UINT if unsigned else INT, value if unsigned else wrapped(value), number.span))

    def boolean(self, boolean: s.Boolean) -> Typed:
        return Typed(ir.Literal(BOOL, boolean.value, boolean.span))

    def name(self, name: s.Name) -> Typed:
        context = self.context
        variable = context.function.scopes.find(name.text)
        if variable is not None:
            if variable.faulty:
                raise AlreadyReported
            return Typed(ir.Local(variable.type, variable.ir_name, name.span), variable.quantity)
        text = context.aliases.get(name.text, name.text)
        value = context.globals.get(text) or builtin_variable(context, name)
        if value is not None:
            reference = ir.Global(value.type, text, name.span)
            if value.constant and value.value and name.text.startswith("gl_"):
                return Typed(literal(value.type, value.value, name.span))
            return Typed(reference, value.quantity)
        if name.text in context.buffer_members:
            if name.text in context.counters and name is not context.counter_place:
                message = f"'{name.text}' is an atomic counter, which only the functions of counters take"
                raise context.fail(name.span, message, f"write atomicCounter({name.text}) for its value")
            return Typed(context.buffer_members[name.text]._replace(span=name.span))
        if name.text in context.blocks:
            raise context.fail(name.span, f"'{name.text}' is a block; write the name of a member behind it")
        if name.text in context.functions or name.text in BUILTINS:
            raise context.fail(name.span, f"'{name.text}' is a function; call it with (…)")
        raise context.unknown(name.span, "name", name.text, [*context.function.scopes.names(), *context.globals])

    def type_name(self, name: s.TypeName) -> Typed:
        raise self.context.fail(name.span, f"'{name.name}' is a type; construct a value with {name.name}(…)")

    def unsized(self, unsized: s.Unsized) -> Typed:
        raise self.context.fail(unsized.span, "an index is missing between the brackets")

    def listed(self, listed: s.Listed) -> Typed:
        raise self.context.fail(listed.span, "{…} does not say all lengths", "write them, or braces for each part")


def _item_counts(value: s.Expression | None) -> Sequence[int]:
    """How many items an array and its first items have according to the syntax of its value, as far as it says so: one
    number for `float a[] = float[](1.0, 2.0)`."""
    if isinstance(value, s.Listed):
        return [len(value.items), *_item_counts(value.items[0] if value.items else None)]
    if isinstance(value, s.CallOf) and isinstance(value.callee, s.TypeName) and value.callee.lengths:
        return [len(value.args)]
    return []
