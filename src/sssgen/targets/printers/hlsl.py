"""Prints HLSL: Shader Model 5 and 6, and the dialects of Unity's pipelines.

Matrices. GLSL's `mat3(a, b, c)` has columns a, b, c; HLSL's `float3x3(a, b, c)` has rows a, b, c. The printed text
has the same numbers in the same order: column i of the IR is row i of HLSL, so `m[i]` and constructors mean the same.
Products then swap their operands: `M * v` is `mul(v, M)` and `A * B` is `mul(B, A)`. A matrix in a constant buffer is
declared `row_major`, so its rows, the columns of the IR, are stored one after the other, as std140 stores columns. An
engine stores its matrices otherwise (Unity's multiply columns from the left, `mul(M, v)`), so there a matrix uniform is
transposed where it is read.
"""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING

from sssgen.ir import nodes as ir
from sssgen.ir.image_formats import FORMATS
from sssgen.ir.memory_operations import MEMORY
from sssgen.ir.types import FLOAT, INT, Array, Image, Matrix, Sampler, Scalar, Struct, Vector, kind_of
from sssgen.ir.walk import subexpressions
from sssgen.passes.uniform_blocks import block_type
from sssgen.targets.descriptor import Target
from sssgen.targets.printers import hlsl_sizes
from sssgen.targets.printers.byte_buffers import BytePrinter
from sssgen.targets.printers.hlsl_entry import print_entry
from sssgen.targets.printers.printed_lines import Line, with_doc
from sssgen.targets.printers.printer import POSTFIX, PRIMARY, UNARY
from sssgen.targets.uniform_layout import Member

if TYPE_CHECKING:
    from sssgen.targets.reflection_record import TextureBinding

_SHIFTS = ("<<", ">>")
LONGEST_UNROLLED = 8
"""Loops with more rounds than this are not unrolled."""


