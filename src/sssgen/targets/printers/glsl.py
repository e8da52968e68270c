"""Prints GLSL: 3.30 core and ES 3.00, the language that the IR is closest to."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence

from sssgen.ir import nodes as ir
from sssgen.ir.intrinsics import BUILTINS
from sssgen.ir.types import Array, Scalar, Struct, Type, Vector, kind_of, spell
from sssgen.passes.stage.stage_interface import COLORS, interpolation
from sssgen.targets.descriptor import Target
from sssgen.targets.printers.printed_lines import WIDTH, Line, comment_text, with_doc, wrap
from sssgen.targets.printers.printer import PRIMARY, Printer
from sssgen.targets.uniform_layout import Member

_PASSED = (("vertex", "out"), ("fragment", "in"))
"""What the vertex shader passes to the fragment shader, by stage and storage."""


class GlslPrinter(Printer):
    """Uniforms are in the default block; everything else is as in the IR."""

    def __init__(self, target: Target, module: ir.Module) -> None:
        super().__init__(target, module)
        self.builtins = {
            variable.name: variable.builtin
            for variable in module.variables
            if variable.builtin and variable.builtin not in COLORS
        }
        self.colors = {uniform.name for uniform in module.uniforms if ("source_color", ()) in uniform.hints}

    def global_value(self, value: ir.Global) -> str:
        return self.builtins.get(value.name, value.name)

    def intrinsic(self, call: ir.Intrinsic) -> tuple[str, int]:
        """A builtin; a channel's texels are not decoded, so a colour's are converted."""
        text, binding = super().intrinsic(call)
        texture = call.args[0] if self.target.channels and BUILTINS[call.name].kind == "fetch" else None
        if isinstance(texture, ir.Global) and texture.name in self.colors:
            return f"linear_texel({text})", PRIMARY
        return text, binding

    def print_variable(self, variable: ir.Variable) -> list[Line]:
        """A variable as it was written. Builtins need no declaration, except for the colours of older versions."""
        if variable.name in self.builtins:
            return []
        if variable.storage == "private":
            return super().print_variable(variable)
        if variable.storage == "buffer":
            return self.with_comments(variable, self.buffer(variable))
        if variable.storage == "image":
            return self.with_comments(variable, [Line(self.image(variable), variable.span)])
        passed = self.stage is not None and (self.stage.kind, variable.storage) in _PASSED
        word = interpolation(variable) if passed else variable.interpolation
        words = [word] if word and (word != "noperspective" or self.target.capabilities.noperspective) else []
        text = " ".join([*words, variable.storage, self.variable(variable.type, variable.name)])
        return self.with_comments(variable, [Line(f"{self.layout(variable)}{text};", variable.span)])

    def buffer(self, variable: ir.Variable) -> list[Line]:
        """A storage buffer: a block with an instance name."""
        struct, access = variable.type, f"{variable.access} " if variable.access else ""
        assert isinstance(struct, Struct)
        head = f"layout({variable.layout}, binding = {self.buffer_binding(variable)}) {access}buffer {struct.name} {{"
        fields = [Line(f"    {self.variable(field.type, field.name)};", variable.span) for field in struct.fields]
        return [Line(head, variable.span), *fields, Line(f"}} {variable.name};")]

    def image(self, variable: ir.Variable) -> str:
        """The declaration of an image."""
        items = [*([variable.layout] if variable.layout else []), f"binding = {self.image_binding(variable)}"]
        access = f"{variable.access} " if variable.access else ""
        return f"layout({', '.join(items)}) {access}uniform {spell(variable.type)} {variable.name};"

    def print_layout(self) -> list[Line]:
        if not self.module.workgroup:
            return []
        sizes = zip("xyz", self.module.workgroup, strict=True)
        return [Line(f"layout({', '.join([f'local_size_{axis} = {size}' for axis, size in sizes])}) in;")]

    def layout(self, variable: ir.Variable) -> str:
        """The location of a variable where the version has a text for it; vertex attributes and fragment colours do."""
        stage = self.stage
        if stage is None:
            return ""
        if (stage.kind, variable.storage) not in (("vertex", "in"), ("fragment", "out")):
            stated = variable.location >= 0 and self.target.capabilities.varying_locations
            return f"layout(location = {variable.location}) " if stated else ""
        slots = [slot for slot in stage.inputs + stage.outputs if slot.variable is variable]
        colors = {slot.variable.name for slot in stage.outputs if slot.location >= 0}
        stated = variable.location >= 0 or (variable.storage == "out" and len(colors) > 1)
        return f"layout(location = {slots[0].location}) " if stated and slots else ""

    def print_uniforms(self, members: list[Member]) -> list[Line]:
        """The uniform declarations, one a line."""
        uniforms = [member.uniform for member in members]
        if self.target.constants:
            return [line for uniform in uniforms for line in self.constant_of(uniform)]
        return [
            with_doc(f"uniform {self.variable(uniform.type, uniform.name)}{self.default(uniform)};", uniform)
            for uniform in uniforms
        ]

    def constant_of(self, uniform: ir.Uniform) -> list[Line]:
        """A uniform as a constant after its documentation, range and unit, for people who change its value."""
        limits, unit = (dict(uniform.hints).get(hint, ()) for hint in ("hint_range", "unit"))
        facts = [f"{limits[0]:g} to {limits[1]:g}"] if limits else []
        facts += [str(name) for name in unit if name != "1"]
        doc = " ".join(uniform.doc.split())
        words = f"{doc} ({', '.join(facts)})" if facts else doc
        comments = [Line(f"// {comment_text(line)}", uniform.span) for line in textwrap.wrap(words, WIDTH - 3)]
        declared = (
            f"const {self.variable(uniform.type, uniform.name)} = {self.value_of(uniform.type, uniform.default)};"
        )
        return [*comments, *wrap(declared, uniform.span)]

    def value_of(self, type_: Type, numbers: Sequence[float]) -> str:
        """The value of a type that consists of these numbers, as an expression."""
        if isinstance(type_, Array):
            size = len(numbers) // type_.length
            parts = [numbers[size * index : size * (index + 1)] for index in range(type_.length)]
            return f"{self.type(type_)}({', '.join([self.value_of(type_.element, part) for part in parts])})"
        number = Scalar(kind_of(type_))
        literals = [
            ir.Literal(number, value if number.kind == "float" else int(value), ir.NOWHERE) for value in numbers
        ]
        texts = ", ".join(map(self.literal, literals))
        return texts if isinstance(type_, Scalar) else f"{self.type(type_)}({texts})"

    def default(self, uniform: ir.Uniform) -> str:
        """The initial value of a uniform, where the version allows one."""
        plain = isinstance(uniform.type, Scalar | Vector) and uniform.type.kind != "bool"
        if not self.keeps_text or not plain or not any(uniform.default) or not self.target.capabilities.uniform_values:
            return ""
        return f" = {self.value_of(uniform.type, uniform.default)}"

    def print_textures(self, textures: list[ir.Uniform]) -> list[Line]:
        """The samplers, one a line."""
        channels = self.target.channels
        if channels:
            named = zip(textures, channels, strict=False)  # a program with more textures is refused before
            return [Line(f"#define {texture.name} {channel}", texture.span) for texture, channel in named]
        lines = []
        for texture in textures:
            type_ = self.type(texture.type)
            lines.append(with_doc(f"uniform {type_} {texture.name};", texture))
        return lines
