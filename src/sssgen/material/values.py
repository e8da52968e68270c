"""The values of parameters in a material: TOML values → the components of a uniform, checked."""

from __future__ import annotations

import math
import re
from typing import Any

from sssgen.ir.contracts import of_uniform
from sssgen.ir.nodes import Uniform
from sssgen.ir.types import Array, Matrix, Sampler, Type, components, kind_of, spell, with_article

_LARGEST = 3.4028234663852886e38
_LIMITS = {"int": (-(2**31), 2**31 - 1), "uint": (0, 2**32 - 1), "float": (-_LARGEST, _LARGEST)}
HEX_COLOUR = r"#(?:[0-9a-fA-F]{3}|[0-9a-fA-F]{6}|[0-9a-fA-F]{8})"
_HEX = re.compile(HEX_COLOUR)


class WrongValue(Exception):
    """A value that does not fit; `index` is the index of the wrong element in a list, or None."""

    def __init__(self, message: str, hint: str = "", index: int | None = None) -> None:
        super().__init__(message)
        self.message, self.hint, self.index = message, hint, index


def read_value(uniform: Uniform, raw: object) -> tuple[float, ...]:
    """The components of a uniform's value. Matrices are given column by column, lists flat or nested.

    A colour may be `"#rgb"`, `"#rrggbb"` or `"#rrggbbaa"` in sRGB, and becomes linear RGB. Raises WrongValue
    for a value of another type or size, one that no 32-bit number holds, and one outside the uniform's range.
    """
    type_ = uniform.type
    if isinstance(raw, str):
        return _colour(uniform, raw)
    if components(type_) == 1 and not isinstance(type_, Array):
        return (_number(uniform, raw, None),)
    flat = _flatten(raw) if isinstance(raw, list) else None
    if flat is None:
        raise WrongValue(f"'{uniform.name}' takes {value_form(uniform)}, but this is {_kind_of_raw(raw)}")
    if len(flat) != components(type_):
        count = f"{len(flat)} value{'' if len(flat) == 1 else 's'}"
        raise WrongValue(f"'{uniform.name}' takes {value_form(uniform)}, but this has {count}")
    nested = any(isinstance(element, list) for element in raw) if isinstance(raw, list) else False
    values = tuple(_number(uniform, element, None if nested else index) for index, element in enumerate(flat))
    if has_opacity(uniform) and not 0.0 <= values[3] <= 1.0:
        hint = 'a colour goes from 0 to 1; for bytes write "#rrggbbaa"'
        raise WrongValue(f"{values[3]:g} is no opacity of '{uniform.name}'", hint, None if nested else 3)
    return values


def read_texture(uniform: Uniform, raw: object) -> str:
    """The picture file of a texture. Raises WrongValue."""
    if not isinstance(raw, str):
        raise WrongValue(f"'{uniform.name}' takes {value_form(uniform)}, but this is {_kind_of_raw(raw)}")
    if not raw or any(ord(character) < 32 for character in raw):
        raise WrongValue(f"{raw!r} is not a file name", "leave the line out to use the texture's default")
    return raw


def value_form(uniform: Uniform) -> str:
    """The values that a uniform takes, for messages: `3 numbers, as in [0.5, 0.5, 0.5]`."""
    type_, kind = uniform.type, _kind(uniform.type)
    if isinstance(type_, Sampler):
        return 'the name of a picture file, as in "map.png"'
    count = components(type_)
    each = {
        "bool": "true or false",
        "float": "a number",
        "int": "a whole number",
        "uint": "a whole number of 0 or more",
    }[kind]
    if count == 1 and not isinstance(type_, Array):
        return each
    many = {
        "bool": "truth values",
        "float": "numbers",
        "int": "whole numbers",
        "uint": "whole numbers of 0 or more",
    }[kind]
    example = {"bool": "true", "float": "0.5", "int": "1", "uint": "1"}[kind]
    if is_colour(uniform):
        return f'a colour: {count} numbers of linear RGB, or an sRGB string as in "#ff8000"'
    if isinstance(type_, Matrix):
        return f"{count} numbers ({spell(type_)}), column by column"
    return f"{count} {many}, as in [{', '.join([example] * min(count, 4))}{', …' if count > 4 else ''}]"


def is_colour(uniform: Uniform) -> bool:
    """Whether the uniform is declared as a colour."""
    return components(uniform.type) in (3, 4) and any(name == "source_color" for name, _ in uniform.hints)


def has_opacity(uniform: Uniform) -> bool:
    """Whether the fourth number of a value is an opacity, from 0 to 1."""
    return is_colour(uniform) and components(uniform.type) == 4 and not isinstance(uniform.type, Array)


