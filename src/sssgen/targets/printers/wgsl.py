"""Prints the subset of WGSL that naga and Tint both accept.

Out parameters are pointers; a variable that is assigned only once is a `let`; uniforms are in one struct.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from sssgen.ir import nodes as ir
from sssgen.ir.image_formats import FORMATS
from sssgen.ir.intrinsics import BUILTINS
from sssgen.ir.types import VOID, Array, Image, Sampler, Struct, Type
from sssgen.ir.walk import subexpressions
from sssgen.passes.scopes import assigned, outs_of
from sssgen.passes.uniform_blocks import block_type
from sssgen.targets.descriptor import Target
from sssgen.targets.printers.atomic_printer import AtomicPrinter
from sssgen.targets.printers.printed_lines import Line, with_doc, wrap
from sssgen.targets.printers.printer import PRIMARY, UNARY
from sssgen.targets.printers.wgsl_entry import print_entry
from sssgen.targets.uniform_layout import Member, padding

if TYPE_CHECKING:
    from sssgen.targets.reflection_record import TextureBinding

_ACCESS = {"readonly": "read", "writeonly": "write", "": "read_write"}
_TYPED = (ir.Local, ir.Global, ir.Call, ir.Construct)


class WgslPrinter(AtomicPrinter):
    """Overrides declarations and parameters; expressions differ in conversions and selects."""

    load = "atomicLoad(&{0})"
    store = "atomicStore(&{0}, {1})"
    atomic = "atomic<{0}>"

    def __init__(self, target: Target, module: ir.Module) -> None:
        super().__init__(target, module)
        self.uniforms = frozenset(uniform.name for uniform in module.uniforms)
        self.outs = outs_of(module.functions)
        self.assigned: set[str] = set()
        """The variables that the current function assigns to after their declaration."""
        self.pointers: set[str] = set()
        """The parameters of the current function that are pointers."""

    def type(self, type_: Type) -> str:
        if isinstance(type_, Array):
            return self.array_of(self.type(type_.element), type_.length)
        return super().type(type_)

    def array_of(self, element: str, length: int) -> str:
        return f"array<{element}, {length}>" if length else f"array<{element}>"

    def variable(self, type_: Type, name: str) -> str:
        return f"{name}: {self.type(type_)}"

    def enter(self, function: ir.Function) -> None:
        super().enter(function)
        self.assigned = assigned(function, self.outs)
        self.pointers = {param.name for param in function.params if param.direction != "in"}

    def local(self, local: ir.Local) -> tuple[str, int]:
        return (f"*{local.name}", UNARY) if local.name in self.pointers else super().local(local)

    def global_value(self, value: ir.Global) -> str:
        in_block = value.name in self.uniforms and not isinstance(value.type, Sampler)
        return f"material.{value.name}" if in_block else value.name

    def intrinsic(self, call: ir.Intrinsic) -> tuple[str, int]:
        if "wgsl" in BUILTINS[call.name].explicit_type and not _has_type(call):
            first = call.args[0]
            call = call._replace(args=(ir.Construct(first.type, (first,), first.span), *call.args[1:]))
        return super().intrinsic(call)

    def select(self, select: ir.Select) -> tuple[str, int]:
        return f"select({self.arguments((select.no, select.yes, select.condition))})", PRIMARY

    def join_arguments(self, texts: list[str]) -> str:
        """The arguments; `(x < y), (z > t)` are in parentheses, as `x < y, z > t` would be read as a template x<y, z>.

        Both are, as npm wesl reads `<y), z>` as a template, too.
        """
        text = ", ".join(texts)
        if " < " not in text:
            return text
        less = [*[_has_open(" < ", text) for text in texts[:-1]], False]
        closed = [less[index] or (any(less[:index]) and _has_open(" >", text)) for index, text in enumerate(texts)]
        return ", ".join([f"({text})" if close else text for text, close in zip(texts, closed, strict=True)])

    def argument(self, arg: ir.Expr, param: ir.Param) -> str:
        if param.direction == "in" or not isinstance(arg, ir.Local):
            return super().argument(arg, param)
        return arg.name if arg.name in self.pointers else f"&{arg.name}"

    def target_of(self, target: ir.Expr) -> str:
        return self.expr(target, UNARY)

    def declare(self, declare: ir.Declare) -> str:
        written = declare.name in self.assigned
        word = "var" if written or declare.value is None else "let"
        if declare.value is None:
            return f"{word} {self.variable(declare.type, declare.name)}"
        return f"{word} {declare.name} = {self.typed(declare.value, declare.type)}"

    def typed(self, value: ir.Expr, type_: Type) -> str:
        """An initialiser. An untyped literal is abstract, for which `i32` and `f32` are the defaults anyway."""
        return self.expr(value)

    def param(self, param: ir.Param) -> str:
        if isinstance(param.type, Sampler) or param.direction == "in":
            return super().param(param)
        return f"{param.name}: ptr<function, {self.type(param.type)}>"

    def signature(self, function: ir.Function) -> str:
        params = ", ".join([self.param(param) for param in function.params])
        result = "" if function.result == VOID else f" -> {self.type(function.result)}"
        return f"fn {function.name}({params}){result}"

    def print_struct(self, struct: ir.StructDecl) -> list[Line]:
        assert isinstance(struct.type, Struct)
        name = struct.type.name
        fields = [
            Line(f"    {field.name}: {self.stored_type(field.type, (name, field.name))},", struct.span)
            for field in struct.type.fields
        ]
        return [Line(f"struct {name} {{", struct.span), *fields, Line("}")]

    def print_constant(self, constant: ir.Constant) -> list[Line]:
        declared = self.variable(constant.type, constant.name)
        return wrap(f"const {declared} = {self.expr(constant.value)};", constant.span)

    def buffer_binding(self, buffer: ir.Variable) -> int:
        """Behind those of the textures and samplers: buffers, then images."""
        textures = sum([isinstance(uniform.type, Sampler) for uniform in self.module.uniforms])
        number = buffer.order if buffer.order >= 0 else [*self.buffers, *self.images].index(buffer)
        return self.target.bindings.first + 1 + 2 * textures + number

    def image_binding(self, image: ir.Variable) -> int:
        return self.buffer_binding(image)

    def print_image(self, variable: ir.Variable) -> list[Line]:
        image = variable.type
        assert isinstance(image, Image)
        place = f"@group({self.group}) @binding({self.image_binding(variable)})"
        shape = f"{image.dim.lower()}{'_array' if image.array else ''}"
        texel = f"{FORMATS[variable.layout].webgpu}, {_ACCESS[variable.access]}"
        text = f"{place} var {variable.name}: texture_storage_{shape}<{texel}>;"
        return self.with_comments(variable, [Line(text, variable.span)])

    def print_variable(self, variable: ir.Variable) -> list[Line]:
        if variable.storage in ("shared", "buffer"):
            text = f"{variable.name}: {self.stored_type(variable.type, (variable.name,))};"
            if variable.storage == "shared":
                return self.with_comments(variable, [Line(f"var<workgroup> {text}", variable.span)])
            place = f"@group({self.group}) @binding({self.buffer_binding(variable)})"
            access = "read" if variable.access == "readonly" else "read_write"
            return self.with_comments(variable, [Line(f"{place} var<storage, {access}> {text}", variable.span)])
        if variable.storage == "image":
            return self.print_image(variable)
        declared = f"var<private> {self.variable(variable.type, variable.name)}"
        value = f" = {self.expr(variable.value)}" if variable.value is not None else ""
        return self.with_comments(variable, wrap(f"{declared}{value};", variable.span))

    def print_entry(self, name: str) -> list[Line]:
        assert self.stage is not None
        return print_entry(self, self.stage, name, f"material.{self.stage.resolution}")

    def print_uniforms(self, members: list[Member]) -> list[Line]:
        """The uniform struct; WGSL's own alignment gives the offsets of std140."""
        if not members:
            return []
        lines = [Line("struct Material {")]
        for member in members:
            text = self.type(block_type(member.uniform.type, self.target.capabilities))
            lines.append(with_doc(f"    {member.uniform.name}: {text},", member.uniform))
        if self.target.bindings.padded:
            lines += [Line(f"    padding_{index}: f32,") for index in range(padding(members))]
        place = f"@group({self.group}) @binding({self.target.bindings.first})"
        return [*lines, Line("}"), Line(f"{place} var<uniform> material: Material;")]

    @property
    def group(self) -> int | str:
        return self.target.bindings.group or self.target.material_group

    def print_textures(self, textures: list[ir.Uniform]) -> list[Line]:
        """Each texture and its sampler, at the bindings after the uniform struct's."""
        lines = []
        for index, texture in enumerate(textures):
            binding = self.binding(index)
            for number, name, type_ in (
                (binding["texture"], texture.name, self.type(texture.type)),
                (binding["sampler"], self.sampler(texture.name), self.sampler_type(texture.type)),
            ):
                place = f"@group({binding['group']}) @binding({number})"
                lines.append(Line(f"{place} var {name}: {type_};", texture.span))
        return lines

    def binding(self, index: int) -> TextureBinding:
        first = self.target.bindings.first
        return {"group": self.group, "texture": first + 1 + 2 * index, "sampler": first + 2 + 2 * index}


def _has_type(call: ir.Intrinsic) -> bool:
    """Whether something in the call is no literal, so that its numbers are not abstract."""
    return any(isinstance(part, _TYPED) for part in subexpressions(call))


def _has_open(operator: str, text: str) -> bool:
    """Whether an operator is outside of parentheses."""
    if operator not in text:
        return False
    depth = 0
    for index, char in enumerate(text):
        depth += (char in "([") - (char in ")]")
        if depth == 0 and text.startswith(operator, index):
            return True
    return False
