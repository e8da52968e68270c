"""Checks calls: of functions and builtins, with their overloads, and of the method `.length()`."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence

from sssgen.ir import nodes as ir
from sssgen.ir import old_names, out_builtins
from sssgen.ir.constant_expressions import literal
from sssgen.ir.intrinsics import BUILTINS
from sssgen.ir.memory_operations import MEMORY
from sssgen.ir.projective_reads import PROJECTIVE_READS, kept_components
from sssgen.ir.rules import element_type
from sssgen.ir.signatures import overload, resolve
from sssgen.ir.types import FLOAT, INT, VOID, Array, Sampler, Scalar, Type, components, kind_of, spell, vector_of
from sssgen.ir.walk import subexpressions
from sssgen.lang.check import atomic_counters
from sssgen.lang.check import quantities as q
from sssgen.lang.check.assignment_checker import check_writable
from sssgen.lang.check.constant_values import constant_value
from sssgen.lang.check.constructor_checker import ConstructorChecker
from sssgen.lang.check.context import AlreadyReported, Typed
from sssgen.lang.check.expression_checker import ExpressionChecker
from sssgen.lang.check.implicit_conversions import as_kind, converts
from sssgen.lang.check.line_textures import is_line, line_size, plane_arguments
from sssgen.lang.check.memory_checker import MemoryChecker
from sssgen.lang.check.name_scope import Signature
from sssgen.lang.check.wording import a_type, overload_hint, signature_text
from sssgen.lang.syntax import tree as s


class CallChecker:
    """Checks the calls of one file.

    `add_function` checks the definition (a name and its text) of a function that replaces a builtin, and declares it.
    """

    def __init__(self, expressions: ExpressionChecker, add_function: Callable[[str, str], None]) -> None:
        self.context = expressions.context
        self.expressions = expressions
        self.constructors = ConstructorChecker(expressions)
        self.memory = MemoryChecker(expressions)
        self.add_function = add_function
        self.out_positions: dict[int, tuple[s.CallOf, set[int]]] = {}
        """By the call's id: a call inside a call would be checked again and again. The call keeps its id taken."""
        expressions.methods[s.CallOf] = self.call

    def call(self, call: s.CallOf) -> Typed:
        context, callee = self.context, call.callee
        if isinstance(callee, s.MemberOf):
            return self.method(callee, call)
        if isinstance(callee, s.TypeName):
            return self.constructors.type_constructor(callee, call)
        name = callee.text
        if context.plain and context.function.scopes.hides(name):
            raise context.fail(callee.span, f"'{name}' is a variable here", "give the variable another name")
        struct = context.find_struct(name)
        if struct is not None and (name not in context.functions or struct is not context.structs.get(name)):
            return self.constructors.construct_parts(struct, call)
        overloads = context.functions.get(name, ())
        if name.startswith("atomicCounter") and not overloads and context.plain:
            operation = atomic_counters.atomic(name, call)
            if operation is not None:
                counter = atomic_counters.counter_name(context, name, call.args[0])
                return self.counter(counter, operation, id(call) in self.expressions.dropped)
        if name in MEMORY and not overloads and context.plain and name != "arrayLength":
            return self.memory.operation(MEMORY[name], call)
        args = self.expressions.operands(call.args, self.outs(name, overloads, call))
        types = tuple([arg.expr.type for arg in args])
        exact = _exact(overloads, types)
        if exact is not None:
            return self.call_function(name, exact, args, call)
        beside = context.plain and not self.hides_builtins(overloads)
        if name in BUILTINS and (not overloads or (beside and resolve(name, types) is not None)):
            return self.call_intrinsic(name, args, call)
        if overloads and not (beside and out_builtins.out_builtin(name, types)):
            return self.call_function(name, self.overload(name, args, call), args, call)
        if name in q.QUANTITIES and not context.plain:
            return self.constructors.construct(q.QUANTITIES[name], name, args, call)
        if context.plain:
            result = self.glsl_builtin(name, args, call)
            if result is not None:
                return result
        known = [*context.functions, *context.structs, *(() if context.plain else q.QUANTITIES), *BUILTINS]
        raise context.unknown(callee.span, "function", name, known)

    def counter(self, counter: s.Name, operation: s.Expression, dropped: bool) -> Typed:
        """An operation on an atomic counter; `dropped`: its result is not used."""
        if dropped:
            self.expressions.dropped.add(id(operation))
        self.context.counter_place = counter
        try:
            return self.expressions.check(operation)
        finally:
            self.context.counter_place = None
            self.expressions.dropped.discard(id(operation))  # another expression may get this id

    def hides_builtins(self, overloads: Sequence[Signature]) -> bool:
        """Whether functions hide the builtins of their name, as those of a file of desktop GLSL do (4.60, 4.2.2)."""
        own = any(not signature.span.file.startswith("intrinsics/") for signature in overloads)
        return own and self.context.language.desktop > 0

    def outs(self, name: str, overloads: Sequence[Signature], call: s.CallOf) -> set[int]:
        """The positions of the out arguments in a call."""
        if not overloads:
            return out_builtins.out_positions(name) if self.context.plain else set()
        if id(call) not in self.out_positions:
            fitting = [signature for signature in overloads if len(signature.directions) == len(call.args)]
            places = {tuple(direction != "in" for direction in signature.directions) for signature in fitting}
            if len(places) > 1:
                places = {tuple(direction != "in" for direction in self.by_types(fitting, call).directions)}
            outs = {index for each in places for index, is_out in enumerate(each) if is_out}
            self.out_positions[id(call)] = call, outs
        return self.out_positions[id(call)][1]

    def by_types(self, overloads: Sequence[Signature], call: s.CallOf) -> Signature:
        """The overload that fits a call best; its arguments are checked for their types only."""
        check = self.expressions.check
        types = tuple([self.expressions.with_prelude(part, check)[0].expr.type for part in call.args])
        exact = _exact(overloads, types)
        if exact is not None:
            return exact
        viable = [signature for signature in overloads if _is_viable(signature, types)] or [*overloads]
        return min(viable, key=lambda signature: _conversion_cost(signature, types))

    def glsl_builtin(self, name: str, args: list[Typed], call: s.CallOf) -> Typed | None:
        """A builtin that only plain GLSL has: one with a name of an old version, or with out parameters; else None."""
        renamed = old_names.new_name(name, len(args))
        if self.context.es == 100 and name.endswith("Lod") and renamed and not self.context.language.vertex:
            hint = f"write {name}EXT with #extension GL_EXT_shader_texture_lod : enable"
            raise self.context.fail(call.span, f"{name} belongs to vertex shaders in GLSL ES 1.00", hint)
        if renamed in BUILTINS:
            return self.call_intrinsic(renamed, args, call)
        name = renamed or name
        if name in PROJECTIVE_READS:
            return self.projective_read(name, args, call)
        if name == "textureGatherOffsets":
            return self.four_gathers(args, call)
        types = [arg.expr.type for arg in args]
        source = out_builtins.out_builtin(name, types)
        if source is None and out_builtins.is_out_builtin(name):
            source = out_builtins.out_builtin(name, [as_kind(arg.expr, "float").type for arg in args])
            if source is None:
                raise self.context.fail(call.span, f"no overload of {name} takes ({', '.join(map(spell, types))})")
        if source is None:
            return None
        self.add_function(name, source)
        return self.call_function(name, self.overload(name, args, call), args, call)

    def projective_read(self, name: str, args: list[Typed], call: s.CallOf) -> Typed:
        """A read at a coordinate that is divided by its last component."""
        types = [arg.expr.type for arg in args]
        kept = kept_components(types[0], types[1]) if len(types) > 1 else None
        if kept is None:
            raise self.context.fail(call.span, f"no overload of {name} takes ({', '.join(map(spell, types))})")
        texture, place, *rest = args
        span, value = place.expr.span, place.expr
        if not isinstance(value, ir.Local | ir.Global | ir.Uniform):
            value = self.context.function.temporary("place", value)
        whole = ir.Swizzle(vector_of("float", kept), value, "xyz"[:kept], span)
        last = ir.Swizzle(FLOAT, value, "xyzw"[components(value.type) - 1], span)
        divided = place._replace(expr=ir.Binary(whole.type, "/", whole, last, span))
        return self.call_intrinsic(PROJECTIVE_READS[name], [texture, divided, *rest], call)

    def four_gathers(self, args: list[Typed], call: s.CallOf) -> Typed:
        """`textureGatherOffsets`: one texel of each of four gathers, each with its own offset."""
        name, context, span = "textureGatherOffsets", self.context, call.span
        position = next((index for index, arg in enumerate(args) if arg.expr.type == Array(_OFFSET, 4)), None)
        if position is None:
            types = ", ".join([spell(arg.expr.type) for arg in args])
            raise context.fail(span, f"no overload of {name} takes ({types})", "its offsets are an ivec2[4]")
        before, offsets, behind = args[:position], args[position], args[position + 1 :]
        for index, arg in enumerate(before):
            if not isinstance(arg.expr, ir.Local | ir.Global | ir.Literal):
                before[index] = arg._replace(expr=context.function.temporary("place", arg.expr))
        texels: list[ir.Expr] = []
        for corner in range(4):
            element = ir.Index(_OFFSET, offsets.expr, ir.Literal(INT, corner, span), offsets.expr.span)
            offset = offsets._replace(expr=element)
            gathered = self.call_intrinsic("textureGatherOffset", [*before, offset, *behind], call)
            texels.append(ir.Swizzle(Scalar(kind_of(gathered.expr.type)), gathered.expr, "w", span))
        return Typed(ir.Construct(gathered.expr.type, tuple(texels), span))

    def line_read(self, name: str, args: list[Typed], call: s.CallOf) -> Typed:
        """A read of a texture of one dimension, from a texture of one row."""
        plane = plane_arguments(name, args, self.context.converts)
        if plane is None:
            types = [spell(arg.expr.type) for arg in args]
            raise self.context.fail(call.span, f"no overload of {name} takes ({', '.join(types)})")
        result = self.call_intrinsic(name, plane, call)
        return result._replace(expr=line_size(result.expr)) if name == "textureSize" else result

    def method(self, callee: s.MemberOf, call: s.CallOf) -> Typed:
        """`values.length()`, the only method."""
        if callee.name.text != "length" or call.args:
            raise self.context.fail(call.span, f"there is no method '{callee.name.text}'", "an array has length()")
        value = self.expressions.check(callee.value).expr
        element = element_type(value.type)
        if element is None:
            raise self.context.fail(call.span, f"{a_type(value.type)} has no length()")
        if element[1] == 0:
            return self.memory.length(value, call)
        if any(isinstance(part, ir.Call) for part in subexpressions(value)):
            self.context.function.temporary("measured", value)  # what the calls do is done
        return Typed(ir.Literal(INT, element[1], call.span))

    def overload(self, name: str, args: list[Typed], call: s.CallOf) -> Signature:
        """The overload for a call: the exact match, the only one, or the one with the fewest conversions."""
        overloads = self.context.functions[name]
        types = tuple([arg.expr.type for arg in args])
        if name in self.context.faulty:
            raise AlreadyReported
        exact = _exact(overloads, types)
        if exact is not None:
            return exact
        if len(overloads) == 1:
            only = overloads[0]
            count = len(only.types)
            if count != len(args):
                message = f"{name} takes {count} argument{'s' if count != 1 else ''}, but gets {len(args)}"
                hidden = ", and hides the builtin" if name in BUILTINS and self.hides_builtins(overloads) else ""
                hint = f"it is declared as {signature_text(name, only)}{hidden}"
                raise self.context.fail(call.span, message, hint)
            return only
        if self.context.converts:
            viable = [signature for signature in overloads if _is_viable(signature, types)]
            if viable:
                return min(viable, key=lambda signature: _conversion_cost(signature, types))
        listed = ", ".join(signature_text(name, signature) for signature in overloads)
        shown = ", ".join(map(spell, types))
        raise self.context.fail(call.span, f"no overload of {name} takes ({shown})", f"its overloads are: {listed}")

    def call_function(self, name: str, signature: Signature, args: list[Typed], call: s.CallOf) -> Typed:
        """A call of one of the file's own functions."""
        outs = [index for index, direction in enumerate(signature.directions) if direction != "in"]
        self.expressions.fix_outs(args, outs)
        values: list[ir.Expr] = []
        given_back: list[ir.Assign] = []
        for index, (arg, written) in enumerate(zip(args, call.args, strict=True)):
            type_, direction = signature.types[index], signature.directions[index]
            quantity, value = signature.quantities[index], arg.expr
            what = f"argument {index + 1} ('{signature.names[index]}') of {name}"
            is_other = direction == "out" and value.type != type_ and self.context.converts
            is_converted = is_other and converts(type_, value.type)
            if not is_converted and (
                direction != "out" or value.type != type_
            ):  # the value of an out argument is not read
                value = self.expressions.require(arg, type_, quantity, written.span, what)
            if direction != "in":
                value = arg.expr
                if is_converted:
                    check_writable(self.context, value, written.span)
                    result = self.context.function.temporary(signature.names[index], None, type_=type_)
                    back = as_kind(result, kind_of(value.type))
                    given_back.append(ir.Assign(value, "", back, written.span))
                    value = result
                elif value.type != type_:
                    message = f"{what} is {a_type(type_)}, but the variable is {a_type(value.type)}"
                    raise self.context.fail(
                        written.span, message, "this out argument is not converted: use a variable of the same type"
                    )
                check_writable(self.context, value, written.span)
                if arg.quantity and quantity != arg.quantity:
                    message = f"{what} returns {q.words(quantity)}, but the variable holds {q.words(arg.quantity)}"
                    raise self.context.fail(written.span, message, q.conversion(quantity, arg.quantity))
            values.append(value)
        value = ir.Call(signature.result, signature.key, tuple(values), call.span)
        return Typed(self.with_results(value, given_back) if given_back else value, signature.quantity)

    def with_results(self, call: ir.Call, given_back: list[ir.Assign]) -> ir.Expr:
        """The result of a call, which is executed before the results of its out arguments are converted."""
        function = self.context.function
        if call.type == VOID:
            result: ir.Expr = ir.Literal(VOID, 0, call.span)
            function.prelude.append(ir.Evaluate(call, call.span))
        else:
            result = function.temporary("result", call)
        function.prelude += given_back
        return result

    def call_intrinsic(self, name: str, args: list[Typed], call: s.CallOf) -> Typed:
        """A call of a builtin."""
        if is_line(args):
            return self.line_read(name, args, call)
        values = tuple([arg.expr for arg in args])
        result = resolve(name, [value.type for value in values])
        if result is None and self.context.converts:
            for converted in _conversions(values):
                result = resolve(name, [value.type for value in converted])
                if result is not None:
                    values = converted
                    break
        if result is None:
            message = f"no overload of {name} takes ({', '.join(spell(arg.expr.type) for arg in args)})"
            raise self.context.fail(call.span, message, overload_hint(name, [arg.expr for arg in args]))
        self.check_es(name, [value.type for value in values], call)
        values = self.with_constants(name, values)
        if BUILTINS[name].kind == "derivative":
            self.context.derivatives.append(call.span)
            extension = "GL_OES_standard_derivatives"
            if self.context.es == 100 and extension not in self.context.language.extensions:
                hint = f"write #extension {extension} : enable"
                raise self.context.fail(call.span, f"GLSL ES 1.00 has no {name} without an extension", hint)
        if not any(arg.quantity for arg in args):
            return Typed(ir.Intrinsic(result, name, values, call.span))
        try:
            if isinstance(values[0].type, Sampler):
                quantity = q.texel_of(args[0].quantity)
                if len(args) > 1 and args[1].quantity == "uv_direction":
                    message = f"a texture is sampled at a position, but this is {q.words(args[1].quantity)}"
                    raise q.Mixup(message, q.conversion(args[1].quantity, "uv_position"))
            else:
                quantity = q.of_intrinsic(name, [arg.quantity for arg in args])
        except q.Mixup as mixup:
            raise self.context.fail(call.span, mixup.message, mixup.hint) from None
        return Typed(ir.Intrinsic(result, name, values, call.span), quantity)

    def check_es(self, name: str, types: list[Type], call: s.CallOf) -> None:
        """Reports a builtin that GLSL ES lacks in this form, or in this stage."""
        context, row = self.context, BUILTINS[name]
        if not context.es:
            return
        match = overload(name, types) if row.not_es else None
        if match is not None and match.params in row.not_es:
            raise context.fail(call.span, f"GLSL ES has no {name} of ({', '.join(map(spell, types))})")
        if context.language.vertex and len(types) == _WITH_BIAS.get(name):
            raise context.fail(call.span, "a vertex shader has no bias of a level", "write textureLod")

    def with_constants(self, name: str, values: tuple[ir.Expr, ...]) -> tuple[ir.Expr, ...]:
        """The arguments of a builtin, with literals for those that must be constant expressions: WGSL has no other
        constants in functions."""
        row = BUILTINS[name]
        if not row.constant:
            return values
        for index, argument in row.constants([value.type for value in values]).items():
            value = values[index]
            if value.span.file.startswith("intrinsics/"):  # a parameter of a polyfill, which is inlined
                continue
            numbers = constant_value(self.context, value)
            if numbers is None:
                message = f"the {argument.what} of {name} must be a constant expression"
                raise self.context.fail(value.span, message, "write a number, or a const variable with such a value")
            lowest, highest = argument.lowest, argument.highest
            if not all(lowest <= number <= highest for number in numbers):
                raise self.context.fail(value.span, f"the {argument.what} of {name} must be in {lowest}..{highest}")
            if any(not isinstance(part, ir.Construct | ir.Literal | ir.Unary) for part in subexpressions(value)):
                values = (*values[:index], literal(value.type, numbers, value.span), *values[index + 1 :])
        return values


