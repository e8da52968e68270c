"""Prints the Metal Shading Language, C++ with vectors.

There are no global variables but constants, so uniforms and textures are parameters of every function. Out parameters
are references into the thread's memory. C++ copies no arrays: here they are members of a struct, which it does copy;
the template declares it where the text names it.
"""

from __future__ import annotations

from sssgen.ir import nodes as ir
from sssgen.ir.types import Array, Sampler, Struct, Type
from sssgen.targets.printers.printed_lines import Line, documented
from sssgen.targets.printers.printer import POSTFIX, PRIMARY, Printer
from sssgen.targets.uniform_layout import Member

ARRAY = "fixed_array"


class MetalPrinter(Printer):
    """Overrides arrays, constructors of structs, and parameters."""

    constant = "constant"

    def type(self, type_: Type) -> str:
        if isinstance(type_, Array):
            return f"{ARRAY}<{self.type(type_.element)}, {type_.length}>"
        return super().type(type_)

    def variable(self, type_: Type, name: str) -> str:
        return f"{self.type(type_)} {name}"

    def bound(self, expr: ir.Expr) -> tuple[str, int]:
        if isinstance(expr, ir.Index) and isinstance(expr.value.type, Array):
            return f"{self.expr(expr.value, POSTFIX)}.items[{self.expr(expr.index)}]", POSTFIX
        if isinstance(expr, ir.Swizzle) and isinstance(expr.value, ir.Swizzle):  # v.zyx.x is v.z
            letters = "".join([expr.value.components["xyzw".index(letter)] for letter in expr.components])
            return self.bound(expr._replace(value=expr.value.value, components=letters))
        return super().bound(expr)

    def construct(self, construct: ir.Construct) -> tuple[str, int]:
        if isinstance(construct.type, Array):
            return f"{self.type(construct.type)}{{{{{self.arguments(construct.args)}}}}}", PRIMARY
        if isinstance(construct.type, Struct):
            return f"{construct.type.name}{{{self.arguments(construct.args)}}}", PRIMARY
        return super().construct(construct)

    def simple(self, stmt: ir.Stmt) -> str:
        return "discard_fragment()" if isinstance(stmt, ir.Discard) else super().simple(stmt)

    def param(self, param: ir.Param) -> str:
        if isinstance(param.type, Sampler) or param.direction == "in":
            return super().param(param)
        return f"thread {self.type(param.type)}& {param.name}"

    def passed(self, uniform: ir.Local, param: ir.Param) -> str:
        return self.argument(uniform, param) if isinstance(param.type, Sampler) else f"material.{uniform.name}"

    def print_uniforms(self, members: list[Member]) -> list[Line]:
        """The struct of the uniforms."""
        fields = [
            documented(f"    {self.variable(member.uniform.type, member.uniform.name)};", member.uniform)
            for member in members
        ]
        return [Line("struct Material {"), *fields, Line("};")] if fields else []

    def print_textures(self, textures: list[ir.Uniform]) -> list[Line]:
        """None: textures are parameters of the fragment function, which the template declares."""
        return []

    def binding(self, index: int) -> dict[str, int | str]:
        return {"texture": index, "sampler": index}