def limits(uniform: Uniform) -> tuple[float, float]:
    """The lowest and the highest number that `read_value` takes as a component."""
    kind = _kind(uniform.type)
    low, high = _LIMITS[kind]
    for hint, args in uniform.hints:
        if hint == "hint_range":
            low, high = max(low, float(args[0])), min(high, float(args[1]))
    contract = of_uniform(uniform)
    return (max(low, contract.low), min(high, contract.high)) if kind == "float" else (low, high)


def linear(srgb: float) -> float:
    """One sRGB component (0..1) as linear light (IEC 61966-2-1)."""
    return srgb / 12.92 if srgb <= 0.04045 else ((srgb + 0.055) / 1.055) ** 2.4


def _colour(uniform: Uniform, text: str) -> tuple[float, ...]:
    if not is_colour(uniform):
        hint = "write the number without quotes" if re.fullmatch(r"[-+0-9.eE]+", text.strip()) else ""
        if text.startswith("#"):
            hint = f"'{uniform.name}' is not declared a colour (source_color): give its components"
        raise WrongValue(f"'{uniform.name}' takes {value_form(uniform)}, but this is a string", hint)
    if not _HEX.fullmatch(text):
        raise WrongValue(f"'{text}' is not a colour", 'write "#rgb", "#rrggbb" or "#rrggbbaa", or a list of linear RGB')
    digits = text[1:]
    if len(digits) == 3:
        digits = "".join(digit * 2 for digit in digits)
    values = [int(digits[start : start + 2], 16) / 255 for start in range(0, len(digits), 2)]
    count = components(uniform.type)
    if len(values) > count:
        raise WrongValue(f"'{uniform.name}' has no alpha", f'write "{text[:7]}"')
    alpha = [*values, 1.0][3]
    return (*map(linear, values[:3]), alpha)[:count]


def _number(uniform: Uniform, raw: Any, index: int | None) -> float:
    """One component."""
    kind, name = _kind(uniform.type), uniform.name
    if kind == "bool":
        if not isinstance(raw, bool):
            raise WrongValue(f"'{name}' takes {value_form(uniform)}, but this is {_kind_of_raw(raw)}", "", index)
        return float(raw)
    if isinstance(raw, bool) or not isinstance(raw, int | float):
        raise WrongValue(f"'{name}' takes {value_form(uniform)}, but this is {_kind_of_raw(raw)}", "", index)
    if kind != "float" and isinstance(raw, float):
        hint = f"write {raw:.0f}" if raw.is_integer() and abs(raw) < 2**32 else ""
        raise WrongValue(f"'{name}' takes {value_form(uniform)}, but this is {raw:g}", hint, index)
    low, high = _LIMITS[kind]
    if not low <= raw <= high:  # also true of nan
        shown = (
            str(raw)
            if isinstance(raw, float) and not math.isfinite(raw)
            else f"a number of {len(str(raw))} digits"
            if abs(raw) > 1e300
            else f"{raw:g}"
        )
        raise WrongValue(f"'{name}' cannot be {shown}", f"{with_article(kind)} has 32 bits", index)
    for hint, args in uniform.hints:
        if hint == "hint_range" and not float(args[0]) <= raw <= float(args[1]):
            default = ", ".join(f"{value:g}" for value in dict.fromkeys(uniform.default))
            raise WrongValue(
                f"{raw:g} is outside the range of '{name}'",
                f"it goes from {args[0]:g} to {args[1]:g}; the default is {default}",
                index,
            )
    contract = of_uniform(uniform)
    if kind == "float" and not contract.low <= raw <= contract.high:
        raise WrongValue(
            f"{raw:g} is outside the safe range of '{name}'",
            f"without a hint_range the range is {contract.low:g} to {contract.high:g}: give it one in the technique",
            index,
        )
    return float(raw)


def _kind(type_: Type) -> str:
    return _kind(type_.element) if isinstance(type_, Array) else kind_of(type_)


def _flatten(raw: list[Any]) -> list[Any]:
    flat: list[Any] = []
    for element in raw:
        flat += _flatten(element) if isinstance(element, list) else [element]
    return flat


def _kind_of_raw(raw: object) -> str:
    """The kind of a TOML value, for messages."""
    if isinstance(raw, bool):
        return "true" if raw else "false"
    if isinstance(raw, int | float):
        return "a number"
    for kind, description in ((str, "a string"), (list, "a list"), (dict, "a table")):
        if isinstance(raw, kind):
            return description
    return "a date or time"
