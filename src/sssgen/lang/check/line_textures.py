"""Textures of one dimension become textures of two with one row: GLSL ES has no others, and WebGPU no levels of them.

    texture(ramp, x)           # texture(ramp, vec2(x, 0.5))
    texelFetch(ramp, i, 0)     # texelFetch(ramp, ivec2(i, 0), 0)
    textureSize(ramp, 0)       # textureSize(ramp, 0).x

A texture of one row has the levels of one of one dimension, and the same texels at each. The checker writes the reads
so; where the file is checked, `without_lines` gives the textures their new types.
"""

from __future__ import annotations

from collections.abc import Sequence

from sssgen.ir import nodes as ir
from sssgen.ir.transform import rewrite_module
from sssgen.ir.types import FLOAT, INT, Sampler, Scalar, Type, components, kind_of, vector_of
from sssgen.lang.check.context import CheckContext, Typed
from sssgen.lang.check.implicit_conversions import as_kind

_FETCHES = ("texelFetch", "texelFetchOffset")
_OFFSETS = {"textureOffset": 2, "textureLodOffset": 3, "textureGradOffset": 4, "texelFetchOffset": 3}
"""Read → the position of the offset among its arguments."""


def is_line(args: Sequence[Typed]) -> bool:
    """Whether the first argument is a texture of one dimension."""
    return bool(args) and isinstance(args[0].expr.type, Sampler) and args[0].expr.type.line


def plane_arguments(name: str, args: Sequence[Typed], converts: bool) -> list[Typed] | None:
    """The arguments of a read of the texture of one row; None where there is no such read."""
    texture = args[0].expr.type
    assert isinstance(texture, Sampler)
    plane = args[0]._replace(expr=_with_type(args[0].expr, _plane(texture)))
    if len(args) < 2 or name == "textureSize":
        return [plane, *args[1:]]
    places = [arg.expr for arg in args[1:]]
    places[0] = as_kind(places[0], "float") if converts and name not in _FETCHES else places[0]
    if components(places[0].type) != _coordinates(texture):
        return None
    places[0] = _place(places[0], texture, INT if name in _FETCHES else FLOAT)
    offset = _OFFSETS.get(name, len(args)) - 1
    for index, place in enumerate(places):
        if index == offset or ("Grad" in name and index in (1, 2)):
            places[index] = _along(place)
    return [plane, *(arg._replace(expr=place) for arg, place in zip(args[1:], places, strict=True))]


def line_size(size: ir.Expr) -> ir.Expr:
    """The size of a texture of one dimension, from that of the texture of one row: the width, and the layers."""
    letters = "x" if components(size.type) == 2 else "xz"
    return ir.Swizzle(vector_of("int", len(letters)), size, letters, size.span)


def without_lines(module: ir.Module, context: CheckContext) -> ir.Module:
    """The module with textures of two dimensions. Reports functions that would have the same parameters."""
    functions: dict[str, ir.Function] = {}
    keys: dict[str, str] = {}
    for function in module.functions:
        plane = function._replace(params=tuple([param._replace(type=_plane(param.type)) for param in function.params]))
        if plane.key in functions:
            message = f"'{function.name}' is the same function for a sampler1D and a sampler2D here"
            context.reporter.error(function.span, message, "give one of them another name")
        functions[plane.key] = plane
        keys[function.key] = plane.key

    def change(node: ir.Expr) -> ir.Expr:
        if isinstance(node, ir.Call):
            return node._replace(function=keys.get(node.function, node.function))
        return _with_type(node, _plane(node.type))

    uniforms = tuple([uniform._replace(type=_plane(uniform.type)) for uniform in module.uniforms])
    return rewrite_module(module._replace(uniforms=uniforms, functions=tuple(functions.values())), change)


def _plane(type_: Type) -> Type:
    return type_._replace(line=False) if isinstance(type_, Sampler) else type_


def _with_type(node: ir.Expr, type_: Type) -> ir.Expr:
    return node._replace(type=type_) if isinstance(node, ir.Local | ir.Global) and node.type != type_ else node


def _coordinates(texture: Sampler) -> int:
    """How many components the coordinate of a read has; that of a comparing texture has an unused one."""
    return 3 if texture.shadow else 2 if texture.array else 1


def _place(place: ir.Expr, texture: Sampler, scalar: Scalar) -> ir.Expr:
    """The coordinate with a second component: the middle of the row, or the row's number."""
    span = place.span
    row = ir.Literal(scalar, 0.5 if scalar == FLOAT else 0, span)
    if texture.shadow and not texture.array:  # (x, unused, reference)
        place = ir.Swizzle(vector_of(kind_of(place.type), 2), place, "xz", span)
    whole = ir.Construct(vector_of(scalar.kind, components(place.type) + 1), (place, row), span)
    letters = {2: "xy", 3: "xzy", 4: "xwyz"}[components(whole.type)]
    return whole if letters == "xy" else ir.Swizzle(whole.type, whole, letters, span)


def _along(value: ir.Expr) -> ir.Expr:
    """A derivative or an offset along the row."""
    if not isinstance(value.type, Scalar):
        return value
    zero = ir.Literal(value.type, 0 if value.type == INT else 0.0, value.span)
    return ir.Construct(vector_of(value.type.kind, 2), (value, zero), value.span)
