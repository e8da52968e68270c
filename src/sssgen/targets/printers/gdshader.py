"""Prints Godot's shading language: GLSL ES whose uniforms have hints for the inspector and for their textures."""

from __future__ import annotations

from collections.abc import Sequence

from sssgen.ir import nodes as ir
from sssgen.ir.frame_passes import BEHIND, pass_name
from sssgen.ir.types import VEC4, Array, Matrix, Sampler, Scalar, Type, Vector, components, kind_of
from sssgen.targets.descriptor import Target
from sssgen.targets.printers.glsl import GlslPrinter
from sssgen.targets.printers.number_text import float_text
from sssgen.targets.printers.printed_lines import Line, comment_text, wrap
from sssgen.targets.printers.printer import PRIMARY
from sssgen.targets.texture_import import has_hint, import_of
from sssgen.targets.uniform_layout import Member

_DEFAULTS = {"default_black": "hint_default_black", "default_bump": "hint_normal"}


class GodotPrinter(GlslPrinter):
    """Colours pass `linear_color` where they are read: the Compatibility renderer leaves them encoded. Parameters with
    the hint `placed` get the object's matrix there."""

    def __init__(self, target: Target, module: ir.Module) -> None:
        super().__init__(target, module)
        self.placed = {uniform.name for uniform in module.uniforms if has_hint(uniform, "placed")}
        self.color_types = {uniform.name: uniform.type for uniform in module.uniforms if uniform.name in self.colors}

    def global_value(self, value: ir.Global) -> str:
        name, color = super().global_value(value), self.color_types.get(value.name)
        if name in self.placed:  # with the object's matrices, which the descriptor declares as varyings
            if isinstance(value.type, Matrix):
                return f"({name} * object_from_world)"
            return f"({name} * pow(abs(determinant(mat3(world_from_object))), 1.0 / 3.0))"
        if isinstance(color, Vector):
            return f"linear_color({name})" if color == VEC4 else f"linear_color(vec4({name}, 1.0)).rgb"
        return name

    def intrinsic(self, call: ir.Intrinsic) -> tuple[str, int]:
        text, binding = super().intrinsic(call)
        first = call.args[0] if call.args else None
        named = (
            isinstance(first, ir.Global | ir.Local) and isinstance(first.type, Sampler) and first.name in self.colors
        )
        return (f"linear_color({text})", PRIMARY) if named and call.type == VEC4 else (text, binding)

    def binary(self, binary: ir.Binary) -> tuple[str, int]:
        """Vectors are compared by functions, as `==` gives one bool here; the operands of bits have one type."""
        if binary.op in ("==", "!=") and isinstance(binary.type, Vector):
            name = "equal" if binary.op == "==" else "notEqual"
            return f"{name}({self.arguments((binary.left, binary.right))})", PRIMARY
        if binary.op in ("<<", ">>", "&", "|", "^") and {binary.left.type, binary.right.type} != {binary.type}:
            sides = [_of_type(binary.type, side) for side in (binary.left, binary.right)]
            binary = binary._replace(left=sides[0], right=sides[1])
        return super().binary(binary)

    def construct(self, construct: ir.Construct) -> tuple[str, int]:
        """A matrix of numbers is written by columns, which is the only constructor for it here."""
        type_, args = construct.type, construct.args
        if not isinstance(type_, Matrix) or len(args) != components(type_):
            return super().construct(construct)
        column = self.type(Vector("float", type_.rows))
        starts = range(0, len(args), type_.rows)
        columns = [f"{column}({self.arguments(args[start : start + type_.rows])})" for start in starts]
        return f"{self.type(type_)}({self.join_arguments(columns)})", PRIMARY

    def print_uniforms(self, members: list[Member]) -> list[Line]:
        """The uniforms in the groups of the inspector, each with its documentation, its hint and its default."""
        return self.print_groups([member.uniform for member in members])

    def print_textures(self, textures: list[ir.Uniform]) -> list[Line]:
        return self.print_groups(textures)

    def print_groups(self, uniforms: list[ir.Uniform]) -> list[Line]:
        lines: list[Line] = []
        group = ""
        for uniform in uniforms:
            if (own := self.groups.get(uniform.name, "")) != group:
                group = own
                lines.append(Line(f"group_uniforms {group};" if group else "group_uniforms;"))
            if words := comment_text(" ".join(uniform.doc.split())).replace("*/", "* /"):
                lines.append(Line(f"/** {words} */"))
            hints = self.texture_hints(uniform) if isinstance(uniform.type, Sampler) else _value_hints(uniform)
            text = f"uniform {self.variable(uniform.type, uniform.name)}{' : ' if hints else ''}{', '.join(hints)}"
            lines += wrap(f"{text}{self.default_of(uniform)};", uniform.span)
        return [*lines, Line("group_uniforms;")] if group else lines

    def texture_hints(self, texture: ir.Uniform) -> list[str]:
        """What a texture holds, its default, and how it is sampled: as in its import settings."""
        assert isinstance(texture.type, Sampler)
        if pass_name(texture) == BEHIND:  # the engine draws such a body behind the others, and fills the picture
            return ["hint_screen_texture", "filter_linear_mipmap", "repeat_disable"]
        default = next((text for name, text in _DEFAULTS.items() if has_hint(texture, name)), "hint_default_white")
        settings = import_of(texture)
        hints = ["source_color"] if has_hint(texture, "source_color") else []
        hints += [default] if texture.type.kind == "float" else []
        hints.append("filter_linear_mipmap" if settings["mipmaps"] else "filter_linear")
        return [*hints, "repeat_enable" if settings["wrap"] == "repeat" else "repeat_disable"]

    def default_of(self, uniform: ir.Uniform) -> str:
        """The default; of a colour as sRGB, which the engine converts like a colour of the inspector."""
        type_, numbers = uniform.type, list(uniform.default)
        if isinstance(type_, Array | Sampler) or len(numbers) != components(type_):
            return ""
        if uniform.name in self.colors:
            numbers = [*map(_as_srgb, numbers[:3]), *numbers[3:]]
        return f" = {self.value_of(type_, numbers)}"

    def value_of(self, type_: Type, numbers: Sequence[float]) -> str:
        if isinstance(type_, Matrix):
            size, column = type_.rows, Vector("float", type_.rows)
            columns = [self.value_of(column, numbers[start : start + size]) for start in range(0, len(numbers), size)]
            return f"{self.type(type_)}({', '.join(columns)})"
        return super().value_of(type_, numbers)


def _of_type(type_: Type, value: ir.Expr) -> ir.Expr:
    """An integer operand as one of a type: a number first gets the kind, and then the size."""
    if isinstance(value.type, Scalar) and kind_of(value.type) != kind_of(type_):
        value = ir.Construct(Scalar(kind_of(type_)), (value,), value.span)
    return value if value.type == type_ else ir.Construct(type_, (value,), value.span)


def _value_hints(uniform: ir.Uniform) -> list[str]:
    limits = dict(uniform.hints).get("hint_range")
    if has_hint(uniform, "source_color"):
        return ["source_color"]
    if not limits or not isinstance(uniform.type, Scalar) or uniform.type.kind not in ("float", "int"):
        return []
    whole = uniform.type.kind == "int"
    return [f"hint_range({', '.join(str(int(limit)) if whole else float_text(float(limit)) for limit in limits)})"]


def _as_srgb(light: float) -> float:
    """Linear light as sRGB."""
    light = max(light, 0.0)
    return float(round(12.92 * light if light <= 0.0031308 else 1.055 * light ** (1.0 / 2.4) - 0.055, 6))