class HlslPrinter(BytePrinter):
    """One printer for all dialects; the descriptor has the texts of textures and uniforms."""

    constant = "static const"
    private = "static "

    def __init__(self, target: Target, module: ir.Module) -> None:
        super().__init__(target, module)
        self.sized: set[hlsl_sizes.SizeFunction] = set()
        self.overloads = Counter([function.name for function in module.functions])

    @property
    def engine_matrices(self) -> bool:
        return self.target.uniform_style == "unity"

    def binary(self, binary: ir.Binary) -> tuple[str, int]:
        left, right = binary.left.type, binary.right.type
        linear = isinstance(left, Matrix | Vector) and isinstance(right, Matrix | Vector)
        if binary.op == "*" and linear and (isinstance(left, Matrix) or isinstance(right, Matrix)):
            return f"mul({self.expr(binary.right)}, {self.expr(binary.left)})", PRIMARY
        if binary.op in _SHIFTS and kind_of(left) != kind_of(right) and _is_untyped(binary.left):
            # a bare literal would take the count's type, and shift in zeros in place of the sign
            binary = binary._replace(left=ir.Construct(left, (binary.left,), binary.left.span))
        return super().binary(binary)

    def intrinsic(self, call: ir.Intrinsic) -> tuple[str, int]:
        """A builtin; DXC takes negative ints for uints where all arguments are literals."""
        first = call.args[0]
        if first.type == INT and all(map(_is_untyped, call.args)):
            call = call._replace(args=(ir.Construct(INT, (first,), first.span), *call.args[1:]))
        return super().intrinsic(call)

    def call(self, call: ir.Call) -> str:
        """A call; literals do not choose between overloads."""
        if any(map(_is_untyped, call.args)) and self.overloads[self.by_key[call.function].name] > 1:
            args = [ir.Construct(arg.type, (arg,), arg.span) if _is_untyped(arg) else arg for arg in call.args]
            call = call._replace(args=tuple(args))
        return super().call(call)

    def construct(self, construct: ir.Construct) -> tuple[str, int]:
        type_, args = construct.type, construct.args
        if isinstance(type_, Array | Struct):  # only in an initialiser
            return "{ " + self.arguments(args) + " }", PRIMARY
        if kind_of(type_) == "uint" and any(map(_is_untyped_choice, args)):
            # DXC converts `float(uint(b ? 2 : -5))` from a literal to a float
            args = tuple([ir.Construct(INT, (arg,), arg.span) if _is_untyped_choice(arg) else arg for arg in args])
            construct = construct._replace(args=args)
        if len(args) == 1 and not isinstance(type_, Scalar):  # a splat or a conversion is a cast here
            text, binding = self.bound(args[0])
            return f"({self.type(type_)}){text if binding >= POSTFIX else f'({text})'}", UNARY
        return super().construct(construct)

    def global_value(self, value: ir.Global) -> str:
        engine_matrix = self.engine_matrices and isinstance(value.type, Matrix)
        is_uniform = engine_matrix and any(uniform.name == value.name for uniform in self.module.uniforms)
        return f"transpose({value.name})" if is_uniform else value.name

    def print_function(self, function: ir.Function) -> list[Line]:
        """A function, after those that return the sizes and levels of its textures."""
        needed = [each for each in hlsl_sizes.size_functions(function) if each not in self.sized]
        self.sized.update(needed)
        lines = [line for each in needed for line in hlsl_sizes.definition(each)]
        return [*lines, *super().print_function(function)]

    def statement(self, stmt: ir.Stmt, indent: int) -> list[Line]:
        """A statement; a loop with an attribute, as FXC would try to unroll 64 steps of a ray march."""
        lines = super().statement(stmt, indent)
        if isinstance(stmt, ir.For | ir.While):
            lines.insert(0, Line(f"{'    ' * indent}{'[unroll]' if self.is_short(stmt) else '[loop]'}", stmt.span))
        return lines

    def is_short(self, loop: ir.For | ir.While) -> bool:
        """Whether a loop counts up to a small constant."""
        if not isinstance(loop, ir.For) or not isinstance(loop.init, ir.Declare):
            return False
        bound = loop.condition.right if isinstance(loop.condition, ir.Binary) else None
        if isinstance(bound, ir.Global):
            name = bound.name
            bound = next((constant.value for constant in self.module.constants if constant.name == name), None)
        start = loop.init.value
        if not isinstance(bound, ir.Literal) or not isinstance(start, ir.Literal):
            return False
        return abs(bound.value - start.value) <= LONGEST_UNROLLED

    def print_uniforms(self, members: list[Member]) -> list[Line]:
        """The constant buffer; only its members where the shell declares the buffer (Unity)."""
        lines: list[Line] = []
        bindings = self.target.bindings
        pad = "    " if bindings.material_block else ""
        for member in members:
            lines += [Line(f"{pad}float padding_{member.offset}_{index};") for index in range(member.padding)]
            type_ = block_type(member.uniform.type, self.target.capabilities)
            of_matrices = isinstance(type_.element if isinstance(type_, Array) else type_, Matrix)
            major = "row_major " if of_matrices and not self.engine_matrices else ""
            declared = self.variable(type_, member.uniform.name)
            lines.append(with_doc(f"{pad}{major}{declared};", member.uniform))
        if lines and bindings.material_block:
            head = f"cbuffer {bindings.material_block} : register({bindings.material_register}) {{"
            lines = [Line(head), *lines, Line("};")]
        return lines

    def print_textures(self, textures: list[ir.Uniform]) -> list[Line]:
        """The textures and their samplers, by the pattern of the descriptor."""
        pattern = self.target.textures.declaration
        lines: list[Line] = []
        for binding, texture in enumerate(textures):
            text = pattern.format(
                name=texture.name,
                sampler=self.sampler(texture.name),
                type=self.type(texture.type),
                sampler_type=self.sampler_type(texture.type),
                dim=texture.type.dim.upper(),  # type: ignore[union-attr]  # textures have sampler types
                binding=binding,
            )
            lines += [Line(part, texture.span) for part in text.splitlines()]
        return lines

    def print_variable(self, variable: ir.Variable) -> list[Line]:
        if variable.storage == "shared":
            text = f"groupshared {self.variable(variable.type, variable.name)};"
            return self.with_comments(variable, [Line(text, variable.span)])
        if variable.storage == "image":
            return self.with_comments(variable, [Line(self.image(variable), variable.span)])
        if variable.storage != "buffer":
            return super().print_variable(variable)
        register, written = ("t", "") if variable.access == "readonly" else ("u", "RW")
        kind = f"{written}ByteAddressBuffer"
        if variable.name not in self.bytes:
            assert isinstance(variable.type, Struct)
            (member,) = variable.type.fields
            element = member.type.element if isinstance(member.type, Array) else member.type
            kind = f"{written}StructuredBuffer<{self.type(element)}>"
        first = sum([isinstance(uniform.type, Sampler) for uniform in self.module.uniforms]) if register == "t" else 0
        place = f"register({register}{first + self.buffer_binding(variable)})"
        text = f"{kind} {variable.name} : {place};"
        return self.with_comments(variable, [Line(text, variable.span)])

    def image(self, variable: ir.Variable) -> str:
        """The declaration of an image."""
        image = variable.type
        assert isinstance(image, Image)
        shape, form = f"{image.dim}{'Array' if image.array else ''}", FORMATS.get(variable.layout)
        norm = f"{form.norm} " if form is not None and form.norm else ""
        texel = f"{norm}{image.kind}{'' if form is not None and form.numbers == 1 else '4'}"
        return f"RWTexture{shape}<{texel}> {variable.name} : register(u{self.image_binding(variable)});"

    def image_binding(self, image: ir.Variable) -> int:
        """The binding of the source, or the next one that neither a storage buffer nor another image has."""
        taken = {self.buffer_binding(buffer) for buffer in self.buffers if buffer.access != "readonly"}
        bindings: dict[str, int] = {}
        for each in self.images:
            binding = max(each.location, 0)
            while binding in taken:
                binding += 1
            taken.add(binding)
            bindings[each.name] = binding
        return bindings[image.name]

    def memory_text(self, stmt: ir.MemoryOperation) -> str:
        image = stmt.args[0] if stmt.args else None
        form = next((FORMATS.get(each.layout) for each in self.images if each.name == getattr(image, "name", "")), None)
        text = MEMORY[stmt.name].texts.get("hlsl-one") if form is not None and form.numbers == 1 else None
        return text or super().memory_text(stmt)

    def bound(self, expr: ir.Expr) -> tuple[str, int]:
        """An expression; the member of a storage buffer is the buffer, or its first element."""
        if isinstance(expr, ir.Member) and isinstance(expr.value, ir.Global):
            name = expr.value.name
            if name not in self.bytes and any(buffer.name == name for buffer in self.buffers):
                return (name, PRIMARY) if isinstance(expr.type, Array) else (f"{name}[0]", POSTFIX)
        return super().bound(expr)

    def memory(self, stmt: ir.MemoryOperation) -> str:
        if stmt.name != "arrayLength" or stmt.result is None or self.place_of(stmt.args[0]) is not None:
            return super().memory(stmt)
        name = self.expr(stmt.result)
        size, stride = self.free_name(f"{name}_size"), self.free_name(f"{name}_stride")
        call = f"{self.expr(stmt.args[0])}.GetDimensions({size}, {stride})"
        return f"uint {size}, {stride};\n{call};\n{name} = int({size});"

    def print_entry(self, name: str) -> list[Line]:
        assert self.stage is not None
        return print_entry(self, self.stage, name, self.stage.resolution)

    def binding(self, index: int) -> TextureBinding:
        if not self.target.bindings.material_block:
            return {}
        return {"texture": f"t{index}", "sampler": f"s{index}"}


def _is_untyped(expr: ir.Expr) -> bool:
    """Whether it consists of number literals, which have types of their own: literal int, literal float."""
    if isinstance(expr, ir.Literal):
        return expr.type in (FLOAT, INT)
    if isinstance(expr, ir.Unary):
        return _is_untyped(expr.operand)
    if isinstance(expr, ir.Binary):
        alone = expr.op in _SHIFTS or _is_untyped(expr.right)
        return alone and expr.type in (FLOAT, INT) and _is_untyped(expr.left)
    return isinstance(expr, ir.Select) and _is_untyped(expr.yes) and _is_untyped(expr.no)


def _is_untyped_choice(expr: ir.Expr) -> bool:
    return expr.type == INT and _is_untyped(expr) and any(isinstance(part, ir.Select) for part in subexpressions(expr))
