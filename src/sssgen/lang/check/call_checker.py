"""Checks calls: of functions and builtins, whose overloads they choose, of constructors, and of `.length()`."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from sssgen.ir import nodes as ir
from sssgen.ir import old_names, out_builtins
from sssgen.ir.intrinsics import BUILTINS
from sssgen.ir.rules import element_type
from sssgen.ir.signatures import candidates, resolve
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
from sssgen.lang.check import quantities as q
from sssgen.lang.check.assignment_checker import AssignmentChecker
from sssgen.lang.check.expression_checker import Typed, Untyped
from sssgen.lang.check.implicit_conversions import as_kind, converts, literal_as
from sssgen.lang.check.name_scope import Signature
from sssgen.lang.check.wording import a_type, constructor_hint, declared, overload_hint
from sssgen.lang.syntax import tree as s


class CallChecker(AssignmentChecker):
    """Checks the calls of one file."""

    def _callof(self, call: s.CallOf) -> Typed:
        callee = call.callee
        if isinstance(callee, s.MemberOf):
            return self.method(callee, call)
        if isinstance(callee, s.TypeName):
            return self.constructor(callee, call)
        name = callee.text
        if name in self.structs and name not in self.functions:
            return self.construct(self.structs[name], "", self.arguments(call, self.structs[name]), call)
        args = self.operands(call.args)
        types = tuple([arg.expr.type for arg in args])
        own = self.functions.get(name, ())
        exact = next((overload for overload in own if overload.types == types), None)
        if exact is not None:
            return self.call_function(name, exact, args, call)
        builtin = candidates(name)
        if builtin and (not own or (self.plain and resolve(name, types) is not None)):
            return self.call_intrinsic(name, args, call)
        if own and not (self.plain and out_builtins.out_builtin(name, types)):
            return self.call_function(name, self.overload(name, args, call), args, call)
        if name in q.QUANTITIES and not self.plain:
            return self.construct(q.QUANTITIES[name], name, args, call)
        if self.plain:
            found = self.plain_builtin(name, args, call)
            if found is not None:
                return found
        known = [*self.functions, *self.structs, *(() if self.plain else q.QUANTITIES), *BUILTINS]
        raise self.unknown(callee.span, "function", name, known)

    def plain_builtin(self, name: str, args: list[Typed], call: s.CallOf) -> Typed | None:
        """What only plain GLSL has: the names of old versions, builtins with out parameters."""
        renamed = old_names.new_name(name, len(args))
        if renamed is not None and candidates(renamed):
            return self.call_intrinsic(renamed, args, call)
        name = renamed or name
        types = [arg.expr.type for arg in args]
        source = out_builtins.out_builtin(name, types)
        if source is None and out_builtins.is_out_builtin(name):
            as_floats = [as_kind(arg.expr, "float") for arg in args]
            source = out_builtins.out_builtin(name, [arg.type for arg in as_floats])
            if source is None:
                given = ", ".join(map(spell, types))
                raise self.fail(call.span, f"no overload of {name} takes ({given})")
        if source is None:
            return None
        self.bring_builtin(name, source)
        return self.call_function(name, self.overload(name, args, call), args, call)

    def bring_builtin(self, name: str, source: str) -> None:
        """Makes the function that stands for a builtin one of the file's own."""
        raise NotImplementedError

    def method(self, callee: s.MemberOf, call: s.CallOf) -> Typed:
        """`values.length()`, the only method there is."""
        if callee.name.text != "length" or call.args:
            raise self.fail(call.span, f"there is no method '{callee.name.text}'", "an array has length()")
        value = self.check(callee.value).expr
        found = element_type(value.type)
        if found is None:
            raise self.fail(call.span, f"{a_type(value.type)} has no length()")
        return Typed(ir.Literal(INT, found[1], call.span))

    def constructor(self, callee: s.TypeName, call: s.CallOf) -> Typed:
        if callee.lengths:
            element, _ = self.type_named(replace(callee, lengths=()))
            type_ = self.array_of(element, callee.lengths, len(call.args))
            return self.construct(type_, "", self.arguments(call, type_), call)
        type_, quantity = self.type_named(callee)
        return self.construct(type_, quantity, self.operands(call.args), call)

    def arguments(self, call: s.CallOf, type_: Type) -> list[Typed]:
        """The arguments of a struct's or an array's constructor, converted where GLSL does that."""
        args = self.operands(call.args)
        if not self.plain:
            return args
        wanted = parts_of(type_)
        return [
            arg._replace(expr=as_kind(arg.expr, kind_of(part))) if converts(arg.expr.type, part) else arg
            for arg, part in zip(args, wanted, strict=False)
        ] + args[len(wanted) :]

    def overload(self, name: str, args: list[Typed], call: s.CallOf) -> Signature:
        """The function that a call without an exact match means: the only one, or that with the fewest conversions."""
        overloads = self.functions[name]
        types = tuple([arg.expr.type for arg in args])
        if name in self.faulty:
            raise Untyped
        if len(overloads) == 1:
            chosen = overloads[0]
            if len(chosen.types) != len(args):
                count, given = len(chosen.types), len(args)
                message = f"{name} takes {count} argument{'s' if count != 1 else ''}, but gets {given}"
                raise self.fail(call.span, message, f"it is declared as {declared(name, chosen)}")
            return chosen
        if self.plain:
            fitting = [one for one in overloads if _fits(one, types)]
            if fitting:
                return min(fitting, key=lambda one: _distance(one, types))
        listed = ", ".join(declared(name, overload) for overload in overloads)
        shown = ", ".join(map(spell, types))
        raise self.fail(call.span, f"no overload of {name} takes ({shown})", f"there are: {listed}")

    def call_function(self, name: str, chosen: Signature, args: list[Typed], call: s.CallOf) -> Typed:
        """A call of one of the file's own functions."""
        given: list[ir.Expr] = []
        for index, (arg, written) in enumerate(zip(args, call.args, strict=True)):
            direction, quantity = chosen.directions[index], chosen.quantities[index]
            what = f"argument {index + 1} ('{chosen.names[index]}') of {name}"
            if direction == "out" and arg.expr.type == chosen.types[index]:
                given.append(arg.expr)  # its value is not read; its quantity is checked on the way out
            else:
                given.append(self.require(arg, chosen.types[index], quantity, written.span, what))
            if direction != "in":
                given[-1] = arg.expr
                if arg.expr.type != chosen.types[index]:
                    message = f"{what} is {a_type(chosen.types[index])}, but the variable {a_type(arg.expr.type)}"
                    raise self.fail(written.span, message, "what is given back is not converted")
                self.check_writable(arg.expr, written.span)
                if arg.quantity and quantity != arg.quantity:
                    message = f"{what} gives {q.words(quantity)}, but the variable holds {q.words(arg.quantity)}"
                    raise self.fail(written.span, message, q.conversion(quantity, arg.quantity))
        return Typed(ir.Call(chosen.result, chosen.key, tuple(given), call.span), chosen.quantity)

    def call_intrinsic(self, name: str, args: list[Typed], call: s.CallOf) -> Typed:
        values = tuple([arg.expr for arg in args])
        result = resolve(name, [value.type for value in values])
        if result is None and self.plain:
            for converted in _conversions(values):
                result = resolve(name, [value.type for value in converted])
                if result is not None:
                    values = converted
                    break
        if result is None:
            given = ", ".join(spell(arg.expr.type) for arg in args)
            message = f"no overload of {name} takes ({given})"
            raise self.fail(call.span, message, overload_hint(name, [arg.expr for arg in args]))
        if not any(arg.quantity for arg in args):
            return Typed(ir.Intrinsic(result, name, values, call.span))
        try:
            if isinstance(values[0].type, Sampler):
                quantity = q.texel_of(args[0].quantity)
                if len(args) > 1 and args[1].quantity == "uv_direction":
                    message = f"a texture is read at a position, but this is {q.words(args[1].quantity)}"
                    raise q.Mixup(message, q.conversion(args[1].quantity, "uv_position"))
            else:
                quantity = q.of_intrinsic(name, [arg.quantity for arg in args])
        except q.Mixup as mixup:
            raise self.fail(call.span, mixup.message, mixup.hint) from None
        return Typed(ir.Intrinsic(result, name, values, call.span), quantity)

    def construct(self, type_: Type, quantity: str, args: list[Typed], call: s.CallOf) -> Typed:
        """A constructor, with every argument brought to the type's own kind."""
        if quantity and len(args) == 1:
            try:
                q.check_constructible(args[0].quantity, quantity)
            except q.Mixup as mixup:
                raise self.fail(call.span, mixup.message, mixup.hint) from None
        if self.plain and len(args) > 1 and isinstance(type_, Vector | Matrix):
            args = _cut(args, components(type_))
        values = tuple([arg.expr for arg in args])
        if self.plain and len(values) == 1 and isinstance(values[0].type, Matrix) and isinstance(type_, Vector):
            values = self.columns(values[0], components(type_))
            args = [Typed(value) for value in values]
        if len(values) == 1 and type_ == Matrix(2) and components(values[0].type) == 4 and kind_of(values[0].type):
            values = self.halves(values[0])
            args = [Typed(value) for value in values]
        wrong = self.constructor_error(type_, args, call)
        if wrong:
            raise self.fail(call.span, wrong, constructor_hint(type_))
        if isinstance(type_, Array):
            held = {arg.quantity for arg in args}
            return Typed(ir.Construct(type_, values, call.span), held.pop() if len(held) == 1 else "")
        kind, given = kind_of(type_), values[0].type
        if isinstance(type_, Scalar) and isinstance(values[0], ir.Literal):
            return Typed(self.literal(values[0], type_, call.span), quantity)
        if isinstance(given, Vector) and len(values) == 1 and components(given) > components(type_):
            letters = "xyzw"[: components(type_)]
            values = (ir.Swizzle(vector_of(given.kind, len(letters)), values[0], letters, call.span),)
        if kind and not (len(values) == 1 and components(values[0].type) == components(type_)):
            values = tuple([as_kind(value, kind) for value in values])
        if len(values) == 1 and values[0].type == type_:
            return Typed(values[0], quantity)
        return Typed(ir.Construct(type_, values, call.span), quantity)

    def columns(self, matrix: ir.Expr, count: int) -> tuple[ir.Expr, ...]:
        """The columns of a matrix as arguments of a vector of `count` components."""
        assert isinstance(matrix.type, Matrix)
        kept = matrix if isinstance(matrix, ir.Local | ir.Global) else self.temporary("matrix", matrix)
        size, span = matrix.type.size, matrix.span
        made = [
            Typed(ir.Index(Vector("float", size), kept, ir.Literal(INT, column, span), span))
            for column in range(-(-count // size))
        ]
        return tuple([typed.expr for typed in _cut(made, count)])

    def halves(self, given: ir.Expr) -> tuple[ir.Expr, ...]:
        """The halves of a vec4 as the columns of a mat2."""
        if not isinstance(given.type, Vector):
            return (given,)
        kept = given if isinstance(given, ir.Local | ir.Global) else self.temporary("columns", given)
        half = Vector(given.type.kind, 2)
        return tuple([ir.Swizzle(half, kept, letters, given.span) for letters in ("xy", "zw")])

    def literal(self, literal: ir.Literal, type_: Scalar, span: ir.Span) -> ir.Literal:
        """A literal converted by a constructor. Reports a float that no int or uint can hold."""
        low, high = (0, 2**32) if type_ == UINT else (-(2**31), 2**31)
        if literal.type == FLOAT and kind_of(type_) in ("int", "uint") and not low <= int(literal.value) < high:
            raise self.fail(span, f"{literal.value:g} does not fit in {a_type(type_)}")
        return literal_as(literal._replace(span=span), type_)

    def constructor_error(self, type_: Type, args: list[Typed], call: s.CallOf) -> str:
        """What is wrong with a constructor's arguments, or ''."""
        types = [arg.expr.type for arg in args]
        name = spell(type_)
        if isinstance(type_, Struct | Array):
            fields = type_.fields if isinstance(type_, Struct) else ()
            wanted = parts_of(type_)
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


def parts_of(type_: Type) -> list[Type]:
    """What a struct's or an array's constructor takes."""
    if isinstance(type_, Struct):
        return [field.type for field in type_.fields]
    return [type_.element] * type_.length if isinstance(type_, Array) else []


def _fits(signature: Signature, types: tuple[Type, ...]) -> bool:
    """Whether a call with these types may mean this function."""
    return len(signature.types) == len(types) and all(
        given == wanted or (direction == "in" and converts(given, wanted))
        for given, wanted, direction in zip(types, signature.types, signature.directions, strict=True)
    )


def _distance(signature: Signature, types: tuple[Type, ...]) -> int:
    """How much is converted in a call: int to uint is nearer than to float."""
    pairs = zip(types, signature.types, strict=True)
    return sum([0 if given == wanted else 1 if kind_of(wanted) == "uint" else 2 for given, wanted in pairs])


def _conversions(values: tuple[ir.Expr, ...]) -> Iterator[tuple[ir.Expr, ...]]:
    """The arguments of a builtin with what is whole converted, the least first."""
    kinds = {kind_of(value.type) for value in values}
    for kind in ("uint", "float"):
        if kinds & {"int", "uint"}:
            yield tuple([as_kind(value, kind) if kind_of(value.type) in ("int", "uint") else value for value in values])
    if kinds >= {"int", "float"}:  # texture(s, uv, 1), textureLod(s, ivec2, 0): but a level of texelFetch stays whole
        for index, value in enumerate(values):
            if kind_of(value.type) == "int":
                yield (*values[:index], as_kind(value, "float"), *values[index + 1 :])


def _cut(args: list[Typed], count: int) -> list[Typed]:
    """A constructor's arguments, the last one without the components that are more than `count`."""
    last = args[-1].expr
    over = sum(components(arg.expr.type) for arg in args) - count
    if not isinstance(last.type, Vector) or not 0 < over < last.type.size:
        return args
    left = last.type.size - over
    return [*args[:-1], Typed(ir.Swizzle(vector_of(last.type.kind, left), last, "xyzw"[:left], last.span))]
