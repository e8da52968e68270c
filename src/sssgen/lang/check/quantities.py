"""Quantity types: what a number or vector measures, so that thickness and transmittance are not mixed by mistake.

A quantity is a name over a plain type. A quantity value may be used as its plain type anywhere; a plain value
becomes a quantity only through the constructor of that name; only a named conversion makes another quantity of it. The
idea of spaces as types is Gator's ("Geometry types for graphics programming", OOPSLA 2020).
"""

from __future__ import annotations

from sssgen.ir.intrinsics import BUILTINS
from sssgen.ir.types import FLOAT, VEC2, VEC3, Type, spell, with_article
from sssgen.lang.check.suggested_conversions import suggested_conversions

SPACES = ("world", "object", "tangent", "uv")

SCALARS = ("thickness", "view_thickness", "thinness", "transmittance")
"""`view_thickness` is the length inside the body along the eye's ray, from the surface to the ray's first exit;
`thickness` is a length towards the light, or along the normal."""

QUANTITIES: dict[str, Type] = dict.fromkeys(SCALARS, FLOAT)
for _space in SPACES:
    QUANTITIES[f"{_space}_position"] = QUANTITIES[f"{_space}_direction"] = VEC2 if _space == "uv" else VEC3

_TEXEL = "texel of "

_FRAMES = {("world", "tangent"), ("tangent", "world"), ("world", "object"), ("object", "world")}
"""The spaces between which common/frames.sss turns directions, from one to the other."""


class Mixup(Exception):
    """Two quantities that cannot be combined; has the message and a hint."""

    def __init__(self, message: str, hint: str = "") -> None:
        super().__init__(message)
        self.message, self.hint = message, hint


def words(quantity: str) -> str:
    """A quantity with its article, for messages: `a world direction`."""
    if not quantity:
        return "a plain value"
    return with_article(quantity.replace("_", " "))


def space(quantity: str) -> str:
    """The space of a position or direction, else ''."""
    return quantity.split("_")[0] if quantity not in SCALARS and "_" in quantity else ""


def texel_of(quantity: str) -> str:
    """The quantity of a texel of a texture that holds `quantity`."""
    return _TEXEL + quantity if quantity else ""


def channel_of(quantity: str) -> str:
    """The quantity of one component of a value: a texel's channel keeps it, a vector's component loses it."""
    return quantity.removeprefix(_TEXEL) if quantity.startswith(_TEXEL) else ""


def conversion(source: str, target: str) -> str:
    """How to convert `source` to `target`: the text of a hint."""
    if name := suggested_conversions().get((source, target)):
        return f"convert it with {name}(…)"
    if space(source) and space(target):
        turned = source.endswith("_direction") and target.endswith("_direction")
        if turned and (space(source), space(target)) in _FRAMES:
            return f"convert it with {space(target)}_from_{space(source)}(…) of common/frames.sss"
        if space(source) != space(target):
            return f"transform it with a matrix or your own function, and write {target}(…) around the result"
        return f"if it is {words(target)}, write {target}({spell(QUANTITIES[target])}(…))"
    if not source:
        return f"if it is {words(target)}, write {target}(…)"
    return f"{words(source)} cannot become {words(target)}"


def check_assignable(source: str, target: str) -> None:
    """Raises Mixup unless a value of quantity `source` may be stored as `target`."""
    if target and source != target:
        raise Mixup(f"this must be {words(target)}, but it is {words(source)}", conversion(source, target))


def check_constructible(source: str, target: str) -> None:
    """Raises Mixup where a constructor would turn one quantity into another."""
    if source and not source.startswith(_TEXEL) and source != target:
        raise Mixup(f"{words(target)} cannot be constructed from {words(source)}", conversion(source, target))


def of_operator(op: str, left: str, right: str, scaling: bool = False) -> str:
    """The quantity of `left op right`; `scaling` says that one of them is a single number.

    Raises Mixup for sums and comparisons that mix quantities, and for anything that mixes spaces.
    """
    _check_one_space((left, right))
    if op in ("*", "/"):
        scaled = next((one for one in (left, right if op == "*" else "") if one.endswith("_direction")), "")
        return scaled if scaling else ""
    if not left or not right:
        return ""
    if op == "+" and left != right and space(left) and space(right):
        return f"{space(left)}_position"
    if op == "-" and left.endswith("_position") and right != left and space(right):
        return left
    if left != right:
        raise Mixup(f"'{op}' cannot combine {words(left)} and {words(right)}", conversion(right, left))
    if left.endswith("_position"):
        return f"{space(left)}_direction" if op == "-" else ""
    return left if op in ("+", "-") else ""


def of_intrinsic(name: str, args: list[str]) -> str:
    """The quantity of a builtin's result, from those of its arguments. Raises Mixup where they cannot be combined."""
    given = [quantity for quantity in args if quantity]
    if not given:
        return ""
    _check_one_space(given)
    row = BUILTINS[name]
    compared = [quantity for quantity in args[: row.same_quantity] if quantity]
    for quantity in compared[1:]:
        if quantity != compared[0]:
            message = f"{name} cannot combine {words(compared[0])} and {words(quantity)}"
            raise Mixup(message, conversion(quantity, compared[0]))
    if row.quantity == "direction":
        return given[0] if all(quantity.endswith("_direction") for quantity in given) else ""
    if row.quantity == "argument":
        return given[0]
    if row.quantity == "blend":
        return args[0] if args[0] == args[1] else ""
    return ""


def _check_one_space(quantities: tuple[str, ...] | list[str]) -> None:
    spaced = [quantity for quantity in quantities if space(quantity)]
    for quantity in spaced[1:]:
        if space(quantity) != space(spaced[0]):
            raise Mixup(
                f"{words(spaced[0])} cannot be combined with {words(quantity)}", conversion(quantity, spaced[0])
            )
