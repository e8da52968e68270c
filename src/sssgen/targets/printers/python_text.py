"""Python text that does not depend on a module: long lines, and the defaults of uniforms and textures."""

from __future__ import annotations

import re

from sssgen.ir.nodes import Span, Uniform
from sssgen.ir.types import Array, Matrix, Sampler, Scalar, Type, components, kind_of
from sssgen.targets.printers.printed_lines import WIDTH, Line

_TEXELS = {
    "default_white": "[1.0, 1.0, 1.0, 1.0]",
    "default_black": "[0.0, 0.0, 0.0, 1.0]",
    "default_gray": "[0.5, 0.5, 0.5, 1.0]",
    "default_bump": "[0.5, 0.5, 1.0, 1.0]",
}
_SHAPES = {"2D": "[[{}]]", "3D": "[[[{}]]]", "Cube": "[[[{}]]] * 6"}
_BREAK = re.compile(r"[(\[]|[)\]]|(?<=,) | (?=[-+*/&|<>]+ )")


def wrap(text: str, span: Span) -> list[Line]:
    """Breaks a long line inside the outermost parentheses that make it fit, after a comma or before an operator."""
    indent = " " * (len(text) - len(text.lstrip()) + 4)
    lines: list[Line] = []
    open_ = 0
    while len(text) > WIDTH:
        depth, places = open_, []
        for match in _BREAK.finditer(text):
            depth += (match[0] in "([") - (match[0] in ")]")
            if match[0] == " " and depth > 0 and len(indent) < match.start() <= WIDTH:
                places.append((depth, -match.start()))
        if not places:
            break
        open_, place = min(places)
        place = -place
        lines.append(Line(text[:place], span))
        text = indent + text[place:].lstrip()
    return [*lines, Line(text, span)]


def value_text(type_: Type, numbers: tuple[float, ...]) -> str:
    """The text of a runtime value with these components."""
    if isinstance(type_, Array):
        size = components(type_.element)
        parts = [value_text(type_.element, numbers[at : at + size]) for at in range(0, len(numbers), size)]
        return f"array({', '.join(parts)})"
    kind = kind_of(type_)
    texts = [
        repr(float(number) if kind == "float" else bool(number) if kind == "bool" else int(number))
        for number in numbers
    ]
    if kind == "uint":
        texts[0] = f"to_uint({texts[0]})"
    if isinstance(type_, Scalar):
        return texts[0]
    return f"{f'mat({type_.columns}, ' if isinstance(type_, Matrix) else 'vec('}{', '.join(texts)})"


def texture_text(texture: Uniform) -> str:
    """The text of a texture with one texel: the default that its hints name."""
    assert isinstance(texture.type, Sampler)
    hints = {name for name, _ in texture.hints}
    texel = next((text for hint, text in _TEXELS.items() if hint in hints), _TEXELS["default_white"])
    type_ = texture.type
    layered = type_.array or type_.dim == "2DMS"  # samples are layers
    data = _SHAPES[type_.dim.removesuffix("MS")].format(texel if type_.kind == "float" else "[0, 0, 0, 0]")
    options = {"dim": '"Cube"'} if type_.dim == "Cube" else {}
    options |= {"layers": "True"} if layered else {}
    options |= {"kind": f'"{type_.kind}"'} if type_.kind != "float" else {}
    options |= {"compare": "True"} if type_.shadow else {}
    named = "".join(f", {name}={value}" for name, value in options.items())
    return f"Texture({f'[{data}]' if layered else data}{named})"
