"""Prints GLSL: 3.30 core and ES 3.00, the language that the IR is closest to."""

from __future__ import annotations

from sssgen.ir import nodes as ir
from sssgen.ir.types import Scalar, Vector, kind_of
from sssgen.passes.stage.stage_interface import COLORS
from sssgen.targets.descriptor import Target
from sssgen.targets.printers.printer import Line, Printer, documented
from sssgen.targets.uniform_layout import Member


class GlslPrinter(Printer):
    """Uniforms are in the default block; everything else is as in the IR."""

    def __init__(self, target: Target, module: ir.Module) -> None:
        super().__init__(target, module)
        self.builtins = {
            variable.name: variable.builtin
            for variable in module.variables
            if variable.builtin and variable.builtin not in COLORS
        }

    def global_value(self, value: ir.Global) -> str:
        return self.builtins.get(value.name, value.name)

    def print_variable(self, variable: ir.Variable) -> list[Line]:
        """A variable as it was written. Builtins need no declaration, except for the colours of older versions."""
        if variable.name in self.builtins:
            return []
        if variable.storage == "private":
            return super().print_variable(variable)
        word = variable.interpolation
        words = [word] if word and (word != "noperspective" or self.target.capabilities.noperspective) else []
        text = " ".join([*words, variable.storage, self.variable(variable.type, variable.name)])
        return self.with_comments(variable, [Line(f"{self.layout(variable)}{text};", variable.span)])

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
        return [
            documented(f"uniform {self.variable(uniform.type, uniform.name)}{self.default(uniform)};", uniform)
            for uniform in (member.uniform for member in members)
        ]

    def default(self, uniform: ir.Uniform) -> str:
        """The initial value of a uniform, where the version allows one."""
        plain = isinstance(uniform.type, Scalar | Vector) and uniform.type.kind != "bool"
        if not self.kept or not plain or not any(uniform.default) or not self.target.capabilities.uniform_values:
            return ""
        number = Scalar(kind_of(uniform.type))
        integral = number.kind != "float"
        parts = [ir.Literal(number, int(value) if integral else value, uniform.span) for value in uniform.default]
        texts = ", ".join(map(self.literal, parts))
        return f" = {texts if len(parts) == 1 else f'{self.type(uniform.type)}({texts})'}"

    def print_textures(self, textures: list[ir.Uniform]) -> list[Line]:
        """The samplers, one a line."""
        lines = []
        for texture in textures:
            type_ = self.type(texture.type)
            lines.append(documented(f"uniform {type_} {texture.name};", texture))
        return lines