_OFFSET = vector_of("int", 2)

_WITH_BIAS = {"texture": 3, "textureOffset": 4}
"""Read → how many arguments it has with a bias."""


def _exact(overloads: Sequence[Signature], types: tuple[Type, ...]) -> Signature | None:
    """The overload that takes exactly these types."""
    return next((signature for signature in overloads if signature.types == types), None)


def _is_viable(signature: Signature, types: tuple[Type, ...]) -> bool:
    """Whether a call with arguments of these types may call this function."""
    return len(signature.types) == len(types) and all(
        type_ == param
        or (direction == "in" and converts(type_, param))
        or (direction == "out" and converts(param, type_))
        for type_, param, direction in zip(types, signature.types, signature.directions, strict=True)
    )


def _conversion_cost(signature: Signature, types: tuple[Type, ...]) -> int:
    """The cost of a call's conversions: int to uint is cheaper than to float."""
    pairs = zip(types, signature.types, strict=True)
    return sum([0 if type_ == param else 1 if kind_of(param) == "uint" else 2 for type_, param in pairs])


def _conversions(values: tuple[ir.Expr, ...]) -> Iterator[tuple[ir.Expr, ...]]:
    """The arguments of a builtin with integers converted, the cheapest conversion first."""
    kinds = {kind_of(value.type) for value in values}
    for kind in ("uint", "float"):
        if kinds & {"int", "uint"}:
            yield tuple([as_kind(value, kind) if kind_of(value.type) in ("int", "uint") else value for value in values])
    if kinds >= {"int", "float"}:  # texture(s, uv, 1), textureLod(s, ivec2, 0); the level of texelFetch stays an int
        for index, value in enumerate(values):
            if kind_of(value.type) == "int":
                yield (*values[:index], as_kind(value, "float"), *values[index + 1 :])
