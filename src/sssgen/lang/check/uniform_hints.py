"""The hints of a uniform: their names, their arguments, and whether the default value agrees with them."""

from __future__ import annotations

from sssgen.ir.frame_passes import CUBES, FRAME_PASSES, VOLUMES
from sssgen.ir.nodes import Span
from sssgen.ir.rules import FLOAT_MAX
from sssgen.ir.types import FLOAT, VEC3, VEC4, Array, Matrix, Sampler, Type, kind_of
from sssgen.lang.check import quantities as q
from sssgen.lang.check.context import CheckContext
from sssgen.lang.syntax import tree as s
from sssgen.support.diagnostics import did_you_mean

Hints = tuple[tuple[str, tuple[float | str, ...]], ...]

# Hint → (minimum and maximum number of arguments, their kind, whether it is for textures; None: for both).
HINTS = {
    "hint_range": (2, 3, float, False),
    "sample_range": (2, 2, float, False),
    "bound_range": (2, 2, float, False),
    "source_color": (0, 0, str, None),
    "unit": (1, 1, str, False),
    "spans_body": (0, 0, str, False),
    "placed": (0, 0, str, False),
    "alias": (1, 8, str, None),
    "default_white": (0, 0, str, True),
    "default_black": (0, 0, str, True),
    "default_gray": (0, 0, str, True),
    "default_bump": (0, 0, str, True),
    "normal_map": (0, 0, str, True),
    "repeat_disable": (0, 0, str, True),
    "holds": (1, 1, str, True),
    "drawn": (1, 1, str, None),
    "texel_bytes": (1, 1, float, True),
}


def check_hints(
    context: CheckContext, uniform: s.Declarator, type_: Type, default: tuple[float, ...]
) -> tuple[Hints, str]:
    """Checks a uniform's hints; returns them with the quantity that a texture holds ('' for none)."""
    hints: dict[str, tuple[float | str, ...]] = {}
    quantity = ""
    for hint in uniform.hints:
        name, span = hint.name.text, hint.name.span
        if name not in HINTS:
            raise context.fail(span, f"unknown hint '{name}'", did_you_mean(name, HINTS))
        if name in hints:
            raise context.fail(span, f"hint '{name}' is given twice")
        fewest, most, kind, for_texture = HINTS[name]
        if any(isinstance(arg, float) and not abs(arg) <= FLOAT_MAX for arg in hint.args):
            raise context.fail(span, f"a number of {name} does not fit in a float")
        if not fewest <= len(hint.args) <= most or any(not isinstance(arg, kind) for arg in hint.args):
            raise context.fail(span, f"{name} takes {_arguments(fewest, most, kind)}")
        if for_texture is not None and for_texture != isinstance(type_, Sampler):
            raise context.fail(span, f"{name} is for {'textures' if for_texture else 'values'} only")
        if name == "source_color" and not isinstance(type_, Sampler) and type_ not in (VEC3, VEC4):
            raise context.fail(span, "source_color is for vec3, vec4 and textures only")
        if name == "placed" and type_ not in (Matrix(4, 4), FLOAT):
            raise context.fail(span, "placed is for the mat4 of a view from the world, and for a length")
        if name == "hint_range":
            _check_range(context, span, hint.args, type_, default, uniform.value is not None)
        if name in ("sample_range", "bound_range"):
            _check_part(context, name, span, hint.args, type_, hints.get("hint_range"))
        if name == "texel_bytes" and not (float(hint.args[0]).is_integer() and 1.0 <= float(hint.args[0]) <= 64.0):
            raise context.fail(span, "texel_bytes takes a whole number from 1 to 64")
        if name == "holds":
            quantity = str(hint.args[0])
            if quantity not in q.SCALARS:
                known = f"it can hold {', '.join(q.SCALARS)}"
                raise context.fail(span, f"a texture cannot hold '{quantity}'", known)
        if name == "drawn":
            _check_drawn(context, span, str(hint.args[0]), type_)
        hints[name] = hint.args
    return tuple(hints.items()), quantity


def _check_drawn(context: CheckContext, span: Span, view: str, type_: Type) -> None:
    if view not in FRAME_PASSES:
        raise context.fail(
            span,
            f"a program cannot draw '{view}'",
            did_you_mean(view, FRAME_PASSES) or f"one of: {', '.join(FRAME_PASSES)}",
        )
    dim = "Cube" if view in CUBES else "3D" if view in VOLUMES else "2D"
    values = type_ in (Matrix(4, 4), FLOAT) or (isinstance(type_, Array) and type_.element == VEC4)
    if not values and not (isinstance(type_, Sampler) and type_.dim == dim):
        what = f"a sampler{dim}, the mat4 of the view in which it is drawn, its size, and an array of vec4 for lights"
        raise context.fail(span, f"drawn({view}) is for {what}")


def _check_range(
    context: CheckContext,
    span: Span,
    args: tuple[float | str, ...],
    type_: Type,
    default: tuple[float, ...],
    written: bool,
) -> None:
    low, high = _ends(context, "hint_range", span, args, type_)
    if not all(float(step) > 0.0 for step in args[2:]):
        raise context.fail(span, "the step of a range must be above 0")
    for value in default:
        if not low <= value <= high:
            message = f"the default {value:g} is outside the range {low:g} to {high:g}"
            raise context.fail(span, message, "" if written else "it has no default value of its own: add one with =")


def _check_part(
    context: CheckContext,
    name: str,
    span: Span,
    args: tuple[float | str, ...],
    type_: Type,
    whole: tuple[float | str, ...] | None,
) -> None:
    """Checks a part of the range: of numbers, not empty, and within the `hint_range` that stands before it."""
    low, high = _ends(context, name, span, args, type_)
    if whole is not None and not float(whole[0]) <= low < high <= float(whole[1]):
        raise context.fail(span, f"{name} goes beyond hint_range")


def _ends(
    context: CheckContext, name: str, span: Span, args: tuple[float | str, ...], type_: Type
) -> tuple[float, float]:
    """The ends of a range of numbers that is not empty."""
    low, high = float(args[0]), float(args[1])
    if kind_of(type_) not in ("float", "int", "uint"):
        raise context.fail(span, f"{name} is for numbers only")
    if not low < high:
        raise context.fail(span, f"the range {low:g} to {high:g} is empty")
    return low, high


def _arguments(fewest: int, most: int, kind: type) -> str:
    if most == 0:
        return "no arguments"
    if most == 1:
        return "one number" if kind is float else "one name or string"
    count = f"{most}" if fewest == most else f"{fewest} to {most}"
    return f"{count} {'numbers' if kind is float else 'names or strings'}"
