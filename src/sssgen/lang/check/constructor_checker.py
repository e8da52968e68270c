"""Checks constructors: of scalars, vectors, matrices, arrays, structs and quantities."""

from __future__ import annotations

from sssgen.ir import nodes as ir
from sssgen.ir.types import (
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
from sssgen.ir.walk import subexpressions
from sssgen.lang.check import quantities as q
from sssgen.lang.check.constant_values import is_constant
from sssgen.lang.check.context import Typed
from sssgen.lang.check.expression_checker import ExpressionChecker
from sssgen.lang.check.implicit_conversions import as_kind, converts, literal_as
from sssgen.lang.check.type_names import array_type, named_element, named_type
from sssgen.lang.check.wording import a_type, constructor_hint
from sssgen.lang.syntax import tree as s


class ConstructorChecker:
    """Checks the constructors of one file; CallChecker calls it."""

    def __init__(self, expressions: ExpressionChecker) -> None:
        self.context = expressions.context
        self.expressions = expressions

    def type_constructor(self, callee: s.TypeName, call: s.CallOf) -> Typed:
        if callee.lengths:
            element, _ = named_element(self.context, callee)
            lengths = callee.lengths
            if call.args and any(isinstance(length, s.Unsized) for length in lengths[1:]):  # float[][](…): as its parts
                first, _ = self.expressions.with_prelude(call.args[0], self.expressions.check)
                element, lengths = first.expr.type, lengths[:1]
            type_ = array_type(self.context, element, lengths, [len(call.args)])
            assert isinstance(type_, Array)
            return self.construct_parts(type_, call)
        type_, quantity = named_type(self.context, callee)
        return self.construct(type_, quantity, self.expressions.operands(call.args), call)

    def construct_parts(self, type_: Array | Struct, call: s.CallOf) -> Typed:
        """The constructor of an array or a struct, with its arguments converted where GLSL does so."""
        args = self.expressions.operands(call.args)
        if self.context.converts:
            for index, (arg, part) in enumerate(zip(args, _part_types(type_), strict=False)):
                if converts(arg.expr.type, part):
                    args[index] = arg._replace(expr=as_kind(arg.expr, kind_of(part)))
        return self.construct(type_, "", args, call)

    def construct(self, type_: Type, quantity: str, args: list[Typed], call: s.CallOf) -> Typed:
        """A constructor, with every argument converted to the scalar kind of the type."""
        if quantity and len(args) == 1:
            try:
                q.check_constructible(args[0].quantity, quantity)
            except q.Mixup as mixup:
                raise self.context.fail(call.span, mixup.message, mixup.hint) from None
        if self.context.plain and len(args) > 1 and isinstance(type_, Vector | Matrix):
            args = _without_excess(args, components(type_))
        values = tuple([arg.expr for arg in args])
        if self.context.plain and values and isinstance(values[-1].type, Matrix) and isinstance(type_, Vector):
            values = self.with_columns(values, components(type_))
            args = [Typed(value) for value in values]
        if self.context.plain and len(values) == 1 and isinstance(values[0].type, Matrix) and isinstance(type_, Scalar):
            column = ir.Index(Vector("float", values[0].type.rows), values[0], ir.Literal(INT, 0, call.span), call.span)
            values = (ir.Swizzle(FLOAT, column, "x", call.span),)
            args = [Typed(value) for value in values]
        if len(values) == 1 and type_ == Matrix(2, 2) and components(values[0].type) == 4 and kind_of(values[0].type):
            values = self.halves(values[0])
            args = [Typed(value) for value in values]
        error = self.constructor_error(type_, args, call)
        if error:
            raise self.context.fail(call.span, error, constructor_hint(type_))
        if isinstance(type_, Array):
            quantities = {arg.quantity for arg in args}
            return Typed(ir.Construct(type_, values, call.span), quantities.pop() if len(quantities) == 1 else "")
        return self.convert(type_, quantity, values, call.span)

    def convert(self, type_: Type, quantity: str, values: tuple[ir.Expr, ...], span: ir.Span) -> Typed:
        """A constructor of numbers; of a literal, or a value of this type, it is that value."""
        kind, first = kind_of(type_), values[0].type
        if isinstance(type_, Scalar) and isinstance(values[0], ir.Literal):
            if self.context.plain and not _fits(values[0], type_):  # GLSL leaves it undefined
                return Typed(ir.Construct(type_, values, span), quantity)
            return Typed(self.literal(values[0], type_, span), quantity)
        if isinstance(first, Vector) and len(values) == 1 and components(first) > components(type_):
            letters = "xyzw"[: components(type_)]
            values = (ir.Swizzle(vector_of(first.kind, len(letters)), values[0], letters, span),)
        if kind and not (len(values) == 1 and components(values[0].type) == components(type_)):
            values = tuple([as_kind(value, kind) for value in values])
        if len(values) == 1 and values[0].type == type_:
            return Typed(values[0], quantity)
        return Typed(ir.Construct(type_, values, span), quantity)

    def with_columns(self, values: tuple[ir.Expr, ...], count: int) -> tuple[ir.Expr, ...]:
        """The arguments of a vector of `count` components, with the columns of the matrix at their end."""
        *first, matrix = values
        missing = count - sum(components(value.type) for value in first)
        if missing <= 0 or not all(isinstance(value.type, Scalar | Vector) for value in first):
            return values
        if any(isinstance(part, ir.Call) for value in first for part in subexpressions(value)):
            first = [self.variable("part", value) for value in first]  # the matrix is computed after them
        return (*first, *self.columns(matrix, missing))

    def columns(self, matrix: ir.Expr, count: int) -> tuple[ir.Expr, ...]:
        """The columns of a matrix as arguments of a vector of `count` components."""
        assert isinstance(matrix.type, Matrix)
        variable = self.variable("matrix", matrix)
        size, span = matrix.type.rows, matrix.span
        columns = [
            Typed(ir.Index(Vector("float", size), variable, ir.Literal(INT, column, span), span))
            for column in range(-(-count // size))
        ]
        return tuple([typed.expr for typed in _without_excess(columns, count)])

    def halves(self, value: ir.Expr) -> tuple[ir.Expr, ...]:
        """The halves of a vec4 as the columns of a mat2."""
        if not isinstance(value.type, Vector):
            return (value,)
        variable = self.variable("columns", value)
        half = Vector(value.type.kind, 2)
        return tuple([ir.Swizzle(half, variable, letters, value.span) for letters in ("xy", "zw")])

    def variable(self, name: str, value: ir.Expr) -> ir.Expr:
        """A variable with this value, which is read more than once; at file scope, where none can be, the value."""
        function = self.context.function
        if isinstance(value, ir.Local | ir.Global) or function is self.context.file_scope:
            return value
        return function.temporary(name, value, constant=is_constant(self.context, value))

    def literal(self, literal: ir.Literal, type_: Scalar, span: ir.Span) -> ir.Literal:
        """A literal converted by a constructor. Reports a float that no int or uint can hold."""
        if not _fits(literal, type_):
            raise self.context.fail(span, f"{literal.value:g} does not fit in {a_type(type_)}")
        return literal_as(literal._replace(span=span), type_)

    def constructor_error(self, type_: Type, args: list[Typed], call: s.CallOf) -> str:
        """What is wrong with a constructor's arguments, or ''."""
        types = [arg.expr.type for arg in args]
        name = spell(type_)
        if isinstance(type_, Struct | Array):
            fields = type_.fields if isinstance(type_, Struct) else ()
            parts = _part_types(type_)
            if types != parts:
                return f"{name}(…) takes ({', '.join(map(spell, parts))}), but gets ({', '.join(map(spell, types))})"
            for arg, field, written in zip(args, fields, call.args, strict=False):
                self.expressions.require(arg, field.type, field.quantity, written.span, f"member '{field.name}'")
            return ""
        if isinstance(type_, Sampler | Void):
            return f"{a_type(type_)} cannot be constructed"
        if not types or any(not kind_of(argument) for argument in types):
            return f"{name}(…) cannot be made from ({', '.join(map(spell, types))})"
        if len(types) == 1:
            argument = types[0]
            if isinstance(type_, Matrix):
                fits = isinstance(argument, Scalar | Matrix)
            else:
                fits = isinstance(argument, Scalar) or components(argument) >= components(type_)
                fits = fits and not isinstance(argument, Matrix)
            return "" if fits else f"{name}(…) cannot be made from {a_type(argument)}"
        if isinstance(type_, Scalar) or any(isinstance(argument, Matrix) for argument in types):
            return f"{name}(…) cannot be made from ({', '.join(map(spell, types))})"
        count = sum(components(argument) for argument in types)
        if count != components(type_):
            return f"{name}(…) takes {components(type_)} components, but gets {count}"
        return ""


def _fits(literal: ir.Literal, type_: Scalar) -> bool:
    """Whether a literal that is a float is in the range of a type."""
    low, high = (0, 2**32) if type_ == UINT else (-(2**31), 2**31)
    return literal.type != FLOAT or type_.kind not in ("int", "uint") or low <= int(literal.value) < high


def _part_types(type_: Array | Struct) -> list[Type]:
    """The parameter types of a constructor."""
    if isinstance(type_, Struct):
        return [field.type for field in type_.fields]
    return [type_.element] * type_.length


def _without_excess(args: list[Typed], count: int) -> list[Typed]:
    """A constructor's arguments, the last one truncated so that they have `count` components, if that is possible."""
    last = args[-1].expr
    excess = sum(components(arg.expr.type) for arg in args) - count
    if not isinstance(last.type, Vector) or not 0 < excess < last.type.size:
        return args
    size = last.type.size - excess
    return [*args[:-1], Typed(ir.Swizzle(vector_of(last.type.kind, size), last, "xyzw"[:size], last.span))]
