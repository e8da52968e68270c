"""Parts of a constructed value, read from its arguments without constructing it: `vec3(a, b).x` is `a.x`."""

from __future__ import annotations

from sssgen.ir.constant_expressions import constant_numbers, literal
from sssgen.ir.nodes import Call, Construct, Expr, Global, Literal, Local, Span, Swizzle
from sssgen.ir.types import Scalar, Type, Vector, components, kind_of, vector_of
from sssgen.ir.walk import subexpressions


def calls(expr: Expr) -> bool:
    """Whether an expression calls a function, which may do more than give its value."""
    return any(type(node) is Call for node in subexpressions(expr))


def only_argument(value: Construct, index: int) -> Expr | None:
    """One argument of a construct, if the others can be dropped."""
    dropped = any(calls(arg) for position, arg in enumerate(value.args) if position != index)
    return None if dropped else value.args[index]


def pick_components(value: Construct, indices: list[int], type: Type, span: Span) -> Expr | None:
    """Components of an assembled vector, without assembling it; None where that is not simpler."""
    constant = constant_numbers(value)
    if constant is not None:
        return literal(type, tuple([constant[index] for index in indices]), span)
    if len(value.args) == 1 and isinstance(value.args[0].type, Scalar):
        return value.args[0] if len(indices) == 1 else Construct(type, value.args, span)
    if len(value.args) == 1:
        return None
    places = [(number, part) for number, arg in enumerate(value.args) for part in range(components(arg.type))]
    groups: list[tuple[int, list[int]]] = []
    for index in indices:
        number, part = places[index]
        if groups and groups[-1][0] == number and isinstance(value.args[number].type, Vector):
            groups[-1][1].append(part)
        else:
            groups.append((number, [part]))
    used = [number for number, _ in groups]
    for number, arg in enumerate(value.args):
        repeated = used.count(number) > 1 and not isinstance(arg, Local | Global | Literal)
        if repeated or (number not in used and calls(arg)):
            return None
    pieces = [components_at(value.args[number], parts, span) for number, parts in groups]
    return pieces[0] if len(pieces) == 1 else Construct(type, tuple(pieces), span)


def components_at(arg: Expr, parts: list[int], span: Span) -> Expr:
    """Some components of a vector, or the scalar itself."""
    if not isinstance(arg.type, Vector) or parts == list(range(arg.type.size)):
        return arg
    value, letters = (arg.value, arg.components) if isinstance(arg, Swizzle) else (arg, "xyzw")
    type_ = vector_of(kind_of(arg.type), len(parts))
    return Swizzle(type_, value, "".join([letters[part] for part in parts]), span)
